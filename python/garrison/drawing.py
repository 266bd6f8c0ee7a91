"""The one way up to the pictures: results draw themselves by it, and nothing else below knows of them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def drawn(picture: str, *what: Any) -> Figure:
    """The figure that garrison.figures makes of something. Raises InvalidInput where matplotlib is not installed."""
    from garrison import figures

    figure: Figure = getattr(figures, picture)(*what)
    return figure


def animated(*what: Any) -> None:
    """Writes the animation that garrison.figures makes of something. Raises as `drawn`."""
    from garrison import figures

    figures.animate(*what)
