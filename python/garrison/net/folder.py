"""The files of a network of nodes: keys, roster, parts of the design, and a folder for every node."""

import math
import re
import socket
import subprocess
import tomllib
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from garrison.importers.toml import document
from garrison.net.plan import Plan
from garrison.net.programs import KEYGEN, program

Array = NDArray[np.float64]
_AFTER_MS = 120_000


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
    def clock(self) -> Path:
        """How wrong its clock is, for plans with `wrong_clock`."""
        return self.path / "clock"

    @property
    def socket(self) -> Path:
        """Of its status."""
        return self.path / "node.sock"


def write_network(plan: Plan, folder: Path, start: float, programs: str | None) -> list[NodeFolder]:
    """Write everything into `folder`; the first sample begins one period after `start`, seconds since 1970."""
    names, agents = plan.scenario.names, plan.scenario.model.agents
    ports = free_ports(2 * agents)
    nodes = [NodeFolder(i, names[i], folder / _place(names, i), ports[i], ports[agents + i]) for i in range(agents)]
    for node in nodes:
        node.path.mkdir()
    keys = [_key(node, programs) for node in nodes]
    (folder / "roster.toml").write_text(_roster(plan, nodes, keys, start))
    for node in nodes:
        plan.reference.prepared.save(node.path / "part.gdesign", agent=node.id)
        np.savetxt(node.path / "sensor.csv", plan.reference.sensor(node.id), fmt="%.17g", delimiter=",")
        if plan.scenario.inputs is not None:
            np.savetxt(node.path / "inputs.csv", _inputs(plan, plan.scenario.inputs), fmt="%.17g", delimiter=",")
        node.settings.write_text(_settings(plan, node))
        node.clock.write_bytes(bytes(8))
    return nodes


def _place(names: list[str], i: int) -> str:
    """Its name where that can be a folder, else its number."""
    plain = all(re.fullmatch(r"\w[\w.-]{0,80}", name) for name in names)
    return names[i] if plain else str(i)


def free_ports(count: int) -> list[int]:
    """Ports that nobody listens at just now."""
    with ExitStack() as stack:
        found = []
        for _ in range(count):
            one = stack.enter_context(socket.socket(socket.AF_INET, socket.SOCK_DGRAM))
            one.bind(("127.0.0.1", 0))
            found.append(int(one.getsockname()[1]))
        return found


def _roster(plan: Plan, nodes: list[NodeFolder], keys: list[str], start: float) -> str:
    run = {"start": int(start * 1e6), "period_ms": plan.period_ms}
    run |= {key: value for key in ("round_ms", "resend_ms") if (value := getattr(plan, key)) is not None}
    agents = [
        {
            "id": node.id,
            "name": node.name,
            "key": key,
            "address": f"127.0.0.1:{node.outside}",
            "hears": heard,
        }
        for node, key, heard in zip(nodes, keys, _heard(plan, len(nodes)), strict=True)
    ]
    return document({"run": run | {"initial": plan.reference.initial.tolist()}, "agent": agents}, [])


def _heard(plan: Plan, agents: int) -> list[list[int]]:
    """Whom every agent hears."""
    heard: list[list[int]] = [[] for _ in range(agents)]
    for sender, receiver in plan.scenario.network.edges:
        heard[receiver].append(sender)
        if not plan.scenario.network.directed:
            heard[sender].append(receiver)
    return [sorted(ids) for ids in heard]


def _inputs(plan: Plan, known: Array) -> Array:
    """Those of the run, and none for as long as the daemons may go on behind it: a node ends with its inputs."""
    return np.vstack([known, np.zeros((math.ceil(_AFTER_MS / plan.period_ms), known.shape[1]))])


def _settings(plan: Plan, node: NodeFolder) -> str:
    known = {} if plan.scenario.inputs is None else {"input": {"source": "file", "path": "inputs.csv"}}
    return document(
        {
            "name": node.name,
            "part": "part.gdesign",
            "roster": "../roster.toml",
            "key": "node.key",
            "listen": {"address": f"127.0.0.1:{node.port}"},
            "sensor": {"source": "file", "path": "sensor.csv"},
            "clock": {"require_synchronised": False},
            "socket": {"path": "node.sock"},
            "state": {"every_s": plan.state_every_s},
        }
        | known,
        [],
    )


def _key(folder: NodeFolder, programs: str | None) -> str:
    """A new key in its folder; its public half."""
    command = [program(KEYGEN, programs), str(folder.path / "node.key")]
    line = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    return str(tomllib.loads(line)["key"])
