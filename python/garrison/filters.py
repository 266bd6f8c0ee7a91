"""The filter families. `garrison list filters` shows their parameters."""

from garrison._core import Filter, Lfre, Saturation, ScalarGain, Structural, make_filter

__all__ = ["Filter", "Lfre", "Saturation", "ScalarGain", "Structural", "make_filter"]
