"""Which sensors are necessary and what could replace them: the structural analysis of a system, as data and table."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from garrison import _core
from garrison._core import structure
from garrison.families import require_common_state
from garrison.scenario import read_scenario
from garrison.tables import read_matrix
from garrison.words import refusal

Array = NDArray[np.float64]


@dataclass
class Anatomy:
    """What follows from the zeros of A and of the sensors alone, and where A is known from its numbers.

    measured: per agent the states that its sensor depends on.
    """

    title: str
    A: Array
    measured: list[list[int]]
    names: list[str]
    network: _core.Network | None = None
    undetectable: list[int] = field(default_factory=list)
    unseen: list[complex] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.system = structure.System(structure.Pattern.of(self.A))

    def report(self) -> dict[str, Any]:
        """Everything, ready for JSON."""
        s = self.system
        out: dict[str, Any] = {
            "title": self.title,
            "states": s.states,
            "structural_rank": s.structural_rank,
            "contractions": s.contraction_components,
            "parent_components": s.parent_components,
            "components": len(s.components),
        }
        if not self.measured:
            return out
        out |= s.observability(self.measured)
        rows = zip(
            self.names,
            self.measured,
            s.classes(self.measured),
            s.necessary(self.measured),
            s.substitutes(self.measured),
            strict=True,
        )
        out["agents"] = [
            {
                "agent": name,
                "measures": states,
                "class": kind if states else "relay",
                "necessary": needed,
                "substitutes": others,
                "could_lie_unseen": i in self.undetectable,
            }
            for i, (name, states, kind, needed, others) in enumerate(rows)
        ]
        out["unstable_modes_nobody_sees"] = [[float(z.real), float(z.imag)] for z in self.unseen]
        return out


def read_anatomy(path: str | Path, measured: list[int | None] | None = None) -> Anatomy:
    """From a scenario (TOML), or from a CSV file with A, whose sensors are the states in `measured`.

    Raises InvalidInput or IoError when something does not fit.
    """
    file = Path(path)
    if file.suffix.lower() == ".csv":
        A = read_matrix(file, square=True)
        states = [[] if m is None else [m] for m in measured or []]
        anatomy = Anatomy(file.name, A, states, [f"agent {i}" for i in range(len(states))])
        anatomy.system.classes(states)  # refuses states out of range
        C = [np.eye(len(A))[s] for s in states]
        model = _core.Model(A, C) if C else None
    else:
        if measured:
            raise refusal("measured", "states together with a scenario", "a CSV file with A")
        scenario = read_scenario(file)
        scenario.require_constant("structure")
        require_common_state(scenario.filters[0][1])
        model = scenario.model
        rows = [np.asarray(c) for c in model.C]
        states = [[int(k) for k in np.flatnonzero(np.abs(c).sum(axis=0))] for c in rows]
        anatomy = Anatomy(scenario.title, np.asarray(model.A), states, scenario.names, scenario.network)
    if model is not None:
        anatomy.undetectable = structure.undetectable_agents(model)
        stacked = np.vstack([np.asarray(c).reshape(-1, model.states) for c in model.C])
        anatomy.unseen = structure.unseen_modes(model.A, stacked, 1.0)
    return anatomy


def states_text(states: list[int], most: int = 12) -> str:
    """A list of states for people."""
    words = ", ".join(str(s) for s in states[:most])
    return f"{words}, ... ({len(states)})" if len(states) > most else words or "-"


def table_rows(report: dict[str, Any]) -> list[list[str]]:
    """The agents of an analysis as rows for a table.

    Parameters
    ----------
    report : dict
        Of Anatomy.report().

    Returns
    -------
    list of lists of str
        Per agent: name, measures, class, necessary, substitutes, could drift unseen.
    """
    return [
        [
            a["agent"],
            states_text(a["measures"], 6),
            a["class"],
            "yes" if a["necessary"] else "no",
            states_text(a["substitutes"]),
            "yes" if a["could_lie_unseen"] else "no",
        ]
        for a in report.get("agents", [])
    ]
