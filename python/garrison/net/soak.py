"""A network that runs for hours under every fault: `garrison-net soak`."""

import random
import time
from dataclasses import dataclass, field

from garrison.net.folder import NodeFolder
from garrison.net.memory import descriptors, resident
from garrison.net.plan import Plan
from garrison.net.processes import Processes, wait_until

#: seconds between two looks at the processes, and between two power cuts on average
_LOOK, _CUT = 5.0, 20.0
_MOST_GROWTH = 1 << 20  # bytes
#: what the network does: shares of the datagrams, ms
WEATHER = {"loss": 0.05, "duplicates": 0.02, "delay_ms": 1.0, "jitter_ms": 1.0}


@dataclass
class Soak:
    """Cuts the power of every second node at random, and watches what the others take of the machine."""

    plan: Plan
    end: float  # seconds since 1970
    cuts: int = 0
    memory: dict[int, list[int]] = field(default_factory=dict)  # bytes of the nodes that are never cut, look by look
    files: dict[int, set[int]] = field(default_factory=dict)

    def __call__(self, processes: Processes, nodes: list[NodeFolder]) -> None:
        """Until the end."""
        chance = random.Random(self.plan.seed)
        cut_at = time.time() + _CUT
        while (now := time.time()) < self.end:
            wait_until(processes, min(now + _LOOK, self.end))
            self._look(processes, nodes)
            if time.time() < cut_at or time.time() > self.end - _CUT:
                continue
            victim = chance.randrange(1, len(nodes), 2)
            processes.kill(victim)
            processes.restart(victim)
            self.cuts += 1
            cut_at += chance.uniform(0.5, 1.5) * _CUT

    def _look(self, processes: Processes, nodes: list[NodeFolder]) -> None:
        for node in nodes[::2]:
            process = processes.id_of(node.id)
            self.memory.setdefault(node.id, []).append(resident(process))
            self.files.setdefault(node.id, set()).add(descriptors(process))

    def growth(self) -> int:
        """Bytes from a quarter of the time to the end, of the node that grew most."""
        return max((seen[-1] - seen[len(seen) // 4] for seen in self.memory.values()), default=0)

    def broken(self) -> list[str]:
        """What did not hold, in sentences."""
        out = []
        if self.growth() > _MOST_GROWTH:
            out.append(f"a node grew by {self.growth()} bytes, expected at most {_MOST_GROWTH}")
        out += [
            f"node {node} had {sorted(counts)} open files, expected always the same number"
            for node, counts in self.files.items()
            if max(counts) - min(counts) > 1  # a file is open for a moment while a snapshot is written
        ]
        return out
