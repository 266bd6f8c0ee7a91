"""The questions that tables, pictures and reports ask of a family."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any


def _nobody(params: dict[str, Any]) -> bool:
    return False


@dataclass(frozen=True)
class Family:
    """Answers of one family. accuses: filters with these parameters may accuse sensors.

    accused: how an accusation is called in a table; proves: an accusation is a proof under the filter's assumptions.
    own_plants: every agent drives a plant of its own, states have an agent axis. picture: name of the figure of a run
    in garrison.figures. suspects: how "suspected" is called.
    """

    accuses: Callable[[dict[str, Any]], bool] = _nobody
    accused: str = "accused"
    proves: bool = False
    own_plants: bool = False
    picture: str = "network"
    suspects: str = "clipped"
