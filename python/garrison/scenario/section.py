"""A table of a scenario, read key by key: every value is of the kind that is asked for, or refused with its place."""

import datetime as dt
import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from garrison import _core
from garrison.numeric import numbers, real, whole_of
from garrison.tables import read_matrix
from garrison.tables.cells import number as cell_number
from garrison.tables.moments import read_end, spelt_out
from garrison.words import near, only, refusal, shown

Array = NDArray[np.float64]
#: whole numbers of C++ end here
_MOST = 2**31 - 1


class Section:
    """One table. where: its name in messages; folder: paths in it are relative to it."""

    def __init__(self, where: str, table: Any, folder: Path) -> None:
        if not isinstance(table, dict):
            raise refusal(where, shown(table), f"a table: a line {where} with its keys below")
        self.where, self.table, self.folder = where, table, folder

    def __contains__(self, key: str) -> bool:
        return key in self.table

    def only(self, known: Sequence[str]) -> None:
        """Refuse other keys, with the nearest known one."""
        only(self.where, self.table, known)

    def place(self, key: str) -> str:
        """`[run].steps`, for messages."""
        return f"{self.where}.{key}"

    def require(self, key: str, expected: str) -> Any:
        """The value of `key`; refused where it is missing."""
        if key not in self.table:
            raise refusal(self.where, f"no {key}", expected)
        return self.table[key]

    def whole(self, key: str, default: int, least: int = 0, most: int = _MOST) -> int:
        """A whole number; 3.0 is one."""
        return whole(self.place(key), self.table[key], least, most) if key in self.table else default

    def number(self, key: str, default: float, *, positive: bool = False) -> float:
        """A number, finite or not."""
        return number(self.place(key), self.table[key], positive=positive) if key in self.table else default

    def flag(self, key: str, default: bool) -> bool:
        """True or false."""
        value = self.table.get(key, default)
        if not isinstance(value, bool):
            raise refusal(self.place(key), shown(value), "true or false")
        return value

    def text(self, key: str, default: str) -> str:
        """A string."""
        value = self.table.get(key, default)
        if not isinstance(value, str):
            raise refusal(self.place(key), shown(value), "a string, in quotes")
        return value

    def choice(self, key: str, default: str, known: Sequence[str]) -> str:
        """One of some strings."""
        value = self.text(key, default)
        if value not in known:
            raise refusal(self.place(key), repr(value), f"one of {', '.join(known)}", near(value, known))
        return value

    def file(self, key: str) -> Path:
        """A path, relative to the scenario."""
        value = self.require(key, "the path of a file")
        if not isinstance(value, str) or not value or "\0" in value:
            raise refusal(self.place(key), shown(value), "the path of a file, as a string")
        return self.folder / value

    def array(self, key: str) -> Any:
        """Numbers inline, or `{ file = "A.csv" }`."""
        value = self.table[key]
        if isinstance(value, dict):
            inner = Section(self.place(key), value, self.folder)
            inner.only(["file"])
            return read_matrix(inner.file("file"))
        if isinstance(value, str):
            raise refusal(self.place(key), shown(value), 'numbers, or { file = ".." } with the path of a file of them')
        return value

    def numbers(self, key: str) -> Array:
        """The same as an array of doubles."""
        return numbers(self.place(key), self.array(key))


def whole(where: str, value: Any, least: int = 0, most: int = _MOST) -> int:
    """`value` as a whole number in a range."""
    found = whole_of(value)
    if found is None or not least <= found <= most:
        above = found is not None and found > most
        words = f"a whole number in {least}..{most}" if above or most < _MOST else f"a whole number >= {least}"
        raise refusal(where, shown(value), words)
    return found


def number(where: str, value: Any, *, positive: bool = False) -> float:
    """`value` as a number."""
    found = real(value)
    if found is None:
        raise refusal(where, shown(value), "a number, without its unit" if isinstance(value, str) else "a number")
    if positive and not found > 0:
        raise refusal(where, shown(value), "a number > 0")
    return found


def tables_of(where: str, value: Any, folder: Path) -> list[Section]:
    """The tables of `[[where]]`; a single `[where]` is a list of one."""
    entries = [value] if isinstance(value, dict) else value
    if not isinstance(entries, list):
        raise refusal(f"[[{where}]]", shown(value), f"tables: a line [[{where}]] with keys below, once per entry")
    return [Section(f"{where}[{k}]", entry, folder) for k, entry in enumerate(entries)]  # as --set counts


def moment(where: str, value: Any, *, last: bool = False) -> dt.date | float:
    """A date, a date with a time (UTC where it has a zone), or a number: of seconds, or a year (`Records.between`).

    last: as the last record; a month is meant to its end.
    """
    if isinstance(value, dt.datetime):
        return _plain(value)
    if isinstance(value, dt.date):
        return value
    if (seconds := real(value)) is not None:
        return seconds
    text = value.strip() if isinstance(value, str) else ""
    if (found := cell_number(text)) is not None and math.isfinite(found) and spelt_out([text]) == [text]:
        return found
    try:
        end = read_end(text, last)
    except _core.Error:
        end = None
    if end is None:
        raise refusal(where, shown(value), "a date YYYY-MM-DD (with a time where the records have one)")
    return _plain(end) if ":" in text or end.time() != dt.time() else end.date()


def _plain(value: dt.datetime) -> dt.datetime:
    return value.astimezone(dt.UTC).replace(tzinfo=None) if value.tzinfo else value


def renamed(error: _core.Error, where: str) -> _core.Error:
    """The same refusal with its place in the scenario in front, if it does not name it itself."""
    words = str(error)
    return error if words.startswith(where) else type(error)(f"{where} {words}")
