"""What a run that is read must look like: axes and kinds of its arrays, types of its lists."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

#: axes that arrays have in common, and those of most
_COMMON = ("trial", "time", "agent")
#: arrays of small whole numbers
_WHOLE = ("verdict", "bound_kind")
#: the only kinds of bytes that are numbers: no texts, no objects
_KINDS = {True: "iu", False: "f"}


def require_arrays(arrays: Mapping[str, NDArray[Any]], named: Mapping[str, tuple[str, ...]], agents: int) -> None:
    """Raise ValueError where an array has other axes than a run's, or no numbers; signals by their prefix.

    named: axes of arrays that have others than most.
    """
    sizes = {"agent": agents}
    for name, values in arrays.items():
        axes = named.get(name, _COMMON)
        if values.ndim != len(axes) or values.dtype.kind not in _KINDS[name in _WHOLE]:
            raise ValueError(f"{name} with {values.ndim} dimensions of {values.dtype}")
        for axis, size in zip(axes, values.shape, strict=True):
            if axis in _COMMON and sizes.setdefault(axis, size) != size:
                raise ValueError(f"{name} of shape {values.shape}, where others have {sizes[axis]} along {axis}")


def require_lists(lists: Mapping[str, Any]) -> None:
    """Raise ValueError where accusations, counters or warnings are of other types than a run's."""
    kinds = {"counters": dict, "made": dict, "warnings": list, "bytes_per_step": (int, float)}
    for name, kind in kinds.items():
        if not isinstance(lists[name], kind):  # type: ignore[arg-type]
            raise ValueError(f"{name} of type {type(lists[name]).__name__}")
    texts = [*lists["warnings"], *lists["counters"]]
    numbers = [*lists["counters"].values()]
    for name in ("accusations", "proved", "details"):
        for trial, time, *rest in lists[name]:
            numbers += [trial, time]
            if not isinstance(rest[-1], list):
                raise ValueError(f"{name} of type {type(rest[-1]).__name__}")
    if not all(isinstance(one, str) for one in texts) or not all(isinstance(one, (int, np.integer)) for one in numbers):
        raise ValueError("words and numbers in each other's place")
