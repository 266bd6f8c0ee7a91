"""The cheapest sensors that make one more liar harmless."""

import heapq
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from garrison import _core
from garrison.answers.removals import smallest_removal, unseen
from garrison.result import Result

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False, repr=False)
class Candidate(Result):
    """A sensor that could be added: what it measures, its row (n,), and its cost > 0."""

    name: str
    row: Array
    cost: float = 1.0


@dataclass(frozen=True, eq=False, repr=False)
class Addition(Result):
    """goal: what becomes true. sensors: names of what to add, one may stand there twice. cost: of all together.

    cheapest: nothing cheaper among the candidates does it, for certain. sensors None: nothing was found.
    """

    goal: str
    sensors: list[str] | None
    cost: float
    cheapest: bool


#: rows that were added -> the sets of rows with which the goal is not reached, None: it is reached
Obstacle = Callable[[Array], list[int] | None]


def cheapest_for_removal(
    goal: str, A: Array, rows: Array, may_go: list[int], spare: int, candidates: Sequence[Candidate], budget: Any
) -> Addition:
    """Additions with which any `spare` of the sensors (new ones, too) may be lost: (A, rest) stays observable.

    Best first. After a set of sensors that must not be lost, a choice goes on with candidates that show a mode which
    the rest does not: every sufficient choice has one of those.
    """

    def obstacle(added: Array) -> list[int] | None:
        all_rows = np.vstack([rows, added])
        new = list(range(len(rows), len(all_rows)))
        removal = smallest_removal(A, all_rows, may_go + new, budget)
        if removal.spare >= spare and removal.fewest > 0:
            return None
        if removal.most > spare or not (removal.exact or removal.example):
            raise _core.InvalidInput("additions: the time is up")
        return removal.example

    def next_ones(added: Array, lost: list[int]) -> list[int]:
        rest = np.delete(np.vstack([rows, added]), lost, axis=0)
        before = unseen(A, rest)
        return [k for k, c in enumerate(candidates) if unseen(A, np.vstack([rest, c.row])) < before]

    return _search(goal, candidates, obstacle, next_ones, budget)


def cheapest_for(
    goal: str, candidates: Sequence[Candidate], reached: Callable[[Array], bool], budget: Any, most: int = 12
) -> Addition:
    """Additions with which `reached`(added rows) is true; at most `most` sensors."""

    def obstacle(added: Array) -> list[int] | None:
        return None if reached(added) else []

    everybody = list(range(len(candidates)))
    found = _search(goal, candidates, obstacle, lambda added, _: everybody if len(added) < most else [], budget)
    return found if found.sensors is not None else replace(found, cheapest=False)  # more than `most` might do


def _search(
    goal: str,
    candidates: Sequence[Candidate],
    obstacle: Obstacle,
    next_ones: Callable[[Array, list[int]], list[int]],
    budget: Any,
) -> Addition:
    """Uniform-cost search over choices with repetition."""
    n = len(candidates[0].row) if candidates else 0
    queue: list[tuple[float, tuple[int, ...]]] = [(0.0, ())]
    seen: set[tuple[int, ...]] = {()}
    try:
        while queue and not budget.over:
            cost, chosen = heapq.heappop(queue)
            added = np.array([candidates[k].row for k in chosen]).reshape(-1, n)
            lost = obstacle(added)
            if lost is None:
                return Addition(goal, [candidates[k].name for k in chosen], cost, True)
            for k in next_ones(added, lost):
                more = tuple(sorted((*chosen, k)))
                if more not in seen:
                    seen.add(more)
                    heapq.heappush(queue, (cost + candidates[k].cost, more))
    except _core.InvalidInput:
        if not budget.over:
            raise
    return Addition(goal, None, float("nan"), not queue and not budget.over)
