"""Doubts about a run that only show when it is looked at from outside: conditions that are not met, divergence."""

import math

import numpy as np
from numpy.typing import NDArray

from garrison import _core
from garrison.checks import check

Array = NDArray[np.float64]
#: growth of the error over half a run, beyond that of the plant, from which on it is called divergence
_GROWTH = 1e3
#: most states of the whole network, and sets of sensors, up to which conditions are evaluated without being asked
_STATES, _SUBSETS = 400, 20_000


def _cheap(model: _core.Model, filter: _core.Filter) -> bool:
    attacked = int(filter.params.get("attacked", 0))
    return model.agents * model.states <= _STATES and math.comb(model.agents, min(attacked, model.agents)) <= _SUBSETS


def of_conditions(model: _core.Model, network: _core.Network, filter: _core.Filter) -> list[str]:
    """One line per required condition that is not met; one line when they were not evaluated."""
    if not _cheap(model, filter):
        return ["conditions were not checked, which takes long for a network of this size: garrison.check does"]
    try:
        failed = check(model, network, filter).failed
    except _core.Error as error:
        return [f"conditions could not be checked: {error}"]
    return [
        f"condition not met: {c['name']} is {c['value']:.4g}, needs {c['needed']} ({c['meaning']}); "
        "what the theorems promise does not hold for this run"
        for c in failed
    ]


def of_divergence(model: _core.Model, estimate: Array | None, error: Array | None, quiet_from: int) -> list[str]:
    """A line when errors (or, without truth, estimates) grow without bound, beyond the plant's own growth.

    Compares the end with the middle, so an attack must not start in between: quiet_from, first sample from which on
    no attack starts any more.
    """
    if error is not None:
        size = error.max(axis=(0, 2))
    elif estimate is not None:
        size = np.linalg.norm(estimate, axis=3).max(axis=(0, 2))
    else:
        return []
    half = len(size) // 2
    if half < 5 or quiet_from > half:
        return []
    middle = float(size[half - half // 5 : half + 1].max())
    end = float(size[-1 - half // 5 :].max())
    plant = float(np.abs(np.linalg.eigvals(np.asarray(model.A))).max())
    growth = max(1.0, plant) ** min(len(size) - half, 10_000 if plant <= 1 else 700 / math.log(max(plant, 1.0001)))
    if math.isfinite(end) and end <= _GROWTH * growth * max(middle, np.finfo(float).tiny):
        return []
    if not math.isfinite(middle):
        return ["estimates are not finite: they diverged"]
    what = "errors" if error is not None else "estimates"
    return [f"the {what} grow from {middle:.3g} in the middle to {end:.3g} at the end of the run: the filter diverges"]
