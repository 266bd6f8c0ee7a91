"""What a step of a certificate with memory costs: banks, and windows of 10 samples."""

from collections.abc import Callable

import garrison_bench as peers
from timing import Rows, Tasks, interleaved, summary

#: samples of one measurement
SAMPLES = 200
#: states, sources, liars
SIZES = ((2, 10, 2), (2, 30, 3), (5, 10, 2), (5, 30, 2))
STEPS = 10
LEAVES = 20


def bank(repeats: int) -> Rows:
    """A step: box and ball alone, as agents ask, and with the ellipsoid. Nobody lies, so that all members live."""
    rows: dict[str, Callable[[], float]] = {}
    for n, m, s in SIZES:
        plant = peers.Remembered(n, m, s, 0.0)
        for ellipsoid in (False, True):
            name = f"s={s} of {m}, n={n}" + (", ellipsoid" if ellipsoid else "")
            rows[name] = lambda p=plant, e=ellipsoid: p.bank(SAMPLES, e)
    return summary(interleaved(rows, repeats), next(iter(rows)))


def window(repeats: int) -> Rows:
    """To fill a window and to ask it, with liars of 3 deviations, whom no sample proves."""
    rows: dict[str, Callable[[], float]] = {}
    for n, m, s in SIZES:
        plant = peers.Remembered(n, m, s, 3.0)
        ways = {"W2M": (False, 0), "W2M, moving": (True, 0), f"A, {LEAVES} leaves": (False, LEAVES), "W3M": (False, -1)}
        for way, (moving, leaves) in ways.items():
            samples = SAMPLES if way == "W2M" else 4
            rows[f"{way}, s={s} of {m}, n={n}"] = lambda p=plant, k=samples, v=moving, a=leaves: p.window(
                k, STEPS, v, a
            )
    return summary(interleaved(rows, repeats), next(iter(rows)))


def tasks(repeats: int) -> Tasks:
    """Banks and windows of the benchmark."""
    return {
        "certificate with memory, bank": lambda: bank(repeats),
        f"certificate with memory, windows of {STEPS} samples": lambda: window(min(repeats, 3)),
    }
