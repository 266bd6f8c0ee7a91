"""A run in a store: its arrays are read where they are indexed."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any

from garrison import run_file
from garrison.record import Run, assembled
from garrison.words import count, hinted_methods


@hinted_methods
class StoredRun(Run):
    """A run that was written while it went on (`to` of `simulate` and `replay`), and does not fit into memory.

    A `Run` whose arrays are read where they are indexed: `run.error[0, -100:]` reads the chunks that hold these
    samples, `np.asarray(run.error)` all of it (refused where it is too large); `to_xarray` gives the dataset without
    reading its arrays. What looks at whole arrays (`alarms`, `to_pandas`, `save`, ==) reads them. `Run.load` reads all.

    No warning is made that looks at whole arrays; `warnings` says so. Arrays that `keep` thins (`garrison.every`) are
    in the dataset alone.

    Attributes
    ----------
    path : Path
        Where it is.
    """

    path: Path

    def to_xarray(self) -> Any:
        """The xarray.Dataset of the store, read where it is asked for; in dask's arrays where dask is there."""
        from garrison.labelled_files import lazily

        return lazily(self.path)

    def __reduce__(self) -> Any:
        return stored, (self.path,)

    def __repr__(self) -> str:
        trials, times, agents = self.shape
        sizes = (count(trials, "trial"), count(max(times - 1, 0), "sample"), count(agents, "agent"))
        return f"<StoredRun of {self.filter.name}: {', '.join(sizes)}, in {self.path}>"


def stored(path: Path) -> StoredRun:
    """The run that was written there as it went. Raises IoError where there is none."""
    run = run_file.opened(path, partial(assembled, StoredRun))
    assert isinstance(run, StoredRun)
    run.path = path
    return run
