"""The trade-off of a design: bytes against the certified error."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from matplotlib.figure import Figure

from garrison.figures.style import axes

if TYPE_CHECKING:
    from garrison.designing import Designed


def design_figure(found: Designed) -> Any:
    """The curve over the number of rounds, with the chosen point."""
    figure = Figure(figsize=(7, 4.2), layout="constrained")
    ax = axes(figure, 1, 1, 1)
    curve = found.curve or [found.chosen]
    ax.plot(
        [c.bytes_per_sample for c in curve],
        [c.error for c in curve],
        color="#0072B2",
        marker="o",
        label="best threshold",
    )
    for c in curve:
        spot = {"textcoords": "offset points", "xytext": (0, 6), "fontsize": 7, "ha": "center"}
        ax.annotate(f"{c.rounds}", (c.bytes_per_sample, c.error), **spot)
    spot = {"color": "#D55E00", "marker": "X", "s": 110, "zorder": 3}
    ax.scatter(
        [found.chosen.bytes_per_sample], [found.chosen.error], label=f"chosen: {found.chosen.rounds} rounds", **spot
    )
    ax.set(
        xscale="log", yscale="log", xlabel="bytes per sample, all messages", ylabel="certified error in the long run"
    )
    ax.set_title(f"saturation filter, {found.attacked} liars; numbers: rounds per sample", fontsize=11)
    ax.legend(frameon=False, fontsize=9)
    return figure
