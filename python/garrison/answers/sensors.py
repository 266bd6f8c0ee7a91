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
        secured = set(self.secured)
        return [k for k in range(len(self.rows)) if k not in secured]


def sensors_of(model: _core.Model, network: _core.Network, names: list[str] | None = None) -> Sensors:
    """One sensor per output. names: of the agents of the model. Raises InvalidInput when sizes do not fit."""
    split, net, owner = _core.split_outputs(model, network)
    agents = names or list(network.names) or [f"agent {i}" for i in range(model.agents)]
    # Asked for once each: these are copies of all matrices and names.
    outputs, parts, named = [len(c) for c in model.C], split.C, list(model.output_names)
    stacked = np.vstack(parts) if parts else np.zeros((0, model.states))
    agent: list[int] = []
    words: list[str] = []
    secured: list[int] = []
    part: dict[int, int] = {}
    exposed = model.__getstate__().get("exposed") or outputs
    for i, of in enumerate(owner):
        if not len(parts[i]):
            continue
        number = part.setdefault(of, 0)
        part[of] += 1
        if number >= exposed[of]:
            secured.append(len(words))
        output = named[len(words)] if named else number + 1
        words.append(f"{agents[of]}:{output}" if outputs[of] > 1 else agents[of])
        agent.append(i)
    return Sensors(split, net, stacked, agent, words, secured)
