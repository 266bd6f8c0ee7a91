"""Values of Python as JSON and back: what JSON has no form for is a table with one entry, named by its kind."""

import base64
import datetime
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from garrison.words import refusal

#: in front of the names of kinds; tables whose keys begin like this are written as lists of pairs
_MARK = "garrison:"
#: lists within lists; nobody writes more, but a list that holds itself has no end
_DEEPEST = 100
#: of arrays whose bytes are all there is to them: numbers, flags, times and texts
_ARRAYS = "biufcmMSU"
_EXPECTED = (
    "numbers, texts, bytes, dates, paths, arrays, lists, tuples, sets and dicts of these, or models, networks and "
    "filters of garrison"
)


class Kind(NamedTuple):
    """A type, and how its values become plain data and are made again."""

    name: str
    type: type
    write: Callable[[Any], Any]
    read: Callable[[Any], Any]
    derived: bool = True
    """Whether values of derived types are meant, too; they may hold more than is written."""

    def has(self, value: Any) -> bool:
        """Whether the value is of this kind."""
        return isinstance(value, self.type) if self.derived else type(value) is self.type


def _write_array(array: Any) -> dict[str, Any]:
    data = base64.b64encode(np.ascontiguousarray(array).tobytes()).decode()
    return {"dtype": array.dtype.str, "shape": list(array.shape), "data": data}


def _read_array(plain: dict[str, Any]) -> Any:
    flat = np.frombuffer(base64.b64decode(plain["data"]), dtype=np.dtype(plain["dtype"]))
    return flat.reshape(plain["shape"]).copy()


_SCALARS = (
    Kind("complex", complex, lambda x: [x.real, x.imag], lambda x: complex(*x), False),
    Kind("bytes", bytes, lambda x: base64.b64encode(x).decode(), base64.b64decode, False),
    Kind("datetime", datetime.datetime, datetime.datetime.isoformat, datetime.datetime.fromisoformat, False),
    Kind("date", datetime.date, datetime.date.isoformat, datetime.date.fromisoformat, False),
    Kind("path", Path, str, Path),
    Kind("number", np.generic, _write_array, lambda plain: _read_array(plain)[()]),
    Kind("array", np.ndarray, _write_array, _read_array, False),
)
_LISTS: dict[str, Any] = {"tuple": tuple, "set": set, "frozenset": frozenset}


def encoded(where: str, value: Any, objects: Iterable[Kind] = (), depth: int = 0) -> Any:
    """The value as plain data; objects: kinds besides those of Python.

    Raises InvalidInput, with `where` and the place in it, for what a file does not hold.
    """
    if depth > _DEEPEST:
        raise refusal(where, "lists within lists, or one that holds itself", f"at most {_DEEPEST} of them")

    def inside(place: str, one: Any) -> Any:
        return encoded(f"{where}{place}", one, objects, depth + 1)

    if value is None or type(value) in (bool, int, float, str):
        return value
    if type(value) is list:
        return [inside(f"[{k}]", one) for k, one in enumerate(value)]
    for name, of in _LISTS.items():
        if type(value) is of:
            return {_MARK + name: [inside(f"[{k}]", one) for k, one in enumerate(value)]}
    if type(value) is dict:
        pairs = [(key, inside(f"[{key!r}]", one)) for key, one in value.items()]
        if all(type(key) is str and not key.startswith(_MARK) for key in value):
            return dict(pairs)
        return {_MARK + "table": [[inside(": a key", key), one] for key, one in pairs]}
    if isinstance(value, (np.ndarray, np.generic)) and value.dtype.kind not in _ARRAYS:
        raise refusal(where, f"an array of {value.dtype} entries", "one of numbers, flags, times or texts")
    for kind in (*_SCALARS, *objects):
        if kind.has(value):
            return {_MARK + kind.name: kind.write(value)}
    raise refusal(
        where, f"an object of type {type(value).__name__}", _EXPECTED, "a file holds nothing else; pickle may"
    )


def decoded(plain: Any, objects: Iterable[Kind] = ()) -> Any:
    """The value that was encoded. Raises KeyError, TypeError or ValueError for anything else."""
    if isinstance(plain, list):
        return [decoded(one, objects) for one in plain]
    if not isinstance(plain, dict):
        return plain
    key, content = next(iter(plain.items()), ("", []))
    if not key.startswith(_MARK):
        return {key: decoded(one, objects) for key, one in plain.items()}
    name = key.removeprefix(_MARK)
    if name in _LISTS:
        return _LISTS[name](decoded(content, objects))
    if name == "table":
        return {decoded(key, objects): decoded(one, objects) for key, one in content}
    return {kind.name: kind for kind in (*_SCALARS, *objects)}[name].read(content)
