"""The files of a network of nodes: keys, roster, parts of the design, and a folder for every node."""

import socket
import subprocess
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from garrison.net.plan import Plan
from garrison.net.programs import KEYGEN, program


@dataclass
class NodeFolder:
    """One node's files, and the ports of 127.0.0.1: where it listens, and where others send to it."""

    id: int
    name: str
    path: Path
    port: int
    outside: int

    @property
    def settings(self) -> Path:
        """node.toml."""
        return self.path / "node.toml"

    @property
    def socket(self) -> Path:
        """Of its status."""
        return self.path / "node.sock"


def write_network(plan: Plan, folder: Path, start: float, programs: str | None) -> list[NodeFolder]:
    """Write everything into `folder`; the first sample begins one period after `start`, seconds since 1970."""
    names, agents = plan.scenario.names, plan.scenario.model.agents
    ports = _free_ports(2 * agents)
    nodes = [NodeFolder(i, names[i], folder / names[i], ports[i], ports[agents + i]) for i in range(agents)]
    keys = []
    for node in nodes:
        node.path.mkdir()
        command = [program(KEYGEN, programs), str(node.path / "node.key")]
        keys.append(subprocess.run(command, check=True, capture_output=True, text=True).stdout.strip())
    (folder / "roster.toml").write_text(_roster(plan, nodes, keys, start))
    for node in nodes:
        plan.reference.prepared.save(node.path / "part.gdesign", agent=node.id)
        np.savetxt(node.path / "sensor.csv", plan.reference.sensor(node.id), fmt="%.17g", delimiter=",")
        node.settings.write_text(_settings(node))
    return nodes


def _free_ports(count: int) -> list[int]:
    """Ports that nobody listens at just now."""
    with ExitStack() as stack:
        found = []
        for _ in range(count):
            one = stack.enter_context(socket.socket(socket.AF_INET, socket.SOCK_DGRAM))
            one.bind(("127.0.0.1", 0))
            found.append(int(one.getsockname()[1]))
        return found


def _roster(plan: Plan, nodes: list[NodeFolder], keys: list[str], start: float) -> str:
    heard: list[list[int]] = [[] for _ in nodes]
    for sender, receiver in plan.scenario.network.edges:
        heard[receiver].append(sender)
        if not plan.scenario.network.directed:
            heard[sender].append(receiver)
    lines = ["[run]", f"start = {int(start * 1e6)}  # microseconds since 1970", f"period_ms = {plan.period_ms!r}"]
    lines += [f"{key} = {value!r}" for key in ("round_ms", "resend_ms") if (value := getattr(plan, key)) is not None]
    lines.append(f"initial = {plan.reference.initial.tolist()}")
    for node, key in zip(nodes, keys, strict=True):
        lines += ["", "[[agent]]", f"id = {node.id}", f'name = "{node.name}"', key]
        lines += [f'address = "127.0.0.1:{node.outside}"', f"hears = {sorted(heard[node.id])}"]
    return "\n".join([*lines, ""])


def _settings(node: NodeFolder) -> str:
    return f"""name = "{node.name}"
part = "part.gdesign"
roster = "../roster.toml"
key = "node.key"
[listen]
address = "127.0.0.1:{node.port}"
[sensor]
source = "file"
path = "sensor.csv"
[clock]
require_synchronised = false
[socket]
path = "node.sock"
"""
