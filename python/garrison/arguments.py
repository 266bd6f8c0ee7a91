"""Arguments of the public functions, read one by one: each is of the kind that is asked for, or refused by name."""

import inspect
from collections.abc import Callable, Iterable, Mapping
from typing import Any, TypeVar

import numpy as np

from garrison.numeric import Array, numbers, real, whole_of
from garrison.sizes import require_room
from garrison.words import near, refusal, shown

T = TypeVar("T")
_MOST = 2**31 - 1
_HUGE = 1e150
#: doubles that a Python number in a list takes
_NUMBERS = 5.0


def whole(which: str, value: Any, least: int, most: int = _MOST) -> int:
    """A whole number in a range; 3.0 is one."""
    found = whole_of(value)
    if found is None or not least <= found <= most:
        small = most >= _MOST and not (found is not None and found > most)
        words = f"a whole number >= {least}" if small else f"a whole number in {least}..{most}"
        raise refusal(which, shown(value), words)
    return found


def entries(which: str, value: Any, expected: str) -> list[Any]:
    """What a list, an array or another iterable holds; words and mappings are none of them."""
    if isinstance(value, (str, bytes, Mapping)) or not isinstance(value, Iterable) or getattr(value, "ndim", 1) == 0:
        raise refusal(which, shown(value), expected)
    if hasattr(value, "toarray"):
        raise refusal(which, "a sparse matrix", expected, "take .toarray(), or the numbers that are meant")
    require_room(which, value, _NUMBERS)
    return list(value)


def alone(value: Any) -> bool:
    """One number, not an array of them."""
    return whole_of(value) is not None or real(value) is not None or getattr(value, "ndim", 1) == 0


def whole_numbers(which: str, value: Any, least: int = 0) -> list[int]:
    """Whole numbers in a list; one alone is a list of one."""
    found = [value] if alone(value) else entries(which, value, f"a list of whole numbers >= {least}")
    return [whole(f"{which}[{k}]", one, least) for k, one in enumerate(found)]


def number(which: str, value: Any) -> float:
    """A number."""
    found = real(value)
    if found is None:
        raise refusal(which, shown(value), "a number")
    return found


def moderate(which: str, value: Any) -> float:
    """A number >= 0 whose square is a number, too."""
    found = number(which, value)
    if not 0.0 <= found <= _HUGE:
        raise refusal(which, f"{found:g}", f"a number >= 0 and <= {_HUGE:g}")
    return found


def probability(which: str, value: Any) -> float:
    """A number strictly between 0 and 1."""
    found = number(which, value)
    if not 0.0 < found < 1.0:
        raise refusal(which, f"{found:g}", "a probability in (0, 1)")
    return found


def chance(which: str, value: Any) -> float:
    """A probability that may be 0."""
    found = number(which, value)
    if not 0.0 <= found < 1.0:
        raise refusal(which, f"{found:g}", "a probability in [0, 1)", "0 = deterministic")
    return found


def flag(which: str, value: Any) -> bool:
    """True or false."""
    if not isinstance(value, (bool, np.bool_)):
        raise refusal(which, shown(value), "True or False")
    return bool(value)


def text(which: str, value: Any) -> str:
    """Words."""
    if not isinstance(value, str):
        raise refusal(which, shown(value), "words in quotes")
    return value


def texts(which: str, value: Any) -> list[str]:
    """Words in a list; one alone is a list of one."""
    value = [value] if isinstance(value, str) else value
    return [text(f"{which}[{k}]", one) for k, one in enumerate(entries(which, value, "a list of words"))]


def labelled(which: str, value: Any, kind: type[T], expected: str) -> dict[str, T]:
    """Objects of a kind by their labels."""
    if not isinstance(value, Mapping) or not all(isinstance(k, str) for k in value):
        raise refusal(which, shown(value), f"a mapping of labels to {expected}")
    for label, one in value.items():
        if not isinstance(one, kind):
            raise refusal(f"{which}[{label!r}]", shown(one), expected)
    return dict(value)


def choices(which: str, value: Any, known: tuple[str, ...]) -> list[str]:
    """Some of the known words; one word is a list of one."""
    found = [value] if isinstance(value, str) else entries(which, value, f"some of {', '.join(known)}")
    for word in found:
        if not isinstance(word, str) or word not in known:
            advice = near(word, known) if isinstance(word, str) else ""
            raise refusal(which, shown(word), f"some of {', '.join(known)}", advice)
    return found


def callback(which: str, value: Any, takes: str = "(done, total)") -> Any:
    """A function to be called, or None. What it raises itself is its owner's and passes."""
    if value is None:
        return None
    if not callable(value):
        raise refusal(which, shown(value), "a function, or None")

    def call(*given: Any) -> Any:
        try:
            return value(*given)
        except TypeError as error:
            if error.__traceback__ is None or error.__traceback__.tb_next is not None:
                raise
            # nothing of the function itself was reached
            raise refusal(which, f"{shown(value)}, which fails: {error}", f"a function of {takes}") from error

    return call


def require_arguments(which: str, function: Callable[..., Any], takes: tuple[str, ...]) -> None:
    """Refuse a function that cannot be called with so many arguments; what tells nothing of itself may pass."""
    try:
        signature = inspect.signature(function)
    except (TypeError, ValueError):
        return
    try:
        signature.bind(*takes)
    except TypeError as error:
        raise refusal(which, f"a function whose call fails: {error}", f"a function of ({', '.join(takes)})") from None


def table(which: str, value: Any) -> Array:
    """Rows of numbers; a single row is a table of one."""
    rows = numbers(which, value)
    if rows.ndim > 2:
        raise refusal(which, f"{rows.ndim} dimensions", "rows of numbers")
    return rows.reshape(1, -1) if rows.ndim < 2 else rows
