"""The main job: run a scenario with all its filters, attacked and not, and sum up."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from garrison.run import Run, central_kalman, replay, simulate
from garrison.scenario import Scenario

Array = NDArray[np.float64]


@dataclass
class Row:
    """One filter in one condition (attacked or not)."""

    label: str
    attacked: bool
    run: Run | None  # None for the central Kalman filter
    error: Array | None  # (trial, time, agent)

    def summary(self, scenario: Scenario) -> dict[str, Any]:
        """Numbers for the table: None = does not exist for this filter."""
        honest, start = attack_facts(scenario)
        out: dict[str, Any] = {"filter": self.label, "attacked": self.attacked}
        if self.error is not None:
            since = self.error[:, start:]
            out["mean_error"] = float(np.nanmean(since))
            out["worst_error"] = float(np.nanmax(since))
        if self.run is not None and self.run.bound is not None and self.error is not None:
            bound, error = self.run.bound[:, 1:], self.error[:, 1:]
            known = np.isfinite(bound) & np.isfinite(error)
            out["share_with_bound"] = float(np.isfinite(bound).mean())
            out["inside_bound"] = float((error <= bound)[known].mean()) if known.any() else None
        if self.run is not None and self.run.filter.params.get("detector"):
            accused = [self.run.first_accused(k) for k in range(len(self.run.bound))]  # type: ignore[arg-type]
            out["detected"] = {scenario.names[a]: int(t) for a, t in sorted(accused[0].items(), key=lambda x: x[1])}
            out["false_alarms"] = sum(a in honest or not self.attacked for found in accused for a in found)
        if self.run is not None and self.run.verdict is not None:
            share = self.run.limited(start=start)
            out["limited"] = {scenario.names[a]: float(v) for a, v in enumerate(share) if v > 0}
        if self.run is not None:
            out["warnings"] = self.run.warnings
            out["counters"] = {k: v for k, v in self.run.counters.items() if v and k != "sent"}
        return out


def attack_facts(scenario: Scenario) -> tuple[set[int], int]:
    """Agents that are never attacked, and the first sample of the comparison: the start of the first attack."""
    hit = {a for attack in scenario.attacks for a in attack.agents}
    starts = [attack.start for attack in scenario.attacks]
    return set(range(scenario.model.agents)) - hit, max(1, min(starts, default=1))


def run_scenario(scenario: Scenario, progress: Callable[[str, int, int], None] | None = None) -> list[Row]:
    """Run every filter of the scenario under its attacks, and once more without them when there are any.

    progress(label, done, total) is called now and then.
    """
    rows: list[Row] = []
    attacked_y: Array | None = None
    conditions = [True, False] if scenario.attacks else [False]
    for attacked in conditions:
        for label, filter in scenario.filters:
            name = f"{label}{', attacked' if attacked else ''}"
            if filter is None:
                rows.append(_kalman_row(scenario, label, attacked, attacked_y))
                continue
            run = _run(scenario, filter, attacked, _labelled(progress, name))
            if attacked and attacked_y is None and run.measurements is not None:
                attacked_y = run.measurements[0]
            rows.append(Row(label, attacked, run, run.error))
    return rows


def _labelled(progress: Callable[[str, int, int], None] | None, label: str) -> Callable[[int, int], None]:
    def report(done: int, total: int) -> None:
        if progress is not None:
            progress(label, done, total)

    return report


def _run(scenario: Scenario, filter: Any, attacked: bool, progress: Callable[[int, int], None]) -> Run:
    options: dict[str, Any] = {k: scenario.run[k] for k in ("trials", "seed", "threads", "start") if k in scenario.run}
    options |= {"attack": scenario.attacks if attacked else [], "progress": progress}
    options["link"] = scenario.link
    model, net = scenario.model, scenario.network
    if filter.detail_names:  # sets over time, for the pictures
        options["keep"] = ("estimate", "report", "measurements", "signals", "details")
    if scenario.measurements is not None:
        return replay(filter, model, net, measurements=scenario.measurements, truth=scenario.truth, **options)
    options |= {k: scenario.run[k] for k in ("x0", "start_error") if k in scenario.run}
    return simulate(model, net, filter, steps=scenario.run["steps"], noise=scenario.noise, **options)


def _kalman_row(scenario: Scenario, label: str, attacked: bool, attacked_y: Array | None) -> Row:
    y = attacked_y if attacked else scenario.measurements
    if y is None:
        return Row(label, attacked, None, None)
    estimate = central_kalman(scenario.model, y)
    if scenario.truth is None:
        return Row(label, attacked, None, None)
    return Row(label, attacked, None, np.linalg.norm(estimate - scenario.truth, axis=1)[None, :, None])


def signal_size(scenario: Scenario) -> float | None:
    """Mean length of the true state: what an estimate of 0 would be off by."""
    return None if scenario.truth is None else float(np.nanmean(np.linalg.norm(scenario.truth[1:], axis=1)))
