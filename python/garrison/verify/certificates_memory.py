"""Cases of the certificates with memory: every kind is told by a field that only it has."""

from collections.abc import Callable
from typing import Any

import numpy as np

from garrison import certificate as theory
from garrison.verify.compare import Array, Inputs, numbers

#: recomputes a case
Case = Callable[[Inputs, Any], Any]


def _row_numbers(row: list[Any]) -> tuple[int, int, Array, float, float, float]:
    step, source, c, y, variance, bias = row
    return step, source, numbers(c), numbers(y).item(), variance, bias


def _window(i: Inputs, process_bound: float = float("nan"), deviations: float | None = None) -> theory.Window:
    """The rows of a case; `deviations`: noise bounded by so many standard deviations instead of what the rows say."""
    A, Gam, rows = numbers(i["A"]), numbers(i["Gam"]), [_row_numbers(row) for row in i["rows"]]
    n, steps = len(A), i["K"]
    w = theory.Window(n, Gam.shape[1], steps, 1 + max(row[1] for row in rows), len(rows))
    w.begin(steps, process_bound)
    prior = i.get("prior")
    if prior is not None:
        c0, P0, r0, kind = prior[:4]
        if kind == "gauss":
            w.prior_gaussian(numbers(c0), numbers(P0))
        else:
            w.prior_set(numbers(c0), numbers(P0), r0, *prior[4:])
    for k in range(steps):
        for step, source, c, y, variance, bias in rows:
            if step == k and deviations is None:
                w.add(source, c, y, variance, bias)
            elif step == k and deviations is not None:
                w.add(source, c, y, variance, deviations * variance**0.5, bounded=True)
        if k < steps - 1:
            w.advance(A, Gam, numbers(i["u"][k]))
    return w


def _levels(i: Inputs) -> tuple[float, float, float]:
    return i["z1"], i["z2"], i["zc"]


def _plain(value: Array | None) -> list[Any] | None:
    return None if value is None else value.tolist()


def _set(w: theory.WindowWitness, states: int) -> dict[str, Any]:
    return {
        "c": _plain(w.center),
        "P": _plain(w.shape),
        "r": w.stretch,
        "box": w.box if w.box is not None else [w.radius] * states,
        "ball": w.radius,
        "proved": w.dropped,
        "mu": w.mu,
        "count": w.count,
    }


def _regression(i: Inputs, expected: Any) -> Any:
    w = _window(i)
    return {
        "N": w.N,
        "z": w.z,
        "src": w.source,
        "tau": w.step_of,
        "bias": w.bias,
        "gauss": w.gaussian,
        "setbias": w.prior_length,
        "E": w.E,
        "o": w.o,
    }


def _leverage(i: Inputs, expected: Any) -> Any:
    moving = i.get("moving", False)
    w = theory.leverage_window(
        _window(i), i["s"], *_levels(i), moving=moving, proved=i.get("proved", []), honest=i.get("honest", [])
    )
    found = _set(w, len(i["A"]))
    if moving:
        found["proved"] = {str(step): sources for step, sources in w.dropped_at.items()}
        if not expected["proved"] and found["proved"]:
            raise ValueError(f"proved {found['proved']}, expected nobody")
    return found


def _subsets(i: Inputs, expected: Any) -> Any:
    w, levels = _window(i), _levels(i)
    return {
        "set": _set(theory.subsets_window(w, i["s"], *levels), len(i["A"])),
        "with_z3": _set(theory.subsets_window(w, i["s"], *levels, z3=i["z3"]), len(i["A"])),
        "promise": theory.subsets_window_width(w, i["s"], i["z1"], i["zc"]),
    }


def _anytime(i: Inputs, expected: Any) -> Any:
    w = _window(i)
    return [_set(theory.anytime_window(w, i["s"], *_levels(i), leaves=leaves), len(i["A"])) for leaves in i["leaves"]]


def _bounded(i: Inputs, expected: Any) -> Any:
    w = _window(i, i["wbound"], deviations=2.0)
    lo, hi = theory.hull_window(w, i["s"])
    return {
        "W2M": _set(theory.leverage_window(w, i["s"], 0.0, 0.0, 0.0), len(i["A"])),
        "W3M": _set(theory.subsets_window(w, i["s"], 0.0, 0.0, 0.0), len(i["A"])),
        "lp_lo": lo,
        "lp_hi": hi,
    }


def _sources(i: Inputs) -> list[tuple[Array, Array]]:
    return [(numbers(C), np.diag(numbers(R))) for C, R in i["sensors"]]


def _bank(i: Inputs, expected: Any) -> Any:
    bank = theory.Bank(numbers(i["A"]), numbers(i["Q"]), _sources(i), i["s"])
    if i["kind"] == "gauss":
        bank.start_gaussian(numbers(i["start"]), numbers(i["P0"]))
    else:
        bank.start_set(numbers(i["start"]), numbers(i["P0"]), i["r0"])
    u = numbers(i["u"])
    return [_set(bank.update(np.concatenate([numbers(y) for y in ys]), *_levels(i), u=u), len(i["A"])) for ys in i["y"]]


def _steady(i: Inputs, expected: Any) -> Any:
    A, Q, sources = numbers(i["A"]), numbers(i["Q"]), _sources(i)
    return [theory.bank_steady(A, Q, sources, s, *_levels(i)).tolist() for s in i["s"]]


def _cells(i: Inputs, expected: Any) -> Any:
    boxes = [(numbers(c), i["quantile"] * np.sqrt(np.diag(numbers(P)))) for c, P in i["sets"]]
    regions = [theory.Region(c, float(np.linalg.norm(box)), box) for c, box in boxes]
    return [[end.tolist() for end in theory.cells(regions, s)] for s in i["s"]]


def _observer(i: Inputs, expected: Any) -> Any:
    C = numbers(i["C"])
    times = [1, 2, 25, 26, 60]  # said in `what` alone

    def table(s: int) -> dict[str, Any]:
        t = theory.observer_table(
            numbers(i["A"]),
            C,
            numbers(i["L"]),
            numbers(i["Gam"]),
            np.full(len(C), i["bv"]),
            s=s,
            bw=i["bw"],
            start=i["start"],
            T=times[-1],
            lags=i["K"],
        )
        return {"d": t.d[times], "level": t.level[times]}

    return [table(s) for s in i["s"]]


def _coast(i: Inputs, expected: Any) -> Any:
    A, Gam, P = numbers(i["A"]), numbers(i["Gam"]), numbers(i["P"])
    then = theory.ellipsoid(np.zeros(len(A)), P, i["r"])
    bounded = theory.Propagation.bounded_entries(A, i["k"], Gam, i["bw"])
    gaussian = theory.Propagation.gaussian_entries(A, i["k"], Gam, i["zc"], i["zc"])
    return [_plain(by.age(then, i["k"]).box) for by in (bounded, gaussian)]


def _meter_rows(i: Inputs, flows_only: bool) -> Array:
    """Unit rows: flows of the lines and, unless told otherwise, injections of the buses; bus 0 is the reference."""
    edges = numbers(i["edges"])
    ends, weight = edges[:, :2].astype(int), edges[:, 2]
    flows = np.zeros((len(edges), ends.max() + 1))
    lines = np.arange(len(edges))
    flows[lines, ends[:, 0]] = weight
    flows[lines, ends[:, 1]] = -weight
    injections = np.zeros((flows.shape[1], flows.shape[1]))
    np.add.at(injections, ends[:, 0], flows)
    np.subtract.at(injections, ends[:, 1], flows)
    rows = flows if flows_only else np.vstack([flows, injections])
    rows = rows[:, 1:]
    unit: Array = rows / np.linalg.norm(rows, axis=1)[:, None]
    return unit


def _meters(i: Inputs, expected: Any) -> Any:
    flows_only = "leverage" not in expected
    rows = _meter_rows(i, flows_only)
    found = theory.meters(rows)
    return {
        "leverage": found.leverage,
        "critical": found.critical,
        "bound": found.bound[:5],
        "removable": found.removable,
        "smallest_undetectable": theory.smallest_undetectable(rows, 3 if flows_only else 5).size,
    }


def _range(i: Inputs, expected: Any) -> Any:
    row = theory.range_row(numbers(i["p"]), numbers(i["c0"]), i["rho"])
    return None if row is None else [row[0].tolist(), row[1], row[2]]


def _byzantine(i: Inputs, expected: Any) -> Any:
    def believed(liars: int) -> list[Any]:
        return [[int(j) for j, paths in i["arrivals"].items() if theory.accepted(paths, liars)], i["s"] + liars]

    return [believed(liars) for liars in range(len(expected))]


#: what a case has, told apart from all others of the certificates -> how it is recomputed
KINDS: list[tuple[Callable[[Inputs, Any], bool], Case]] = [
    (lambda i, e: "setbias" in e, _regression),
    (lambda i, e: {"rows", "s"} <= i.keys() and "mu" in e, _leverage),
    (lambda i, e: "promise" in e, _subsets),
    (lambda i, e: "leaves" in i, _anytime),
    (lambda i, e: "wbound" in i, _bounded),
    (lambda i, e: {"sensors", "kind"} <= i.keys(), _bank),
    (lambda i, e: "sensors" in i, _steady),
    (lambda i, e: "sets" in i, _cells),
    (lambda i, e: {"L", "bv"} <= i.keys(), _observer),
    (lambda i, e: {"Gam", "k", "r"} <= i.keys(), _coast),
    (lambda i, e: "smallest_undetectable" in e, _meters),
    (lambda i, e: "rho" in i, _range),
    (lambda i, e: "arrivals" in i, _byzantine),
]


def case_of(inputs: Inputs, expected: Any) -> Case | None:
    """How a case with memory is recomputed; None when it is another certificate."""
    return next((case for told, case in KINDS if told(inputs, expected)), None)


__all__ = ["case_of"]
