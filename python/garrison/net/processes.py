"""Starts the daemons and the relay, waits, and ends what it started, by its handle and nothing else."""

import json
import os
import shutil
import subprocess
import time
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from garrison import _core
from garrison.net.client import Client
from garrison.net.folder import NodeFolder
from garrison.net.memory import resident
from garrison.net.plan import Plan
from garrison.net.programs import LIAR, NODE, RELAY, program

#: seconds for a process to end after it was asked to
_PATIENCE = 10.0


@dataclass
class Ended:
    """What a network left: exit code and last status of every node, and the relay's counters."""

    codes: list[int]
    said: list[str]  # on their standard error
    memory: list[int]  # bytes, before they were asked to end
    statuses: list[dict[str, Any]]
    relay: dict[str, int]


class Processes:
    """The daemons of a network, and the relay between them: a context, at whose end none is left."""

    def __init__(self, plan: Plan, nodes: list[NodeFolder], programs: str | None) -> None:
        self._plan, self._nodes, self._programs = plan, nodes, programs
        self._stack = ExitStack()
        #: what the commands begin with: real-time priority where that is allowed, as the service unit gives it
        self.priority = real_time()
        self._daemons: list[subprocess.Popen[bytes]] = []

    def __enter__(self) -> Self:
        with ExitStack() as stack:
            self._relay = self._started(stack, self._relay_command(), self._nodes[0].path.parent / "relay.json")
            self._daemons = [self._node(stack, node) for node in self._nodes]
            self._stack = stack.pop_all()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._stack.close()

    def require_running(self) -> None:
        """Raise IoError with what it said when one has ended already."""
        for process, path in self._all():
            if process.poll() is not None:
                said = path.with_suffix(".err").read_text(errors="replace").strip()
                raise _core.IoError(f"{path.parent.name}: got an end with exit code {process.returncode}: {said}")

    def id_of(self, k: int) -> int:
        """Of the process of node k."""
        return self._daemons[k].pid

    def kill(self, k: int) -> None:
        """End node k at once, as a power cut would."""
        self._daemons[k].kill()
        self._daemons[k].wait()

    def restart(self, k: int) -> None:
        """Start node k again, with the files that it left."""
        self._daemons[k] = self._node(self._stack, self._nodes[k])

    def end(self) -> Ended:
        """Ask for every status, end all of them, and collect what they leave."""
        statuses = [Client(node.socket).status() for node in self._nodes]
        memory = [resident(process.pid) for process in self._daemons]
        for process in self._daemons:
            process.terminate()
        codes = [_awaited(process) for process in self._daemons]
        self._relay.terminate()
        _awaited(self._relay)
        relay = json.loads((self._nodes[0].path.parent / "relay.json").read_text())
        said = [(node.path / "samples.err").read_text(errors="replace") for node in self._nodes]
        return Ended(codes, said, memory, statuses, relay)

    def _relay_command(self) -> list[str]:
        relay = self._plan.relay
        options = [f"--{key.replace('_', '-')}={value}" for key, value in relay.items()]
        words = [word for option in options for word in option.split("=")]
        limit = str(self._plan.seconds + 120)
        ways = [f"{node.outside}:{node.port}" for node in self._nodes]
        return [
            *self.priority,
            program(RELAY, self._programs),
            "--seed",
            str(self._plan.seed),
            *words,
            "--seconds",
            limit,
            *ways,
        ]

    def _node(self, stack: ExitStack, node: NodeFolder) -> "subprocess.Popen[bytes]":
        which = LIAR if node.id == self._plan.liar else NODE
        return self._started(
            stack,
            [*self.priority, program(which, self._programs), "--print", str(node.settings)],
            node.path / "samples.jsonl",
            self._surroundings(node),
        )

    def _surroundings(self, node: NodeFolder) -> dict[str, str] | None:
        library = self._plan.wrong_clock
        return None if library is None else {**os.environ, "LD_PRELOAD": library, "GARRISON_CLOCK": str(node.clock)}

    def _started(
        self, stack: ExitStack, command: list[str], out: Path, surroundings: dict[str, str] | None = None
    ) -> "subprocess.Popen[bytes]":
        written = stack.enter_context(out.open("ab"))
        said = stack.enter_context(out.with_suffix(".err").open("ab"))
        process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=written, stderr=said, env=surroundings)
        stack.callback(_end, process)
        return process

    def _all(self) -> list[tuple["subprocess.Popen[bytes]", Path]]:
        nodes = zip(self._daemons, (node.path / "samples.jsonl" for node in self._nodes), strict=True)
        return [(self._relay, self._nodes[0].path.parent / "relay.json"), *nodes]


def real_time(priority: int = 20) -> list[str]:
    """What a command begins with for this priority, by default the service unit's; nothing where it is not allowed."""
    command = ["chrt", "--fifo", str(priority)]
    allowed = shutil.which("chrt") and subprocess.run([*command, "true"], capture_output=True).returncode == 0
    return command if allowed else []


def _awaited(process: "subprocess.Popen[bytes]") -> int:
    try:
        return process.wait(_PATIENCE)
    except subprocess.TimeoutExpired:
        process.kill()
        return process.wait()


def _end(process: "subprocess.Popen[bytes]") -> None:
    if process.poll() is None:
        process.terminate()
        _awaited(process)


def wait_until(processes: Processes, moment: float) -> None:
    """Sleep until `moment`, seconds since 1970, and look at the processes every second."""
    while (left := moment - time.time()) > 0:
        time.sleep(min(left, 1.0))
        processes.require_running()
