"""Cases of the structural filter (section 5 of the cases' README)."""

import math
from typing import Any

import numpy as np

import garrison as gr
from garrison import structural as theory
from garrison.verify import structural_designs as designs
from garrison.verify import structural_patterns as patterns
from garrison.verify.compare import NOT_COMPARED, Array, Inputs, array, numbers

NAME = "structural"
#: relative tolerances other than the common one, by the end of the field's name
TOLERANCES: dict[str, float] = {}

#: fields that the cases' README says are not to be compared; they are returned as they are
INFORMATIVE = frozenset(
    {"isolated_h2_at_most/rho", "isolation_ratio_reached", "hungarian_picks", "exact_picks", "approx_cost"}
)


def recognises(inputs: Inputs) -> bool:
    """Inputs that only this family has."""
    return (
        {"W", "U"} <= inputs.keys()
        or {"edges", "measured"} <= inputs.keys()
        or {"adjacency", "runs"} <= inputs.keys()
        or {"settings", "scalar"} <= inputs.keys()
        or bool({"classes", "networks", "scalar"} & inputs.keys())
    )


def _gains(i: Inputs) -> list[Array]:
    return list(numbers(i["K"]))


def _run(i: Inputs, y: Array) -> gr.Run:
    A, C, W, U = (numbers(i[k]) for k in ("A", "C", "W", "U"))
    links = np.argwhere((W != 0) | (U != 0))
    net = gr.Network([(int(b), int(a)) for a, b in links if a != b], agents=len(C), directed=True)
    model = gr.Model(A, C)
    gain = numbers(i["K"]).ravel().tolist()
    filter = gr.filters.Structural(weights=W.ravel().tolist(), sharing=U.ravel().tolist(), gain=gain)
    keep = ("estimate", "signals")
    truth = numbers(i["x_true"]) if "x_true" in i else None
    return gr.replay(model, net, filter, measurements=y, truth=truth, start=numbers(i["xhat0"]), keep=keep)


def _estimates(i: Inputs, setting: theory.Setting, expected: dict[str, Any]) -> dict[str, Any]:
    y = numbers(i["y"])
    run = _run(i, y)
    assert run.estimate is not None
    x, r = run.estimate[0], run.signals["residual"][0, 1:]
    out: dict[str, Any] = {
        "xhat": x[1:],
        "residual": r,
        "xpred": np.array([theory.predictions(setting, before) for before in x[:-1]]),
    }
    # Without the true states the errors cannot be recomputed.
    out["mse_over_time"] = NOT_COMPARED if run.error is None else run.error[0, 1:] ** 2 / x.shape[-1]
    if "tau" in i:
        clean = _run(i, y - numbers(i["tau"]))
        assert clean.estimate is not None
        without = clean.signals["residual"][0, 1:]
        out["residual_without_attack"] = without
        out["max_residual_change"] = float(np.abs(r - without).max())
        out["estimate_change_at_end"] = float(np.abs(x[-1] - clean.estimate[0, -1]).max())
    return out


def _tests(i: Inputs, setting: theory.Setting, residual: Array | None, expected: dict[str, Any]) -> dict[str, Any]:
    """Everything that follows from the stationary covariance."""
    K = _gains(i)
    window = i.get("window", 1)
    lags = max(len(expected.get("residual_autocovariance", [[0]])[0]), window, 1) - 1
    x = theory.stationary(setting, K, lags)
    covariances, std = x["covariances"], x["residual_std"]
    diagonals = np.array([np.diag(g) for g in covariances]).T
    out = {
        "rho_Ahat": x["rho"],
        "Q_norm": x["Q_norm"],
        "Q_agent_traces": x["Q_agent_traces"],
        "residual_covariance": covariances[0],
        "residual_std": std,
        "residual_autocovariance": diagonals,
        "dc_gain": x["dc_gain"],
        "isolation_ratios": theory.isolation_ratios(setting, K),
        "bound_printed": theory.covariance_bound(setting, K, printed=True),
        "bound_corrected": theory.covariance_bound(setting, K),
    }
    m = expected.get("m", 2.0)
    Q1 = out["bound_printed"]["Q1"]
    out |= {"m": m, "threshold_exact": theory.thresholds(std, m)}
    if math.isfinite(Q1):
        out["threshold_printed"] = theory.thresholds_printed(setting, Q1, m)
        out["threshold_root"] = theory.thresholds_root(setting, Q1, m)
    if residual is not None:
        for kind in ("exact", "printed"):
            if f"threshold_{kind}" in out:
                out[f"alarms_{kind}"] = theory.alarms(residual, out[f"threshold_{kind}"])
    responses = expected.get("step_response_to_attack_on_agent", {})
    out["step_response_to_attack_on_agent"] = {
        key: theory.step_response(setting, K, int(key), len(rows)) for key, rows in responses.items()
    }
    if "window" in i and residual is not None:
        out |= _windows(i, residual, x, window, diagonals)
    return out


def _windows(i: Inputs, residual: Array, x: dict[str, Any], window: int, diagonals: Array) -> dict[str, Any]:
    threshold = theory.chi_square_level(window, i["false_alarm"])
    covariances = x["covariances"][:window]
    out: dict[str, Any] = {
        "lag_covariances": covariances,
        "autocov": diagonals[:, :window],
        "threshold": threshold,
        "naive": theory.windows_naive(residual, x["residual_std"], window),
        "exact": theory.windows_exact(residual, covariances),
        "template_glr_from_full_window": theory.template_statistics(residual, covariances, x["dc_gain"]),
    }
    for kind in ("naive", "exact"):
        out[f"alarms_{kind}"] = [[int(a) for a in np.flatnonzero(row > threshold)] for row in out[kind]]
    return out


def _levels(i: Inputs) -> dict[str, Any]:
    out: dict[str, Any] = {"m_of_false_alarm": [theory.level_of_false_alarm(fa) for fa in (0.1, 0.01, 0.001)]}
    if "m" in i:
        out["kappa"] = [theory.kappa(m) for m in np.atleast_1d(numbers(i["m"]))]
    if {"mean", "std", "theta"} <= i.keys():
        out["power"] = [theory.power(i["mean"], i["std"], t) for t in np.atleast_1d(numbers(i["theta"]))]
    return out


def _run_case(i: Inputs, expected: dict[str, Any]) -> dict[str, Any]:
    setting = designs.setting_of(i)
    out: dict[str, Any] = _levels(i)
    residual = None
    if "K" in i and "y" in i:
        out |= _estimates(i, setting, expected)
        residual = out["residual"]
    if "K" in i and "E" in i and "R" in i:
        out |= _tests(i, setting, residual, expected)
    if "E" in i and "R" in i:
        out |= designs.kalman(setting, expected)
    if "measured" in i:
        out |= patterns.mitigation(i, expected)
    return out


# Double-time-scale comparison ----------------------------------------------------------------------------------


def _saturated(i: Inputs, beta: float, rounds: int, expected: dict[str, Any]) -> dict[str, Any]:
    adjacency, C = numbers(i["adjacency"]), numbers(i["C"])
    links = np.argwhere(np.triu(adjacency, 1))
    net = gr.Network([(int(a), int(b)) for a, b in links], agents=len(C))
    filter = gr.filters.Saturation(threshold=beta, rounds=rounds)
    start = numbers(i["xhat0"])
    run = gr.replay(
        gr.Model(numbers(i["A"]), C),
        net,
        filter,
        measurements=numbers(i["y"]),
        start=start,
        keep=("estimate", "signals"),
    )
    assert run.estimate is not None
    innovation = run.signals["innovation"][0, 1:]
    last = len(expected.get("xhat_last5", [0] * 5))
    return {
        "beta": beta,
        "L": rounds,
        "innovation": innovation,
        "xhat_last5": run.estimate[0, -last:],
        "detected": [[int(a) for a in np.flatnonzero(np.abs(row) > i["threshold"])] for row in innovation],
        "saturated": [[int(a) for a in np.flatnonzero(np.abs(row) > beta)] for row in innovation],
    }


# ---------------------------------------------------------------------------------------------------------------


def evaluate(inputs: Any, expected: Any) -> Any:
    """Recompute every expected field from the inputs; keys that are not known stay away."""
    if isinstance(inputs, list):
        return [evaluate(i, e) for i, e in zip(inputs, expected, strict=True)]
    if "adjacency" in inputs and "runs" in inputs:
        pairs = zip(inputs["runs"], expected, strict=True)
        return [_saturated(inputs, float(array(beta)), int(L), e) for (beta, L), e in pairs]
    out: dict[str, Any] = {}
    if "settings" in inputs and "settings" in expected:
        pairs = zip(inputs["settings"], expected["settings"], strict=True)
        out["settings"] = [designs.gain_setting(i, e) for i, e in pairs]
    if "scalar" in inputs:
        out["scalar"] = [designs.scalar(i) for i in inputs["scalar"]]
    if {"classes", "overlap", "networks"} & inputs.keys():
        out |= patterns.costs(inputs, expected)
    elif "W" in inputs:
        out |= _run_case(inputs, expected)
    elif "measured" in inputs:
        out |= patterns.structure_case(inputs)
    return out


def use(inputs: Inputs, template: dict[str, Any], scope: str | None) -> None:
    """Use the inputs as the template does, and let any refusal through."""
    y = numbers(inputs["y"]) if "y" in inputs else None
    evaluate(inputs, template.get("expected", {"m": 2.0}))
    if y is not None and not np.isfinite(y).all():
        _require_alarm(inputs, y)


def _require_alarm(inputs: Inputs, y: Array) -> None:
    """A measurement that is not finite is survived; refused unless the agent's alarm tells of it."""
    out = evaluate(inputs, {"m": 2.0})
    for k, agent in np.argwhere(~np.isfinite(y)):
        if not np.isfinite(out["xhat"]).all() or agent not in out["alarms_exact"][k]:
            raise AssertionError("a measurement that is not finite made an estimate not finite, or no alarm")


def survive(inputs: Inputs, template: dict[str, Any], paths: list[str]) -> dict[str, Any]:
    """Outputs of a case that has to be survived."""
    return dict(evaluate(inputs, template.get("expected", {"m": 2.0})))


__all__ = ["NAME", "TOLERANCES", "evaluate", "recognises", "survive", "use"]
