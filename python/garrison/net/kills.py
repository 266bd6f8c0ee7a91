"""Power cuts: daemons that are killed and started again, drawn from a seed."""

import json
import random
import time
from dataclasses import dataclass

from garrison.net.folder import NodeFolder
from garrison.net.plan import Plan
from garrison.net.processes import Processes, wait_until

#: samples without a power cut at the begin, and at the end
_CALM = 10


@dataclass
class Kill:
    """Node `node` was killed, and started again, at `moment` (seconds since 1970)."""

    node: int
    moment: float


def kill_some(processes: Processes, plan: Plan, start: float, count: int) -> list[Kill]:
    """Kill and restart `count` times, evenly over the run; whom is drawn from the plan's seed."""
    chance = random.Random(plan.seed)
    period = plan.period_ms / 1000
    first, last = start + _CALM * period, start + plan.seconds - _CALM * period
    done = []
    for k in range(count):
        wait_until(processes, first + (last - first) * k / count)
        victim = chance.randrange(plan.scenario.model.agents)
        processes.kill(victim)
        processes.restart(victim)
        done.append(Kill(victim, time.time()))
    return done


def seconds_back(kill: Kill, nodes: list[NodeFolder]) -> float | None:
    """From the restart to the end of the node's first complete sample; None = there was none."""
    for line in (nodes[kill.node].path / "samples.jsonl").read_text().splitlines():
        sample = json.loads(line)
        if sample["complete"] and sample["time"] > kill.moment:
            return float(sample["time"]) - kill.moment
    return None
