"""When a run said that a sensor is attacked, or held it back: its verdicts as intervals."""

from collections.abc import Iterator
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from garrison.verdict import Verdict

_ALARMS = (Verdict.SUSPECTED, Verdict.ATTACKED)


class Alarm(NamedTuple):
    """The samples start <= t < stop of one trial in which an agent's verdict was the same alarm.

    agent: its number; name: its name, or "". verdict: SUSPECTED (its measurement was limited) or ATTACKED.
    """

    trial: int
    agent: int
    name: str
    start: int
    stop: int
    verdict: Verdict

    def __repr__(self) -> str:
        return f"garrison.alarms.Alarm({', '.join(f'{key}={value!r}' for key, value in self._asdict().items())})"


def intervals(verdict: NDArray[np.uint8], names: list[str]) -> Iterator[Alarm]:
    """Alarms of verdicts (trial, time, agent), by trial, start and agent."""
    for trial, table in enumerate(verdict):
        found = []
        for agent, line in enumerate(table.T):
            cuts = [0, *(np.flatnonzero(np.diff(line)) + 1).tolist(), len(line)]
            for start, stop in pairwise(cuts):
                kind = Verdict(int(line[start]))
                if kind in _ALARMS:
                    found.append(Alarm(trial, agent, names[agent] if names else "", start, stop, kind))
        yield from sorted(found, key=lambda a: (a.start, a.agent))
