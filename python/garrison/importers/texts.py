"""Files of cells with lines about the recording above the header."""

import gzip
import zlib
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from garrison import _core
from garrison.files import contents
from garrison.tables.cells import number
from garrison.tables.text import read_rows
from garrison.words import near, refusal

Array = NDArray[np.float64]
#: rows among which the header is looked for
_LOOK = 30


@dataclass(frozen=True)
class Grid:
    """Named columns of a text file. time: index of the column of times. vehicles: names from a line above."""

    path: Path
    names: list[str]
    cells: list[list[str]]
    lines: list[int]
    time: int
    vehicles: list[str]

    def column(self, name: str) -> Array:
        """A column of numbers, nan = missing. Raises InvalidInput with the line where a cell is none."""
        k = self.names.index(name)
        out = np.full(len(self.cells), np.nan)
        for r, row in enumerate(self.cells):
            value = number(row[k]) if k < len(row) else np.nan
            if value is None:
                raise refusal(f"{self.path}, line {self.lines[r]}, column {name}", repr(row[k]), "a number")
            out[r] = value if np.isfinite(value) else np.nan
        return out


def read_grid(path: Path, times: set[str]) -> Grid:
    """Read cells below the first row that has one of the names of `times`."""
    rows = read_rows(path)
    for k, row in enumerate(rows.cells[:_LOOK]):
        found = [i for i, cell in enumerate(row) if _plain(cell) in times]
        if found and any(_plain(cell) and number(cell) is None and i not in found for i, cell in enumerate(row)):
            names = [cell.strip() for cell in row]
            vehicles = [r[1:] for r in rows.cells[:k] if _plain(r[0]) in ("vehicle_order", "vehicles")]
            named = [cell.strip() for cell in vehicles[0] if cell.strip()] if vehicles else []
            return Grid(path, names, rows.cells[k + 1 :], rows.lines[k + 1 :], found[0], named)
    first = ", ".join(rows.cells[0])[:80]
    raise refusal(str(path), f"the first line {first!r}", f"a header with a column {' or '.join(sorted(times))}")


def _plain(cell: str) -> str:
    return cell.strip().lower().partition("[")[0].partition("(")[0].strip()


def bytes_of(path: Path, expected: str) -> bytes:
    """The bytes of a file, unpacked where they are gzip. Raises IoError."""
    try:
        data = contents(path)
        return gzip.decompress(data) if data.startswith(b"\x1f\x8b") else data
    except (OSError, zlib.error) as error:
        what = getattr(error, "strerror", None) or "a damaged gzip file"
        raise _core.IoError(f"{path}: got {what}, expected {expected}") from None
    except EOFError:
        raise _core.IoError(f"{path}: got a gzip file that ends early, expected {expected}") from None


def absent(where: str, wanted: str, names: list[str]) -> _core.InvalidInput:
    """The refusal of a file without a column."""
    return refusal(where, f"the columns {', '.join(names)}", wanted, near(wanted, names))
