"""One task of a sweep: some trials of one point, written to a file that appears whole or not at all."""

import csv
import json
import os
import time
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from garrison import _core
from garrison.drivers import replay, simulate
from garrison.families import accuses
from garrison.prepared import Prepared, prepare
from garrison.record import Run
from garrison.scenario import Scenario, read_scenario

#: columns of a part after those of the point; see docs in garrison.sweep
COLUMNS = (
    "filter", "attacked", "trial", "mean_error", "worst_error", "q50", "q95", "q99", "final_error", "share_with_bound",
    "inside_bound", "first_detected", "false_alarms", "status", "seconds",
)  # fmt: skip


@dataclass(frozen=True)
class Task:
    """Trials first .. first + count - 1 of one point. path, out: absolute; every worker must see them."""

    path: str
    point: int
    values: str  # as JSON
    seed: int | None
    first: int
    count: int
    out: str
    name: str

    @property
    def part(self) -> Path:
        """The file that the task writes."""
        return Path(self.out) / "parts" / f"part-{self.name}.csv"


def work(task: Task) -> float:
    """Do it; returns the seconds it took. Input that is refused becomes a row that says so."""
    start = time.perf_counter()
    try:
        rows = rows_of(task)
    except _core.Error as error:
        rows = [refused(" ".join(str(error).split()))]
    _write(task.part, rows)
    return time.perf_counter() - start


def refused(message: str) -> dict[str, Any]:
    """The row of a point that cannot be run."""
    return {"status": f"refused: {message}"}


def _write(part: Path, rows: list[dict[str, Any]]) -> None:
    temporary = part.with_suffix(f".{os.getpid()}-{time.monotonic_ns()}.tmp")
    with temporary.open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
        file.flush()
        os.fsync(file.fileno())
    temporary.replace(part)


@lru_cache(maxsize=4)
def _designed(path: str, values: str, key: str) -> tuple[Scenario, list[tuple[str, Prepared]]]:
    """Scenario and designs of a point, made once per worker; key: the hash of everything they depend on."""
    scenario = read_scenario(path, json.loads(values))
    parts = scenario.model, scenario.network
    return scenario, [(label, prepare(*parts, f)) for label, f in scenario.filters if f is not None]


def rows_of(task: Task) -> list[dict[str, Any]]:
    """A row per filter, condition and trial. Raises what refuses the point."""
    scenario, filters = _designed(task.path, task.values, task.name.partition("-")[0])
    rows: list[dict[str, Any]] = []
    for label, design in filters:
        for attacked in (True, False) if scenario.attacks else (False,):
            start = time.perf_counter()
            run = _run(scenario, design, attacked, task)
            seconds = (time.perf_counter() - start) / task.count
            for k in range(task.count):
                row = {"filter": label, "attacked": attacked, "trial": task.first + k, "status": "ok"}
                rows.append(row | _summary(scenario, run, k, attacked) | {"seconds": f"{seconds:.3g}"})
    return rows


def _run(scenario: Scenario, design: Prepared, attacked: bool, task: Task) -> Run:
    options: dict[str, Any] = {k: scenario.run[k] for k in ("seed", "start") if k in scenario.run}
    if task.seed is not None:
        options["seed"] = task.seed
    options |= {"attack": scenario.attacks if attacked else [], "link": scenario.link, "threads": 1}
    options |= {"trials": task.count, "first_trial": task.first, "keep": ("report",), "conditions": False}
    options["design"] = design._design
    parts = scenario.plant, scenario.ground, design.filter
    if scenario.inputs is not None:
        options["inputs"] = scenario.inputs
    if scenario.measurements is not None:
        return replay(*parts, measurements=scenario.measurements, truth=scenario.truth, **options)
    options |= {k: scenario.run[k] for k in ("x0", "start_error") if k in scenario.run}
    return simulate(*parts, steps=scenario.steps, noise=scenario.noise, **options)


def _summary(scenario: Scenario, run: Run, k: int, attacked: bool) -> dict[str, Any]:
    """Numbers of one trial, errors from the first attack on; what does not exist is left out."""
    out: dict[str, Any] = {}
    if run.error is not None:
        error = run.error[k, scenario.first_attack :]
        out["mean_error"], out["worst_error"] = float(np.nanmean(error)), float(np.nanmax(error))
        for name, share in (("q50", 0.5), ("q95", 0.95), ("q99", 0.99)):
            out[name] = float(np.nanquantile(error, share))
        out["final_error"] = float(np.nanmax(run.error[k, -1]))
    if run.bound is not None:
        bound = run.bound[k, 1:]
        out["share_with_bound"] = float(np.isfinite(bound).mean())
        if run.error is not None:
            known = np.isfinite(bound) & np.isfinite(run.error[k, 1:])
            if known.any():
                out["inside_bound"] = float((run.error[k, 1:] <= bound)[known].mean())
    if accuses(run.filter, run.accusations):
        accused = run.first_accused(k)
        hit = scenario.hit if attacked else []
        found = [t for a, t in accused.items() if a in hit]
        if found:
            out["first_detected"] = min(found)
        if scenario.truth_is_declared:
            out["false_alarms"] = sum(a not in hit for a in accused)
    return out
