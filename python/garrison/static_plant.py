"""A plant that does not move, by sparse rows: a power grid of thousands of buses, for gr.analyze."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from garrison import arguments
from garrison.numeric import numbers
from garrison.result import Result
from garrison.words import count, hinted_methods, refusal, shown

Array = NDArray[np.float64]


@hinted_methods
@dataclass(eq=False, repr=False)
class StaticPlant(Result):
    """x(k+1) = x(k), y = H x: measurements of a state that stays, with H by its entries that are not 0.

    No matrix of all states is made, so that thousands of states fit. Every row is a sensor.

    Raises InvalidInput where something does not fit.

    Attributes
    ----------
    entries : (k, 3) array
        [row, column, value] of H, in any order; entries at one place add up.
    size : (int, int)
        Sensors and states, both >= 1.
    agent : list of int
        (sensors,): whose sensor a row is, >= 0; where it is not given, an agent per sensor.
    states, outputs : list of str
        Names of the states and of the sensors; numbers where they are not given.
    """

    entries: Array
    size: tuple[int, int]
    agent: list[int] = field(default_factory=list)
    states: list[str] = field(default_factory=list)
    outputs: list[str] = field(default_factory=list)

    def __post_init__(self) -> None:
        if not isinstance(self.size, (tuple, list)) or len(self.size) != 2:
            raise refusal("size", shown(self.size), "two numbers: sensors and states")
        rows, columns = (arguments.whole("size", v, 1) for v in self.size)
        self.size = rows, columns
        self.entries = _entries(self.entries, rows, columns)
        agent = [] if self.agent is None else arguments.whole_numbers("agent", self.agent)
        self.agent = agent or list(range(rows))
        if len(self.agent) != rows:
            raise refusal("agent", count(len(self.agent), "number"), f"{rows}, one per sensor")
        self.states = _names("states", self.states, columns, "state")
        self.outputs = _names("outputs", self.outputs, rows, "sensor")

    @classmethod
    def of(cls, rows: Any, agent: ArrayLike | None = None, **names: list[str]) -> StaticPlant:
        """The plant of a matrix of rows.

        Parameters
        ----------
        rows : scipy.sparse matrix or (sensors, states) array
            H, finite.
        agent : (sensors,) sequence of int, optional
            Whose sensor a row is, >= 0; default: an agent per sensor.
        **names : lists of str
            `states` and `outputs`: their names.

        Returns
        -------
        StaticPlant

        Raises
        ------
        InvalidInput
            Where something does not fit.
        """
        if hasattr(rows, "tocoo"):
            found = rows.tocoo()
            entries, (sensors, states) = [found.row, found.col, numbers("rows", found.data)], found.shape
        else:
            table = arguments.table("rows", rows)
            at = np.nonzero(table)
            entries, (sensors, states) = [*at, table[at]], table.shape
        whose = [] if agent is None else arguments.whole_numbers("agent", agent)
        return cls(np.column_stack(entries), (sensors, states), whose, **names)

    @property
    def agents(self) -> int:
        """The least number of agents that the sensors are on."""
        return max(self.agent) + 1


def _entries(given: Any, rows: int, columns: int) -> Array:
    entries = numbers("entries", given)
    if entries.size == 0:
        return np.zeros((0, 3))
    if entries.ndim != 2 or entries.shape[1] != 3:
        raise refusal("entries", f"shape {entries.shape}", "triples [row, column, value]")
    at = entries[:, :2]
    wrong = ~((at == np.floor(at)) & (at >= 0) & (at < [rows, columns])).all(axis=1)
    if wrong.any():
        row, column, _ = entries[int(np.argmax(wrong))]
        raise refusal("entries", f"an entry at ({row:g}, {column:g})", f"one within {rows} x {columns}")
    if not np.isfinite(entries[:, 2]).all():
        raise refusal("entries", "a value that is not finite", "finite numbers")
    return entries


def _names(which: str, given: Any, many: int, noun: str) -> list[str]:
    names = [] if given is None else arguments.texts(which, given)
    if names and len(names) != many:
        raise refusal(which, count(len(names), "name"), f"{many}, one per {noun}")
    return names or [f"{noun} {k}" for k in range(many)]
