"""What answers have in common: they compare by value, can be kept, and print as the code that makes them."""

import sys
from collections.abc import Mapping
from dataclasses import fields
from pathlib import PurePath
from typing import Any

import numpy as np

from garrison.words import Hinting

#: larger arrays and longer lists are not shown as code, as in numpy
MOST_SHOWN = 1000


def same(a: Any, b: Any) -> bool:
    """Equal in value, whatever is inside; nan is nan."""
    if isinstance(a, np.ndarray) or isinstance(b, np.ndarray):
        a, b = np.asarray(a), np.asarray(b)
        return a.shape == b.shape and bool(np.array_equal(a, b, equal_nan=a.dtype.kind == "f" and b.dtype.kind == "f"))
    if isinstance(a, Mapping) and isinstance(b, Mapping):
        return a.keys() == b.keys() and all(same(a[key], b[key]) for key in a)
    if isinstance(a, (list, tuple)) and isinstance(b, (list, tuple)):
        return type(a) is type(b) and len(a) == len(b) and all(same(x, y) for x, y in zip(a, b, strict=True))
    return bool(a == b) or (a != a and b != b)


def code(value: Any) -> str:
    """The value as code, with `array`, nan and inf as numpy's, Path and datetime; what is large by its size only."""
    if isinstance(value, np.ndarray):
        if value.size > MOST_SHOWN:
            return f"<array of shape {value.shape}>"
        shaped = f".reshape({value.shape})" if value.size == 0 else ""  # lists do not say how wide nothing is
        return f"array({value.tolist()!r}){shaped}"
    if isinstance(value, np.generic):
        return repr(value.item())
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{key!r}: {code(one)}" for key, one in value.items()) + "}"
    if isinstance(value, PurePath):
        return f"Path({str(value)!r})"
    if isinstance(value, list):
        if len(value) > MOST_SHOWN:
            return f"<list of {len(value)}>"
        return "[" + ", ".join(map(code, value)) + "]"
    if isinstance(value, tuple):
        return "(" + "".join(code(one) + "," for one in value) + ")"
    return repr(value)


class Result(metaclass=Hinting):
    """Base of the dataclasses that functions answer with."""

    def _fields(self) -> dict[str, Any]:
        return {f.name: getattr(self, f.name) for f in fields(self)}  # type: ignore[arg-type]

    def __eq__(self, other: object) -> bool:
        return type(other) is type(self) and same(self._fields(), other._fields())

    def __hash__(self) -> int:
        words = (value for value in self._fields().values() if isinstance(value, str))
        return hash((type(self).__name__, *words))

    def __repr__(self) -> str:
        kind = type(self)
        public = getattr(sys.modules["garrison"], kind.__name__, None) is kind
        home = "garrison" if public else kind.__module__
        return f"{home}.{kind.__name__}({', '.join(f'{key}={code(v)}' for key, v in self._fields().items())})"
