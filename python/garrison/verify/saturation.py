"""Cases of the saturation filter (section 1 of the cases' README)."""

import math
from typing import Any

import numpy as np

import garrison as gr
from garrison import _core
from garrison._core import saturation as theory
from garrison.verify.compare import NOT_UNDERSTOOD, Array, Inputs, array

NAME = "saturation"
#: relative tolerances other than the common one, by the end of the field's name
TOLERANCES = {"design/beta": 1e-6, "design/bound": 1e-6, "bound_at_design_beta": 1e-6}


def recognises(inputs: Inputs) -> bool:
    """Inputs that only this family has."""
    tables = [item.keys() for item in inputs.get("items", []) if isinstance(item, dict)]
    return (
        bool({"beta", "eta0", "L_sgcf", "grid"} & inputs.keys())
        or {"alpha", "x0_hat"} <= inputs.keys()
        or any({"A", "C", "s"} <= keys for keys in tables)
    )


def _system(i: Inputs) -> tuple[gr.Model, gr.Network]:
    C = np.asarray(array(i["C"]), dtype=float)
    model = gr.Model(
        np.asarray(array(i["A"]), dtype=float),
        C,
        process_bound=i.get("b_w", math.nan),
        measurement_bound=i.get("b_v"),
    )
    return model, gr.Network([tuple(e) for e in i["edges"]], agents=len(C))


def _filter(i: Inputs, **more: Any) -> _core.Filter:
    given: dict[str, Any] = {"threshold": i.get("beta"), "rounds": i.get("L"), "step": i.get("alpha")}
    if len(i["C"]) == 1:
        given["step"] = None  # alpha = 0: there is nobody to average with
    return gr.filters.make_filter("saturation", {k: v for k, v in (given | more).items() if v is not None})


def _bounded(i: Inputs) -> dict[str, Any]:
    return {"attacked": i["s"], "initial_error": i["eta0"]}


def _run(i: Inputs, filter: _core.Filter) -> gr.Run:
    model, net = _system(i)
    start = np.asarray(array(i["x0_hat"]), dtype=float)
    y = np.asarray(array(i["y"]), dtype=float)[1:]
    truth = np.asarray(array(i["x"]), dtype=float) if "x" in i else None
    return gr.replay(
        model, net, filter, measurements=y, truth=truth, start=start, keep=("estimate", "report", "signals")
    )


def _algorithm2(i: Inputs, index: str = "t") -> _core.Filter:
    # A measurement that is not a number counts as an attack, as the cases of bad input want it.
    return _filter(i, detector=True, detector_index=index, accuse_missing=True, **_bounded(i))


def _changes(run: gr.Run) -> list[dict[str, Any]]:
    return [{"t": t, "sets": sets} for _, t, sets in run.accusations]


def _signals(run: gr.Run, inputs: Inputs) -> dict[str, Any]:
    """Everything of one run under the names of the case files."""
    assert run.estimate is not None and run.bound is not None
    s = run.signals
    x_hat = run.estimate[0]
    out = {
        "x_hat": x_hat,
        "k": s["gain"][0, 1:],
        "phi": s["phi"][0, 1:],
        "rho_bar": s["rho"][0],
        "p": s["p"][0, :, 0],
        "innovations": s["innovation"][0, 1:],
        "detected_changes": _changes(run),
        "disagreement": np.linalg.norm(x_hat - x_hat.mean(axis=1, keepdims=True), axis=(1, 2)),
    }
    if run.error is not None:
        out["max_error"] = run.error[0].max(axis=1)
        out["within_bound"] = (run.error[0], run.bound[0])
    return out


def _is_algorithm2(expected: dict[str, Any]) -> bool:
    return bool({"phi", "rho_bar", "p", "innovations", "detected_changes", "ineq16_fails_at"} & expected.keys())


def _facts(i: Inputs) -> dict[str, Any]:
    """Spectrum, norms and subset quantities."""
    model, net = _system(i)
    s = i.get("s", 0)
    probe = gr.filters.Saturation(threshold=1.0, rounds=i.get("L", 1), attacked=s)
    found = gr.check(model, net, probe)
    return {
        "N": model.agents,
        "n": model.states,
        "normA": found["||A||"],
        "lambda2": found["lambda_2"],
        "lambda_max": found["lambda_max"],
        "alpha": found["alpha"],
        "gamma": found["gamma"],
        "contraction": found["contraction"],
        "lambda0": found["lambda_0"],
    }


def _setting(i: Inputs, facts: dict[str, Any], **more: Any) -> Any:
    given = {
        "agents": facts["N"],
        "a": facts["normA"],
        "lambda0": facts["lambda0"],
        "contraction": facts["contraction"],
        "attacked": i.get("s", 0),
        "beta": i.get("beta", math.nan),
        "eta0": i.get("eta0", 1.0),
        "b_w": i.get("b_w", 0.0),
        "b_v": i.get("b_v", 0.0),
    }
    return theory.Setting(**(given | more))


def _copied(i: Inputs, keys: tuple[str, ...]) -> dict[str, Any]:
    return {k: i[k] for k in keys if k in i}


def _bounds(i: Inputs, expected: dict[str, Any]) -> dict[str, Any]:
    """Objects `constants` and `bounds`: all of section 1.5."""
    facts = _facts(i)
    setting = _setting(i, facts)
    model, _ = _system(i)
    C, A, s = np.asarray(i["C"], dtype=float), model.A, i["s"]
    varpi = gr._core.varpi(C, A, s).upper
    tau0 = gr._core.tau0(C, A, s).upper
    T = len(expected.get("rho", [0])) - 1
    length = max(len(expected.get(key, [0])) for key in ("thm1_item1_t0_1", "thm3_item2_t0_1"))
    lo, hi = theory.fixed_points(setting)
    G, radius = theory.theorem5(setting, tau0, varpi)
    out = facts | _copied(i, ("s", "beta", "L", "eta0", "b_w", "b_v")) | theory.constants(setting)
    out |= {
        "rho": theory.rho_sequence(setting, T),
        "rho_lo": lo,
        "rho_hi": hi,
        "p": [theory.p_at(setting, t) for t in range(len(expected.get("p", [0])))],
        "varpi": varpi,
        "tau0": tau0,
        "normA_max_exact": theory.normA_max_exact(setting),
        "feasibility_margin": theory.feasibility_margin(setting),
        "minimal_L": theory.minimal_rounds(setting, facts["gamma"]),
        "beta_interval": theory.beta_interval(setting),
        "G": G,
        "G_spectral_radius": radius,
    }
    bounds = theory.theorem_bounds(setting, varpi, length)
    if bounds["cond9"]:
        out |= {
            "thm1_item1_t0_1": bounds["thm1_item1"],
            "thm1_item2_t0_1": bounds["thm1_item2"],
            "thm1_item3": bounds["thm1_item3"],
            "prop2_f": bounds["prop2_f"],
            "cond12_margin_t0_1": bounds["cond12_margin"],
            "cond12_t0_1": bounds["cond12"],
            "thm4": theory.theorem4(setting, 3),
        }
        if bounds["cond12"]:
            out |= {"thm3_item2_t0_1": bounds["thm3_item2"], "thm3_item3": bounds["thm3_item3"]}
    return out


def _adaptive(i: Inputs) -> dict[str, Any]:
    run = _run(i, _filter(i | {"beta": None}, adaptive=True, **_bounded(i)))
    assert run.estimate is not None
    s = run.signals
    return {
        "x_hat": run.estimate[0],
        "beta": s["level"][0, 1:, 0],
        "rho": s["rho"][0, :, 0],
        "p": s["p"][0, :, 0],
    }


def _subset_item(item: Inputs) -> dict[str, Any]:
    """One entry of the lambda_0 table."""
    C, A, s = np.asarray(item["C"], dtype=float), np.asarray(item["A"], dtype=float), item["s"]
    N = len(C)
    worst = gr.lambda0(C, s)
    setting = theory.Setting(agents=N, a=1.0, lambda0=worst.lower, contraction=0.0, attacked=s)
    out: dict[str, Any] = {
        "name": item.get("name"),
        "s": s,
        "lambda0": worst.lower,
        "varpi": gr._core.varpi(C, A, s).upper,
        "tau0": gr._core.tau0(C, A, s).upper,
        "normA_max_exact": theory.normA_max_exact(setting),
        "cond11": theory.condition11(setting),
        "one_step_s_sparse": gr.one_step_sparse_observable(C, s),
        "orthogonal_closed_form": gr._core.lambda0_orthogonal(C, s),
        "eps_paper": theory.eps_paper(setting),
        "lambda0_bruteforce": worst.lower,
    }
    if N < 20:
        out["s_sparse_observable"] = gr.s_sparse_observable(A, C, s)
    if 2 * s < N:
        out["one_step_2s_sparse"] = gr.one_step_sparse_observable(C, 2 * s)
    return out


def _design_row(i: Inputs, row: Inputs, expected: dict[str, Any]) -> dict[str, Any]:
    """One entry of the design table."""
    case = i | {"s": row["s"], "L": row["L"], "eta0": row["eta0"]}
    facts = _facts(case)
    setting = _setting(case, facts)
    interval = theory.beta_interval(setting)
    out: dict[str, Any] = _copied(case, ("s", "L", "eta0")) | {
        "lambda0": facts["lambda0"],
        "minimal_L": theory.minimal_rounds(setting, facts["gamma"]),
        "beta_interval": interval,
        "design": None,
    }
    try:
        best = theory.best_threshold(setting, 0.0)
    except gr.DesignInfeasible:
        return out
    out["design"] = {
        "beta": best["beta"],
        "L": row["L"],
        "bound": best["bound"],
        "beta_lo": interval[0],
        "beta_hi": interval[1],
    }
    if isinstance(expected.get("design"), dict):
        at = _setting(case, facts, beta=expected["design"]["beta"])
        lo, hi = theory.fixed_points(at)
        if row["eta0"] <= hi * (1 + 1e-9):
            out["bound_at_design_beta"] = lo + theory.constants(at)["p0"]
    return out


def _baselines(i: Inputs, expected: dict[str, Any]) -> dict[str, Any]:
    out: dict[str, Any] = {}
    if "sgcf_x_hat" in expected:
        rounds = i.get("L_sgcf", i.get("L"))
        params = {"rounds": rounds} | ({"step": i["alpha"]} if len(i["C"]) > 1 else {})
        out["sgcf_x_hat"] = _estimate(_run(i, gr.filters.make_filter("scalar_gain", params)))
    if "L0_x_hat" in expected:
        out["L0_x_hat"] = _estimate(_run(i, _filter(i | {"beta": i["beta_L0"], "L": 0})))
    if any(key.startswith("lfre_") for key in expected):
        model, net = _system(i)
        lfre = gr.filters.Lfre(faulty=i["f"], poles=list(i["lfre_poles"]))
        run = _run(i, lfre)
        out["lfre_x_hat"] = _estimate(run)
        out["lfre_source"] = [bool(v) for v in run.signals["source"][0, 0]]
        out["lfre_parents"] = _core.lfre_parents(model, net, lfre)
    return out


def _estimate(run: gr.Run) -> Array:
    assert run.estimate is not None
    estimate: Array = run.estimate[0]
    return estimate


def _ineq16(i: Inputs, run: dict[str, Any]) -> Any:
    """The only place where an honest sensor's innovation is above phi; None when there is not exactly one."""
    above = np.abs(run["innovations"]) > run["phi"]
    above[:, i["attacked"]] = False
    places = np.argwhere(above)
    return {"t": int(places[0, 0]) + 1, "sensor": int(places[0, 1])} if len(places) == 1 else None


def _evaluate_one(i: Inputs, expected: dict[str, Any]) -> dict[str, Any]:
    out: dict[str, Any] = {}
    main = {
        "x_hat",
        "k",
        "phi",
        "rho_bar",
        "p",
        "innovations",
        "detected_changes",
        "max_error",
        "disagreement",
        "ineq16_fails_at",
    }
    if main & expected.keys():
        second = _is_algorithm2(expected)
        run = _signals(_run(i, _algorithm2(i) if second else _filter(i)), i)
        out |= run
        if "ineq16_fails_at" in expected:
            out["ineq16_fails_at"] = _ineq16(i, run)
    for index, key in (("t", "d_index_t"), ("t+1", "d_index_t_plus_1")):
        if key in expected:
            out[key] = _signals(_run(i, _algorithm2(i, index)), i)
    if any(key.startswith("alg1_") for key in expected):
        run = _signals(_run(i, _filter(i)), i)
        out |= {"alg1_x_hat": run["x_hat"], "alg1_k": run["k"]}
    if any(key.startswith("alg2_") for key in expected):
        run = _signals(_run(i, _algorithm2(i)), i)
        out |= {f"alg2_{k}": run[k] for k in ("x_hat", "k", "phi", "rho_bar")}
        out["alg2_any_detected"] = any(s for change in run["detected_changes"] for s in change["sets"])
    if {"constants", "bounds", "cond9"} & expected.keys():
        out["constants"] = _bounds(i, expected.get("constants", {}))
        out["bounds"] = _bounds(i, expected.get("bounds", {}))
        out["cond9"] = out["constants"]["cond9"]
    if {"lambda2", "lambda_max", "gamma", "p0"} & expected.keys():
        facts = _facts(i)
        out |= {k: facts[k] for k in ("lambda2", "lambda_max", "gamma")}
        if "p0" in expected:
            out["p0"] = theory.constants(_setting(i, facts))["p0"]
    if "adaptive_beta" in expected:
        out["adaptive_beta"] = _adaptive(i)
    if "bounds_hold" in expected:
        error = out["max_error"] if "max_error" in out else _signals(_run(i, _filter(i)), i)["max_error"]
        limit = np.asarray(_bounds(i, {"thm1_item1_t0_1": error[1:]})["thm1_item1_t0_1"])
        out["bounds_hold"] = bool((error[1 : len(limit) + 1] <= limit).all())
    return out | _baselines(i, expected)


def evaluate(inputs: Any, expected: Any) -> Any:
    """Recompute every expected field from the inputs; keys that are not known stay away."""
    if isinstance(inputs, list):
        return [evaluate(i, e) for i, e in zip(inputs, expected, strict=True)]
    out: dict[str, Any] = {}
    if "items" in inputs:
        out["items"] = [_subset_item(item) for item in inputs["items"]]
    if "grid" in inputs:
        rows = expected.get("rows", [{}] * len(inputs["grid"]))
        out["rows"] = [_design_row(inputs, row, e) for row, e in zip(inputs["grid"], rows, strict=True)]
    if "runs" in inputs:
        shared = {k: v for k, v in inputs.items() if k != "runs"}
        if "runs" in expected:
            out["runs"] = [
                _evaluate_one(shared | run, e) for run, e in zip(inputs["runs"], expected["runs"], strict=True)
            ]
        rest = {k: v for k, v in expected.items() if k != "runs"}
        return out | _evaluate_one(shared, rest)
    for key, value in inputs.items():  # named systems that share the other inputs
        if isinstance(value, dict) and key in expected:
            shared = {k: v for k, v in inputs.items() if not isinstance(v, dict)}
            out[key] = _bounds(shared | value, expected[key])
    if "C" in inputs and "grid" not in inputs:
        out |= _evaluate_one(inputs, expected)
    return out


def use(inputs: Inputs, template: dict[str, Any], scope: str | None) -> None:
    """Use the inputs as the template does, and let any refusal through."""
    if "expected" in template:
        evaluate(inputs, template["expected"])
        return
    if {"s", "eta0", "b_w", "b_v"} <= inputs.keys():
        _run(inputs, _algorithm2(inputs))
    else:
        _run(inputs, _filter(inputs))


def survive(inputs: Inputs, template: dict[str, Any], paths: list[str]) -> dict[str, Any]:
    """Outputs of a case that has to be survived, for the paths that its rules look at."""
    wanted: dict[str, Any] = {}
    for path in paths:
        place = wanted
        *outer, last = path.split("/")
        for key in outer:
            place = place.setdefault(key, {})
        place[last] = None
    pattern = template.get("expected", {})
    hint = {k: v for k, v in pattern.items() if k in ("phi", "rho_bar", "detected_changes")}
    return dict(evaluate(inputs, hint | wanted))


__all__ = ["NAME", "NOT_UNDERSTOOD", "TOLERANCES", "evaluate", "recognises", "survive", "use"]
