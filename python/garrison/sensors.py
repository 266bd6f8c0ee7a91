"""Who is indispensable: the structural analysis of a system and its sensors, as data, table and picture."""

import csv
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from garrison import _core
from garrison._core import structure
from garrison.scenario import read_scenario

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


def _square(path: Path) -> Array:
    rows: list[list[float]] = []
    try:
        with path.open(newline="", encoding="utf-8") as file:
            for line in csv.reader(file):
                if line and not line[0].lstrip().startswith("#"):
                    rows.append([float(v) for v in line])
    except ValueError as error:
        raise _core.InvalidInput(f"{path}: {error}, expected numbers separated by commas") from None
    except UnicodeDecodeError:
        raise _core.InvalidInput(f"{path}: got a file that is no text, expected numbers separated by commas") from None
    if not rows or any(len(row) != len(rows) for row in rows):
        got = f"{len(rows)} rows of {sorted({len(row) for row in rows})} numbers"
        raise _core.InvalidInput(f"{path}: got {got}, expected a square matrix")
    return np.array(rows)


def read_anatomy(path: str | Path, measured: list[int | None] | None = None) -> Anatomy:
    """From a scenario (TOML), or from a CSV file with A, whose sensors are the states in `measured`.

    Raises InvalidInput or IoError when something does not fit.
    """
    file = Path(path)
    if file.suffix.lower() == ".csv":
        try:
            A = _square(file)
        except OSError as error:
            raise _core.IoError(f"{file}: {error.strerror}") from None
        states = [[] if m is None else [m] for m in measured or []]
        anatomy = Anatomy(file.name, A, states, [f"agent {i}" for i in range(len(states))])
        anatomy.system.classes(states)  # refuses states out of range
        C = [np.eye(len(A))[s] for s in states]
        model = _core.Model(A, C) if C else None
    else:
        if measured:
            raise _core.InvalidInput("measured: got states together with a scenario, expected a CSV file with A")
        scenario = read_scenario(file)
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
    """One row per agent: name, measures, class, necessary, substitutes, could lie unseen."""
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


#: per class: colour and marker
LOOKS = {
    "alpha": ("#D55E00", "s"),
    "beta": ("#0072B2", "o"),
    "gamma": ("#009E73", "^"),
    "relay": ("#888888", "D"),
}


def anatomy_figure(anatomy: Anatomy, most_labels: int = 150) -> Any:
    """The system digraph with contractions, parent components and sensors; beside it the network (extra: plot)."""
    import networkx as nx
    from matplotlib.figure import Figure

    report = anatomy.report()
    two = anatomy.network is not None
    figure = Figure(figsize=(12.5 if two else 7.5, 6.4), layout="constrained")
    axes = figure.subplots(1, 2 if two else 1, squeeze=False)[0]
    graph = nx.DiGraph()
    n = len(anatomy.A)
    graph.add_nodes_from(range(n))
    graph.add_edges_from((int(j), int(i)) for i, j in np.argwhere(anatomy.A != 0) if i != j)
    place = nx.kamada_kawai_layout(nx.Graph(graph)) if n <= 200 else nx.spring_layout(graph, seed=1)
    _draw_states(axes[0], anatomy, report, graph, place, n <= most_labels)
    if two:
        _draw_network(axes[1], anatomy, report)
    figure.suptitle(anatomy.title, fontsize=13)
    return figure


def _draw_states(ax: Any, anatomy: Anatomy, report: dict[str, Any], graph: Any, place: Any, labels: bool) -> None:
    import networkx as nx

    n = len(graph)
    size = 420 if n <= 30 else 130 if labels else 30
    contraction = {s for c in report["contractions"] for s in c}
    parent = {s for c in report["parent_components"] for s in c}
    measured = {s for states in anatomy.measured if len(states) == 1 for s in states}
    kinds = (
        ("in a contraction", contraction, LOOKS["alpha"]),
        ("in a parent component", parent - contraction, LOOKS["beta"]),
        ("neither", set(graph) - contraction - parent, LOOKS["gamma"]),
    )
    links = {"ax": ax, "width": 0.8, "edge_color": "#888888", "node_size": size, "arrowsize": 9 if n <= 60 else 4}
    nx.draw_networkx_edges(graph, place, **links, connectionstyle="arc3,rad=0.08")
    for word, states, (colour, marker) in kinds:
        for ring in (False, True):
            some = [s for s in states if (s in measured) == ring]
            if not some:
                continue
            ax.scatter(
                *np.array([place[s] for s in some]).T,
                s=size,
                c=colour,
                marker=marker,
                edgecolors="black" if ring else "white",
                linewidths=2.2 if ring else 0.8,
                label=f"{word}{', measured' if ring else ''} ({len(some)})",
                zorder=3,
            )
    if labels:
        small = 9 if n <= 30 else 6
        nx.draw_networkx_labels(graph, place, ax=ax, font_size=small, font_color="white")
    ax.set_title(f"system digraph: {n} states, structural rank {report['structural_rank']}", fontsize=11)
    ax.legend(loc="upper center", bbox_to_anchor=(0.5, -0.01), ncols=2, frameon=False, fontsize=9, markerscale=0.6)
    ax.set_axis_off()
    ax.margins(0.08)


def _draw_network(ax: Any, anatomy: Anatomy, report: dict[str, Any]) -> None:
    assert anatomy.network is not None
    count = len(report["agents"])
    angle = 2 * np.pi * np.arange(count) / max(count, 1)
    place = np.column_stack([np.sin(angle), np.cos(angle)])
    for i, j in anatomy.network.edges:
        ax.plot(*place[[i, j]].T, color="#bbbbbb", linewidth=0.8, zorder=1)
    for kind, (colour, marker) in LOOKS.items():
        for needed in (False, True):
            some = [k for k, a in enumerate(report["agents"]) if a["class"] == kind and a["necessary"] == needed]
            if some:
                ax.scatter(
                    *place[some].T,
                    s=170,
                    c=colour,
                    marker=marker,
                    edgecolors="black" if needed else "white",
                    linewidths=2.2 if needed else 0.8,
                    label=f"{kind}{', necessary' if needed else ''} ({len(some)})",
                    zorder=3,
                )
    if count <= 40:
        for k, a in enumerate(report["agents"]):
            side = "left" if place[k, 0] > 0.2 else "right" if place[k, 0] < -0.2 else "center"
            ax.annotate(a["agent"], place[k] * 1.1, ha=side, va="center", fontsize=9)
    ax.set_title("network: classes of the agents", fontsize=11)
    ax.legend(loc="upper center", bbox_to_anchor=(0.5, -0.01), ncols=2, frameon=False, fontsize=9, markerscale=0.8)
    ax.set_aspect("equal")
    ax.set_axis_off()
    ax.margins(0.22, 0.15)
