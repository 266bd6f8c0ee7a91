"""How garrison says no: one form of refusal, near names, plurals, the order of arguments."""

import functools
from collections.abc import Callable, Iterable
from typing import Any, ParamSpec, TypeVar

from garrison import _core

P = ParamSpec("P")
T = TypeVar("T")


def refusal(which: str, got: str, expected: str, advice: str = "") -> _core.InvalidInput:
    """An InvalidInput in the project's form: `<which>: got <got>, expected <expected>; <what to do>`."""
    return _core.InvalidInput(f"{which}: got {got}, expected {expected}{f'; {advice}' if advice else ''}")


def shown(value: Any, most: int = 60) -> str:
    """A value as it may stand in a message: its kind where that matters, one line, not too long."""
    if value is None:
        return "nothing"
    text = repr(value) if isinstance(value, str) else str(value)
    text = " ".join(text.split())
    text = text if len(text) <= most else f"{text[: most - 3]}..."
    if isinstance(value, bool):
        return text.lower()
    if isinstance(value, dict):
        return f"a table {text}"
    return text


def near(name: str, known: Iterable[str]) -> str:
    """Ending of a refusal: the known name that was probably meant, or nothing."""
    found = _core.nearest_name(name, list(known)) if name.isprintable() else ""
    return f'did you mean "{found}"?' if found else ""


def only(where: str, names: Iterable[str], known: Iterable[str]) -> None:
    """Refuse names that are not known, with the nearest one."""
    known = list(known)
    for name in names:
        if name not in known:
            raise refusal(where, f"the unknown key {name!r}", f"one of {', '.join(known)}", near(name, known))


def hinted(function: Callable[P, T]) -> Callable[P, T]:
    """`function`, but a keyword that it does not have is refused with the nearest one that it has."""
    code = function.__code__
    known = code.co_varnames[: code.co_argcount + code.co_kwonlyargcount]

    @functools.wraps(function)
    def guarded(*args: P.args, **keywords: P.kwargs) -> T:
        for name in keywords:
            if name not in known:
                got = f"the unknown argument {name!r}"
                raise refusal(function.__name__, got, f"one of {', '.join(known)}", near(name, known))
        return function(*args, **keywords)

    return guarded


def count(number: int, noun: str, plural: str = "") -> str:
    """`1 trial`, `2 trials`."""
    return f"{number} {noun if number == 1 else plural or noun + 's'}"


def require_order(function: str, model: object, network: object, filter: object) -> None:
    """Refuse arguments in another order than (model, network, filter), the only one in garrison."""
    kinds = (("model", _core.Model), ("network", _core.Network), ("filter", _core.Filter))
    given = (model, network, filter)
    if all(isinstance(value, kind) for value, (_, kind) in zip(given, kinds, strict=True)):
        return
    got = [next((name for name, kind in kinds if isinstance(v, kind)), f"a {type(v).__name__}") for v in given]
    old = "; the order changed: it is the same everywhere now" if sorted(got) == ["filter", "model", "network"] else ""
    raise _core.InvalidInput(f"{function}: got ({', '.join(got)}), expected (model, network, filter){old}")
