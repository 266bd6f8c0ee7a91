"""Filters and attacks of a comparison when none are given: every family and every attack that can be set up alone."""

from typing import Any

import numpy as np

from garrison import _core
from garrison.drivers import simulate
from garrison.families import family_called
from garrison.filters import make_filter
from garrison.varying import VaryingModel, parted

#: attacks that need something only the user can give: a field of a family's message, the width of a message
_SPECIAL = ("falsify", "perturb")


def filters_for(
    model: _core.Model | VaryingModel, network: _core.Network, liars: int, size: float
) -> dict[str, _core.Filter]:
    """Label -> filter, of every family that watches one plant and says what it runs with where it needs parameters."""
    threshold = _threshold(model, network, size)
    found = {}
    for info in _core.filter_infos():
        family = family_called(info["name"])
        params = family.contest(liars, threshold) | (family.changing if isinstance(model, VaryingModel) else {})
        needed = {p["name"] for p in info["params"] if p["required"]}
        if not family.own_plants and needed <= params.keys():
            found[info["name"]] = make_filter(info["name"], params)
    return found


def _threshold(model: _core.Model | VaryingModel, network: _core.Network, size: float) -> float:
    """What the innovations of a clean run stay below, with an unprotected filter."""
    base, parts = parted(model)
    try:
        filter = make_filter("scalar_gain", {"rounds": 6})
        clean = simulate(
            model, network, filter, steps=min([50, *map(len, parts.values())]), conditions=False, keep=("estimate",)
        )
    except _core.Error:
        return size
    assert clean.error is not None
    ends = np.cumsum([len(c) for c in base.C])[:-1]
    seen = [c for C in parts.get("C", [np.vstack(base.C)]) for c in np.split(C, ends) if len(c)]
    length = max(float(np.linalg.norm(c, 2)) for c in seen)
    typical = float(np.nanquantile(clean.error[:, 1:], 0.99))
    return min(max(2.0 * length * typical, 1e-9), size) if np.isfinite(typical) else size


def attacks_for(agents: list[int], states: int, start: int, size: float) -> dict[str, _core.Attack]:
    """Label -> attack of these agents from `start` on; size: of a lie, unit of the measurement."""
    params: dict[str, dict[str, Any]] = {
        "bias": {"value": size},
        "constant": {"value": size},
        "random": {"size": size},
        "ramp": {"slope": size / 10},
        "sinusoid": {"amplitude": size},
        "autoregressive": {"size": size},
        "forge": {"offset": size},
        "equivocate": {"size": size},
        "outdated": {"age": 5},
        "false_trajectory": {"offset": np.full(states, size)},
        "coordinated": {"covariance": (size**2 * np.eye(len(agents) * states)).ravel()},
    }
    out = {}
    for info in _core.attack_infos():
        if info["name"] not in _SPECIAL:
            schedule = [(start, agents)]
            out[info["name"]] = _core.make_attack(info["name"], schedule, params=params.get(info["name"], {}))
    return out


def typical_size(model: _core.Model) -> float:
    """Ten times the spread of clean measurements' noise, or 1 where that is not known."""
    bounds = np.asarray(model.measurement_bound).ravel()
    if bounds.size and np.isfinite(bounds).all() and bounds.max() > 0:
        return 10.0 * float(bounds.max())
    R = model.measurement_covariance
    if R is not None:
        return 10.0 * float(np.sqrt(max(np.diag(np.asarray(r)).max(initial=0.0) for r in R))) or 1.0
    return 1.0
