"""OpenACC files: all cars of a recording in one file, or a file per follower with its leader."""

import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from garrison.importers.followers import Follower, read_follower
from garrison.importers.regular import longest_whole, period_of, require_increasing
from garrison.importers.texts import Grid, read_grid
from garrison.words import refusal

Array = NDArray[np.float64]
_NUMBERED = re.compile(r"(Speed|IVS)_?(\d+)", re.IGNORECASE)
#: m, by which a length may vary that is taken off all gaps
_SAME_LENGTH = 0.01
#: a car of which less is known is left out
_LEAST_KNOWN = 0.5


@dataclass(frozen=True)
class Convoy:
    """Cars in a row, the first one ahead, at a regular period, without gaps in time.

    speed: (rows, cars), m/s. gap: (rows, cars - 1), m, of every car to the one ahead. acceleration: (rows, cars),
    m/s^2, from each sample to the next one. start: s.
    """

    where: str
    names: list[str]
    period: float
    start: float
    speed: Array
    gap: Array
    acceleration: Array
    notes: list[str] = field(default_factory=list)

    def between(self, start: float | None, end: float | None) -> "Convoy":
        """The part from `start` to `end`, s. Raises InvalidInput where there are less than two samples."""
        t = self.start + self.period * np.arange(len(self.speed))
        half = 0.5 * self.period
        first = 0 if start is None else int(np.searchsorted(t, start - half))
        last = len(t) if end is None else int(np.searchsorted(t, end + half))
        if last - first < 2:
            span = f"{t[0]:g} to {t[-1]:g} s"
            raise refusal("--from, --to", f"{max(last - first, 0)} samples", f"at least two; the cars have {span}")
        part = slice(first, last)
        cut = (self.speed[part], self.gap[part], self.acceleration[part])
        return Convoy(self.where, self.names, self.period, float(t[first]), *cut, self.notes)


def read_convoy(paths: Sequence[Path]) -> Convoy:
    """The cars of one recording. Raises IoError or InvalidInput."""
    grids = [read_grid(path, {"time", "t", "timestamp", "time_index"}) for path in paths]
    wide = [any(_NUMBERED.fullmatch(name) for name in grid.names) for grid in grids]
    if wide[0] and len(paths) > 1:
        got = f"{len(paths)} files with all cars each"
        raise refusal(str(paths[1]), got, "one such file, or one file per follower", "import them one by one")
    if wide[0]:
        return _of_wide(grids[0])
    return _of_followers([read_follower(grid) for grid in grids])


def _of_wide(grid: Grid) -> Convoy:
    """Columns Time, Speed1, Speed2, .., IVS1, ..: IVSk is the gap between the cars k and k + 1."""
    columns = {(m[1].lower(), int(m[2])): name for name in grid.names if (m := _NUMBERED.fullmatch(name))}
    t = grid.column(grid.names[grid.time])
    cars = sorted(k for kind, k in columns if kind == "speed")
    speed = {k: grid.column(columns["speed", k]) for k in cars}
    gap = {k: grid.column(columns["ivs", k]) for kind, k in columns if kind == "ivs"}
    known = [k for k in cars if np.isfinite(speed[k]).mean() >= _LEAST_KNOWN]
    row = _longest_row(known, {k for k, g in gap.items() if np.isfinite(g).mean() >= _LEAST_KNOWN})
    name = {k: grid.vehicles[k - 1] if k <= len(grid.vehicles) else f"car {k}" for k in cars}
    names = [name[k] for k in row]
    notes = []
    if len(row) < len(cars):
        left = ", ".join(f"{name[k]} (Speed{k})" for k in cars if k not in row)
        notes.append(f"left out, for want of speeds, or of gaps that join them to the others: {left}")
    if any(_straight(grid, k, gap[k]) for k in row[:-1]):
        notes.append(
            "the gaps are distances in a straight line (those of the places E, N, less a length): in bends they are "
            "shorter than the road, and odometers seem to drift by as much"
        )
    if not row:
        raise refusal(str(grid.path), f"no car with more than {_LEAST_KNOWN:.0%} of its speeds", "speeds and gaps")
    gaps = [gap[k] for k in row[:-1]]
    return _whole(str(grid.path), names, t, [speed[k] for k in row], gaps, None, notes)


def _straight(grid: Grid, k: int, gap: Array) -> bool:
    """The gap behind car k is the distance of the two places in the file, less a constant."""
    names = [f"{axis}{car}" for axis in "EN" for car in (k, k + 1)]
    if not set(names) <= set(grid.names):
        return False
    east, east_behind, north, north_behind = (grid.column(name) for name in names)
    rest = np.hypot(east - east_behind, north - north_behind) - gap
    return bool(np.isfinite(rest).any()) and float(np.nanstd(rest)) < _SAME_LENGTH


def _longest_row(cars: list[int], gaps: set[int]) -> list[int]:
    """The most cars one behind the other, all gaps between them known."""
    best: list[int] = []
    row: list[int] = []
    for k in cars:
        row = [*row, k] if row and row[-1] == k - 1 and k - 1 in gaps else [k]
        best = row if len(row) > len(best) else best
    return best


def _of_followers(files: list[Follower]) -> Convoy:
    """One file per follower: ordered so that every leader is the follower of the file before."""
    files = _ordered(files)
    where, notes = ", ".join(str(f.path) for f in files), []
    first = max(f.t[0] for f in files)
    last = min(f.t[-1] for f in files)
    if last <= first:
        raise refusal(where, "recordings of different times", "one recording, a file per follower")
    period = period_of(str(files[0].path), files[0].t)
    t = first + period * np.arange(int(np.floor((last - first) / period + 1e-6)) + 1)

    def at(file: Follower, values: Array) -> Array:
        return np.asarray(np.interp(t, file.t, values))

    names = ["leader", *(f.path.stem for f in files)]
    speeds = [at(files[0], files[0].leader_speed), *(at(f, f.speed) for f in files)]
    measured: list[Array | None] = [None, *(None if f.acceleration is None else at(f, f.acceleration) for f in files)]
    if any(f.gap_is_of_positions for f in files):
        notes.append("gaps are differences of the recorded positions, which have to be along the road")
    return _whole(where, names, t, speeds, [at(f, f.gap) for f in files], measured, notes)


def _ordered(files: list[Follower]) -> list[Follower]:
    """The order of the string, from the speeds: whose leader is nobody's follower drives first."""
    if len(files) == 1:
        return files
    apart = np.array([[_apart(f, g) for g in files] for f in files])  # leader of f against follower g
    np.fill_diagonal(apart, np.inf)
    order = [int(np.argmax(apart.min(axis=1)))]
    while len(order) < len(files):
        rest = [k for k in range(len(files)) if k not in order]
        order.append(min(rest, key=lambda k: apart[k, order[-1]]))
    for ahead, behind in pairwise(order):
        if not apart[behind, ahead] < _SAME:
            raise refusal(
                f"{files[behind].path}",
                f"a leader that is the follower of no other file (nearest: {files[ahead].path}, speeds "
                f"{apart[behind, ahead]:.2g} m/s apart)",
                "files of one string, each follower the leader of the next one",
            )
    return [files[k] for k in order]


#: m/s: two columns of speeds that differ less are of the same car
_SAME = 0.5


def _apart(behind: Follower, ahead: Follower) -> float:
    """Median distance between the speed of a leader and that of a follower of another file."""
    known = (behind.t >= ahead.t[0]) & (behind.t <= ahead.t[-1])
    if known.sum() < 2:
        return float("inf")
    speeds = np.interp(behind.t[known], ahead.t, ahead.speed)
    return float(np.nanmedian(np.abs(behind.leader_speed[known] - speeds)))


def _whole(
    where: str,
    names: list[str],
    t: Array,
    speeds: list[Array],
    gaps: list[Array],
    measured: list[Array | None] | None,
    notes: list[str],
) -> Convoy:
    """The longest stretch in which every sensor has a value."""
    require_increasing(where, t)
    period = period_of(where, t)
    speed, gap = np.column_stack(speeds), np.column_stack(gaps) if gaps else np.zeros((len(t), 0))
    part = longest_whole(t, np.column_stack([speed, gap]), period)
    if part.stop - part.start < 2:
        raise refusal(where, "no two samples in a row with all speeds and gaps", "a recording without gaps")
    if part.stop - part.start < len(t):
        span = f"{t[part.start]:g} to {t[part.stop - 1]:g} s"
        notes = [*notes, f"used is the longest stretch without missing values, {span} of {t[0]:g} to {t[-1]:g} s"]
    inputs = np.diff(speed[part], axis=0, append=np.nan) / period
    inputs[-1] = 0.0  # of the last sample: nothing follows
    for k, given in enumerate(measured or []):
        if given is not None and np.isfinite(given[part]).all():
            inputs[:, k] = given[part]
    return Convoy(where, names, period, float(t[part.start]), speed[part], gap[part], inputs, notes)
