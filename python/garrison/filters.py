"""The filter families. `garrison list filters` shows their parameters."""

from garrison._core import (
    Dkf,
    Filter,
    Lfre,
    PartialSharing,
    Platoon,
    PlatoonBaseline,
    Rdkf,
    Saturation,
    ScalarGain,
    Structural,
    make_filter,
)

__all__ = [
    "Dkf",
    "Filter",
    "Lfre",
    "PartialSharing",
    "Platoon",
    "PlatoonBaseline",
    "Rdkf",
    "Saturation",
    "ScalarGain",
    "Structural",
    "make_filter",
]
