"""Numbers that an import may assume."""

import math

from garrison.words import refusal


def require_positive(**values: float) -> None:
    """Refuse numbers that are not finite and > 0, by the option that sets them."""
    for name, value in values.items():
        if not (math.isfinite(value) and value > 0.0):
            raise refusal(f"--{name.replace('_', '-')}", f"{value:g}", "a finite number > 0")


def require_probability(name: str, value: float) -> None:
    """Refuse what is no probability strictly between 0 and 1."""
    if not 0.0 < value < 1.0:
        raise refusal(f"--{name}", f"{value:g}", "a probability, > 0 and < 1")
