"""Cases of the run-time certificates: every kind is told by a field that only it has."""

from collections.abc import Callable
from typing import Any

from garrison import certificate as theory
from garrison.verify.certificates_memory import case_of
from garrison.verify.compare import Inputs, numbers

NAME = "certificate"
#: relative tolerances other than the common one, by the end of the field's name
TOLERANCES: dict[str, float] = {"lp_lo": 1e-6, "lp_hi": 1e-6}

#: recomputes a case; questions that are stored under `expected` are copied
Case = Callable[[Inputs, dict[str, Any]], dict[str, Any]]


def recognises(inputs: Inputs) -> bool:
    """These cases always name their paper."""
    return False


# Where the state is --------------------------------------------------------------------------------------------


def _place(w: theory.Witness) -> dict[str, Any]:
    return {"center": None if w.center is None else w.center.tolist(), "radius": w.radius}


def _ball(i: Inputs, expected: dict[str, Any]) -> dict[str, Any]:
    prior = theory.Region(numbers(i["prior"][0]), numbers(i["prior"][1]).item()) if "prior" in i else None
    w = theory.leverage_ball(
        numbers(i["y"]),
        numbers(i["C"]),
        numbers(i["R"]),
        i["s"],
        i.get("z1", 0.0),
        i.get("z2", 0.0),
        widths=numbers(i["widths"]) if "widths" in i else None,
        prior=prior,
        proved=i.get("proved", []),
    )
    return _place(w) | {"kept": w.kept}


def _subsets(i: Inputs, expected: dict[str, Any]) -> dict[str, Any]:
    y = numbers(i["y"])
    w = theory.witness_subsets(y, numbers(i["C"]), numbers(i["R"]), i["s"], i["z1"], i["z2"], z3=i["z3"])
    return _place(w) | {"proved": [j in w.proved for j in range(len(y))]}


def _interval(i: Inputs, expected: dict[str, Any]) -> dict[str, Any]:
    lo, hi = theory.interval(numbers(i["y"]), numbers(i["width"]), i["s"])
    return {"lo": lo, "hi": hi}


def _order(i: Inputs, expected: dict[str, Any]) -> dict[str, Any]:
    return {"bound": [theory.order_bound(numbers(i["r"]), numbers(i["width"]), s) for s in i["s"]]}


def _scan(i: Inputs, expected: dict[str, Any]) -> dict[str, Any]:
    lo, hi = theory.scan(numbers(i["r"]), numbers(i["R"]), i["s"], i["z1"], i["z2"])
    return {"lo": lo, "hi": hi}


def _quantiles(i: Inputs, expected: dict[str, Any]) -> dict[str, Any]:
    return {
        "two_sided": [theory.two_sided(d) for d in i["delta"]],
        "two_sided_12": [theory.two_sided(d / 12) for d in i["delta"]],
        "chi_2": [theory.chi(d, 2) for d in i["delta"]],
        "sub_gaussian_2": [[theory.sub_gaussian_two_sided(d), theory.sub_gaussian_chi(d, 2)] for d in i["delta"]],
    }


# What the network's errors can be ------------------------------------------------------------------------------


def _system(i: Inputs) -> theory.ErrorSystem:
    return theory.error_system(numbers(i["A"]), numbers(i["C"]), numbers(i["J"]), i.get("silent", []))


def _kernels(i: Inputs) -> theory.Kernels:
    return theory.kernels(_system(i), i["window"])


def _kernel_case(i: Inputs, expected: dict[str, Any]) -> dict[str, Any]:
    system, k = _system(i), _kernels(i)
    out: dict[str, Any] = {"M": system.M, "B": system.B, "Bw": system.B_w}
    out |= {f"{name}_0_1": getattr(k, name)[:2] for name in ("gb", "ge", "wb", "we")}
    return out | {"Rb_1": k.Rb[1], "Re_1": k.Re[1], "Rb_12": k.Rb[12]}


def _gaussian(i: Inputs) -> theory.GaussianTable:
    return theory.gaussian_table(
        _kernels(i),
        s=i["s"],
        start=i["start"],
        T=i["T"],
        Q=numbers(i["Q"]),
        R=numbers(i["R"]),
        z=i["z"],
        beta=i.get("beta"),
        fixed=i.get("fixed", False),
    )


def _bounded(i: Inputs, kernels: theory.Kernels) -> theory.Table:
    return theory.table(
        kernels,
        s=i["s"],
        start=i["start"],
        T=i["T"],
        bw=i["bw"],
        bv=numbers(i["bv"]),
        beta=i.get("beta"),
        fixed=i.get("fixed", False),
    )


def _table(i: Inputs, expected: dict[str, Any]) -> dict[str, Any]:
    out: dict[str, Any] = {}
    if "Q" in i:
        gaussian = _gaussian(i)
        t = gaussian.table
        out["bound_T"] = gaussian.bound(i["T"], i["delta"])
    else:
        t = _bounded(i, _kernels(i))
    times = expected["times"]
    return out | {"times": times, "d": t.d[times], "eta": t.eta[times], "level": t.level[times[1:]], "steady": t.steady}


def _informed(i: Inputs, expected: dict[str, Any]) -> dict[str, Any]:
    system, start = _system(i), numbers(i["start"])
    Q, R, P0 = (numbers(i[k]) for k in ("Q", "R", "P0"))
    gauss = theory.informed_gaussian(system, start, len(expected["gauss"]), Q, R, P0, i["delta"])
    return {
        "bounded": theory.informed(system, start, len(expected["bounded"]), i["bw"], numbers(i["bv"])),
        "gauss": gauss,
    }


def _recovery(i: Inputs, expected: dict[str, Any]) -> dict[str, Any]:
    k = _kernels(i)
    recovery, loss = theory.Recovery(k, i["s"]), i["loss"]

    def excess(one: dict[str, Any]) -> list[float]:
        question = (one["agent"], tuple(one["state"]), one["t"])
        return [recovery.error_excess(*question), recovery.level_excess(*question)]

    nominal = float(_bounded(i, k).d[loss["t"], loss["agent"]])
    return {
        "rb": recovery.rb,
        "re": recovery.re,
        "excess": [one | {"value": excess(one)} for one in expected["excess"]],
        "merge": [
            one | {"value": list(recovery.merge(tuple(one["p"]), tuple(one["q"]), one["t"]))}
            for one in expected["merge"]
        ],
        "lost": list(recovery.lost(loss["t"], loss["b"], nominal)),
    }


def _two_numbers(i: Inputs, expected: dict[str, Any]) -> dict[str, Any]:
    m = theory.TwoNumbers(numbers(i["A"]), numbers(i["C"]), i["s"], i["rho0"], i["p0"], i["bw"], numbers(i["bv"]))
    return {"constants": m.constants, "bound": [m.step(g) for g in i["gamma"]], "rho": m.rho, "p": m.p}


# What messages carry -------------------------------------------------------------------------------------------


def _relay(i: Inputs, expected: dict[str, Any]) -> dict[str, Any]:
    bounds, own = numbers(i["bs"]), i["own"]
    return {
        "bound": theory.averaged(numbers(i["weights"]), numbers(i["xs"]), bounds).radius,
        "time": theory.after_injection(own["a"], own["b"], own["bw"], own["kappa"]),
        "order_f1": theory.order_rule(bounds, 1),
        "order_f3": theory.order_rule(bounds, 3),
    }


def _propagate(i: Inputs, expected: dict[str, Any]) -> dict[str, Any]:
    A, then, k = numbers(i["A"]), theory.Region(numbers(i["c"]), i["b"]), i["k"]

    def aged(by: theory.Propagation) -> dict[str, Any]:
        now = by.age(then, k)
        return {"c": now.center, "b": now.radius}

    return {
        "bounded": aged(theory.Propagation.bounded(A, k, i["bw"])),
        "gauss": aged(theory.Propagation.gaussian(A, k, numbers(i["Q"]), i["delta"])),
    }


def _kind(i: Inputs, expected: dict[str, Any]) -> Case:
    told_by: list[tuple[bool, Case]] = [
        ("gb_0_1" in expected, _kernel_case),
        ("steady" in expected and "window" in i, _table),
        ("silent" in i, _informed),
        ("weights" in i, _relay),
        ({"r", "z1"} <= i.keys(), _scan),
        ("kept" in expected, _ball),
        ({"y", "width"} <= i.keys(), _interval),
        ({"r", "width"} <= i.keys(), _order),
        ("rb" in expected, _recovery),
        ("gamma" in i, _two_numbers),
        ("two_sided" in expected, _quantiles),
        ({"z3", "y"} <= i.keys(), _subsets),
        ({"k", "c", "delta"} <= i.keys(), _propagate),
    ]
    for told, case in told_by:
        if told:
            return case
    raise ValueError("this kind of certificate is not understood")


def evaluate(inputs: Inputs, expected: Any) -> Any:
    """Recompute every expected field from the inputs."""
    return (case_of(inputs, expected) or _kind(inputs, expected))(inputs, expected)


def use(inputs: Inputs, template: dict[str, Any], scope: str | None) -> None:
    """Use the inputs as the template does, and let any refusal through."""
    evaluate(inputs, template["expected"])


def survive(inputs: Inputs, template: dict[str, Any], paths: list[str]) -> Any:
    """Outputs of a case that has to be survived."""
    return evaluate(inputs, template["expected"])


__all__ = ["NAME", "TOLERANCES", "evaluate", "recognises", "survive", "use"]
