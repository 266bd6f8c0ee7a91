"""What is said about a track before anybody runs it: long gaps, velocities that the positions contradict."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
#: s, of a gap that is worth a note
_LONG = 60.0
#: s, between two positions whose distance tells a speed; m/s, below which it does not
_APART, _SLOW = 30.0, 10.0
#: part by which a velocity may change from one report to the next: in a turn the way is no straight line
_STEADY = 0.1
#: ratio of speeds and degrees between directions from which on a column is doubted, and pairs that it takes
_OFF, _TURNED, _PAIRS = 1.25, 20.0, 20


def long_gap(fresh: NDArray[np.bool_], period: float) -> list[str]:
    """What the filter does after the longest gap, where it is long. fresh: which samples have a position; period: s."""
    longest = float(np.diff(np.flatnonzero(np.concatenate([[True], fresh, [True]]))).max() - 1) * period
    if longest < _LONG:
        return []
    return [
        f"the longest gap without a position takes {longest:g} s; after gaps that make the estimate ten times as "
        "unsure as usual, reports within what the gap allows are taken up untested, wherever they are"
    ]


def contradictions(values: Array, period: float) -> list[str]:
    """Reported velocities that are not those of the positions, in the middle of all pairs of neighbouring reports.

    values: (rows, 4), positions and velocities, m and m/s, nan = missing.
    """
    known = np.flatnonzero(np.isfinite(values).all(axis=1))
    apart = np.diff(known) * period
    moved = np.diff(values[known, :2], axis=0) / np.maximum(apart, period)[:, None]
    told = 0.5 * (values[known[1:], 2:] + values[known[:-1], 2:])
    straight = np.hypot(*np.diff(values[known, 2:], axis=0).T) < _STEADY * np.hypot(*told.T)
    used = (apart <= _APART) & straight & (np.hypot(*moved.T) > _SLOW) & (np.hypot(*told.T) > _SLOW)
    if used.sum() < _PAIRS:
        return []
    ways, speeds = (z[used, 0] + 1j * z[used, 1] for z in (moved, told))
    ratio = float(np.median(np.abs(speeds) / np.abs(ways)))
    turned = float(np.median(np.abs(np.rad2deg(np.angle(speeds / ways)))))
    pairs = f"(the median of {int(used.sum())} pairs of reports)"
    notes = []
    if not 1.0 / _OFF < ratio < _OFF:
        notes.append(
            f"reported speeds are {ratio:.2g} times those of the positions {pairs}: a column in another unit than its "
            "name says (1 m/s = 1.94 knots), or one that only repeats old values"
        )
    if turned > _TURNED:
        notes.append(
            f"reported tracks are {turned:.0f} degrees off the way of the positions {pairs}: the column does not hold "
            "the direction over ground, clockwise from north; alarms say no more than that"
        )
    return notes
