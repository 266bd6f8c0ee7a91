"""Counts of numbers in bins a thousandth wide: their quantiles do not depend on the order in which they came."""

import math

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Codes = NDArray[np.int64]

#: relative width of a bin
WIDTH = 1e-3
_STEP = math.log1p(WIDTH)
#: more than any logarithm of a double, in steps; of infinity
_ZERO, _INFINITE = 800_000, 800_000
#: codes of one cell
_SPAN = 2 * (_ZERO + _INFINITE) + 1


class Bins:
    """How many numbers of each cell are in each bin; only bins with a number take room."""

    def __init__(self) -> None:
        self._keys: Codes = np.zeros(0, dtype=np.int64)
        self._counts: Codes = np.zeros(0, dtype=np.int64)
        self._new: list[tuple[Codes, Codes]] = []
        self._waiting = 0

    def add(self, cells: Codes, values: Array) -> None:
        """Numbers, none of them nan, each of a cell >= 0."""
        keys, counts = np.unique(cells * _SPAN + _code(values) + _SPAN // 2, return_counts=True)
        self._new.append((keys, counts.astype(np.int64)))
        self._waiting += len(keys)
        if self._waiting > max(len(self._keys), 1 << 16):
            self._merge()

    def sorted(self) -> tuple[Codes, Array, Codes]:
        """Cells, numbers and counts, by cell and number."""
        self._merge()
        cells = self._keys // _SPAN
        return cells, _value(self._keys - cells * _SPAN - _SPAN // 2), self._counts

    def _merge(self) -> None:
        if not self._new:
            return
        keys = np.concatenate([self._keys, *(k for k, _ in self._new)])
        counts = np.concatenate([self._counts, *(c for _, c in self._new)])
        order = np.argsort(keys, kind="stable")
        keys, counts = keys[order], counts[order]
        first = np.flatnonzero(np.concatenate([[True], keys[1:] != keys[:-1]]))
        self._keys, self._counts = keys[first], np.add.reduceat(counts, first)
        self._new, self._waiting = [], 0


def quantile(bins: Bins, counts: Codes, share: float) -> Array:
    """Per cell, the middle of the bin below whose end there are `share` of its numbers; nan where there is none."""
    cells, values, many = bins.sorted()
    out = np.full(len(counts), np.nan)
    if not len(cells):
        return out
    before = np.cumsum(many) - many
    first = np.searchsorted(cells, np.arange(len(counts)))
    filled = np.flatnonzero(counts)
    rank = np.maximum(np.ceil(share * counts[filled]), 1).astype(np.int64)  # how many are at most the quantile
    total = np.cumsum(many)
    out[filled] = values[np.searchsorted(total, before[first[filled]] + rank)]
    return out


def _code(values: Array) -> Codes:
    with np.errstate(divide="ignore"):
        steps = np.floor(np.log(np.abs(values)) / _STEP + 0.5)
    steps = np.clip(steps, 1 - _ZERO, _INFINITE).astype(np.int64)
    return np.where(values == 0, 0, np.sign(values).astype(np.int64) * (steps + _ZERO))


def _value(codes: Codes) -> Array:
    steps = np.abs(codes) - _ZERO
    with np.errstate(over="ignore"):
        size = np.where(steps == _INFINITE, np.inf, np.exp(np.minimum(steps * _STEP, 709.78)))
    found: Array = np.where(codes == 0, 0.0, np.sign(codes) * size)
    return found
