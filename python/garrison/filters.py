"""The filter families, one class each. `garrison list filters` shows their parameters."""

from garrison._core import Filter, filters, make_filter
from garrison._core.filters import *  # noqa: F403  (what the core registers)

#: the name of every family's class
FAMILIES = tuple(name for name, value in vars(filters).items() if isinstance(value, type))

__all__ = ["FAMILIES", "Filter", "make_filter", *FAMILIES]
