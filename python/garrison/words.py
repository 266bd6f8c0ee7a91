"""How garrison says no: one form of refusal, near names, plurals, the order of arguments."""

import functools
import inspect
from collections.abc import Callable, Iterable
from enum import EnumType, IntEnum
from types import BuiltinFunctionType, FunctionType
from typing import Any, NoReturn, ParamSpec, TypeVar

from garrison import _core

P = ParamSpec("P")
T = TypeVar("T")


def refusal(which: str, got: str, expected: str, advice: str = "") -> _core.InvalidInput:
    """An InvalidInput in the project's form: `<which>: got <got>, expected <expected>; <what to do>`."""
    return _core.InvalidInput(f"{which}: got {got}, expected {expected}{f'; {advice}' if advice else ''}")


def shown(value: Any, most: int = 60) -> str:
    """A value as it may stand in a message: its kind where that matters, one line, not too long."""
    if value is None:
        return "no value"
    if isinstance(value, (type, BuiltinFunctionType, FunctionType)):
        return _kind(value)
    text = repr(str(value)) if isinstance(value, str) else str(value)
    text = " ".join(text.split())
    text = text if len(text) <= most else f"{text[: most - 3]}..."
    if isinstance(value, bool):
        return text.lower()
    if isinstance(value, dict):
        return f"a table {text}"
    return text


def near(name: str, known: Iterable[str]) -> str:
    """Ending of a refusal: the known name that was probably meant, or nothing."""
    known = list(known)
    other_case = (one for one in known if one.casefold() == name.casefold())
    found = next(other_case, "") or (_nearest(name, known) if name.isprintable() else "")
    return f'did you mean "{found}"?' if found else ""


def _nearest(name: str, known: list[str]) -> str:
    try:
        return _core.nearest_name(name, known)
    except _core.Error:  # a wrong GARRISON_MEMORY_GB is refused by what needs memory, not by the import of a module
        return ""


def refuse_attribute(module: str, name: str, known: Iterable[str]) -> NoReturn:
    """The AttributeError of a module that lacks `name`, with the name that was probably meant."""
    known = list(known)
    raise AttributeError("; ".join(filter(None, [f"module {module!r} has no attribute {name!r}", near(name, known)])))


class Hinting(type):
    """The class of our classes: an attribute that a class lacks is refused with the nearest name."""

    def __getattr__(cls, name: str) -> NoReturn:
        refuse_unknown(f"the class {cls.__name__}", name, _names(cls))


class HintingEnum(EnumType):
    """The same for enumerations."""

    def __getattr__(cls, name: str) -> Any:
        members = cls.__dict__.get("_member_map_", {})
        if name in members:  # in Python 3.11 members are found here
            return members[name]
        refuse_unknown(f"the class {cls.__name__}", name, [*members, *_names(cls)])


class Word(IntEnum, metaclass=HintingEnum):
    """Base of our enumerations: their values have words, and print as the code that makes them."""

    @property
    def word(self) -> str:
        """For people: `not tested`."""
        return self.name.lower().replace("_", " ")

    @classmethod
    def _missing_(cls, value: object) -> Any:
        """By its word, as tables and files have it; refused otherwise."""
        for member in cls:
            if isinstance(value, str) and value.strip().lower().replace("_", " ") == member.word:
                return member
        words = [member.word for member in cls]
        advice = near(value, words) if isinstance(value, str) else ""
        raise refusal(cls.__name__, shown(value), f"0..{len(words) - 1} or one of {', '.join(words)}", advice)

    def __getattr__(self, name: str) -> Any:
        return missing(self, name)

    def __repr__(self) -> str:
        return f"garrison.{type(self).__name__}.{self.name}"


def refuse_unknown(owner: str, name: str, known: Iterable[str]) -> NoReturn:
    """The AttributeError of something that lacks `name`, with the public name that was probably meant.

    Names with an underscore in front are questions of libraries, not slips.
    """
    advice = "" if name.startswith("_") else near(name, [one for one in known if not one.startswith("_")])
    raise AttributeError("; ".join(filter(None, [f"{owner} has no attribute {name!r}", advice])))


def _names(cls: type) -> list[str]:
    """Names of a class; `dir` does not tell those of enumerations."""
    return [name for one in cls.__mro__ for name in vars(one)]


def missing(self: Any, name: str) -> Any:
    """`__getattr__` of our classes: called for what an object lacks."""
    if not name.startswith("_") and hasattr(type(self), name):  # a property that failed: its own words
        return object.__getattribute__(self, name)
    return refuse_unknown(f"{type(self).__name__!r} object", name, [*_names(type(self)), *vars(self)])


def only(where: str, names: Iterable[str], known: Iterable[str]) -> None:
    """Refuse names that are not known, with the nearest one."""
    known = list(known)
    for name in names:
        if name not in known:
            words = f"one of {', '.join(known)}" if known else "none"
            raise refusal(where, f"the unknown key {name!r}", words, near(name, known))


def hinted(function: Callable[P, T]) -> Callable[P, T]:
    """`function`, but arguments that it does not have, or that are missing, are refused in our words."""
    return _guarded(function, function.__name__, 0)


def hinted_methods(cls: type[T]) -> type[T]:
    """`cls` with its public methods, its constructor and assignments to its attributes guarded like that.

    Attributes that an object of it lacks are refused with the nearest name; the metaclass Hinting does the same for
    those of the class.
    """
    for key, value in list(vars(cls).items()):
        if key.startswith("_") and key != "__init__":
            continue
        name = cls.__name__ if key == "__init__" else f"{cls.__name__}.{key}"
        guarded: Any = None
        if isinstance(value, (classmethod, staticmethod)):
            bound = 1 if isinstance(value, classmethod) else 0
            guarded = type(value)(_guarded(value.__func__, name, bound))
        elif isinstance(value, FunctionType) and not hasattr(value, "__wrapped__"):
            guarded = _guarded(value, name, 1)
        if guarded is not None:
            setattr(cls, key, guarded)
    plain = cls.__setattr__

    def assign(self: Any, key: str, value: Any) -> None:
        try:
            plain(self, key, value)
        except AttributeError:
            advice = "objects of this class are not changed: make another one"
            raise refusal(f"{cls.__name__}.{key}", "an assignment", "none", advice) from None

    cls.__setattr__ = assign  # type: ignore[method-assign]
    cls.__getattr__ = missing  # type: ignore[attr-defined]
    return cls


def _guarded(function: Callable[P, T], name: str, bound: int) -> Callable[P, T]:
    """bound: arguments in front that Python fills in, self or the class."""
    parameters = list(inspect.signature(function).parameters.values())[bound:]
    own = [p for p in parameters if p.kind not in (p.VAR_POSITIONAL, p.VAR_KEYWORD)]
    known = [p.name for p in own]
    ordered = [p.name for p in own if p.kind is not p.KEYWORD_ONLY]
    needed = [p.name for p in own if p.default is p.empty]
    open_ended = any(p.kind is p.VAR_KEYWORD for p in parameters)
    any_number = any(p.kind is p.VAR_POSITIONAL for p in parameters)
    allowed = f"{len(ordered)} at most; {', '.join(known) or ('all by name' if open_ended else 'there are none')}"

    @functools.wraps(function)
    def guarded(*args: P.args, **keywords: P.kwargs) -> T:
        places = args[bound:]
        if len(places) > len(ordered) and not any_number:
            raise refusal(name, f"{count(len(places), 'argument')} without a name", allowed)
        given = [*ordered[: len(places)], *keywords]
        for one in keywords:
            if one not in known and not open_ended:
                got = f"the unknown argument {one!r}"
                raise refusal(name, got, f"one of {', '.join(known)}" if known else "none", near(one, known))
        if len(set(given)) < len(given):
            twice = next(one for one in given if given.count(one) > 1)
            raise refusal(f"{name}.{twice}", "two values", "one")
        if missing := [one for one in needed if one not in given]:
            raise refusal(name, f"no {', '.join(missing)}", f"{', '.join(needed)}")
        return function(*args, **keywords)

    return guarded


def count(number: int, noun: str, plural: str = "") -> str:
    """`1 trial`, `2 trials`."""
    return f"{number} {noun if number == 1 else plural or noun + 's'}"


def _require_constant(function: str, model: object) -> None:
    kind = type(model).__name__
    if kind in ("VaryingModel", "NonlinearModel"):
        takers = "simulate, replay and compare" if kind == "VaryingModel" else "simulate and replay"
        raise refusal(function, f"a {kind}", "a constant Model", f"{takers} take a {kind}")


def require_plant(function: str, model: object, network: object) -> None:
    """Refuse what is no model and no network, or these in another order."""
    _require_constant(function, model)
    if not isinstance(model, _core.Model) or not isinstance(network, _core.Network):
        raise refusal(function, f"({type(model).__name__}, {type(network).__name__}, ..)", "(model, network, ..)")


def _kind(value: object) -> str:
    """What was given in place of an object of garrison."""
    if isinstance(value, (BuiltinFunctionType, FunctionType)):
        return f"the function {value.__name__}, not called yet"
    return f"the class {value.__name__}, not made yet" if isinstance(value, type) else f"a {type(value).__name__}"


def require_order(function: str, model: object, network: object, filter: object) -> None:
    """Refuse arguments in another order than (model, network, filter), the only one in garrison."""
    kinds = (("model", _core.Model), ("network", _core.Network), ("filter", _core.Filter))
    given = (model, network, filter)
    if all(isinstance(value, kind) for value, (_, kind) in zip(given, kinds, strict=True)):
        return
    _require_constant(function, model)
    got = [next((name for name, kind in kinds if isinstance(v, kind)), _kind(v)) for v in given]
    old = "; the order changed: it is the same everywhere now" if sorted(got) == ["filter", "model", "network"] else ""
    raise _core.InvalidInput(f"{function}: got ({', '.join(got)}), expected (model, network, filter){old}")
