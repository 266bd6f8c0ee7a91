"""Figures (extra: plot). Colours are colour-blind safe, and no two things differ by colour alone.

Nothing here touches pyplot or the process's matplotlib backend. Raises InvalidInput where matplotlib is not installed.
"""

from garrison.words import refusal

try:
    import matplotlib as _matplotlib  # noqa: F401
except ImportError:
    raise refusal(
        "figures", "no matplotlib", 'it installed: pip install "garrison[plot]", or Debian\'s python3-matplotlib'
    ) from None

from garrison.figures.analysis import analysis_figure
from garrison.figures.anatomy import anatomy_figure
from garrison.figures.comparison import comparison_figure
from garrison.figures.design import design_figure
from garrison.figures.errors import error_figure
from garrison.figures.innovations import innovation_figure
from garrison.figures.map import map_figure, overview_figure
from garrison.figures.resilience import resilience_figure
from garrison.figures.run import run_figure
from garrison.figures.string import animate, string_figure
from garrison.figures.sweep import sweep_figure
from garrison.figures.verdicts import verdict_figure

__all__ = [
    "analysis_figure",
    "anatomy_figure",
    "animate",
    "comparison_figure",
    "design_figure",
    "error_figure",
    "innovation_figure",
    "map_figure",
    "overview_figure",
    "resilience_figure",
    "run_figure",
    "string_figure",
    "sweep_figure",
    "verdict_figure",
]
