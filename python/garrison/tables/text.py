"""From bytes to rows of cells: encoding, separators, comments, blank lines."""

import csv
import re
from dataclasses import dataclass
from os import PathLike
from pathlib import Path

from garrison import _core
from garrison.files import contents
from garrison.tables.cells import has_decimal_comma, is_missing, number
from garrison.words import count, refusal, shown

_SEPARATORS = (";", "\t", "|", ",")
_NAMES = {";": "semicolons", "\t": "tabs", "|": "bars", ",": "commas", " ": "blanks"}
_BOMS = ((b"\xef\xbb\xbf", "utf-8-sig"), (b"\xff\xfe", "utf-16"), (b"\xfe\xff", "utf-16"))
#: how packed files and spreadsheets begin
_PACKED = (
    (b"\x1f\x8b", "a gzip file (unpack it first)"),
    (b"PK\x03\x04", "a zip file or a spreadsheet (save it as text)"),
    (b"\xd0\xcf\x11\xe0", "a spreadsheet (save it as text)"),
)
#: lines that the separator is guessed from
_LOOK = 50


@dataclass(frozen=True)
class Rows:
    """The cells of a file, blank lines and comments (#) left out. lines: line number of each row, from 1.

    comment: the last comment before the first row, which may be a header.
    """

    path: Path
    cells: list[list[str]]
    lines: list[int]
    separator: str
    comment: str = ""

    @property
    def separated_by(self) -> str:
        """For messages."""
        return _NAMES[self.separator]


def read_rows(path: str | Path) -> Rows:
    """Read a text file of cells. Raises IoError when it cannot be read, InvalidInput when it is no such text."""
    if not isinstance(path, (str, PathLike)):
        raise refusal("path", shown(path), "the path of a file of records")
    path = Path(path)
    text = _text(path)
    numbered = [(k, line) for k, line in enumerate(text.splitlines(), start=1) if line.strip()]
    comment = ""
    while numbered and numbered[0][1].lstrip().startswith("#"):
        comment = numbered.pop(0)[1].lstrip().lstrip("#")
    numbered = [(k, line) for k, line in numbered if not line.lstrip().startswith("#")]
    if not numbered:
        raise refusal(str(path), "an empty file", "rows of cells separated by commas, semicolons or tabs")
    told = re.fullmatch(r'"?sep=(.)"?', numbered[0][1].strip())  # the first line that spreadsheets write
    if told is not None and told[1] in _NAMES and len(numbered) > 1:
        numbered.pop(0)
        separator = told[1]
    else:
        separator = _separator([line for _, line in numbered[:_LOOK]])
    cells = _split([line for _, line in numbered], separator, path)
    lines = [k for k, _ in numbered]
    return Rows(path, _without_empty_end(cells), lines, separator, comment)


def _text(path: Path) -> str:
    try:
        data = contents(path)
    except OSError as error:
        raise _core.IoError(f"{path}: got {error.strerror}, expected a readable CSV file") from error
    text = decoded(path, data, "a readable CSV file")
    if "\0" in text:
        got = "characters that are zero, as in UTF-16 without its mark"
        raise _core.IoError(f"{path}: got {got}, expected a readable CSV file; save it as UTF-8")
    return text


def decoded(path: Path, data: bytes, expected: str) -> str:
    """UTF-8, or what the mark at the beginning says. Raises IoError for other bytes."""
    packed = next((name for magic, name in _PACKED if data.startswith(magic)), "")
    if packed:
        raise _core.IoError(f"{path}: got {packed}, expected {expected}")
    encoding = next((name for bom, name in _BOMS if data.startswith(bom)), "utf-8")
    try:
        return data.decode(encoding)
    except UnicodeDecodeError as error:
        got = f"a file that is no text in {encoding.upper()} (byte {error.start})"
        raise _core.IoError(f"{path}: got {got}, expected {expected}; save it as UTF-8") from None


def _separator(lines: list[str]) -> str:
    """The separator that splits most lines into the same number (> 1) of cells; blanks where none does."""
    best, score = " ", 0
    for separator in _SEPARATORS:
        widths = [len(_cells(line, separator)) for line in lines]
        usual = max(set(widths), key=widths.count)
        if usual > 1 and widths.count(usual) > score:
            best, score = separator, widths.count(usual)
    if best == ",":  # decimal commas in columns separated by blanks
        spaced = [line.split() for line in lines]
        if all(len(row) == len(spaced[0]) > 1 for row in spaced) and all(
            re.fullmatch(r"[+-]?\d+,\d+", cell) for row in spaced[1:] for cell in row
        ):
            return " "
    if best == " " and all(len(line.split()) == 1 for line in lines):
        return ","  # a single column
    return best


def _cells(line: str, separator: str) -> list[str]:
    if '"' not in line:
        return line.split(separator)
    try:
        return next(csv.reader([line], delimiter=separator, skipinitialspace=True), [])
    except csv.Error:
        return [line]


def _split(lines: list[str], separator: str, path: Path) -> list[list[str]]:
    if separator == " ":
        return [line.split() for line in lines]
    return [[cell.strip() for cell in _cells(line, separator)] for line in lines]


def _without_empty_end(cells: list[list[str]]) -> list[list[str]]:
    """Without the empty cell that a separator at the end of every line makes."""
    body = cells[1:] or cells
    while body and all(row and row[-1] == "" for row in body):
        width = len(body[0])
        head_too = len(cells[0]) == width and (cells[0][-1] == "" or body is cells)
        longer = len(cells) > 1 and len(cells[0]) == width - 1
        if width < 2 or any(len(row) != width for row in body) or not (head_too or longer):
            break
        cells = [row[:-1] if len(row) == width else row for row in cells]
        body = cells[1:] or cells
    return cells


#: a number with a comma that may separate thousands
_THOUSANDS = re.compile(r"[+-]?[1-9]\d{0,2},\d{3}")


def decimal_comma(rows: Rows, columns: list[list[str]], notes: list[str] | None = None) -> bool:
    """Whether commas in these cells are decimal ones. In a file of commas the cells were quoted.

    A number such as 0,5 or 1234,5 shows it, or 1500 beside 1,234. Where all have the form 1,234 nothing shows it:
    between semicolons, with three places everywhere, they are read as decimal ones and a doubt goes to `notes`. Raises
    InvalidInput where these may as well separate thousands, or where nobody takes notes.
    """
    cells = [cell for column in columns for cell in column]
    if not has_decimal_comma(cells):
        return False
    with_comma = [cell for cell in cells if "," in cell and number(cell, True) is not None]
    if not all(_THOUSANDS.fullmatch(cell) for cell in with_comma) or any(map(_large_without, columns)):
        return True
    if rows.separator == "," or notes is None or any(map(_mixed, columns)):
        got = f"{with_comma[0]!r}, in which the comma is a decimal one or separates thousands"
        raise refusal(str(rows.path), got, "numbers with a decimal point and nothing between thousands")
    read = with_comma[0].replace(",", ".")
    notes.append(f"{with_comma[0]} is read as {read}, with a decimal comma; if it separates thousands, remove it")
    return True


def _large_without(column: list[str]) -> bool:
    """Beside numbers with a comma there is one >= 1000 without: thousands are not separated."""
    return any("," in c for c in column) and any(re.fullmatch(r"[+-]?[1-9]\d{3,}", c.strip()) for c in column)


def _mixed(column: list[str]) -> bool:
    """Beside numbers with three places there are some without, as where the comma separates thousands."""
    plain = any("," not in c and not is_missing(c) and number(c) not in (None, 0.0) for c in column)
    return plain and any("," in c for c in column)


def require_widths(rows: Rows, first: int, width: int) -> None:
    """Refuse rows (from index `first` on) that have not `width` cells."""
    widths = {len(row) for row in rows.cells[first:]}
    if width == 1 and len(widths) == 1 and min(widths) > 1:
        raise refusal(
            f"{rows.path}, line {rows.lines[0]}",
            f"{rows.cells[0][0]!r} above rows of {min(widths)} columns",
            "the names of the columns",
            "leave out what stands above them, or begin it with #",
        )
    for line, row in zip(rows.lines[first:], rows.cells[first:], strict=True):
        if len(row) != width:
            more = ""
            if len(row) > width and rows.separator == "," and any(re.fullmatch(r"\d+", c) for c in row):
                more = "; a decimal comma needs semicolons or tabs between the columns"
            raise _core.InvalidInput(
                f"{rows.path}, line {line}: got {count(len(row), 'column')}, expected {width} "
                f"(separated by {rows.separated_by}){more}"
            )
