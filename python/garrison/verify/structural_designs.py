"""Structural cases about gains: Riccati, Kalman, H2, isolation, one scalar."""

import math
from typing import Any

import numpy as np

from garrison import structural as theory
from garrison.verify.compare import Array, Inputs, numbers


def setting_of(i: Inputs) -> theory.Setting:
    """The inputs as an object of the library."""
    given = {k: numbers(i[k]) for k in ("A", "C", "W", "U", "E", "R") if k in i}
    given["C"] = given["C"].reshape(-1, given["A"].shape[0])
    return theory.Setting(**given)


def kalman(setting: theory.Setting, expected: dict[str, Any]) -> dict[str, Any]:
    """Coupled Riccati and joint Kalman gains, those that are expected."""
    out: dict[str, Any] = {}
    if {"coupled_riccati_gain", "coupled_riccati_P", "coupled_riccati_Pprior"} & expected.keys():
        g = theory.coupled_riccati(setting)
        out |= {
            "coupled_riccati_gain": g["K"],
            "coupled_riccati_P": g["P"],
            "coupled_riccati_Pprior": g["Pprior"],
        }
    if "kalman_gain" in expected:
        out["kalman_gain"] = theory.joint_kalman(setting)["K"]
    return out


def _at_most(got: float, limit: float, slack: float) -> float:
    """The limit itself when it is met: it is an upper bound, not a value to be hit."""
    return limit if got <= limit * (1.0 + slack) else got


def _costs_of(setting: theory.Setting, K: list[Array]) -> dict[str, float]:
    rho = theory.error_radius(setting, K)
    trace = float(np.trace(theory.stationary(setting, K)["Q"])) if rho < 1 else math.inf
    return {"rho": rho, "trQ": trace}


def gain_setting(i: Inputs, expected: dict[str, Any]) -> dict[str, Any]:
    """Every design for one setting, and what it costs."""
    setting = setting_of(i)
    g = theory.coupled_riccati(setting)
    traces = [float(np.trace(P)) for P in g["P"]]
    out: dict[str, Any] = {
        "coupled_riccati": {"K": g["K"], "traces": traces, "converged": g["converged"]} | _costs_of(setting, g["K"])
    }
    joint = theory.joint_kalman(setting)["K"]
    out["kalman"] = {"K_on_span": joint} | _costs_of(setting, joint)
    out["projection"] = _costs_of(setting, theory.projection_gains(setting))
    start = g["K"] if np.isfinite(g["K"]).all() else theory.projection_gains(setting)
    best = theory.h2_gains(setting, start)
    if "h2_at_most" in expected:
        out["h2_at_most"] = _at_most(_costs_of(setting, best)["trQ"], expected["h2_at_most"], 1e-6)
    isolated = expected.get("isolated_h2_at_most")
    if isolated is not None:
        out["isolated_h2_at_most"] = _isolated(setting, best, isolated) if isolated else {}
    return out


def _isolated(setting: theory.Setting, start: list[Array], expected: dict[str, Any]) -> dict[str, Any]:
    U = np.asarray(setting.U)
    hubs = [int(j) for j in np.flatnonzero((U == 1).all(axis=0))]
    K = theory.h2_gains(setting, start, hubs, 0.01)
    reached = _costs_of(setting, K)
    ratios = theory.isolation_ratios(setting, K)[:, hubs]
    limits = {"isolation_eps": 0.0101, "trQ": math.inf} | expected
    return {
        "isolation_eps": _at_most(float(ratios.max(initial=0.0)), limits["isolation_eps"], 0.0),
        "trQ": _at_most(reached["trQ"], limits["trQ"], 0.01),  # inf when rho(Ahat) >= 1
    }


def scalar(i: Inputs) -> dict[str, Any]:
    """The best gain of one state."""
    gain, radius = theory.best_scalar_gain(float(numbers(i["A"])[0, 0]), numbers(i["W"]))
    return {"best_rho": radius, "best_gain": gain, "schur_gain_exists": radius < 1.0}
