"""One run of a comparison: a filter of the library, or a baseline, under one attack."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from garrison import _core
from garrison.comparison.baselines import BASELINES, DISTRIBUTED, Plant, plant_of
from garrison.comparison.table import Row, empty
from garrison.drivers import simulate
from garrison.families import accuses
from garrison.kalman import central_kalman, local_kalman
from garrison.prepared import prepare
from garrison.record import Run
from garrison.varying import VaryingModel, parted

Array = NDArray[np.float64]

#: Kalman filters of all measurements, or of each agent's and its neighbours', with what protects them
KALMAN: dict[str, dict[str, float]] = {
    "central Kalman filter": {},
    "gated Kalman filter (central)": {"gate": 1e-3},
    "Huber Kalman filter (central)": {"huber": 1.345},
    "Kalman filter (per agent)": {},
    "gated Kalman filter (per agent)": {"gate": 1e-3},
    "Huber Kalman filter (per agent)": {"huber": 1.345},
}


@dataclass
class Job:
    """What all runs of a comparison share; its methods are the runs."""

    model: _core.Model | VaryingModel
    network: _core.Network
    liars: list[int]
    steps: int
    start: int
    trials: int
    seed: int
    x0: ArrayLike | None

    @property
    def base(self) -> _core.Model:
        """The constant part of the plant."""
        return self.model.model if isinstance(self.model, VaryingModel) else self.model

    def family(self, filter: _core.Filter, attack: _core.Attack | None) -> tuple[Row, Run | None]:
        """Numbers of a filter of the library, and its run."""
        keep = ("report", "measurements")
        options: dict[str, Any] = {"steps": self.steps, "trials": self.trials, "seed": self.seed, "x0": self.x0}
        try:
            design = prepare(self.base, self.network, filter)._design
            options |= {"attack": attack or [], "keep": keep, "conditions": False, "threads": 1, "design": design}
            began = time.perf_counter()
            run = simulate(self.model, self.network, filter, **options)
        except _core.Error as error:
            return empty(" ".join(str(error).split())), None
        seconds = time.perf_counter() - began
        row = empty("ok") | self._errors(run.error) | self._alarms(run, attack) | _bounds(run)
        row["bytes_per_sample"] = run.bytes_per_step
        row["microseconds"] = 1e6 * seconds / (self.trials * self.steps * self.base.agents)
        return row, run

    def baseline(self, label: str, attack: _core.Attack | None, log: Run | None) -> Row:
        """Numbers of a baseline on the measurements of a run."""
        if attack is not None and attack.target == "message":
            return empty("does not apply: it takes the messages as they were sent")
        if log is None or log.measurements is None or log.truth is None:
            return empty("no filter ran that it could read the measurements of")
        few = min(self.trials, 5)
        try:
            plant = plant_of(self.model, self.network, len(self.liars))
            began = time.perf_counter()
            found = [self._estimate(label, plant, log.measurements[k]) for k in range(few)]
        except (_core.Error, np.linalg.LinAlgError) as error:
            return empty(" ".join(str(error).split()))
        seconds = time.perf_counter() - began
        distance = np.linalg.norm(np.array(found) - log.truth[:few, :, None], axis=3)
        row = empty("ok") | self._errors(distance)
        row["microseconds"] = 1e6 * seconds / (few * self.steps * self.base.agents)
        if label in DISTRIBUTED:
            n = self.base.states
            row["bytes_per_sample"] = 8 * (n + n * (n + 1) // 2) * sum(len(heard) for heard in plant.heard)
        return row

    def _estimate(self, label: str, plant: Plant, y: Array) -> Array:
        if label not in KALMAN:
            return BASELINES[label](plant, y)
        base, parts = self.base, dict[str, Any](parted(self.model)[1])
        if base.measurement_covariance is None or base.process_covariance is None:
            known = plant.constant
            base = _core.Model(known.A, known.C, process_covariance=known.Q, measurement_covariance=known.R)
        model = VaryingModel(base, **parts) if parts else base
        if label.endswith("(per agent)"):
            return local_kalman(model, self.network, y, **KALMAN[label])
        return np.repeat(central_kalman(model, y, **KALMAN[label])[:, None], plant.agents, axis=1)

    def _errors(self, error: Array | None) -> Row:
        if error is None:
            return {}
        honest = [i for i in range(error.shape[2]) if i not in self.liars] or list(range(error.shape[2]))
        since = error[:, self.start :, honest]
        shares = {"q50": 0.5, "q95": 0.95, "q99": 0.99}
        return {name: float(np.nanquantile(since, share)) for name, share in shares.items()}

    def _alarms(self, run: Run, attack: _core.Attack | None) -> Row:
        if not accuses(run.filter, run.accusations):
            return {}
        hit = self.liars if attack is not None else []
        first: list[dict[int, int]] = [{} for _ in range(self.trials)]  # accusations that are right
        false: set[tuple[int, int]] = set()  # (trial, agent)
        for trial, at, sets in run.accusations:
            for agent in {a for some in sets for a in some}:
                if agent in hit and at >= self.start:
                    first[trial].setdefault(agent, at)
                else:
                    false.add((trial, agent))
        delays = [min(found.values()) for found in first if found]
        delay = float(np.median(delays)) - self.start if delays else None
        return {"detection_delay": delay, "false_alarms": len(false) / self.trials}


def _bounds(run: Run) -> Row:
    if run.bound is None or run.error is None:
        return {}
    bound, error = run.bound[:, 1:], run.error[:, 1:]
    known = np.isfinite(bound) & np.isfinite(error)
    inside = float((error <= bound)[known].mean()) if known.any() else None
    return {"bound_share": float(np.isfinite(bound).mean()), "inside_bound": inside}
