"""The system digraph with its contractions, parent components and sensors; beside it the network."""

from typing import Any

import numpy as np

from garrison.anatomy import Anatomy
from garrison.figures.style import plain

#: per class: colour and marker
LOOKS = {
    "alpha": ("#D55E00", "s"),
    "beta": ("#0072B2", "o"),
    "gamma": ("#009E73", "^"),
    "relay": ("#888888", "D"),
}


def anatomy_figure(anatomy: Anatomy, most_labels: int = 150) -> Any:
    """The system digraph with contractions, parent components and sensors; beside it the network (extra: plot).

    Parameters
    ----------
    anatomy : Anatomy
        Of garrison.anatomy.
    most_labels : int
        Names are left out where there are more states.

    Returns
    -------
    matplotlib Figure
    """
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
    figure.suptitle(plain(anatomy.title), fontsize=13)
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
            ax.annotate(plain(a["agent"]), place[k] * 1.1, ha=side, va="center", fontsize=9)
    ax.set_title("network: classes of the agents", fontsize=11)
    ax.legend(loc="upper center", bbox_to_anchor=(0.5, -0.01), ncols=2, frameon=False, fontsize=9, markerscale=0.8)
    ax.set_aspect("equal")
    ax.set_axis_off()
    ax.margins(0.22, 0.15)
