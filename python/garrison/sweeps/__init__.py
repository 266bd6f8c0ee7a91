"""Sweeps: a scenario over a grid of values and many trials, on one process, several, or a cluster."""

from garrison.sweeps.grid import parsed, points_of
from garrison.sweeps.run import Sweep, sweep

__all__ = ["Sweep", "parsed", "points_of", "sweep"]
