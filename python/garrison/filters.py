"""The filter families, one class each. `garrison list filters` shows their parameters."""

from typing import NoReturn

from garrison._core import Filter, filters, make_filter
from garrison._core.filters import *  # noqa: F403  (what the core registers)
from garrison.words import refuse_attribute

#: the name of every family's class
FAMILIES = tuple(name for name, value in vars(filters).items() if isinstance(value, type))

__all__ = ["FAMILIES", "Filter", "make_filter", *FAMILIES]


def __getattr__(name: str) -> NoReturn:
    refuse_attribute(__name__, name, __all__)
