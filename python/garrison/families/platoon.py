"""Vehicles in a string: every agent drives a plant of its own, and measures the one ahead."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from garrison import _core
from garrison.families.family import Family

Array = NDArray[np.float64]
#: sets that a vehicle keeps, in the order of what is known: harmless, open, proved
SETS = ("free", "suspected", "attacked")


@dataclass(frozen=True)
class World:
    """Facts of a string that its pictures need. period: s; spacing: m."""

    vehicles: int
    period: float
    spacing: float
    inputs: bool  # the measurements carry the applied inputs

    @property
    def places(self) -> list[int]:
        """Columns of the measurements with the absolute positions."""
        width = 5 if self.inputs else 4
        first = 3 if self.inputs else 2
        return [0, *(first + width * k for k in range(self.vehicles - 1))]


def world_of(model: _core.Model, filter: _core.Filter) -> World:
    """The string that `model` and `filter` describe."""
    inputs = model.outputs > 4 * model.agents - 2
    return World(model.agents, float(model.A[0, 1]), float(filter.params["spacing"]), inputs)


PLATOON = Family(
    accuses=lambda params: bool(params["detector"]),
    proves=True,
    own_plants=True,
    picture="string",
    least_attacked=1,
)
PLATOON_BASELINE = Family(accuses=lambda params: False, own_plants=True, picture="string")
