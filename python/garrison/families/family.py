"""The questions that tables, pictures and reports ask of a family."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any


def _as_it_comes(liars: int, threshold: float) -> dict[str, Any]:
    return {}


def _designed(params: dict[str, Any]) -> str:
    return "its gains are designed for one A and C"


@dataclass(frozen=True)
class Family:
    """Answers of one family. accuses: filters with these parameters may accuse sensors; None: their runs show it.

    proves: an accusation is a proof under the filter's assumptions (else an alarm, false at a chosen rate).
    own_plants: every agent drives a plant of its own, states have an agent axis. picture: name of the figure of a run
    in garrison.figures. contest: parameters in a comparison with so many liars; threshold: what clean innovations stay
    below. changing: those that are others where the plant changes in time. least_attacked: the fewest liars that its
    parameter `attacked` takes. linear: why, with these parameters, the plant has to be linear; empty: it need not.
    """

    accuses: Callable[[dict[str, Any]], bool] | None = None
    proves: bool = False
    own_plants: bool = False
    picture: str = "network"
    contest: Callable[[int, float], dict[str, Any]] = _as_it_comes
    changing: dict[str, Any] = field(default_factory=dict)
    least_attacked: int = 0
    linear: Callable[[dict[str, Any]], str] = _designed
