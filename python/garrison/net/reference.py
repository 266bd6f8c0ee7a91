"""The same run in one process, without a network: what the daemons are compared with."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from garrison import _core
from garrison.jobs import certificate_of
from garrison.prepared import Prepared, prepare
from garrison.record import Run
from garrison.scenario import Scenario
from garrison.words import refusal

Array = NDArray[np.float64]


@dataclass
class Reference:
    """The design, the measurements as the attackers left them, and the run without any loss."""

    prepared: Prepared
    measurements: Array  # (samples, outputs)
    run: Run
    initial: Array  # (n,)

    def sensor(self, agent: int) -> Array:
        """What agent `agent` measures: (samples, its outputs)."""
        ends = np.cumsum([0, *(len(C) for C in self.prepared.model.C)])
        return self.measurements[:, ends[agent] : ends[agent + 1]]


def reference_of(scenario: Scenario) -> Reference:
    """Design the scenario's filter and run it once, under its attacks, with every message there."""
    filter = scenario.filters[0][1]
    assert filter is not None
    prepared = prepare(scenario.model, scenario.network, filter, **certificate_of(scenario, filter))
    if scenario.varying is not None or scenario.present is not None:
        got = "a plant or network that changes in time"
        raise refusal("scenario", got, "none: daemons do not take them yet", "`garrison run` does")
    initial = np.asarray(scenario.run.get("start", np.zeros(scenario.model.A.shape[0])), dtype=float)
    if initial.ndim != 1:
        raise refusal("[run].start", f"an array of shape {initial.shape}", "one estimate that all nodes start with")
    options = {"attack": scenario.attacks, "start": initial, "seed": scenario.run.get("seed", 0), "conditions": False}
    on_messages = {info["name"] for info in _core.attack_infos() if info["target"] == "message"}
    for attack in scenario.attacks:
        if attack.name in on_messages:
            raise refusal(
                "[[attack]]", f"{attack.name}, a lie in messages", "attacks on measurements: daemons are honest"
            )
    run = _run(scenario, prepared, options)
    assert run.measurements is not None
    return Reference(prepared, run.measurements[0], run, initial)


def _run(scenario: Scenario, prepared: Prepared, options: dict[str, object]) -> Run:
    if scenario.inputs is not None:
        options = {**options, "inputs": scenario.inputs}
    if scenario.measurements is not None:
        return prepared.replay(measurements=scenario.measurements, truth=scenario.truth, **options)
    more = {key: scenario.run[key] for key in ("x0", "start_error") if key in scenario.run}
    return prepared.simulate(steps=scenario.steps, noise=scenario.noise, **options, **more)
