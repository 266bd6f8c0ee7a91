"""The cheapest sensors that make one more liar harmless."""

import heapq
from collections.abc import Callable, Mapping, Sequence
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

    counted = _counted(A, rows, may_go, spare, candidates)
    return _search(goal, candidates, obstacle, next_ones, budget, counted)


def by_counting(shown: Sequence[int], spare: int, prices: Mapping[int, float]) -> list[int] | None:
    """States, each for a sensor of it alone, so that more than `spare` rows show every state.

    shown: by how many rows each state is shown. prices: what a sensor of one state costs. A plant that does not move
    needs that much: without the rows of one state nothing tells it. None: a sensor that is needed is not on offer.
    """
    missing = [(k, spare + 1 - rows) for k, rows in enumerate(shown) if rows <= spare]
    if any(k not in prices for k, _ in missing):
        return None
    return [k for k, times in missing for _ in range(times)]


def _counted(A: Array, rows: Array, may_go: list[int], spare: int, candidates: Sequence[Candidate]) -> list[int] | None:
    """by_counting as numbers of candidates; None where it says nothing: they show several states, or A moves them."""
    states = [np.flatnonzero(c.row) for c in candidates]
    if not np.array_equal(A, np.eye(len(A))) or any(len(some) != 1 for some in states):
        return None
    of: dict[int, int] = {}
    for number in sorted(range(len(candidates)), key=lambda k: -candidates[k].cost):
        of[int(states[number][0])] = number
    loose = np.isin(np.arange(len(rows)), may_go)
    safe = (rows[~loose] != 0).any(axis=0)  # shown by a sensor that is never lost
    shown = np.where(safe, spare + 1, (rows[loose] != 0).sum(axis=0))
    found = by_counting(shown.tolist(), spare, {k: candidates[number].cost for k, number in of.items()})
    return None if found is None else sorted(of[k] for k in found)


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
    needed: Sequence[int] | None = None,
) -> Addition:
    """Uniform-cost search over choices with repetition. needed: what no choice costs less than; None: nothing."""
    n = len(candidates[0].row) if candidates else 0
    first = tuple(needed or ())
    queue: list[tuple[float, tuple[int, ...]]] = [(sum(candidates[k].cost for k in first), first)]
    seen: set[tuple[int, ...]] = {first}
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
