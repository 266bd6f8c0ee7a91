"""Cases of the partial-sharing filter (section 4 of the cases' README)."""

from typing import Any

import numpy as np

from garrison._core import partial_sharing as theory
from garrison.verify.compare import NOT_UNDERSTOOD, Array, Inputs, numbers
from garrison.verify.partial_sharing_case import Case

NAME = "partial_sharing"
#: relative tolerances other than the common one, by the end of the field's name
TOLERANCES: dict[str, float] = {}
#: fields for information: the plant's noise, without which they cannot be computed, is not stored
INFORMATIVE = frozenset({"x_true"})

#: 0 of a square root: agreement to the square root of rounding
_ZERO_GAMMA = 1e-6


def recognises(inputs: Inputs) -> bool:
    """Inputs that only this family has."""
    items = inputs.get("list")
    return {"s0", "tau"} <= inputs.keys() or (isinstance(items, list) and all({"s0", "tau"} <= i.keys() for i in items))


def _filters(c: Case, expected: dict[str, Any]) -> dict[str, Any]:
    """Trajectories, gains and covariances of Algorithm 1 and of the full solution."""
    out: dict[str, Any] = {}
    wanted = expected.keys()
    if {"xhat", "xhat_algorithm1"} & wanted:
        out["xhat"] = out["xhat_algorithm1"] = c.estimates()
    last = c.steps - 1
    for key, at in (("K_step0", ("K", 0)), ("C_step0", ("C", 0)), ("K_last", ("K", last)), ("C_last", ("C", last))):
        if key in wanted:
            out[key] = c.base.gains(at[1])[at[0]]
    if {"P_local_final", "P_final"} & wanted:
        local = c.base.gains(c.steps)["P"]
        out |= {"P_local_final": local, "P_final": local[0] if np.ndim(expected.get("P_final", ())) == 2 else local}
    if {"P_local_steady", "P_steady", "C_steady", "trace_Pi_steady", "mse_local_no_attack"} & wanted:
        steady = c.base.steady_gains()
        # One agent: the matrix itself, as one_agent has it.
        single = np.ndim(expected.get("P_steady", ())) == 2
        out |= {
            "P_local_steady": steady["P"],
            "P_steady": steady["P"][0] if single else steady["P"],
            "C_steady": steady["C"],
            "trace_Pi_steady": [float(np.trace(P)) for P in steady["P"]],
            "mse_local_no_attack": float(np.mean([np.trace(P) for P in steady["P"]])),
        }
    if {"xhat_full", "K_full_last", "C_full_last", "P_full_final", "trace_full_common_initial"} & wanted:
        full = c.full()
        out |= {
            "xhat_full": full["estimate"],
            "K_full_last": full["K"],
            "C_full_last": full["C"],
            "P_full_final": full["P"],
            "trace_full_common_initial": full["trace"],
        }
    if "trace_full_independent_initial" in wanted:
        out["trace_full_independent_initial"] = c.full(common_start=False)["trace"]
    return out


def _network(c: Case, expected: dict[str, Any]) -> dict[str, Any]:
    """Exact covariances of the network, and the paper's."""
    out: dict[str, Any] = {}
    wanted = expected.keys()
    if {
        "trace_29_algorithm1",
        "P_29_algorithm1_final",
        "nmse_29",
        "P_29_final",
        "mse_29_common_initial_error",
    } & wanted:
        exact = c.trajectory()
        out |= dict.fromkeys(("trace_29_algorithm1", "nmse_29"), exact["nmse"])
        out |= dict.fromkeys(("P_29_algorithm1_final", "P_29_final"), exact["P"])
        out["mse_29_common_initial_error"] = np.asarray(exact["nmse"]) / c.agents
    if "nmse_mean_over_iid_selections" in wanted:
        out["nmse_mean_over_iid_selections"] = c.trajectory(iid_selections=True)["nmse"]
    if "mse_periodic_29_no_attack" in wanted:
        out["mse_periodic_29_no_attack"] = c.base.periodic_mse()
    for key, moments in (("mse_26", "p_e"), ("mse_25_exact_uniform", "uniform"), ("mse_25_exact_cycle", "cycle")):
        if key in wanted:
            out[key] = c.base.mse_local(moments, c.Sigma, c.liars)
    if "mse_26_half" in wanted:
        out["mse_26_half"] = c.base.mse_local("p_e", c.Sigma, c.liars)
    if "mse_26_full_sharing" in wanted:
        out["mse_26_full_sharing"] = c.base.mse_local("full", c.Sigma, c.liars)
    if "mse_periodic_29" in wanted:
        out["mse_periodic_29"] = c.base.periodic_mse(c.Sigma, c.liars)
    sharing = {"half": c.s0, "full": np.ones_like(c.s0)}
    for name, s in sharing.items():
        for state in ("no_attack", "attack"):
            key = f"periodic_29_{state}_{name}"
            if key in wanted:
                analysis = c.analysis(selection=s.ravel().tolist())
                phases = np.asarray(analysis.periodic_mse(*((c.Sigma, c.liars) if state == "attack" else ())))
                # As many phases as the shift says, even where the selections themselves do not change.
                out[key] = np.resize(phases, len(expected[key]))
    return out


def _stability(c: Case, expected: dict[str, Any]) -> dict[str, Any]:
    """The three stability tests."""
    out: dict[str, Any] = {}
    for key in ("gamma_star", "gamma_star_22"):
        if key in expected:
            value = c.base.gamma_star()
            out[key] = 0.0 if expected[key] == 0 and value < _ZERO_GAMMA else value
    if "gamma_star_22_for_l_2_4_6_8" in expected:
        out["gamma_star_22_for_l_2_4_6_8"] = [c.base.gamma_star(part / c.states) for part in (2, 4, 6, 8)]
    for key in ("cycle_radius", "cycle_radius_at_gamma"):
        if key in expected:
            out[key] = c.base.cycle_radius()
    if "lambda_I_blocks" in expected:
        out["lambda_I_blocks"] = c.base.lambda_I()
    if "period" in expected:
        out["period"] = c.base.selection.period
    if "decrease_matrix_min_eig_at_gamma_star" in expected:
        M = c.base.decrease_matrix(c.base.gamma_star(), 0)
        out["decrease_matrix_min_eig_at_gamma_star"] = float(np.linalg.eigvalsh(M)[0])
    for key, entry in expected.items():
        if not (key.startswith("tau_") and isinstance(entry, dict)):
            continue
        shift = int(key.removeprefix("tau_"))
        star = c.base.gamma_star()
        out[key] = {
            "radius_at_fraction_of_gamma_star": {
                # Without edges gamma* is infinite, and no gain matters.
                f: c.analysis(shift=shift, gain=float(f) * star if np.isfinite(star) else 0.0).cycle_radius()
                for f in entry.get("radius_at_fraction_of_gamma_star", {})
            }
        }
        if "gamma_with_decreasing_V" in entry:
            out[key]["gamma_with_decreasing_V"] = c.analysis(shift=shift).gamma_lyapunov()
    return out


def _ascents(c: Case, problem: theory.SelectionProblem, start: Array) -> dict[str, Any]:
    out = {}
    for rule, newest in (("jacobi", False), ("gauss", True)):
        for factor in (1, 2):
            a = problem.ascent(start, c.inputs["T"], float(factor), newest, True)
            out[f"{rule}_coupling{factor}"] = {
                "objective_per_sweep": a["objective"],
                "s": np.asarray(c.blocks(a["s"]), dtype=int).tolist(),
                "objective_after_rounding": a["rounded"],
            }
    return out


def _mse_table(c: Case, attacks: dict[str, Array | None], expected: dict[str, Any]) -> dict[str, Any]:
    """All notions of MSE side by side, under each attack."""
    k0 = c.inputs["k0"]
    out = {}
    for name, Sigma in attacks.items():
        if name not in expected:
            continue
        steps = len(expected[name].get("recursion_8_from_steady_state_k0_on", [0]))
        out[name] = {
            "theory_26": c.base.mse_local("p_e", Sigma, c.liars),
            "exact_25_uniform": c.base.mse_local("uniform", Sigma, c.liars),
            "exact_25_cycle": c.base.mse_local("cycle", Sigma, c.liars),
            "recursion_8_from_steady_state_k0_on": c.base.recursion8(Sigma, k0, steps),
            "periodic_29_by_phase": c.base.periodic_mse(Sigma, c.liars),
        }
    return out


#: fields that follow from the attack design of `hard_attack`
_DESIGNED = {
    "brute_force",
    "coupling_U",
    "mse",
    "selection",
    "selection_S_at_k0",
    "selection_form_G",
    "selection_random_objective",
    "sigma37",
    "sigma_steady",
}


def _attacks(c: Case, expected: dict[str, Any]) -> dict[str, Any]:
    """Attack design."""
    out: dict[str, Any] = {}
    if "byzantine_top_degree" in expected:
        out["byzantine_top_degree"] = c.base.top_degree(len(expected["byzantine_top_degree"]))
    if "objective_37_optimum" in expected:
        worst = c.base.worst(c.byzantine, c.inputs["eta_37"], c.inputs["k_of_selection_for_37"])
        out["objective_37_optimum"] = worst["gain"]
    if not _DESIGNED & expected.keys():
        return out
    k0 = c.inputs["k0"]
    order = sorted(c.byzantine)
    selected = np.asarray(c.base.selection.at(k0))
    one_step = c.base.worst(order, c.inputs["eta"], k0)
    steady = c.base.worst(order, c.inputs["eta"])
    entries = [b * c.states + a for b in c.byzantine for a in range(c.states)]
    U = np.asarray(c.base.coupling_form(c.byzantine))
    assert c.Sigma is not None
    G = U * c.Sigma[np.ix_(entries, entries)]
    problem = theory.SelectionProblem(G, len(c.byzantine), c.inputs["l"])
    start = selected[c.byzantine].ravel()
    back = np.concatenate([np.arange(c.states) + order.index(b) * c.states for b in c.byzantine])
    best = problem.exact()
    attacks = {
        "none": None,
        "random": c.Sigma,
        "sigma37": np.asarray(c.base.spread(order, one_step["covariance"])),
        "sigma_steady": np.asarray(c.base.spread(order, steady["covariance"])),
    }
    return out | {
        "selection_S_at_k0": selected.astype(int).tolist(),
        "coupling_U": U,
        "selection_form_G": G,
        "selection_random_objective": problem.objective(start),
        "selection": _ascents(c, problem, start),
        "brute_force": {"s": c.blocks(best["s"]).astype(int).tolist(), "objective": best["objective"]},
        "sigma37": {
            "objective": one_step["gain"],
            "top_eigenvector_byzantine": c.blocks(np.asarray(one_step["direction"])[back]),
        },
        "sigma_steady": {
            "N_byzantine_block": np.asarray(steady["form"])[np.ix_(back, back)],
            "gain_of_averaged_NMSE": steady["gain"],
            "top_eigenvector_byzantine": c.blocks(np.asarray(steady["direction"])[back]),
        },
        "mse": _mse_table(c, attacks, expected.get("mse", {})),
    }


def _selection_item(item: Inputs) -> dict[str, Any]:
    s = theory.Selection(numbers(item["s0"]), int(item["tau"]))
    return {
        "period": s.period,
        "cycle": [np.asarray(s.at(k)).astype(int).tolist() for k in range(s.period)],
        "frequency": s.frequency,
        "moments_cycle": s.moments_cycle(),
        "moments_uniform": s.moments_uniform(),
    }


def evaluate(inputs: Any, expected: Any) -> Any:
    """Recompute every expected field from the inputs; keys that are not known stay away."""
    if isinstance(inputs, list):
        return [evaluate(i, e) for i, e in zip(inputs, expected, strict=True)]
    out: dict[str, Any] = {}
    if "list" in inputs:
        out["list"] = [_selection_item(item) for item in inputs["list"]]
    if "A" not in inputs:
        return out
    case = Case(inputs)
    out |= _filters(case, expected) | _network(case, expected) | _stability(case, expected) | _attacks(case, expected)
    return out


def use(inputs: Inputs, template: dict[str, Any], scope: str | None) -> None:
    """Use the inputs as the template does, and let any refusal through."""
    expected = template.get("expected", {"xhat": None})
    if "A" in inputs:
        case = Case(inputs)
        if case.Sigma is not None:
            case.base.periodic_mse(case.Sigma, case.liars)
    evaluate(inputs, expected)


def survive(inputs: Inputs, template: dict[str, Any], paths: list[str]) -> dict[str, Any]:
    """Outputs of a case that has to be survived, for the paths that its rules look at."""
    pattern = template.get("expected", {})
    wanted = {path.split("/")[0]: pattern.get(path.split("/")[0]) for path in paths}
    return dict(evaluate(inputs, wanted))


__all__ = ["NAME", "NOT_UNDERSTOOD", "TOLERANCES", "evaluate", "recognises", "survive", "use"]
