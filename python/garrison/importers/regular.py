"""Times of recordings: their period, their gaps."""

import numpy as np
from numpy.typing import NDArray

from garrison.words import refusal

Array = NDArray[np.float64]
#: part of a period by which times may be off
_JITTER = 0.3


def require_increasing(where: str, t: Array) -> None:
    """Refuse times that stand still, go back, or are missing."""
    if not np.isfinite(t).all():
        raise refusal(where, f"no time in row {int(np.argmin(np.isfinite(t))) + 1}", "a time in every row")
    if len(t) < 2:
        raise refusal(where, "fewer than two rows", "a recording")
    step = np.diff(t)
    if (step <= 0).any():
        k = int(np.argmax(step <= 0))
        raise refusal(where, f"the time {t[k + 1]:g} after {t[k]:g}", "a later one", "sort the rows by time")


def period_of(where: str, t: Array) -> float:
    """The usual distance between samples, rounded to microseconds."""
    require_increasing(where, t)
    return float(round(float(np.median(np.diff(t))), 6))


def longest_whole(t: Array, values: Array, period: float) -> slice:
    """The longest run of rows, a period apart, without a missing value."""
    whole = np.asarray(np.isfinite(values).all(axis=1))
    best = slice(0, 0)
    start = 0
    for k in range(len(t) + 1):
        joined = k < len(t) and whole[k] and (k == start or abs(t[k] - t[k - 1] - period) <= _JITTER * period)
        if joined:
            continue
        if k - start > best.stop - best.start:
            best = slice(start, k)
        start = k if k < len(t) and whole[k] else k + 1
    return best
