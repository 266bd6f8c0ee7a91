"""Maxima, means and quantiles of the arrays of a run, worked out while it goes on: the arrays are never whole."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from garrison import _core
from garrison.bins import Bins, quantile
from garrison.labelled import axes
from garrison.run_file import reduced_name

Array = NDArray[np.float64]
#: a block of a trial: (name, rows, number of the first one, how many a trial has, time of row 0)
Block = list[tuple[str, NDArray[Any], int, int, int]]
_QUANTILE = re.compile(r"q(\d+(\.\d+)?)$")


def share_of(statistic: str) -> float | None:
    """0.95 of "q95"; None for another word."""
    found = _QUANTILE.match(statistic)
    return float(found[1]) / 100 if found and 0 <= float(found[1]) <= 100 else None


class Reductions:
    """Takes the blocks of a run, and hands on to `sink` those arrays that are kept themselves.

    wanted: array -> (statistics, axes that go). kept: whether an array is kept itself.
    """

    def __init__(
        self,
        filter: _core.Filter,
        trials: int,
        wanted: Mapping[str, tuple[list[str], list[str]]],
        kept: Callable[[str], bool],
        sink: Callable[[int, Block], None] | None,
    ) -> None:
        self._filter, self._trials, self._wanted, self._kept, self._sink = filter, trials, wanted, kept, sink
        self._made: dict[str, Reduction] = {}

    def take(self, trial: int, block: Block) -> None:
        """A block of a trial; those of one trial come in order of time, those of several in any order."""
        for name, rows, start, total, _ in block:
            if name in self._wanted:
                if name not in self._made:
                    statistics, over = self._wanted[name]
                    names = axes(self._filter, name)
                    self._made[name] = Reduction(statistics, over, names, (self._trials, total, *rows.shape[1:]))
                self._made[name].take(trial, start, rows)
        if self._sink is not None:
            self._sink(trial, [one for one in block if self._kept(one[0])])

    def arrays(self) -> dict[str, NDArray[Any]]:
        """What was asked for, by name (Run.reduced)."""
        return {
            reduced_name(name, statistic, self._wanted[name][1]): values
            for name, made in self._made.items()
            for statistic, values in made.results().items()
        }


class Reduction:
    """Statistics of one array (trial, time, ..) over some of its axes; nan counts nowhere."""

    def __init__(self, statistics: list[str], over: list[str], names: tuple[str, ...], shape: tuple[int, ...]) -> None:
        self._statistics = statistics
        self._trial, self._time = names[0] in over, names[1] in over
        self._within = tuple(k for k in range(2, len(names)) if names[k] in over)
        left = [size for k, size in enumerate(shape) if names[k] not in over]
        self._shape, self._total, self._of_row = tuple(left), shape[1], shape[2:]
        self._most = np.full(self._shape, -np.inf)
        self._least = np.full(self._shape, np.inf)
        self._count = np.zeros(self._shape, dtype=np.int64)
        self._sum = np.zeros(self._shape) if "mean" in statistics else None
        self._pending: dict[int, tuple[Array, int]] = {}  # sums of trials whose turn it is not yet, and rows in them
        self._next = 0  # trial whose sum is added next
        shares = [share_of(word) for word in statistics]
        self._bins = Bins() if any(share is not None for share in shares) else None

    def take(self, trial: int, start: int, rows: NDArray[Any]) -> None:
        """Rows of a trial from number `start` on."""
        rows = np.asarray(rows, dtype=float)
        gone = ((0,) if self._time else ()) + tuple(k - 1 for k in self._within)
        there = ~np.isnan(rows)
        at = self._place(trial, start, len(rows))
        self._count[at] += there.sum(axis=gone)
        self._most[at] = np.maximum(self._most[at], np.where(there, rows, -np.inf).max(axis=gone, initial=-np.inf))
        self._least[at] = np.minimum(self._least[at], np.where(there, rows, np.inf).min(axis=gone, initial=np.inf))
        if self._sum is not None:
            self._add(trial, start, np.where(there, rows, 0.0))
        if self._bins is not None:
            cells = np.arange(self._count.size).reshape(self._shape)[at]
            self._bins.add(np.broadcast_to(np.expand_dims(cells, gone), rows.shape)[there], rows[there])

    def results(self) -> dict[str, NDArray[Any]]:
        """By statistic; nan where nothing was counted."""
        none = self._count == 0
        out: dict[str, NDArray[Any]] = {}
        for word in self._statistics:
            if word == "count":
                out[word] = self._count.astype(float)
            elif word == "mean":
                assert self._sum is not None
                out[word] = np.where(none, np.nan, self._sum / np.maximum(self._count, 1))
            elif word in ("max", "min"):
                out[word] = np.where(none, np.nan, self._most if word == "max" else self._least)
            else:
                assert self._bins is not None
                share = share_of(word)
                assert share is not None
                out[word] = quantile(self._bins, self._count.ravel(), share).reshape(self._shape)
        return out

    def _place(self, trial: int, start: int, many: int) -> tuple[Any, ...]:
        """Where rows of a trial are counted."""
        place: tuple[Any, ...] = () if self._trial else (trial,)
        return (*place, ...) if self._time else (*place, slice(start, start + many))

    def _add(self, trial: int, start: int, rows: Array) -> None:
        """Sums in order of time, and of trials, whatever the blocks and threads are."""
        assert self._sum is not None
        rows = rows.sum(axis=tuple(k - 1 for k in self._within))
        if not self._trial:
            place = self._sum[trial]
            if self._time:
                self._sum[trial] = _after(place, rows)
            else:
                place[start : start + len(rows)] = rows
            return
        if trial not in self._pending:
            self._pending[trial] = np.zeros(self._shape), 0
        own, rows_in = self._pending[trial]
        if self._time:
            own = np.asarray(_after(own, rows))
        else:
            own[start : start + len(rows)] = rows
        self._pending[trial] = own, rows_in + len(rows)
        while self._pending.get(self._next, (None, -1))[1] == self._total:
            self._sum += self._pending.pop(self._next)[0]
            self._next += 1


def _after(before: Array, rows: Array) -> Array:
    """before + rows[0] + rows[1] + .., in this order: numpy's own sums depend on how long they are."""
    found: Array = np.add.accumulate(np.concatenate([np.asarray(before)[None], rows]), axis=0)[-1]
    return found


def numbers_of(
    filter: _core.Filter, wanted: Mapping[str, tuple[list[str], list[str]]], lengths: Mapping[str, int]
) -> float:
    """How many numbers reductions hold beside the counts of quantiles. lengths: of axes."""
    left = ([axis for axis in axes(filter, name) if axis not in over] for name, (_, over) in wanted.items())
    return 4.0 * sum(math.prod(float(lengths[axis]) for axis in some) for some in left)
