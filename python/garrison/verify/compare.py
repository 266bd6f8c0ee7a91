"""Comparison of computed and expected fields, by the rules of the cases' README."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from garrison.words import shown

#: the object `inputs` of a case
Inputs = dict[str, Any]
Array = NDArray[np.float64]

RELATIVE = 1e-9
ABSOLUTE = 1e-12

#: what an evaluator returns for an expected key that it does not know
NOT_UNDERSTOOD = object()
#: what an evaluator returns for a key that nobody can recompute from the inputs of this case
NOT_COMPARED = object()


@dataclass
class Within:
    """A computed number or array with a tolerance of its own, absolute, per entry."""

    value: Any
    allowed: Any


@dataclass
class FieldResult:
    """One field: deviation relative to its largest entry, and whether it is within tolerance."""

    name: str
    deviation: float
    ok: bool
    note: str = ""

    @staticmethod
    def failure(name: str, note: str) -> "FieldResult":
        """A miss that has no number."""
        return FieldResult(name, float("inf"), False, note)


def number(value: Any) -> Any:
    """Numbers as written in case files: infinities and not-a-number are texts."""
    return float(value) if isinstance(value, str) and value in ("inf", "-inf", "nan") else value


def array(value: Any) -> Any:
    """Nested lists of such numbers as an array; anything else unchanged."""
    if isinstance(value, list):
        try:
            return np.array(_decoded(value), dtype=float)
        except (ValueError, TypeError, OverflowError):
            return value
    return number(value)


def numbers(value: Any) -> Array:
    """Nested lists as an array; null and the texts nan, inf, -inf are not finite."""
    return np.asarray(array(value), dtype=float)


def _decoded(value: Any) -> Any:
    return [_decoded(v) for v in value] if isinstance(value, list) else number(value)


def _whole(value: Any) -> bool:
    """Nested lists of whole numbers only: index lists, which must agree exactly."""
    if isinstance(value, list):
        return all(_whole(v) for v in value)
    return isinstance(value, int) and not isinstance(value, bool)


def _lists(value: Any) -> Any:
    """Arrays, also inside lists and tuples, as nested lists with their numbers decoded."""
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, (list, tuple)):
        return [_lists(v) for v in value]
    return value.item() if isinstance(value, np.generic) else number(value)


def _shape(value: Any) -> Any:
    """Lengths of nested lists: 0 dimensions, or the shapes of all entries."""
    return [_shape(v) for v in value] if isinstance(value, list) else None


def _leaves(value: Any) -> list[Any]:
    return [leaf for v in value for leaf in _leaves(v)] if isinstance(value, list) else [value]


def _blocks(name: str, got: Any, expected: Any, relative: float) -> FieldResult:
    """Blocks of different sizes (gains per agent, lists of sets): the same sizes, and entries as in one array."""
    ours, theirs = _lists(got), _lists(expected)
    if _shape(ours) != _shape(theirs):
        return FieldResult.failure(name, f"got blocks of other sizes than expected ({_sizes(ours)}, {_sizes(theirs)})")
    if _whole(theirs) and _whole(ours):
        return _same(name, ours, theirs)
    a, b = _leaves(ours), _leaves(theirs)
    if any(isinstance(v, (str, dict, bool)) or v is None for v in [*a, *b]):
        return _same(name, ours, theirs)
    return _numeric(name, a, b, relative)


def _sizes(value: Any) -> str:
    if not isinstance(value, list):
        return "no blocks"
    return " + ".join(str(len(_leaves(v))) for v in value[:8]) + (" + ..." if len(value) > 8 else "") + " numbers"


def _same(name: str, got: Any, expected: Any) -> FieldResult:
    same = bool(got == expected)
    return FieldResult(
        name, 0.0 if same else 1.0, same, "" if same else f"got {shown(got)}, expected {shown(expected)}"
    )


def _numeric(name: str, got: Any, expected: Any, relative: float) -> FieldResult:
    e = np.asarray(expected, dtype=float)
    allowed: Any = None
    if isinstance(got, Within):
        got, allowed = got.value, got.allowed
    try:
        g = np.asarray(array(_lists(got)), dtype=float)
    except (ValueError, TypeError):
        return FieldResult.failure(name, f"got a {type(got).__name__}, expected an array of shape {e.shape}")
    if g.shape != e.shape:
        return FieldResult.failure(name, f"got shape {g.shape}, expected {e.shape}")
    if allowed is not None:
        allowed = np.broadcast_to(np.asarray(allowed, dtype=float), e.shape)
    finite = np.isfinite(e)
    special_agree = np.array_equal(g[~finite], e[~finite], equal_nan=True) and bool(np.isfinite(g[finite]).all())
    if not special_agree:
        return FieldResult.failure(name, "entries that are not finite differ")
    scale = float(np.abs(e[finite]).max(initial=0.0))
    worst = float(np.abs(g[finite] - e[finite]).max(initial=0.0))
    deviation = worst / scale if scale > 0 else worst
    if allowed is not None:
        return FieldResult(name, deviation, bool((np.abs(g[finite] - e[finite]) <= allowed[finite]).all()))
    return FieldResult(name, deviation, worst <= relative * scale + ABSOLUTE)


def _leaf(name: str, got: Any, expected: Any, relative: float) -> FieldResult:
    if got is NOT_UNDERSTOOD:
        return FieldResult.failure(name, "not understood")
    if (
        isinstance(expected, bool)
        or expected is None
        or (isinstance(expected, str) and isinstance(array(expected), str))
    ):
        comparable = isinstance(got, (bool, str, int, float)) or got is None
        same = comparable and got == expected and isinstance(got, bool) == isinstance(expected, bool)
        return FieldResult(
            name, 0.0 if same else 1.0, same, "" if same else f"got {shown(got)}, expected {shown(expected)}"
        )
    if got is None or isinstance(got, (bool, dict, str)):
        return FieldResult.failure(name, f"got {shown(got)}, expected a number")
    found = array(expected)
    if isinstance(found, (list, dict)):  # ragged
        return _blocks(name, got.value if isinstance(got, Within) else got, expected, relative)
    if _whole(expected) and _whole(got):
        return _same(name, got, expected)
    return _numeric(name, got, found, relative)


def compare(
    got: Any, expected: Any, tolerances: dict[str, float], name: str = "", informative: frozenset[str] = frozenset()
) -> list[FieldResult]:
    """Field by field; `tolerances` maps the end of a field's name to its own relative tolerance.

    Fields whose key, or key within its parent ("parent/key"), is in `informative` say something about the reference
    and are not compared.
    """
    if isinstance(expected, dict):
        results = []
        for key, value in expected.items():
            path = f"{name}/{key}" if name else key
            if key in informative or "/".join(path.split("/")[-2:]) in informative:
                continue
            inner = got.get(key, NOT_UNDERSTOOD) if isinstance(got, dict) else NOT_UNDERSTOOD
            if inner is not NOT_COMPARED:
                results += compare(inner, value, tolerances, path, informative)
        return results
    if isinstance(expected, list) and expected and all(isinstance(v, dict) for v in expected):
        if not isinstance(got, list) or len(got) != len(expected):
            count = len(got) if isinstance(got, list) else "no"
            return [FieldResult.failure(name, f"got {count} entries, expected {len(expected)}")]
        results = []
        for k, (g, e) in enumerate(zip(got, expected, strict=True)):
            results += compare(g, e, tolerances, f"{name}[{k}]", informative)
        return results
    own = [tolerance for end, tolerance in tolerances.items() if name.endswith(end)]
    return [_leaf(name, got, expected, own[0] if own else RELATIVE)]
