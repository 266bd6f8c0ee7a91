"""Cases of the resilient distributed Kalman filter (section 2 of the cases' README)."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np

import garrison as gr
from garrison import _core
from garrison._core import rdkf as theory
from garrison.verify.compare import Array, Inputs, Within, array

NAME = "rdkf"
#: relative tolerances other than the common one, by the end of the field's name
TOLERANCES = {"xhat_l1": 1e-8, "x_l1": 1e-8, "xhat_group": 1e-6}
#: fields that say something about the reference, not about what is computed
INFORMATIVE = frozenset({"max_relative_difference_to_clarabel", "l1_violation", "other_start_difference", "sweeps"})
#: a multiplier above this counts as a residual that is not zero; below, rounding decides
_NOT_ZERO = 1e-9


def recognises(inputs: Inputs) -> bool:
    """Inputs that only this family has."""
    return "lam" in inputs or "P0_other" in inputs or {"Sv", "Sw"} <= inputs.keys() or "variants" in inputs


def _matrices(value: Any, columns: int | None = None) -> list[Array]:
    """One matrix per agent; an agent without sensors has []."""
    out = []
    for one in value:
        matrix = np.asarray(array(one), dtype=float)
        out.append(matrix.reshape(0, columns or 0) if matrix.size == 0 else np.atleast_2d(matrix))
    return out


class _Case:
    """Model, network and measurements of one case."""

    def __init__(self, i: Inputs) -> None:
        A = np.atleast_2d(np.asarray(array(i["A"]), dtype=float))
        C = _matrices(i["C"], A.shape[0])
        self.inputs = i
        self.agents = int(i.get("N", len(C)))
        if self.agents != len(C):
            raise gr.InvalidInput(f"C: got {len(C)} matrices, expected N = {self.agents}")
        Sv = _matrices(i["Sv"]) if "Sv" in i else [np.eye(len(c)) for c in C]
        Sw = np.asarray(array(i["Sw"]), dtype=float) if "Sw" in i else np.eye(len(A))
        self.model = gr.Model(A, C, process_covariance=Sw, measurement_covariance=Sv)
        # N_i contains i anyway, and an edge counts once: self-loops and repetitions change nothing.
        edges = [(int(a), int(b)) for a, b in i.get("edges", [])]
        self.network = gr.Network([e for e in edges if e[0] != e[1]], agents=self.agents)
        self._setting: Any = None
        self._steady: Any = None

    @property
    def setting(self) -> Any:
        if self._setting is None:
            self._setting = theory.Setting(self.model, self.network)
        return self._setting

    @property
    def steady(self) -> Any:
        if self._steady is None:
            self._steady = self.setting.steady_state()
        return self._steady

    @property
    def start(self) -> Array:
        given = self.inputs["xhat0"]
        if isinstance(given, str):  # "zeros"
            return np.zeros((self.agents, self.model.states))
        return np.asarray(array(given), dtype=float)

    @property
    def measurements(self) -> Array:
        """(T, all sensors), agent by agent."""
        rows = [np.concatenate([np.asarray(array(y), dtype=float).ravel() for y in row]) for row in self.inputs["y"]]
        return np.asarray(rows, dtype=float).reshape(len(rows), -1)

    def run(self, filter: _core.Filter, measurements: Array | None = None, truth: Array | None = None) -> gr.Run:
        return gr.replay(
            self.model,
            self.network,
            filter,
            measurements=self.measurements if measurements is None else measurements,
            truth=truth,
            start=self.start,
            keep=("estimate", "report", "signals"),
        )

    def constants(self, weight: float) -> dict[str, Any]:
        c = theory.constants(self.setting, self.steady, weight)
        return {
            "resiliency_bound_eq10": c["resiliency_bound"],
            "prior_deviation_bound": c["deviation_bound"],
            "theorem3_level_max_V": c["level"],
            "theorem3_refined_threshold": c["refined_threshold"],
            "gamma": c["rate"],
            "eta": c["eta"],
            "dkf_error_radius": c["dkf_error_radius"],
            "prior_error_radius": c["prior_error_radius"],
            "trace_P": [np.trace(P) for P in self.steady.P],
            # Only whether it exists is compared: the reference gives partial sums.
            "persistent_series_bound": Within(c["persistent_bound"], np.inf),
        }


def _filter(penalty: str, weight: float, **more: Any) -> _core.Filter:
    return gr.filters.Rdkf(weight=float(array(weight)), penalty=penalty, **more)


def _estimate(run: gr.Run) -> Array:
    assert run.estimate is not None
    estimate: Array = run.estimate[0]
    return estimate


def _whitened_size(case: _Case, estimate: Array) -> Array:
    """|b| + |M x| per time and agent, an upper estimate of the scale that multipliers are compared on."""
    sizes = np.zeros((len(estimate) - 1, case.agents))
    Sv = _matrices(case.inputs["Sv"]) if "Sv" in case.inputs else None
    column = 0
    y = case.measurements
    for i, C in enumerate(case.model.C):
        if len(C) == 0:
            continue
        least = 1.0 if Sv is None else math.sqrt(np.linalg.eigvalsh(Sv[i])[0])
        rows = np.linalg.norm(y[:, column : column + len(C)], axis=1)
        sizes[:, i] = (rows + np.linalg.norm(estimate[1:, i] @ C.T, axis=1)) / least
        column += len(C)
    return sizes


def _flags(mu: Array, expected: dict[str, Any]) -> Any:
    """Flags agree where both multipliers are on the same side of 1e-9."""
    ours = mu > _NOT_ZERO
    if "mu" not in expected:
        return ours.tolist()
    theirs = np.asarray(array(expected["mu"]), dtype=float) > _NOT_ZERO
    flags = np.asarray(expected["residual_nonzero"], dtype=bool)
    return (np.where(ours == theirs, flags, ~flags) if flags.shape == ours.shape else ours).tolist()


def _truth(case: _Case, steps: int, x0: Array | None = None) -> Array:
    """States without noise from x0, else those of the case."""
    if x0 is None:
        return np.asarray(array(case.inputs["x"]), dtype=float)
    states = [np.asarray(x0, dtype=float)]
    for _ in range(steps):
        states.append(case.model.A @ states[-1])
    return np.asarray(states)


#: expected key -> filter that gives it
_TRAJECTORIES: dict[str, Callable[[float], _core.Filter]] = {
    "xhat_dkf": lambda weight: gr.filters.Dkf(),
    "xhat_huber": lambda weight: _filter("huber", weight),
    "xhat_l1": lambda weight: _filter("l1", weight),
    "xhat_group": lambda weight: _filter("group", weight),
}


def _trajectories(case: _Case, expected: dict[str, Any]) -> dict[str, Any]:
    out: dict[str, Any] = {}
    weight = float(array(case.inputs.get("lam", 1.0)))
    if {"xhat_rdkf", "mu", "residual_nonzero", "V_rdkf"} & expected.keys():
        run = case.run(_filter("norm", weight))
        estimate, mu = _estimate(run), run.signals["mu"][0, 1:]
        out["xhat_rdkf"] = estimate
        scale = _whitened_size(case, estimate) / weight if weight > 0 else np.zeros(mu.shape)
        reference = np.abs(np.asarray(array(expected["mu"]), dtype=float)) if "mu" in expected else mu
        reference = np.where(np.isfinite(reference), reference, 0.0)
        out["mu"] = Within(mu, 1e-9 * reference + 1e-12 * scale if reference.shape == mu.shape else 0.0)
        if "residual_nonzero" in expected:
            out["residual_nonzero"] = _flags(mu, expected)
        if "V_rdkf" in expected:
            # The state is not stored: x_0 = xhat_0 - 0.05, no noise (cases' README, 2.4).
            known = "x" in case.inputs
            x = _truth(case, len(estimate) - 1, None if known else case.start[0] - 0.05)
            out["V_rdkf"] = [theory.lyapunov(case.steady, e - t) for e, t in zip(estimate, x, strict=True)]
    for key, make in _TRAJECTORIES.items():
        if key in expected:
            out[key] = _estimate(case.run(make(weight)))
    if "xhat_smoothed" in expected:
        smoothed = _filter("norm", weight, smoothing=float(array(case.inputs["eps"])))
        out["xhat_smoothed"] = _estimate(case.run(smoothed))
    return out


def _covariances(case: _Case, expected: dict[str, Any]) -> dict[str, Any]:
    i = case.inputs
    out: dict[str, Any] = {}
    if {"P", "Pbar", "Q"} & expected.keys():
        out |= {"P": case.steady.P, "Pbar": case.steady.Pbar, "Q": case.steady.Q}
    if "iterates_from_zero" in expected:
        n = case.model.states
        P = [np.zeros((n, n)) for _ in range(case.agents)]
        iterates = [P]
        for _ in range(len(expected["iterates_from_zero"]) - 1):
            P = case.setting.sweep(P)
            iterates.append(P)
        out["iterates_from_zero"] = iterates
    for key in expected:
        if key.endswith("_P") and isinstance(i.get(key[:-2]), dict):  # a model of its own: singular_P
            out[key] = _Case(i[key[:-2]]).steady.P
    if "refused" in i:
        _require_refused(i["refused"])
    return out


def _require_refused(model: Inputs) -> None:
    """A model that has no covariances must be refused, also where it comes without noise covariances."""
    n = len(model["A"])
    filled = {"Sv": [np.eye(len(c)).tolist() for c in model["C"]], "Sw": [np.eye(n).tolist()] * len(model["C"])}
    try:
        _ = _Case(filled | model).steady
    except gr.Error:
        return
    raise AssertionError("the model `refused` was not refused")


def _variant(case: _Case, weight: float, attacked: bool, expected: dict[str, Any]) -> dict[str, Any]:
    """One run of the paper's simulation: y_k^i = C_i A^k x0 + attack."""
    i = case.inputs
    x = _truth(case, int(i["T"]), np.asarray(array(i["x0"]), dtype=float))
    y = np.hstack([x[1:] @ C.T for C in case.model.C])
    first = np.cumsum([0, *(len(C) for C in case.model.C)])
    for hit in i["attack"] if attacked else []:
        a = hit["agent"]
        y[hit["time"] - 1, first[a] : first[a + 1]] += np.asarray(array(hit["vector"]), dtype=float)
    out: dict[str, Any] = {}
    rdkf = case.run(_filter("norm", weight), y, x)
    times = i["report_times"]
    assert rdkf.error is not None
    out["rdkf_error_norm"] = rdkf.error[0, times]
    if "rdkf_xhat_at_times" in expected:
        estimate = _estimate(rdkf)
        out["rdkf_xhat_at_times"] = {k: estimate[int(k)] for k in expected["rdkf_xhat_at_times"]}
    if "dkf_error_norm" in expected:
        dkf = case.run(gr.filters.Dkf(), y, x)
        assert dkf.error is not None
        out["dkf_error_norm"] = dkf.error[0, times]
    return out


def _variants(i: Inputs, expected: dict[str, Any]) -> dict[str, Any]:
    """The paper's simulation for every (lambda, Sv, Sw)."""
    out: dict[str, Any] = {}
    n = len(i["A"])
    for lam, sv, sw in i["variants"]:
        name = f"lam{lam:g}_sv{sv:g}_sw{sw:g}"
        noise = {
            "Sv": [(sv * np.eye(len(c))).tolist() for c in i["C"]],
            "Sw": [(sw * np.eye(n)).tolist()] * len(i["C"]),
        }
        case = _Case(i | noise)
        for kind in ("attack_free", "attacked"):
            if (key := f"{kind}_{name}") in expected:
                out[key] = _variant(case, float(lam), kind == "attacked", expected[key])
        out[f"constants_{name}"] = case.constants(float(lam))
    return out


def _scalar(i: Inputs) -> dict[str, Any]:
    """One agent, one state, no attack: the basin of convergence."""
    model = {"A": [[i["a"]]], "C": [[[i["c"]]]], "Sv": [[[i["Sv"]]]], "Sw": [[[i["Sw"]]]], "edges": []}
    x0 = float(array(i.get("true_state", 0.0)))
    x = [x0 * float(i["a"]) ** k for k in range(int(i["T"]) + 1)]
    case = _Case(model | {"xhat0": [[x0 + float(i["e0"])]], "y": [[[float(i["c"]) * v]] for v in x[1:]]})
    weight = float(array(i["lam"]))
    level = theory.constants(case.setting, case.steady, weight)["level"]
    P = float(case.steady.P[0][0, 0])
    return {
        "a": i["a"],
        "w": i["Sw"],
        "e0": i["e0"],
        "lam": i["lam"],
        "error": _estimate(case.run(_filter("norm", weight)))[:, 0, 0] - np.asarray(x),
        "Pbar": float(case.steady.Pbar[0][0, 0]),
        "admissible_e0": {k: math.sqrt(v * P) for k, v in level.items()},
        "true_basin": theory.scalar_basin(case.setting, case.steady, weight),
    }


def _single(i: Inputs, expected: dict[str, Any]) -> dict[str, Any]:
    """One problem (8) in whitened form."""
    Q = np.atleast_2d(np.asarray(array(i["Q"]), dtype=float))
    x0, b = (np.asarray(array(i[k]), dtype=float).ravel() for k in ("x0", "b"))
    M = np.asarray(array(i["M"]), dtype=float).reshape(len(b), len(x0))
    lam = float(array(i["lam"]))
    main = theory.step(Q, M, b, x0, lam)
    size = float(np.linalg.norm(b) + np.linalg.norm(M @ x0))
    end = float(np.linalg.norm(b) + np.linalg.norm(M @ main["x"]))
    reference = abs(float(array(expected.get("mu", 0.0))))
    out: dict[str, Any] = {
        "tag": i.get("tag"),
        "x": main["x"],
        "mu": Within(main["mu"], 1e-9 * reference + 1e-12 * size / lam if lam > 0 else 0.0),
        "residual_norm": Within(
            main["residual_norm"], 1e-9 * float(array(expected.get("residual_norm", 0.0))) + 1e-12 * size
        ),
        "objective": Within(
            main["objective"], 1e-9 * abs(float(array(expected.get("objective", 0.0)))) + 1e-14 * lam * end
        ),
        "x_huber": theory.step(Q, M, b, x0, lam, penalty="huber")["x"],
        "x_l1": theory.step(Q, M, b, x0, lam, penalty="l1")["x"],
    }
    if "residual_nonzero" in expected:
        out["residual_nonzero"] = bool(np.asarray(_flags(np.array([main["mu"]]), _as_rows(expected)))[0])
    if "eps" in i:
        out["x_smoothed"] = theory.step(Q, M, b, x0, lam, smoothing=float(array(i["eps"])))["x"]
    return out


def _as_rows(expected: dict[str, Any]) -> dict[str, Any]:
    return {k: [v] for k, v in expected.items() if k in ("mu", "residual_nonzero")}


def evaluate(inputs: Any, expected: Any) -> Any:
    """Recompute every expected field from the inputs; keys that are not known stay away."""
    if isinstance(inputs, list):
        return [evaluate(i, e) for i, e in zip(inputs, expected, strict=True)]
    if "M" in inputs and "Q" in inputs:
        return _single(inputs, expected)
    if "a" in inputs and "e0" in inputs:
        return _scalar(inputs)
    if "variants" in inputs:
        return _variants(inputs, expected)
    case = _Case(inputs)
    out = _trajectories(case, expected) | _covariances(case, expected)
    constants = case.constants(float(array(inputs.get("lam", 1.0))))
    return out | constants | {"constants": constants}


def use(inputs: Inputs, template: dict[str, Any], scope: str | None) -> None:
    """Use the inputs as the template does, and let any refusal through."""
    if "expected" in template:
        evaluate(inputs, template["expected"])
        return
    case = _Case(inputs)
    if "y" in inputs:
        case.run(_filter("norm", inputs.get("lam", 1.0)))
    else:
        case.constants(float(array(inputs.get("lam", 1.0))))


def survive(inputs: Inputs, template: dict[str, Any], paths: list[str]) -> dict[str, Any]:
    """Outputs of a case that has to be survived, for the paths that its rules look at."""
    return dict(evaluate(inputs, {path.split("/")[0]: [] for path in paths}))


__all__ = ["INFORMATIVE", "NAME", "TOLERANCES", "evaluate", "recognises", "survive", "use"]
