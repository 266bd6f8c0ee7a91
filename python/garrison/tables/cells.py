"""What a cell says: a number, nothing, or something else."""

import re

_MISSING = {"", "na", "n/a", "#n/a", "nan", "null", "none", "nil", "-", "--", "?", "missing", ".", "<na>"}
_NUMBER = re.compile(r"[+-]?(\d+(\.\d*)?|\.\d+)([eE][+-]?\d+)?")
_COMMA_NUMBER = re.compile(r"[+-]?\d*,\d+([eE][+-]?\d+)?")
_INFINITE = {"inf": float("inf"), "+inf": float("inf"), "-inf": float("-inf"), "infinity": float("inf")}


def is_missing(cell: str) -> bool:
    """One of the usual texts for no value."""
    return cell.strip().lower() in _MISSING


def number(cell: str, decimal_comma: bool = False) -> float | None:
    """The number that the cell says, nan for a missing one, None for anything else."""
    text = cell.strip().replace("\N{MINUS SIGN}", "-")
    if decimal_comma:
        text = text.replace(",", ".")
    if _NUMBER.fullmatch(text):
        found = float(text)
        return found if abs(found) < float("inf") else None  # 1e400: no double holds it
    if is_missing(text):
        return float("nan")
    return _INFINITE.get(text.lower())


def has_decimal_comma(cells: list[str]) -> bool:
    """Some cells are numbers with a decimal comma, and none has a point."""
    found = any(_COMMA_NUMBER.fullmatch(c.strip()) for c in cells)
    return found and not any("." in c and number(c) is not None and not is_missing(c) for c in cells)
