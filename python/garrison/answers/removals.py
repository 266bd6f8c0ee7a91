"""The fewest sensors whose loss leaves part of the state unseen: the measure of what attackers can hide."""

from dataclasses import dataclass
from itertools import combinations
from typing import Any

import numpy as np
from numpy.typing import NDArray

from garrison import _core
from garrison._core import certificate, structure
from garrison.result import Result

Array = NDArray[np.float64]

#: rows up to which sets are listed one by one to name an example
_MOST_SETS = 200_000


@dataclass(frozen=True, eq=False, repr=False)
class Removal(Result):
    """The fewest sensors whose loss breaks something are between fewest and most; example: a set of `most` of them.

    fewest == most: exact, and the example is a smallest one. Nothing to break: 0 of both, and an empty example.
    """

    fewest: int
    most: int
    example: list[int]

    @property
    def exact(self) -> bool:
        """The search was finished."""
        return self.fewest == self.most

    @property
    def spare(self) -> int:
        """Any so many may be lost, for certain."""
        return self.fewest - 1


def smallest_removal(A: Array, rows: Array, may_go: list[int], budget: Any) -> Removal:
    """Fewest of the rows `may_go` without which (A, rows) is not observable; within the budget, else an interval.

    A the identity asks what one sample determines. Where no removal breaks it, fewest = most = len(may_go) + 1.
    """
    if not _seen(A, rows):
        return Removal(0, 0, [])
    at_once = _is_identity(A)
    example = _by_support(A, rows, may_go, at_once, budget)
    if example is None:
        return Removal(len(may_go) + 1, len(may_go) + 1, [])
    most = len(example)
    certain = 0
    if most > 1 and len(may_go) == len(rows) and at_once and np.all(np.any(rows != 0.0, axis=1)):
        try:
            attack = certificate.smallest_undetectable(rows, most - 1, 1e12)  # stops with the budget
        except _core.InvalidInput:  # rows that determine the state by their rounding only
            return Removal(1, most, sorted(example))
        if attack.size is not None:
            return Removal(attack.size, attack.size, sorted(attack.example))
        return Removal(attack.searched + 1, most, sorted(example))
    try:
        while certain + 1 < most and not budget.over:
            found = _breaking(A, rows, may_go, certain + 1, budget)
            if found is not None:
                return Removal(len(found), len(found), sorted(found))
            certain += 1
    except _core.InvalidInput:  # the time is up, or the sets are too many: what is certain so far stays
        pass
    return Removal(certain + 1, most, sorted(example))


def _breaking(A: Array, rows: Array, may_go: list[int], size: int, budget: Any) -> list[int] | None:
    """A breaking set of `size` rows; None: there is none. Smaller sets are known not to break."""
    if len(may_go) == len(rows) and _core.s_sparse_observable(A, rows, size):
        return None
    for tried, some in enumerate(combinations(may_go, size)):
        if budget.over or tried > _MOST_SETS:
            raise _core.InvalidInput("smallest_removal: too many sets of sensors to try")
        if not _seen(A, np.delete(rows, some, axis=0)):
            return list(some)
    return None


def _by_support(A: Array, rows: Array, may_go: list[int], at_once: bool, budget: Any) -> list[int] | None:
    """A breaking set that is quickly found: all sensors of one state. None: no such set breaks.

    at_once: A is the identity, so that nothing else shows a state.
    """
    allowed = set(may_go)
    touching = [np.flatnonzero(column) for column in rows.T]
    for some in sorted(touching, key=len):
        if budget.over:
            break
        if allowed.issuperset(some.tolist()) and (at_once or not _seen(A, np.delete(rows, some, axis=0))):
            return [int(k) for k in some]
    if not _seen(A, np.delete(rows, may_go, axis=0)):
        return list(may_go)
    return None


def unseen(A: Array, rows: Array) -> int:
    """How many modes the rows do not surely show."""
    return len(structure.unseen_modes(A, rows, 0.0))


def _seen(A: Array, rows: Array) -> bool:
    if len(rows) == 0:
        return False
    return bool(_core.surely_observable(A, rows))


def _is_identity(A: Array) -> bool:
    return np.array_equal(A, np.eye(len(A)))
