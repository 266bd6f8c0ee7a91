"""gr.sweep: all points and trials, resumed where an earlier run ended."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from garrison import _core, arguments, paths
from garrison.drawing import drawn
from garrison.result import Result
from garrison.scenario import read_document
from garrison.scenario.overrides import digest, overridden
from garrison.sweeps.grid import Point, points_of
from garrison.sweeps.pool import outcomes
from garrison.sweeps.tables import Row, point_rows, read_part, trial_rows, write_csv, write_parquet
from garrison.sweeps.work import COLUMNS, Task, rows_of
from garrison.words import count, hinted, hinted_methods, refusal, shown

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Progress = Callable[[int, int], None]

#: what an output folder holds that says which sweep it is of
MANIFEST = "sweep.json"
#: seconds that a task should last, and the trials that lanes take at once
_LASTS, _LANES = 5.0, 8


@hinted_methods
@dataclass(eq=False, repr=False)
class Sweep(Result):
    """What a sweep over values of a scenario found.

    Attributes
    ----------
    title : str
        For tables and pictures.
    keys : list of str
        What was varied.
    trials : list of dict
        One row per point, filter, condition and trial.
    points : list of dict
        One row per point, filter and condition.
    refused, lost : list of str
        Points that were refused, trials that were lost.
    folder : Path
        With trials.csv, points.csv (and .parquet where pyarrow is installed), sweep.json and the parts.
    """

    title: str
    keys: list[str]
    trials: list[Row] = field(repr=False)
    points: list[Row] = field(repr=False)
    refused: list[str]
    lost: list[str]
    folder: Path

    def to_pandas(self) -> Any:
        """trials.csv as a pandas.DataFrame (extra: pandas)."""
        import pandas as pd

        return pd.read_csv(self.folder / "trials.csv")

    def plot(self) -> Figure:
        """Errors over the values: bands for one key, maps for two (extra: plot)."""
        return drawn("sweep_figure", self)


@hinted
def sweep(
    scenario: str | Path,
    *,
    set: Mapping[str, Iterable[Any]] | None = None,
    points: Sequence[Point] | None = None,
    trials: int = 1,
    out: str | Path,
    workers: int = 1,
    client: Any = None,
    block: int | None = None,
    independent: bool = False,
    progress: Progress | None = None,
) -> Sweep:
    """Run the scenario's filters at all combinations of the values in `set`, and sum up every trial.

    trials.csv has the same bytes for any workers, client, block and number of restarts, but for its column `seconds`. A
    point that is refused is a row with the reason; a task whose worker dies three times is a row "lost". Ctrl-C keeps
    what is done.

    Parameters
    ----------
    scenario : str or Path
        Scenario file (TOML).
    set : dict, optional
        Key of the scenario -> values, as {"filter.threshold": np.linspace(.5, 2, 8), "attack[0].value": [1, 5,
        25]}.
    points : sequence of dict, optional
        Such keys and values, in place of all combinations.
    trials : int
        Of every point, >= 1.
    out : str or Path
        Folder for the tables; where it holds a part of the same sweep, that is kept and the rest is run.
    workers : int
        Processes on this machine, each with one thread (a script that starts more than one must guard its main
        code by `if __name__ == "__main__":`).
    client : dask.distributed.Client, optional
        In place of workers; its workers see the same files.
    block : int, optional
        Trials of a task, default: so many that one lasts a few seconds.
    independent : bool
        Another seed at every point; else all points have the same noise.
    progress : callable, optional
        progress(done, total) counts tasks.

    Returns
    -------
    Sweep
        The table; `plot()` draws it.

    Raises
    ------
    InvalidInput
        Something does not fit, or `out` holds another sweep.
    """
    path = paths.path("scenario", scenario).absolute()
    independent, progress = arguments.flag("independent", independent), arguments.callback("progress", progress)
    if client is not None and not hasattr(client, "submit"):
        raise refusal("client", shown(client), "a dask.distributed Client, or None")
    document = read_document(path)
    if set is not None and not isinstance(set, Mapping):
        raise refusal("set", shown(set), "a mapping of keys of the scenario to lists of values")
    if points is None:
        points = points_of(set or {})
    elif set:
        raise refusal("sweep", "both set and points", "one of them")
    elif isinstance(points, (str, bytes)) or not isinstance(points, Sequence):
        raise refusal("points", shown(points), "a list of mappings of keys to values")
    elif wrong := [p for p in points if not isinstance(p, Mapping)]:
        raise refusal("points", f"an entry {shown(wrong[0])}", "a mapping of keys to values")
    trials = arguments.whole("trials", trials, 1, 2**24)
    workers = arguments.whole("workers", workers, 1, 4096)
    if block is not None:
        block = arguments.whole("block", block, 1)
    hashes = [_hash(document, point, path) for point in points]
    seeds = [_seed(document, h) if independent else None for h in hashes]
    folder = paths.path("out", out).absolute()
    plan = {
        "scenario": digest(document, path.parent),
        "version": _core.__version__,
        "points": list(points),
        "trials": trials,
        "independent": independent,
    }
    known = _claimed(folder, plan, path)
    if block is None:
        block = known or _fitting_block(path, points, hashes, trials)
    _write_manifest(folder, plan, block, path)
    jobs = [
        Task(str(path), k, json.dumps(point), seeds[k], first, min(block, trials - first), str(folder), "")
        for k, point in enumerate(points)
        for first in range(0, trials, block)
    ]
    jobs = [_named(job, hashes[job.point]) for job in jobs]
    lost = _run(jobs, workers, client, progress)
    return _collected(path, document, list(points), jobs, lost, plan, folder)


def _hash(document: dict[str, Any], point: Point, path: Path) -> str:
    try:
        return digest(overridden(document, point), path.parent)
    except _core.InvalidInput as error:  # a key that leads nowhere is a mistake in the command, not in a point
        raise _core.InvalidInput(f"set: {error}") from None


def _seed(document: dict[str, Any], hashed: str) -> int:
    own = document.get("run", {}).get("seed", 0)
    return (int(own) ^ int(hashed, 16)) & (2**63 - 1)


def _named(job: Task, hashed: str) -> Task:
    seed = "" if job.seed is None else "-i"
    return Task(**(vars(job) | {"name": f"{hashed}{seed}-{job.first}-{job.count}"}))


def _claimed(folder: Path, plan: dict[str, Any], path: Path) -> int | None:
    """Make the folder, or see that it holds the same sweep; its block where it does."""
    inside = paths.folder("out", folder)
    parts = folder / "parts"
    if not inside or inside == [parts]:  # ended before its manifest was written
        paths.folder("out", parts)
        return None
    try:
        found = json.loads((folder / MANIFEST).read_text(encoding="utf-8"))
        block = int(found["block"])
    except (OSError, ValueError, TypeError, KeyError):
        raise refusal(
            "out", f"{folder}, which holds something else", "a new folder, or one of the same sweep"
        ) from None
    plain = json.loads(json.dumps(plan))
    for key, value in plain.items():
        if found.get(key) != value:
            what = f"{folder}, whose sweep differs in {key}"
            raise refusal("out", what, "a new folder, or the same sweep", f"it was made from {found.get('path', path)}")
    paths.folder("out", parts)
    return block


def _write_manifest(folder: Path, plan: dict[str, Any], block: int, path: Path) -> None:
    temporary = folder / f"{MANIFEST}.tmp"
    content = {"program": "garrison", "path": str(path)} | plan | {"block": block}
    temporary.write_text(json.dumps(content, indent=1), encoding="utf-8")
    temporary.replace(folder / MANIFEST)


def _fitting_block(path: Path, points: Sequence[Point], hashes: list[str], trials: int) -> int:
    """Trials that last a few seconds, by some timed trials of the first point that runs; a multiple of 8."""
    return max(_LANES, round(_LASTS / timed(path, points, hashes) / _LANES) * _LANES) if trials > _LANES else trials


def timed(path: Path, points: Sequence[Point], hashes: list[str]) -> float:
    """Seconds of a trial with all filters, without design, at the first point that is not refused."""
    for k, point in enumerate(points):
        job = Task(str(path), k, json.dumps(point), None, 0, _LANES, "", f"{hashes[k]}-0-{_LANES}")
        try:
            rows_of(job)  # designs
            start = time.perf_counter()
            rows_of(job)
        except _core.Error:
            continue
        return max((time.perf_counter() - start) / _LANES, 1e-6)
    return 1.0


def _run(jobs: list[Task], workers: int, client: Any, progress: Progress | None) -> dict[Task, str]:
    todo = [job for job in jobs if not job.part.exists()]
    done = len(jobs) - len(todo)
    lost: dict[Task, str] = {}
    if progress is not None:
        progress(done, len(jobs))
    for task, trouble in outcomes(todo, workers, client):
        done += 1
        if trouble is not None:
            lost[task] = trouble
        if progress is not None:
            progress(done, len(jobs))
    return lost


def _collected(
    path: Path,
    document: dict[str, Any],
    points: list[Point],
    jobs: list[Task],
    lost: dict[Task, str],
    plan: dict[str, Any],
    folder: Path,
) -> Sweep:
    marks = {"scenario_hash": plan["scenario"], "version": plan["version"]}
    parts = [(job.point, read_part(job.part)) for job in jobs if job not in lost]
    rows = trial_rows(points, parts, marks)
    rows += [{"point": job.point} | points[job.point] | _lost_row(job, why) | marks for job, why in lost.items()]
    sums = point_rows(points, rows)
    write_csv(folder / "trials.csv", rows)
    write_csv(folder / "points.csv", sums)
    write_parquet(folder / "trials.parquet", rows)
    write_parquet(folder / "points.parquet", sums)
    refused = [f"point {row['point']}: {row['status']}" for row in rows if str(row["status"]).startswith("refused")]
    keys = list(dict.fromkeys(key for point in points for key in point))
    missing = [f"point {job.point}, {count(job.count, 'trial')}: {why}" for job, why in lost.items()]
    return Sweep(str(document.get("title", path.stem)), keys, rows, sums, refused, missing, folder)


def _lost_row(job: Task, why: str) -> Row:
    return dict.fromkeys(COLUMNS, "") | {"trial": job.first, "status": f"lost: {count(job.count, 'trial')}, {why}"}
