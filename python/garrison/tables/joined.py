"""Dates that are spread over several columns, in one."""

from garrison.tables.text import Rows

#: names of the columns of a date, in their order, and of the hour that may follow
_PARTS = (("year", "yyyy", "yr", "jahr"), ("month", "mm", "mo", "monat"), ("day", "dd", "dy", "tag"))
_HOURS = ("hour", "hh", "hr", "stunde")


def with_joined_date(rows: Rows) -> Rows:
    """With year, month and day in one column, and the hour where it follows, where the first columns are called so."""
    names = [cell.strip().lower() for cell in rows.cells[0]]
    if len(names) < 4 or any(name not in known for name, known in zip(names, _PARTS, strict=False)):
        return rows
    used = 4 if names[3] in _HOURS and len(names) > 4 else 3
    if not all(len(row) > used and all(cell.strip().isdigit() for cell in row[:used]) for row in rows.cells[1:]):
        return rows
    joined = [[_moment([int(cell) for cell in row[:used]]), *row[used:]] for row in rows.cells[1:]]
    return Rows(rows.path, [["date", *rows.cells[0][used:]], *joined], rows.lines, rows.separator)


def _moment(parts: list[int]) -> str:
    date = "-".join(f"{part:02d}" for part in parts[:3])
    return f"{date} {parts[3]:02d}:00" if len(parts) > 3 else date
