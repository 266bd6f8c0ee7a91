"""Matrices of numbers, and logs of measurements without a model of their own."""

import math
from itertools import zip_longest
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from garrison import _core
from garrison.tables.cells import number
from garrison.tables.text import decimal_comma, read_rows, require_widths

Array = NDArray[np.float64]


def read_matrix(path: str | Path, *, square: bool = False, notes: list[str] | None = None) -> Array:
    """The numbers of a file, (rows, columns); a header is passed over. Raises IoError or InvalidInput with the line.

    square: of a square matrix without missing numbers. notes: where doubts about decimal commas go; without, refused.
    """
    rows = read_rows(path)
    comma = decimal_comma(rows, [[c for c in column if c] for column in zip_longest(*rows.cells, fillvalue="")], notes)
    first = 0 if any(number(c, comma) is not None for c in rows.cells[0]) else 1
    if first == len(rows.cells):
        raise _core.InvalidInput(f"{rows.path}, line {rows.lines[0]}: got {rows.cells[0][0]!r}, expected numbers")
    require_widths(rows, first, len(rows.cells[first]))
    out = np.empty((len(rows.cells) - first, len(rows.cells[first])))
    for r, row in enumerate(rows.cells[first:]):
        for c, cell in enumerate(row):
            value = number(cell, comma)
            if value is None or (square and not math.isfinite(value)):
                line = rows.lines[first + r]
                kind = "a finite number" if square else "a number"
                raise _core.InvalidInput(f"{rows.path}, line {line}, column {c + 1}: got {cell!r}, expected {kind}")
            out[r, c] = value
    if square and out.shape[0] != out.shape[1]:
        raise _core.InvalidInput(f"{rows.path}: got {out.shape[0]} x {out.shape[1]} numbers, expected a square matrix")
    return out
