"""The questions that tables, pictures and reports ask of a family."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any


def _as_it_comes(liars: int, threshold: float) -> dict[str, Any]:
    return {}


@dataclass(frozen=True)
class Family:
    """Answers of one family. accuses: filters with these parameters may accuse sensors; None: their runs show it.

    proves: an accusation is a proof under the filter's assumptions (else an alarm, false at a chosen rate).
    own_plants: every agent drives a plant of its own, states have an agent axis. picture: name of the figure of a run
    in garrison.figures. contest: parameters in a comparison with so many liars; threshold: what clean innovations stay
    below. least_attacked: the fewest liars that its parameter `attacked` takes.
    """

    accuses: Callable[[dict[str, Any]], bool] | None = None
    proves: bool = False
    own_plants: bool = False
    picture: str = "network"
    contest: Callable[[int, float], dict[str, Any]] = _as_it_comes
    least_attacked: int = 0
