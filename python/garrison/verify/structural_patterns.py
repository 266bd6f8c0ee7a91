"""Structural cases about patterns alone: structure, mitigation, cheapest sensors and networks."""

import math
from typing import Any

import numpy as np

from garrison import structure
from garrison.verify.compare import Inputs, numbers


def _pattern(i: Inputs) -> structure.Pattern:
    if "edges" in i:
        return structure.Pattern(i["n"], i["n"], [tuple(e) for e in i["edges"]])
    return structure.Pattern.of(numbers(i["A"]))


def _structure(pattern: structure.Pattern, measured: list[Any]) -> dict[str, Any]:
    system = structure.System(pattern)
    seen = system.observability(measured)
    states = [s for s in measured if s is not None]
    both = {s: system.in_contraction(s) and system.in_parent(s) for s in states}
    return {
        "structural_rank": system.structural_rank,
        "dm": system.parts,
        "contraction_union": system.contraction_union,
        "contraction_components": system.contraction_components,
        "sccs": system.components,
        "parent_sccs": system.parent_components,
        "types": system.classes(measured),
        "in_both_sets": [s is not None and both[s] for s in measured],
        "necessary": system.necessary(measured),
        "contraction_of_measured_state": {str(k): v for k, v in system.contraction_of_measured(measured).items()},
        "exact_substitutes": system.substitutes(measured),
    } | seen


def _network_conditions(i: Inputs, types: list[str]) -> dict[str, bool]:
    W, U = numbers(i["W_pattern"]), numbers(i["U"])
    count, _ = structure.strong_components(structure.Pattern.of(W))
    hubs = [k for k, t in enumerate(types) if t == "alpha"]
    return {
        "strong": count == 1,
        "self_links": bool((np.diag(W) != 0).all()),
        "hubs": bool((U[:, hubs] != 0).all()),
        "own": bool((np.diag(U) != 0).all()),
    }


def structure_case(i: Inputs) -> dict[str, Any]:
    """Parts, classes and ranks of a pattern, and whether its network sees everything."""
    pattern = _pattern(i)
    out = _structure(pattern, i["measured"])
    out["name"] = i.get("name")
    if "W_pattern" in i and "U" in i:
        W, U = numbers(i["W_pattern"]), numbers(i["U"])
        out["network_conditions"] = _network_conditions(i, out["types"])
        own = np.eye(len(U))
        for key, links in (("distributed_observable", U), ("distributed_observable_without_hubs", own)):
            out[key] = structure.distributed_observability(pattern, i["measured"], W, links)["observable"]
    if "mitigated_measured" in i:
        out["after_mitigation"] = _structure(pattern, i["mitigated_measured"])
    return out


def mitigation(i: Inputs, expected: dict[str, Any]) -> dict[str, Any]:
    """Substitutes of every sensor, and the switches after the alarms of the case."""
    system = structure.System(_pattern(i))
    measured, types = i["measured"], i.get("types") or system.classes(i["measured"])
    substitutes = [
        {"type": t, "class_candidates": system.class_candidates(measured, k, t), "exact": exact}
        for k, (t, exact) in enumerate(zip(system.classes(measured), system.substitutes(measured), strict=True))
    ]
    runs = []
    for run in expected.get("substitution_runs", []):
        new, log = system.mitigate(measured, run["alarms"], types=types, choice="class")
        runs.append({"alarms": run["alarms"], "new": new, "log": [list(line) for line in log]})
    return {"substitutes": substitutes, "substitution_runs": runs}


def _assignments(i: Inputs) -> dict[str, Any]:
    cost = numbers(i["cost"])
    pattern = _pattern(i)
    per_class = structure.cheapest_per_class(cost, i["classes"])
    exact = structure.cheapest_rank_sensors(pattern, cost)
    return {"pattern": pattern, "per_class": per_class, "exact": exact}


def costs(i: Inputs, expected: dict[str, Any]) -> dict[str, Any]:
    """Cheapest sensors and cheapest strongly connected networks."""
    out: dict[str, Any] = {}
    if "classes" in i:
        found = _assignments(i)
        if found["per_class"] is not None:
            out["assignment_cost"] = found["per_class"]["cost"]
            out["assignment_agent_state_class"] = [list(p) for p in found["per_class"]["picks"]]
        if found["exact"] is not None:
            out["rank_exact_cost"] = found["exact"]["cost"]
            # A set: in the order of the case where the members agree.
            picks = [list(p) for p in found["exact"]["picks"]]
            wanted = expected.get("rank_exact_picks", picks)
            out["rank_exact_picks"] = wanted if sorted(picks) == sorted(wanted) else picks
    if "overlap" in i:
        out["overlap"] = _overlap(i["overlap"])
    if "networks" in i:
        out["networks"] = []
        for net in i["networks"]:
            edges = [tuple(e) for e in net["edges"]]
            best = structure.cheapest_strong_subgraph(net["N"], edges, net["weights"])
            out["networks"].append({"optimal_cost": best["cost"]})
    return out


def _overlap(i: Inputs) -> dict[str, Any]:
    found = _assignments(i)
    system = structure.System(found["pattern"])
    picks = found["per_class"]["picks"]
    out = {"hungarian_cost": found["per_class"]["cost"]}
    out["hungarian_observable"] = system.observability([[state] for _, state, _ in picks])["observable"]
    full = system.observability([[state] for _, state in found["exact"]["picks"]])["rank_condition"]
    out["exact_cost"] = found["exact"]["cost"] if full else math.inf
    return out
