"""Datagrams of junk at one node, from a process of its own."""

import json
import subprocess

from garrison.net.folder import NodeFolder, free_ports
from garrison.net.processes import Processes, real_time
from garrison.net.programs import RELAY, program


class Flood:
    """So many datagrams a second, for so many seconds. `sent` counts them once the flood is over."""

    def __init__(self, rate: float, seconds: float, programs: str | None) -> None:
        self._rate, self._seconds, self._programs = rate, seconds, programs
        self.sent = 0

    def on_first(self, _processes: Processes, nodes: list[NodeFolder]) -> None:
        """Flood the first node, and return when that is over. The flood goes before other work, and behind nodes."""
        way = f"{free_ports(1)[0]}:{nodes[0].port}"
        words = ["--flood", str(self._rate), "--seconds", str(self._seconds), way]
        command = [*real_time(1), program(RELAY, self._programs), *words]
        done = subprocess.run(command, capture_output=True, text=True, check=True)
        self.sent = int(json.loads(done.stdout)["flooded"])
