"""What a page shows beside the statuses: where nodes are, what is known of the truth."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass
class Scene:
    """What is the same throughout a run.

    title; positions: name -> (x, y), y upwards, any unit; hijacked: names; truth (samples, n) from sample 1 on;
    sources: names of those behind the measurements, by their numbers.
    """

    title: str = "garrison"
    positions: dict[str, tuple[float, float]] = field(default_factory=dict)
    hijacked: list[str] = field(default_factory=list)
    truth: Array | None = None
    sources: list[str] = field(default_factory=list)

    def source(self, number: int) -> str:
        """What a source is called."""
        return self.sources[number] if number < len(self.sources) else f"source {number}"

    def error(self, status: dict[str, Any]) -> float | None:
        """Distance of a status's estimate to the truth of its sample, where that is known."""
        at = status["t"] - 1
        if self.truth is None or not 0 <= at < len(self.truth) or None in status["estimate"]:
            return None
        found = float(np.linalg.norm(np.array(status["estimate"]) - self.truth[at]))
        return found if np.isfinite(found) else None
