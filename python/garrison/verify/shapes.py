"""What is wrong with the inputs of a case, in words, when they could not be used."""

from typing import Any

import numpy as np

from garrison.words import shown

_SPECIAL = ("inf", "-inf", "nan")
_MOST = 12  # inputs that a message lists


def words(case: dict[str, Any], error: Exception) -> str:
    """Why `error` came of the inputs (or expected values) of a case."""
    inputs, expected = case.get("inputs"), case.get("expected")
    if found := problem("inputs", inputs):
        return f"refused: {found}"
    if isinstance(error, KeyError) and error.args:
        key = error.args[0]
        where = "inputs" if isinstance(inputs, dict) and key not in inputs else "inputs or expected"
        return f"refused: {where}: got no {key!r}, expected one in a case of this family"
    if found := problem("expected", expected):
        return f"refused: {found}"
    listed = ", ".join(_shapes("inputs", inputs)[:_MOST] + _shapes("expected", expected)[:_MOST])
    return f"refused: got values whose kinds and shapes do not fit together ({listed})"


def problem(name: str, value: Any) -> str | None:
    """The first entry that is no array of numbers where one begins; None where all are."""
    if isinstance(value, dict):
        found = (problem(f"{name}.{key}", inner) for key, inner in value.items())
        return next((words for words in found if words), None)
    if not isinstance(value, list) or not value:
        return None
    kinds = {_kind(entry) for entry in value}
    if kinds == {"object"} or kinds == {"list"}:
        found = (problem(f"{name}[{k}]", entry) for k, entry in enumerate(value))
        return next((words for words in found if words), None) or _ragged(name, value)
    if len(kinds) > 1 and kinds & {"list", "object"}:
        odd = next(k for k, entry in enumerate(value) if _kind(entry) != _kind(value[0]))
        return f"{name}[{odd}]: got {shown(value[odd])}, expected {_article(_kind(value[0]))} as in the entries before"
    return None


def _ragged(name: str, value: list[Any]) -> str | None:
    """Rows of different lengths in an array that has rows of equal length everywhere else; agents may differ."""
    if any(not isinstance(row, list) or any(isinstance(cell, (list, dict)) for cell in row) for row in value):
        return None
    lengths = [len(row) for row in value]
    usual = max(set(lengths), key=lengths.count)
    if len(value) < 2 or lengths.count(usual) == len(lengths):
        return None
    odd = next(k for k, length in enumerate(lengths) if length != usual)
    return (
        f"{name}[{odd}]: got rows of different lengths, {lengths[odd]} here and {usual} in others, expected equal ones"
    )


def _kind(entry: Any) -> str:
    if isinstance(entry, dict):
        return "object"
    if isinstance(entry, list):
        return "list"
    if isinstance(entry, str) and entry not in _SPECIAL:
        return "string"
    return "number"


def _article(kind: str) -> str:
    return f"an {kind}" if kind == "object" else f"a {kind}"


def _shapes(name: str, value: Any) -> list[str]:
    """`inputs.A (2, 2)` and so on."""
    if isinstance(value, dict):
        return [words for key, inner in value.items() for words in _shapes(f"{name}.{key}", inner)]
    if isinstance(value, list):
        try:
            return [f"{name} {np.array(value, dtype=object).shape}"]
        except ValueError:
            return [f"{name} of {len(value)}"]
    return [f"{name} {shown(value, 20)}"]
