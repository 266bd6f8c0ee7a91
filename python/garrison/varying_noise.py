"""Covariances of measurements over time, in every form that says whose a number is."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
from numpy.typing import NDArray

from garrison.numeric import numbers
from garrison.words import refusal

Array = NDArray[np.float64]
_NAME = "VaryingModel.measurement_covariance"


def below_each_other(given: Any, rows: list[int]) -> Any:
    """(T, outputs, most outputs of an agent): the blocks of all agents below each other, zeros right of smaller ones.

    A function gives what is asked of it at one time. None stays None; what is no list of blocks and no table of
    variances is left to the reader of matrices over time. rows: outputs of each agent.
    """
    if given is None:
        return None
    if callable(given):
        return lambda t: _blocks_at(f"measurement_covariance({t})", given(t), rows)
    if _one_each(given, rows, 3):
        return _stacked_blocks(given, rows)
    value = numbers(_NAME, given)
    if value.ndim == 2 and value.shape[1] == sum(rows):
        return np.array([_diagonals(row, rows) for row in value])
    if value.ndim < 3:
        expected = f"(steps, {sum(rows)}) variances, or (steps, {sum(rows)}, {max(rows, default=0)})"
        raise refusal(_NAME, f"{value.shape}", f"{expected}, or a list with a (steps, m, m) array per agent")
    return value


def _one_each(given: Any, rows: list[int], dimensions: int) -> bool:
    return isinstance(given, (list, tuple)) and len(given) == len(rows) and all(np.ndim(b) == dimensions for b in given)


def _stacked_blocks(given: Any, rows: list[int]) -> Array:
    blocks = [numbers(f"{_NAME}[{i}]", block) for i, block in enumerate(given)]
    for i, (block, m) in enumerate(zip(blocks, rows, strict=True)):
        if block.shape[1:] != (m, m) or len(block) != len(blocks[0]):
            raise refusal(f"{_NAME}[{i}]", f"{block.shape}", f"({len(blocks[0])}, {m}, {m}), as the model has {m} rows")
    return np.array([_padded([block[t] for block in blocks], rows) for t in range(len(blocks[0]))])


def _blocks_at(which: str, value: Any, rows: list[int]) -> Array:
    """The blocks of all agents at one time."""
    if _one_each(value, rows, 2):
        blocks = [numbers(f"{which}[{i}]", block) for i, block in enumerate(value)]
        for i, (block, m) in enumerate(zip(blocks, rows, strict=True)):
            if block.shape != (m, m):
                raise refusal(f"{which}[{i}]", f"{block.shape}", f"({m}, {m})")
        return _padded(blocks, rows)
    found = numbers(which, value)
    if found.ndim == 0:
        return _diagonals(np.full(sum(rows), float(found)), rows)
    if found.ndim == 1 and len(found) == sum(rows):
        return _diagonals(found, rows)
    if found.shape == (sum(rows), max(rows, default=0)):
        return found
    raise refusal(which, f"{found.shape}", f"a number, {sum(rows)} variances, or a list with an (m, m) array per agent")


def _padded(blocks: list[Array], rows: list[int]) -> Array:
    out, first = np.zeros((sum(rows), max(rows, default=0))), 0
    for block, m in zip(blocks, rows, strict=True):
        out[first : first + m, :m] = block
        first += m
    return out


def _diagonals(variances: Array, rows: list[int]) -> Array:
    """Blocks of outputs that are independent."""
    ends = np.cumsum([0, *rows])
    blocks = [np.diag(variances[first:last]) for first, last in itertools.pairwise(ends)]
    return _padded(blocks, rows)


__all__ = ["below_each_other"]
