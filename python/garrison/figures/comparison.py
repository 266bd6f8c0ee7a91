"""A comparison as a map: filters down, attacks across, colour and number are the error."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure

from garrison.figures.style import plain

if TYPE_CHECKING:
    from garrison.comparison import Comparison


def comparison_figure(found: Comparison) -> Any:
    """95 % quantiles of the errors; a dash where a filter refuses or an attack does not apply."""
    filters, attacks, numbers = found.table("q95")
    figure = Figure(figsize=(2.6 + 0.72 * len(attacks), 1.8 + 0.42 * len(filters)), layout="constrained")
    ax = figure.add_subplot(1, 1, 1)
    known = numbers[np.isfinite(numbers) & (numbers > 0)]
    low, high = (known.min(), known.max()) if known.size else (1.0, 10.0)
    high = min(high, low * 1e4) if high > low else low * 10
    shades = LogNorm(low, high)
    image = ax.imshow(np.where(numbers > 0, numbers, np.nan), norm=shades, cmap="viridis_r", aspect="auto")
    for i, row in enumerate(numbers):
        for j, value in enumerate(row):
            dark = np.isfinite(value) and value > 0 and shades(value) > 0.5
            word = f"{value:.2g}" if np.isfinite(value) else "-"
            ax.text(j, i, word, ha="center", va="center", fontsize=7, color="white" if dark else "black")
    ax.set_xticks(range(len(attacks)), [plain(a) for a in attacks], rotation=55, ha="right", fontsize=8)
    ax.set_yticks(range(len(filters)), [plain(f) for f in filters], fontsize=8)
    figure.colorbar(image, ax=ax, label="error, 95 % quantile", extend="max")
    liars = ", ".join(str(a) for a in found.attacked)
    ax.set_title(plain(f"{found.title or 'errors'}: agents {liars} attacked"), fontsize=11)
    return figure
