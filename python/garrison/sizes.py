"""Sizes without sense are refused before anything is allocated."""

import os

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


def require_memory(which: str, got: str, doubles: float) -> None:
    """Refuse what would take more memory than the limit. doubles: how many numbers it would hold."""
    size, limit = 8.0 * doubles, limit_bytes()
    if size > limit:
        raise refusal(
            which,
            f"{got}, which would take {size / 1e9:.3g} GB",
            f"at most {limit / 1e9:g} GB",
            f"set {VARIABLE} if this machine has more",
        )
