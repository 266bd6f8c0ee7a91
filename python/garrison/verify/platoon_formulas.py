"""Formulas of the platoon cases that have no time in them: gains, theorem 4, partitions, design rows."""

import math
from typing import Any

import garrison as gr
from garrison._core import platoon as theory
from garrison.verify.compare import Inputs, numbers


def _setting(p: Inputs) -> Any:
    return theory.Setting(
        vehicles=p["N"],
        range=p["L"],
        period=p["T"],
        attacked=p["b"],
        eps=p["eps"],
        mu=p["mu"],
        q=p["q"],
        varpi=p["varpi"],
        beta=p["beta"],
        adaptive=p["threshold"] == "adaptive",
    )


def _none(value: Any) -> Any:
    """null where a number does not exist."""
    if isinstance(value, dict):
        return {k: _none(v) for k, v in value.items()}
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _interval(ends: tuple[float, float]) -> list[float] | None:
    return None if math.isnan(ends[0]) else list(ends)


def _design_row(row: Inputs) -> dict[str, Any]:
    p = row["params"]
    s = _setting(p)
    known = {"free_in_reach": 2 * p["L"] + 1 - p["b"], "proved": p["b"]}
    at = {key: [float(w) for w in row.get(key, {})] for key in ("beta1_bar", "beta2_bar", "prop2", "f3", "f4")}
    names = {key: list(row.get(key, {})) for key in at}
    functions = {
        "beta1_bar": theory.beta1_bar,
        "beta2_bar": theory.beta2_bar,
        "prop2": theory.proposition2,
        "f3": theory.f3,
        "f4": theory.f4,
    }
    out: dict[str, Any] = {
        "params": p,
        "norm_A": s.norm_A,
        "mubar": s.mubar,
        "beta0": s.beta0,
        "k0": s.k0,
        "omega_interval": _interval(theory.omega_interval(s)),
        "beta_interval": _interval(theory.beta_interval(s)),
        "beta_interval_safe": _interval(theory.beta_interval_safe(s)),
        "rho_limit_safe_no_detection": _none(theory.safe_limit(s)),
    }
    for key, function in functions.items():
        out[key] = {name: function(s, w) for name, w in zip(names[key], at[key], strict=True)}
    distances: dict[str, Any] = {key: row[key] for key in ("jdist_T0", "jdist_detected") if key in row}
    for suffix, more in (("T0", {}), ("detected", known)):
        if f"jdist_{suffix}" not in distances:
            continue
        distance = distances[f"jdist_{suffix}"]
        out[f"theorem1_{suffix}"] = _none(theory.theorem1(s, distance=distance, **more))
        out[f"theorem2_{suffix}"] = _none(theory.theorem2(s, distance=distance, **more))
    return out | distances


def _theorem4(row: Inputs) -> dict[str, Any]:
    loop: tuple[int, float, float, float] = (row["N"], row["T"], row["gs"], row["gv"])
    copied = {key: row[key] for key in ("N", "T", "gs", "gv", "eps", "alpha_hat") if key in row}
    out = copied | {
        "assumption4": theory.assumption4(*loop),
        "ok": theory.assumption4(*loop),
        "grounded_eigs": theory.grounded_eigenvalues(row["N"]),
        **theory.loop_factors(*loop),
    }
    out["schur"] = out["rho"] < 1.0
    if {"eps", "alpha_hat"} <= row.keys():
        out |= theory.theorem4(*loop, row["eps"], row["alpha_hat"])
    return {key: _none(value) for key, value in out.items()}


def _partition(row: Inputs) -> dict[str, Any]:
    N, L = row["N"], row["L"]
    net = gr.Network.band(N, L)
    inner = [v for v in range(N) if theory.in_V1(v, N, L)]
    outer = [v for v in range(N) if v not in inner]
    return {
        "N": N,
        "L": L,
        "V1": [v + 1 for v in inner],
        "V21": [v + 1 for v in outer if v < L],
        "V2": [v + 1 for v in outer],
        "neighbours": [[v + 1 for v in net.neighbours(vehicle)] for vehicle in range(N)],
        "nbar": [[v + 1 for v in theory.nearest(vehicle, N)] for vehicle in range(-1, N)],
    }


def _runs(row: Inputs) -> dict[str, Any]:
    runs, count = theory.runs(row["labels"])
    return {"labels": row["labels"], "runs": runs, "count": count}


def _gains(row: Inputs, eta: dict[str, Any]) -> dict[str, Any]:
    k = {
        label: theory.gain(
            row["beta"], *numbers(value), attacked=int(label) in row["attacked"], free=int(label) in row["free"]
        )
        for label, value in eta.items()
    }
    return row | {"k": k}


def _j_choice(row: Inputs) -> dict[str, Any]:
    j = theory.best_source(
        row["i"] - 1,
        row.get("N", 7),
        row.get("L", 2),
        [label - 1 for label in row["free"]],
        by_bound=row["tie"] == "bound",
        alpha=[float(v) for v in row["alpha_prev"]],
    )
    return row | {"j": j + 1 if j >= 0 else None}


def pieces(inputs: Inputs, expected: dict[str, Any]) -> dict[str, Any]:
    """Formulas without time; the inputs stand in the expected rows."""
    evaluators = {
        "rows": _design_row,
        "theorem4": _theorem4,
        "assumption4": _theorem4,
        "partition": _partition,
        "runs": _runs,
        "gains": lambda row: _gains(row, row.get("eta", inputs.get("eta", {}))),
        "j_choice": _j_choice,
    }
    return {
        key: [evaluators[key](row) for row in rows]
        for key, rows in expected.items()
        if key in evaluators and isinstance(rows, list)
    }
