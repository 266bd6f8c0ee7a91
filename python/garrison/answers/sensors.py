"""The sensors of a network one by one: their rows, names, and who can lie."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from garrison import _core

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Sensors:
    """Every measured number by itself. model, network: with an agent per output (garrison.split_outputs).

    rows (M, n); agent: of each row, in the split model; names: of the rows; secured: rows that no attacker reaches.
    """

    model: _core.Model
    network: _core.Network
    rows: Array
    agent: list[int]
    names: list[str]
    secured: list[int]

    @property
    def can_lie(self) -> list[int]:
        """Rows that an attacker reaches."""
        return [k for k in range(len(self.rows)) if k not in set(self.secured)]


def sensors_of(model: _core.Model, network: _core.Network, names: list[str] | None = None) -> Sensors:
    """One sensor per output. names: of the agents of the model. Raises InvalidInput when sizes do not fit."""
    split, net, owner = _core.split_outputs(model, network)
    agents = names or list(network.names) or [f"agent {i}" for i in range(model.agents)]
    rows: list[Array] = []
    agent: list[int] = []
    words: list[str] = []
    secured: list[int] = []
    part: dict[int, int] = {}
    exposed = model.__getstate__().get("exposed") or [len(c) for c in model.C]
    for i, of in enumerate(owner):
        row = np.asarray(split.C[i]).reshape(-1, model.states)
        if not len(row):
            continue
        number = part.setdefault(of, 0)
        part[of] += 1
        if number >= exposed[of]:
            secured.append(len(rows))
        several = len(model.C[of]) > 1
        output = model.output_names[len(rows)] if model.output_names else number + 1
        words.append(f"{agents[of]}:{output}" if several else agents[of])
        rows.append(row[0])
        agent.append(i)
    stacked = np.array(rows).reshape(-1, model.states)
    return Sensors(split, net, stacked, agent, words, secured)
