"""A run that is written while it goes on: a folder of zarr that takes blocks of samples."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from numpy.typing import NDArray

from garrison import _core, run_file
from garrison.growing import Growing, Writer, chunks
from garrison.labelled import about, axes, dataset, thinned
from garrison.labelled_files import DIGEST, DOCUMENT, STREAMED, THINNED, is_run, require_zarr
from garrison.paths import growing_folder, path, told
from garrison.storage import digest
from garrison.words import refusal

if TYPE_CHECKING:
    from garrison.record import Run

#: what a run that was written as it went has not looked for
UNSEEN = (
    "the run was written as it went: nothing looked at whole arrays, so no warning tells of tests above their level, "
    "bounds or tests that end, measurements that contradict the model, or estimates that diverge"
)
#: what `keep` calls report is several arrays
REPORT = ("bound", "bound_kind", "published", "statistic", "threshold", "verdict")


def place(to: Any) -> Path:
    """Where a run is written as it goes; refused where it cannot be."""
    found = path("to", to)
    if found.suffix != ".zarr":
        advice = 'other formats are written from memory: garrison.Run.load("run.zarr").save("run.nc")'
        raise refusal("to", str(found), "a name that ends in .zarr", advice)
    require_zarr("to")
    return found


@contextmanager
def written(
    to: Path | None, model: _core.Model, filter: _core.Filter, trials: int, every: dict[str, int]
) -> Iterator[Store | None]:
    """The store of a run that goes on, which takes its place at the end if all went well; None without `to`."""
    if to is None:
        yield None
        return
    with growing_folder(to, is_run) as folder:
        store = Store(to, folder, model, filter, trials, every)
        try:
            yield store
        finally:
            store.close()


class Store:
    """The folder of a run that goes on, and the place that it will take. every: steps of what `keep` thins."""

    def __init__(
        self, to: Path, folder: Path, model: _core.Model, filter: _core.Filter, trials: int, every: dict[str, int]
    ) -> None:
        import zarr

        with told(to):
            self._group = zarr.open_group(folder, mode="w", zarr_format=2)
        self._to = to
        self._folder, self._filter, self._model, self._trials = folder, filter, model, trials
        self._steps = every | dict.fromkeys(REPORT, every.get("report", 1))
        self._arrays: dict[str, Growing] = {}
        self._writer = Writer()

    def take(self, trial: int, block: list[tuple[str, NDArray[Any], int, int, int]]) -> None:
        """Write a block of a trial: (name, rows, number of the first one, how many a trial has, time of row 0)."""
        with told(self._to):
            for name, rows, start, total, first in block:
                self._put(trial, name, rows, start, total, first)

    def _put(self, trial: int, name: str, rows: NDArray[Any], start: int, total: int, first: int) -> None:
        step = self._steps.get(name, 1)
        if step > 1:  # rows before a time t are those of the multiples of step below it
            rows = rows[-(start + first) % step :: step]
            before = _multiples(first, step)
            start = _multiples(start + first, step) - before
            total = _multiples(total + first, step) - before
        for own, values in self._named(name, rows):
            self._growing(own, step, values, total).put(trial, start, values)

    def finish(self, run: Run) -> None:
        """Write everything else of the run, which holds no array that was written here."""
        with told(self._to):
            self._writer.finish()
        small = run_file.labelled(run)
        whole = [name for name in self._arrays if self._step(name) == 1]
        rest = [name for name in self._arrays if name not in whole]
        said = {"arrays": [*whole, *small], STREAMED: whole, THINNED: rest}
        text = json.dumps(run_file.document(run) | said)
        lengths: dict[str, int] = {}
        for one in self._arrays.values():
            lengths |= zip(one.axes, one.array.shape, strict=True)
        data = dataset(run, small, lengths).assign_attrs({DOCUMENT: text, DIGEST: digest(text, small)})
        data.attrs = {name: str(value) for name, value in data.attrs.items()}
        with told(self._to):
            data.to_zarr(self._folder, mode="a", consolidated=False, zarr_format=2)

    def close(self) -> None:
        """Write nothing more: the folder may go."""
        self._writer.close()

    def _named(self, name: str, rows: NDArray[Any]) -> Iterator[tuple[str, NDArray[Any]]]:
        """Arrays as a dataset calls them: of signals each is one of its own."""
        if name != "signals":
            yield name, rows
            return
        for k, signal in enumerate(self._filter.signal_names):
            yield run_file.label(f"{run_file.SIGNAL}{signal}"), rows[:, k]

    def _growing(self, name: str, step: int, rows: NDArray[Any], total: int) -> Growing:
        if name not in self._arrays:
            names = axes(self._filter, name)
            if step > 1:
                names = (names[0], thinned(names[1], step), *names[2:])
            shape = (self._trials, total, *rows.shape[1:])
            from numcodecs import Zstd

            codec = Zstd(level=-1, checksum=True)
            array = self._created(name, names, shape, rows, codec)
            self._arrays[name] = Growing(array, names, self._folder / array.path, codec, self._writer)
        return self._arrays[name]

    def _created(
        self, name: str, names: tuple[str, ...], shape: tuple[int, ...], rows: NDArray[Any], codec: Any
    ) -> Any:
        """A new array of the folder: little time for compression, sums that tell of damage, every chunk written."""
        return self._group.create_array(
            name,
            shape=shape,
            chunks=chunks(shape, rows.itemsize),
            dtype=rows.dtype,
            compressors=codec,
            fill_value=None,
            attributes={"_ARRAY_DIMENSIONS": list(names), **about(self._model, name)},
        )

    def _step(self, name: str) -> int:
        """The step of an array of the folder."""
        return 1 if axes(self._filter, name) == self._arrays[name].axes else 2


def _multiples(time: int, step: int) -> int:
    """How many multiples of step are below a time."""
    return -(-time // step)
