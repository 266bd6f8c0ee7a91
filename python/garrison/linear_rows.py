"""Which outputs of a nonlinear plant are linear, and their rows."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from garrison.numeric import numbers
from garrison.words import count, refusal

Array = NDArray[np.float64]
_NAME = "NonlinearModel.linear"


class Rows:
    """h where all outputs are linear: the rows (outputs, n) of all agents, agent i at its own X[i]."""

    __name__ = "rows"

    def __init__(self, C: Array, outputs: list[int]) -> None:
        self._C = C
        self._agent = np.repeat(np.arange(len(outputs)), outputs)

    def __call__(self, X: Array, t: int) -> Array:
        """What all sensors measure, agent by agent."""
        return np.asarray((self._C * X[self._agent]).sum(axis=1))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Rows) and np.array_equal(self._C, other._C)

    def __hash__(self) -> int:
        return hash(self._C.tobytes())


def linear_rows(given: Any, outputs: list[int], n: int) -> Array:
    """(outputs, n): the rows of outputs that are linear, nan in the others. outputs: of each agent."""
    m = sum(outputs)
    if given is None:
        return np.full((m, n), np.nan)
    by_agent = isinstance(given, (list, tuple)) and len(given) == len(outputs)
    found = _of_agents(given, outputs, n) if by_agent else numbers(_NAME, given)
    if found.shape != (m, n):
        expected = f"({m}, {n}), or a list with the rows of each of {count(len(outputs), 'agent')}"
        raise refusal(_NAME, f"{found.shape}", expected)
    missing = np.isnan(found)
    if np.isinf(found).any() or (missing.any(axis=1) != missing.all(axis=1)).any():
        expected = "finite numbers, or a row of nan where h is not linear"
        raise refusal(_NAME, "a row that is partly nan, or inf", expected)
    return found


def _of_agents(given: Any, outputs: list[int], n: int) -> Array:
    parts = []
    for i, (one, own) in enumerate(zip(given, outputs, strict=True)):
        part = numbers(f"{_NAME}[{i}]", one)
        part = part[None] if part.ndim == 1 and part.size else part
        if part.size == own * n == 0:
            part = np.zeros((0, n))
        if part.shape != (own, n):
            raise refusal(f"{_NAME}[{i}]", f"{part.shape}", f"({own}, {n}), a row per output of agent {i}")
        parts.append(part)
    return np.concatenate(parts)


__all__ = ["Rows", "linear_rows"]
