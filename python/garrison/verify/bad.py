"""Cases of bad input: refused with a fitting message, or survived with what must hold."""

import re
from types import ModuleType
from typing import Any

import numpy as np

from garrison._core import Error
from garrison.verify.compare import FieldResult, array
from garrison.verify.shapes import problem, words


def _fits(message: str, names: list[str]) -> bool:
    """The message contains one of the names as a whole word (single letters exactly as written)."""
    for name in names:
        flags = 0 if len(name) == 1 else re.IGNORECASE
        if re.search(rf"(?<![A-Za-z0-9_]){re.escape(name)}(?![A-Za-z0-9_])", message, flags):
            return True
    return False


def _refused(module: ModuleType, case: dict[str, Any], template: dict[str, Any]) -> list[FieldResult]:
    try:
        module.use(case["inputs"], template, case.get("scope"))
    except Error as error:
        fits = _fits(str(error), case["names"])
        note = str(error) if fits else f"the message names none of {case['names']}: {error}"
        return [FieldResult("refused", 0.0 if fits else 1.0, fits, note)]
    except Exception as error:
        found = problem("inputs", case["inputs"])  # the reader of cases cannot even make arrays of them
        fits = found is not None and _fits(found, case["names"])
        return [FieldResult("refused", 0.0 if fits else 1.0, fits, words(case, error))]
    if "also_ok" in case:
        return [FieldResult("refused", 0.0, True, f"not refused; accepted: {case['also_ok']}")]
    return [FieldResult.failure("refused", "was not refused")]


def _at(output: Any, path: str) -> Any:
    for key in path.split("/"):
        output = output[key]
    return output


def _accused(changes: list[dict[str, Any]], end_only: bool) -> set[int]:
    entries = changes[-1:] if end_only else changes
    return {agent for entry in entries for sets in entry["sets"] for agent in sets}


def _holds(rule: dict[str, Any], output: Any) -> FieldResult:
    name = f"{rule['of']} {rule['is']}"
    got = _at(output, rule["of"])
    kind = rule["is"]
    if kind == "finite":
        ok = bool(np.isfinite(np.asarray(got, dtype=float)).all())
        return FieldResult(name, 0.0 if ok else np.inf, ok)
    if kind == "equal":
        wanted = np.asarray(array(rule["to"] if "to" in rule else rule["value"]), dtype=float)
        if np.shape(got) != wanted.shape:
            return FieldResult.failure(name, f"got shape {np.shape(got)}, expected {wanted.shape}")
        scale = float(np.abs(wanted).max(initial=0.0)) or 1.0
        deviation = float(np.abs(np.asarray(got) - wanted).max(initial=0.0)) / scale
        return FieldResult(name, deviation, deviation <= rule["tol"])
    if kind == "at_most":
        values = np.asarray(got, dtype=float)
        limit = np.asarray(array(rule["value"]), dtype=float)
        limit = limit.reshape(limit.shape + (1,) * (values.ndim - limit.ndim)) if limit.ndim else limit
        excess = float((values - limit).max())
        return FieldResult(name, max(excess, 0.0), excess <= rule.get("tol", 0.0))
    if kind == "accuses_only":
        extra = _accused(got, False) - set(rule["value"])
        return FieldResult(name, float(len(extra)), not extra, f"accused {sorted(extra)}" if extra else "")
    if kind == "accuses":
        missing = set(rule["value"]) - _accused(got, True)
        return FieldResult(name, float(len(missing)), not missing, f"not accused {sorted(missing)}" if missing else "")
    if kind == "within_bound":
        error, bound = output["within_bound"] if "bound" in rule else got
        known = np.isfinite(bound)
        excess = float((error[known] - bound[known]).max(initial=0.0))
        return FieldResult(name, max(excess, 0.0), excess <= 0.0)
    return FieldResult.failure(name, "not understood")


def judge(module: ModuleType, case: dict[str, Any], template: dict[str, Any]) -> list[FieldResult]:
    """Run a case with `must` and say whether what must hold does; what is only preferred is noted, not required."""
    if case["must"] == "refuse":
        return _refused(module, case, template)
    if case["must"] != "survive":
        return [FieldResult.failure("must", f"{case['must']!r} is not understood")]
    paths = [rule["of"] for rule in [*case["hold"], *case.get("prefer", [])]]
    output = module.survive(case["inputs"], template, paths)
    results = [_holds(rule, output) for rule in case["hold"]]
    for rule in case.get("prefer", []):
        wish = _holds(rule, output)
        note = "preferred, and so" if wish.ok else f"preferred, but not so: {wish.note}"
        results.append(FieldResult(f"{wish.name} (preferred)", wish.deviation if wish.ok else 0.0, True, note))
    return results
