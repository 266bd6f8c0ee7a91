"""A daemon whose wall clock steps by an hour, forwards and back, and is right again."""

import struct
import time
from pathlib import Path

import numpy as np

from garrison.net.accept.plans import band, carried_out
from garrison.net.accept.row import Measured
from garrison.net.folder import NodeFolder
from garrison.net.outcome import Outcome
from garrison.net.processes import Processes
from garrison.net.programs import WRONG_CLOCK, program

_NODE = 4
_HOUR = 3_600_000_000  # microseconds
#: seconds that the clock is right before a step, and that it is wrong
_CALM, _WRONG = 3.0, 2.0
_SAMPLES_BACK = 3


class Steps:
    """Steps the clock of one node; `right` has the moments (seconds since 1970) at which it was right again."""

    def __init__(self) -> None:
        self.right: list[float] = []

    def __call__(self, _processes: Processes, nodes: list[NodeFolder]) -> None:
        """An hour ahead and right again, an hour behind and right again."""
        for hour in (_HOUR, -_HOUR):
            time.sleep(_CALM)
            set_clock(nodes[_NODE].clock, hour)
            time.sleep(_WRONG)
            set_clock(nodes[_NODE].clock, 0)
            self.right.append(time.time())


def set_clock(path: Path, offset: int) -> None:
    """How wrong it is from now on, in microseconds; the file is mapped, so it is written in place."""
    with path.open("r+b") as file:
        file.write(struct.pack("=q", offset))


def clock(_seconds: float, programs: str | None) -> Measured:
    """Steps of an hour, both ways."""
    plan = band(10, 3, 100.0, 3 * _CALM + 2 * _WRONG + 1)
    plan.wrong_clock = program(WRONG_CLOCK, programs)
    steps = Steps()
    outcome = carried_out(plan, programs, meanwhile=steps)
    back = [_samples_until_complete(outcome, moment, plan.period_ms / 1000) for moment in steps.right]
    bodies = sum(link["fates"].get("conflict", 0) for node in outcome.nodes for link in node.status["links"])
    seen = outcome.nodes[_NODE].status["counters"]["clock_steps"]
    text = f"{seen} steps seen; complete again after {back} samples; {bodies} second bodies for a round"
    met = bodies == 0 and seen >= 2 * len(back) and all(samples <= _SAMPLES_BACK for samples in back)
    return Measured("; ".join([text, *outcome.broken]), met and not outcome.broken)


def _samples_until_complete(outcome: Outcome, moment: float, period: float) -> int:
    """From the sample that had begun when the clock was right again to the node's next complete one."""
    begun = int((moment - outcome.start) / period)
    later = np.flatnonzero(outcome.nodes[_NODE].complete[begun:])  # entry k is sample k + 1
    return int(later[0]) + 1 if later.size else 1_000_000
