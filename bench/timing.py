"""How things are timed: in turn in one run, medians, ratios pair by pair."""

import time
from collections.abc import Callable
from typing import Any

import numpy as np

#: one dict per row: row, ms, ratio, spread
Rows = list[dict[str, Any]]
#: title of a table -> what measures it
Tasks = dict[str, Callable[[], Rows]]


def interleaved(rows: dict[str, Callable[[], float]], repeats: int) -> dict[str, list[float]]:
    """Seconds of every row, round after round in turn, after one round of warm-up."""
    for run in rows.values():
        run()
    times: dict[str, list[float]] = {name: [] for name in rows}
    for _ in range(repeats):
        for name, run in rows.items():
            times[name].append(run())
    return times


def summary(times: dict[str, list[float]], ours: str) -> Rows:
    """Median, and how many times longer than ours, pair by pair."""
    out = []
    for name, seconds in times.items():
        ratios = np.array(seconds) / np.array(times[ours])
        spread = [float(ratios.min()), float(ratios.max())]
        out.append(
            {"row": name, "ms": 1e3 * float(np.median(seconds)), "ratio": float(np.median(ratios)), "spread": spread}
        )
    return out


def cpu(run: Callable[[], Any]) -> float:
    start = time.process_time()
    run()
    return time.process_time() - start


def wall(run: Callable[[], Any]) -> float:
    start = time.perf_counter()
    run()
    return time.perf_counter() - start
