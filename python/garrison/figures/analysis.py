"""What a network withstands: limits, leverages, and the network with what must not fail."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from garrison.answers.text import number
from garrison.figures.style import axes, plain

if TYPE_CHECKING:
    from garrison.answers import Analysis

_BLUE, _ORANGE, _GREY = "#0072B2", "#D55E00", "#888888"
_MOST_BARS = 40


def analysis_figure(analysis: Analysis) -> Any:
    """Liars that each guarantee stands, certain and perhaps; what each sensor holds alone; the network."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(15, 5.2), layout="constrained")
    _limits(axes(figure, 1, 3, 1), analysis)
    _leverage(axes(figure, 1, 3, 2), analysis)
    _network(figure.add_subplot(1, 3, 3), analysis)
    if analysis.title:
        figure.suptitle(plain(analysis.title), fontsize=13)
    return figure


def _limits(ax: Any, analysis: Analysis) -> None:
    shown = analysis.limits
    for k, limit in enumerate(shown):
        y = len(shown) - 1 - k
        ax.barh(y, limit.holds, height=0.4, color=_BLUE, label="certain" if k == 0 else None)
        last = limit.holds if limit.fails is None else max(limit.fails - 1, 0)
        if last > limit.holds:
            room = last - limit.holds
            ax.barh(y, room, left=limit.holds, height=0.4, color="white", edgecolor=_BLUE, hatch="///", label="perhaps")
        ax.text(0, y + 0.3, plain(limit.guarantee), fontsize=8, va="bottom")
        ax.text(limit.holds, y, f" {number(limit)}", fontsize=9, va="center")
    ax.set_ylim(-0.5, len(shown) - 0.2)
    ax.set_xlim(0, max([*(limit.holds for limit in shown), 1]) * 1.4)
    ax.set_yticks([])
    ax.xaxis.get_major_locator().set_params(integer=True)
    ax.set(xlabel="sensors that may lie", title="what holds for how many liars")
    handles, labels = ax.get_legend_handles_labels()
    found = dict(zip(labels, handles, strict=True))
    ax.legend(found.values(), found.keys(), frameon=False, fontsize=8, loc="lower right")


def _leverage(ax: Any, analysis: Analysis) -> None:
    ax.set_title("share of a reading that nobody checks in one sample", fontsize=11)
    if analysis.leverage is None:
        ax.text(0.5, 0.5, "one sample does not\ndetermine the state", ha="center", transform=ax.transAxes)
        ax.set_axis_off()
        return
    order = np.argsort(analysis.leverage, kind="stable")[::-1][:_MOST_BARS]
    values = np.array(analysis.leverage)[order]
    colours = [_ORANGE if v > 1 - 1e-6 else _BLUE for v in values]
    hatches = ["///" if v > 1 - 1e-6 else "" for v in values]
    ax.bar(range(len(order)), values, color=colours, hatch=hatches, edgecolor="white")
    names = [plain(analysis.sensors[k]) for k in order]
    ax.set_xticks(range(len(order)), names, rotation=60 if len(order) > 6 else 0, fontsize=8)
    ax.set(ylim=(0, 1.05), ylabel="leverage, 1 = nobody checks it")
    if len(analysis.leverage) > _MOST_BARS:
        ax.set_xlabel(f"the {_MOST_BARS} largest of {len(analysis.leverage)}")


def _network(ax: Any, analysis: Analysis) -> None:
    N = analysis.network.agents
    angle = 2 * np.pi * np.arange(N) / max(N, 1)
    place = np.column_stack([np.sin(angle), np.cos(angle)])
    names = analysis.agent_names
    bridges = {frozenset(pair) for pair in analysis.critical_links}
    for i, j in analysis.network.edges if N <= 2000 else []:
        cut = frozenset((names[i], names[j])) in bridges
        ax.plot(*place[[i, j]].T, color=_ORANGE if cut else "#bbbbbb", linewidth=2.2 if cut else 0.8, zorder=1)
    kinds = (
        ("can drift unseen", set(analysis.unbounded), _ORANGE, "X"),
        ("parts the network", set(analysis.critical_agents) - set(analysis.unbounded), "#E69F00", "^"),
        ("neither", set(names) - set(analysis.unbounded) - set(analysis.critical_agents), _BLUE, "o"),
    )
    for word, some, colour, marker in kinds:
        which = [k for k, name in enumerate(names) if name in some]
        if which:
            size = 150 if N <= 60 else 20
            edge = "white" if N <= 400 else "none"  # edges of neighbours would hide all of them
            style = {"s": size, "c": colour, "marker": marker, "edgecolors": edge, "zorder": 3}
            ax.scatter(*place[which].T, label=f"{word} ({len(which)})", **style)
    for k in range(N) if N <= 40 else []:
        side = "left" if place[k, 0] > 0.2 else "right" if place[k, 0] < -0.2 else "center"
        ax.annotate(plain(names[k]), place[k] * 1.12, ha=side, va="center", fontsize=8)
    if bridges:
        ax.plot([], [], color=_ORANGE, linewidth=2.2, label=f"link that parts the network ({len(bridges)})")
    ax.set_title("network", fontsize=11)
    ax.legend(loc="upper center", bbox_to_anchor=(0.5, -0.01), frameon=False, fontsize=8, ncols=2)
    ax.set_aspect("equal")
    ax.set_axis_off()
    ax.margins(0.25, 0.15)
