"""A table with named columns: header, units, an optional column of time, numbers."""

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from garrison import _core
from garrison.tables.cells import is_missing, number
from garrison.tables.clock import Clock, doubt, read_clock
from garrison.tables.joined import with_joined_date
from garrison.tables.moments import is_time_of_day, looks_like_time
from garrison.tables.text import Rows, decimal_comma, read_rows, require_widths
from garrison.words import count, refusal

Array = NDArray[np.float64]
_UNIT = re.compile(r"(.*?)\s*[\[(]([^\[\]()]*)[\])]\s*")
#: names of a first column that is time even where it holds plain numbers
TIME_NAMES = {
    "t",
    "time",
    "times",
    "date",
    "datetime",
    "timestamp",
    "day",
    "days",
    "hour",
    "hours",
    "minute",
    "minutes",
    "year",
    "jahr",
    "unix",
    "epoch",
    "sample",
    "second",
    "seconds",
    "zeit",
    "datum",
}
#: constants that many instruments write for "no value"
_SENTINELS = (-999.0, -9999.0, -99999.0, -999.9, -999.99, -99.9, -99.99, -99.0, 9999.0, 99999.0, 999.9)
_FAR = 100.0  # robust deviations from which on a value is suspicious
_EMPTY = 0.5  # part of the range on its side of the middle that is empty before it
_OFTEN = 3  # times as often as any other value, from which on such a constant is suspicious
_ALONE = 5.0  # robust deviations between it and the next value, from which on it is


@dataclass(frozen=True)
class Column:
    """Name and unit ("" where none is said)."""

    name: str
    unit: str


@dataclass(frozen=True)
class Table:
    """Columns of numbers (rows, columns), nan = missing; clock: times of the rows, where the first column has them."""

    path: Path
    columns: list[Column]
    values: Array
    clock: Clock | None
    notes: list[str]

    @property
    def names(self) -> list[str]:
        """Names of the columns of numbers."""
        return [c.name for c in self.columns]


def read_table(path: str | Path) -> Table:
    """Read a CSV file with a header; rows in order of time, missing ones filled in where the times are regular.

    Separators (comma, semicolon, tab, bar, blanks) and decimal commas are detected; units may stand in the header as
    `name [unit]`. Raises IoError or InvalidInput with the line when something does not fit.
    """
    rows = _with_joined_time(with_joined_date(_without_empty_rows(_with_header(read_rows(path)))))
    head = rows.cells[0]
    if _starts_with_data(rows):
        row = ", ".join(head)[:60]
        advice = f"put one above, such as {rows.separator.join(_invented(head))}"
        raise refusal(
            str(rows.path),
            f"the first row {row!r}, which looks like data",
            "a header with the names of the columns",
            advice,
        )
    require_widths(rows, 1, len(head))
    if len(rows.cells) < 3:
        raise refusal(
            str(rows.path), f"{count(len(rows.cells) - 1, 'row')} of records", "a header and at least two rows"
        )
    columns = [_column(text) for text in head]
    body = rows.cells[1:]
    timed = _is_timed(columns[0].name, [row[0] for row in body])
    clock = read_clock(rows, [row[0] for row in body], columns[0].name, columns[0].unit) if timed else None
    named = columns[1:] if timed else columns
    _require_names(rows, named)
    notes: list[str] = []
    values = _numbers(rows, 1, int(timed), [c.name for c in named], notes)
    notes += _suspicious(named, values)
    notes += doubt([row[0] for row in body], columns[0].name, columns[0].unit) if timed else []
    if clock is not None:
        values, filled = clock.fill(values)
        notes += (
            [f"{count(filled, 'missing row')} between the first and the last one, read as missing records"]
            if filled
            else []
        )
    return Table(rows.path, named, values, clock, [f"{rows.path.name}: {note}" for note in notes])


def _has_no_header(cells: list[str]) -> bool:
    """The cells are those of a row: a time first, or numbers only."""
    return looks_like_time(cells[0]) or all(number(cell, True) is not None for cell in cells)


def _starts_with_data(rows: Rows) -> bool:
    """The first row is one of data: like a row of a file without a header, or a word before numbers, as in the next."""
    head, body = rows.cells[0], rows.cells[1:2]
    words = all(number(row[0], True) is None and not looks_like_time(row[0]) for row in (head, *body) if row)
    named = head[0].strip().lower() in TIME_NAMES or len(head) < 2 or not body
    return _has_no_header(head) or (words and not named and all(number(c, True) is not None for c in head[1:]))


def _invented(cells: list[str]) -> list[str]:
    """Names for the columns of a file without a header, to show what one looks like."""
    timed = looks_like_time(cells[0])
    return (
        ["time", *(f"station{k}" for k in range(1, len(cells)))]
        if timed
        else [f"name{k + 1}" for k, _ in enumerate(cells)]
    )


def _with_joined_time(rows: Rows) -> Rows:
    """With the date and the time of day in one column, where the first two columns hold them."""
    if any(len(row) < 2 or not looks_like_time(row[0]) or not is_time_of_day(row[1]) for row in rows.cells[1:]):
        return rows
    head = rows.cells[0]
    joined = [[f"{row[0].strip()} {row[1].strip()}", *row[2:]] for row in rows.cells[1:]]
    if len(head) < 2 or _has_no_header(head):
        return rows
    return Rows(rows.path, [[head[0], *head[2:]], *joined], rows.lines, rows.separator)


def _with_header(rows: Rows) -> Rows:
    """With the comment before the first row as a header, where that is what it is."""
    names = rows.comment.split() if rows.separator == " " else [c.strip() for c in rows.comment.split(rows.separator)]
    if not _has_no_header(rows.cells[0]) or len(names) != len(rows.cells[0]) or _has_no_header(names):
        return rows
    return Rows(rows.path, [names, *rows.cells], [max(rows.lines[0] - 1, 1), *rows.lines], rows.separator)


def _without_empty_rows(rows: Rows) -> Rows:
    """Without rows of separators alone, as spreadsheets write them, where every row of records has a time."""
    timed = len(rows.cells) > 1 and _is_timed(_column(rows.cells[0][0]).name, [rows.cells[1][0]])
    there = [k for k, row in enumerate(rows.cells) if any(row) or not timed]
    cells, lines = [rows.cells[k] for k in there], [rows.lines[k] for k in there]
    return Rows(rows.path, cells, lines, rows.separator, rows.comment)


def _column(text: str) -> Column:
    found = _UNIT.fullmatch(text.strip())
    name, unit = (found[1], found[2]) if found and found[1] else (text.strip(), "")
    return Column(name.strip(), unit.strip())


def _is_timed(name: str, cells: list[str]) -> bool:
    present = [c for c in cells if not is_missing(c)]
    return name.lower() in TIME_NAMES or (bool(present) and looks_like_time(present[0]))


def _require_names(rows: Rows, columns: list[Column]) -> None:
    if not columns:
        raise refusal(f"{rows.path}, line {rows.lines[0]}", "no column besides the time", "columns of numbers")
    seen: dict[str, int] = {}
    for k, column in enumerate(columns, start=1):
        if not column.name:
            advice = "leave the column out if it numbers the rows" if k == 1 else ""
            raise refusal(
                f"{rows.path}, line {rows.lines[0]}", f"no name for column {k}", "a name for every column", advice
            )
        if column.name in seen:
            places = f"columns {seen[column.name]} and {k}"
            raise refusal(
                f"{rows.path}, line {rows.lines[0]}", f"the name {column.name!r} twice ({places})", "different names"
            )
        seen[column.name] = k


def _numbers(rows: Rows, first: int, skip: int, names: list[str], notes: list[str]) -> Array:
    """Numbers of all cells; everything that is none is refused at once, the first of each column by name."""
    cells = [row[skip:] for row in rows.cells[first:]]
    comma = decimal_comma(rows, [list(column) for column in zip(*cells, strict=True)], notes)
    values = np.empty((len(cells), len(names)))
    wrong: dict[str, str] = {}
    for r, row in enumerate(cells):
        for c, cell in enumerate(row):
            value = number(cell, comma)
            if value is None:
                line = rows.lines[first + r]
                wrong.setdefault(names[c], f"{rows.path}, line {line}, column {names[c]}: got {cell!r}")
                value = np.nan
            values[r, c] = value
    if wrong:
        others = list(wrong)[1:]
        more = f"; also in column {', '.join(others[:8])}" if others else ""
        first_wrong = next(cell for row in cells for cell in row if number(cell, comma) is None)
        raise _core.InvalidInput(
            f"{next(iter(wrong.values()))}, expected a number or an empty cell{_advice(first_wrong)}{more}"
        )
    return values


def _advice(cell: str) -> str:
    """What to do with a cell that is no number but nearly one."""
    if looks_like_time(cell):
        return "; the column of times comes first"
    if re.fullmatch(r"\W{0,2}\d[\d.,'_\s]*\D{0,8}\d?", cell):
        return "; write numbers with a decimal point, nothing between thousands, and units in the header: A [unit]"
    return ""


def _suspicious(columns: list[Column], values: Array) -> list[str]:
    """Constants that stand for "no value" in many files, and values far from all others."""
    notes = []
    for column, series in zip(columns, values.T, strict=True):
        known = series[np.isfinite(series)]
        if infinite := int(np.isinf(series).sum()):
            what = count(infinite, "infinite value")
            notes.append(f"column {column.name}: {what}; if that means that there is none, make the cells empty")
        if len(known) < 4:
            continue
        middle = np.median(known)
        spread = 1.4826 * np.median(np.abs(known - middle))
        away = (np.abs(known - middle) > _FAR * spread) & _apart(known, float(middle))
        far = known[away] if spread > 0 else known[np.isin(known, _SENTINELS)]
        if not len(far) and (constant := _constant(known, spread)) is not None:
            often = count(int(np.sum(known == constant)), "value")
            notes.append(
                f"column {column.name}: {often} of exactly {constant:g}, which many instruments write where there is "
                "none; if they mean that, make the cells empty"
            )
        if len(far) and len(far) < len(known) / 2:
            kinds, counts = np.unique(far, return_counts=True)
            worst = kinds[np.argmax(counts)]
            how = (
                f"{np.abs(worst - middle) / spread:.4g} robust deviations off" if spread > 0 else "far from all others"
            )
            notes.append(
                f"column {column.name}: {count(len(far), 'value')} such as {worst:g}, {how}; "
                "if they mean that there is none, make the cells empty"
            )
    return notes


def _apart(known: Array, middle: float) -> NDArray[np.bool_]:
    """Which values lie behind a wide empty part of the range: what a signal passes through is no constant."""
    out = np.zeros(len(known), dtype=bool)
    for side in (known >= middle, known < middle):
        away = np.abs(known[side] - middle)
        order = np.argsort(away)
        widest = np.maximum.accumulate(np.diff(away[order], prepend=0.0))
        out[np.flatnonzero(side)[order]] = widest >= _EMPTY * away.max(initial=0.0)
    return out


def _constant(known: Array, spread: float) -> float | None:
    """A constant for "no value", the least or largest one, that is there too often, or too far away, for a value."""
    kinds, counts = np.unique(known, return_counts=True)
    for k, beside in ((0, 1), (len(kinds) - 1, len(kinds) - 2)):
        if kinds[k] not in _SENTINELS or counts[k] < 2 or len(kinds) < 2:
            continue
        often = counts[k] >= _OFTEN * int(np.delete(counts, k).max())
        if often or abs(kinds[k] - kinds[beside]) > _ALONE * spread:
            return float(kinds[k])
    return None
