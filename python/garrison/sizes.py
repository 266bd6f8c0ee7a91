"""Sizes without sense are refused before anything is allocated."""

import math
import os
from typing import Any

from garrison.words import refusal

#: environment variable that raises (or lowers) the limit, in gigabytes
VARIABLE = "GARRISON_MEMORY_GB"
_STANDARD = 8.0


def limit_bytes() -> float:
    """The most memory that one run, fit or network may ask for."""
    given = os.environ.get(VARIABLE, "")
    try:
        return float(given or _STANDARD) * 1e9
    except ValueError:
        raise refusal(VARIABLE, repr(given), "a number of gigabytes") from None


def require_memory(which: str, got: str, doubles: float, advice: str = "") -> None:
    """Refuse what would take more memory than the limit. doubles: how many numbers it would hold.

    advice: what to do instead.
    """
    size, limit = 8.0 * doubles, limit_bytes()
    if size > limit:
        raise refusal(
            which,
            f"{got}, which would take {size / 1e9:.3g} GB",
            f"at most {limit / 1e9:g} GB",
            f"{advice}{', or ' if advice else ''}set {VARIABLE} if this machine has more",
        )


def require_room(which: str, value: Any, each: float = 1.0) -> None:
    """Refuse what is too large with all its entries, as views of one number may pretend to be, and long ranges.

    each: how many doubles an entry takes.
    """
    shape = getattr(value, "shape", None)
    if isinstance(value, range):
        require_memory(which, f"{value}", each * min(1e18, max(0, (value.stop - value.start) // value.step)))
    elif isinstance(shape, tuple) and all(isinstance(length, int) for length in shape):
        require_memory(which, f"an array of shape {shape}", each * math.prod(shape))
