"""What the fuzz calls: every public function, class, method and property, and the arguments that each one takes."""

from __future__ import annotations

import functools
import inspect
import re
import types
from collections.abc import Iterator
from typing import Any

import garrison as gr
from fuzz_samples import samples
from garrison import _core

#: names that are not called, with the reason
EXCLUDED: dict[str, str] = {
    "garrison.StoredRun": "made by simulate and replay with `to`; its arguments are theirs",
    "garrison.Run": "made by simulate, replay and load; its arguments are theirs",
    "garrison.Verdict": "an enumeration of Python's own",
    "garrison.BoundKind": "the same",
}

Parameter = tuple[str, bool, bool]  # name, required, keyword only


def parameters(function: Any) -> list[Parameter]:
    """(name, required, keyword only) of what `function` takes; from its documentation where it is bound."""
    try:
        known = [
            p
            for p in inspect.signature(function).parameters.values()
            if p.kind not in (p.VAR_KEYWORD, p.VAR_POSITIONAL)
        ]
        return [(p.name, p.default is p.empty, p.kind is p.KEYWORD_ONLY) for p in known]
    except (TypeError, ValueError):
        pass
    source = function.__init__ if isinstance(function, type) else function
    line = (source.__doc__ or "").split("\n")[0]
    inside = re.search(r"\((.*)\) ->", line)
    if not inside:
        return []
    flat = inside[1]
    while (less := re.sub(r"\[[^\[\]]*\]|\([^()]*\)|'[^']*'", "", flat)) != flat:
        flat = less
    found, keyword_only = [], False
    for part in flat.split(","):
        name = part.split(":")[0].split("=")[0].strip()
        if name == "*":
            keyword_only = True
        elif name and name != "self":
            found.append((name, "=" not in part, keyword_only))
    return found


def bare(function: Any) -> Any:
    """Without the object that it is bound to."""
    return function.func if isinstance(function, functools.partial) else function


def takes(function: Any) -> list[Parameter]:
    """`parameters` without self where that is given."""
    found = parameters(bare(function))
    return found[1:] if isinstance(function, functools.partial) and found and found[0][0] == "self" else found


def public() -> Iterator[tuple[str, str, Any]]:
    """(name, module, callable) of all public functions, classes, methods and properties."""
    modules = {"garrison": gr}
    for module in (_core, gr):
        for key, value in vars(module).items():
            if (
                isinstance(value, types.ModuleType)
                and value.__name__.startswith("garrison")
                and not key.startswith("_")
                and (module is _core or key in gr.__all__)  # the other modules of the package are its own affair
            ):
                modules[value.__name__] = value
    modules["garrison._core"] = _core
    seen: set[int] = set()
    for where, module in modules.items():
        names = getattr(module, "__all__", None) or [k for k in vars(module) if not k.startswith("_")]
        for key in names:
            value = getattr(module, key)
            if (
                not callable(value)
                or id(value) in seen
                or not str(getattr(value, "__module__", "")).startswith("garrison")
            ):
                continue
            seen.add(id(value))
            if isinstance(value, type) and issubclass(value, BaseException):
                continue
            short = where.rsplit(".", 1)[-1]
            yield f"{where}.{key}", short, value
            if isinstance(value, type):
                yield from methods(f"{where}.{key}", short, value)


def methods(name: str, owner: str, cls: type) -> Iterator[tuple[str, str, Any]]:
    """Methods and properties of a class, called on its samples."""
    found = samples()
    mine = [x for group in found.values() for x in group if type(x) is cls]
    for key, value in vars(cls).items():
        if key.startswith("_") and key not in ("__repr__", "__eq__", "__hash__"):
            continue
        if isinstance(value, staticmethod):
            yield f"{name}.{key}", owner, value.__func__
        elif isinstance(value, property) and not isinstance(value.fget, types.FunctionType):
            yield f"{name}.{key}", owner, value.fget
        elif callable(value):
            for one in mine:
                yield f"{name}.{key}", owner, functools.partial(getattr(type(one), key), one)
