"""Bytes against errors."""

import numpy as np
from matplotlib.figure import Figure

from garrison.figures.style import axes
from garrison.resilience import Resilience


def resilience_figure(found: list[Resilience], title: str = "resilience per byte") -> Figure:
    """Bytes per sample against errors, with and without the worst attack.

    Parameters
    ----------
    found : list of Resilience
        As garrison.resilience_per_byte returns them.
    title : str
        Above the picture.

    Returns
    -------
    matplotlib Figure
    """
    figure = Figure(figsize=(7, 4), layout="constrained")
    ax = axes(figure, 1, 1, 1)
    stable = [r for r in found if np.isfinite(r.mse)]
    bytes_per_step = [r.bytes_per_step for r in stable]
    ax.plot(bytes_per_step, [r.mse for r in stable], color="#0072B2", marker="o", label="no attack")
    attacked = [r.mse_attacked for r in stable]
    ax.plot(bytes_per_step, attacked, color="#D55E00", marker="X", linestyle="--", label="attacked")
    for r in stable:
        spot = {"textcoords": "offset points", "xytext": (0, 6), "fontsize": 8}
        ax.annotate(f"l = {r.shared}", (r.bytes_per_step, r.mse_attacked), **spot)
    ax.set(xlabel="bytes per sample, all messages", ylabel="mean squared error", title=title)
    ax.margins(y=0.12)
    ax.legend(frameon=False, fontsize=9)
    return figure
