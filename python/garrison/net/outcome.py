"""What a network of daemons did, against the run in one process, and what must hold of it."""

import json
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from garrison import _core
from garrison.net.folder import NodeFolder
from garrison.net.plan import Plan
from garrison.net.processes import Ended

Array = NDArray[np.float64]


@dataclass
class NodeOutcome:
    """One node. Arrays have one entry per sample, nan or False where the node said nothing."""

    name: str
    complete: NDArray[np.bool_]
    said: NDArray[np.bool_]
    bound: Array
    estimate: Array  # (samples, n)
    error: Array
    same: NDArray[np.bool_]  # the estimate is that of the run in one process, bit for bit
    status: dict[str, Any]
    accused: list[str]
    code: int
    took: Array  # ms from the begin of a sample to its end
    complaint: str  # what it said to the service manager, in one line
    memory: int  # bytes resident at the end
    replayed: int = 0
    differ: int = 0


@dataclass
class Outcome:
    """All nodes; `broken` says what did not hold, in sentences."""

    nodes: list[NodeOutcome]
    relay: dict[str, int]
    hijacked: list[str]
    broken: list[str] = field(default_factory=list)
    back: list[float | None] = field(default_factory=list)  # s after every kill until a complete sample
    proved: list[float] = field(default_factory=list)  # s from a liar's first lie, for every node with a proof
    start: float = 0.0  # of sample 0, s since 1970
    cores: float = 0.0  # CPU time of all processes, the relay's, too, per second

    def share(self, name: str) -> float:
        """Of all samples of all nodes: complete, bound (there is one)."""
        values = [np.isfinite(n.bound) if name == "bound" else n.complete for n in self.nodes]
        return float(np.mean(values))


def read_outcome(plan: Plan, nodes: list[NodeFolder], ended: Ended, shares: bool = True) -> Outcome:
    """Read what the nodes printed and logged, and check it. shares: those that the plan expects, too."""
    names = plan.scenario.names
    found = [_node(plan, node, ended) for node in nodes]
    outcome = Outcome(found, ended.relay, [names[a] for a in plan.scenario.hit])
    if plan.liar is not None:
        return outcome  # what holds then is said in liars.py
    outcome.broken = [*_broken_nodes(outcome), *_broken_bits(outcome)]
    outcome.broken += _broken_shares(plan, outcome) if shares else []
    return outcome


def _node(plan: Plan, folder: NodeFolder, ended: Ended) -> NodeOutcome:
    status = ended.statuses[folder.id]
    samples, n = plan.samples, len(plan.reference.initial)
    complete, said = np.zeros(samples, dtype=bool), np.zeros(samples, dtype=bool)
    bound, took, estimate = np.full(samples, np.nan), np.full(samples, np.nan), np.full((samples, n), np.nan)
    for line in (folder.path / "samples.jsonl").read_text().splitlines():
        sample = json.loads(line)
        at = sample["t"] - 1
        if not 0 <= at < samples:
            continue
        said[at], complete[at], took[at] = True, sample["complete"], sample["took_ms"]
        bound[at] = np.nan if sample["bound"] is None else sample["bound"]
        estimate[at] = [np.nan if x is None else x for x in sample["estimate"]]
    run = plan.reference.run
    assert run.estimate is not None
    truth = run.truth[0, 1:] if run.truth is not None else np.full((samples, n), np.nan)
    out = NodeOutcome(
        name=folder.name,
        complete=complete,
        said=said,
        bound=bound,
        estimate=estimate,
        error=np.linalg.norm(estimate - truth, axis=1),
        same=(estimate == run.estimate[0, 1:, folder.id]).all(axis=1),
        status=status,
        accused=[plan.scenario.names[a] for a in status["accused"]],
        code=ended.codes[folder.id],
        took=took,
        complaint=" ".join(ended.said[folder.id].split()),
        memory=ended.memory[folder.id],
    )
    for log in sorted((folder.path / "log").glob("*.mcap")):
        replayed = _core.replay_log(log.read_bytes())
        out.replayed += replayed["estimates"]
        out.differ += replayed["differ"]
    return out


def _broken_nodes(outcome: Outcome) -> list[str]:
    out = []
    for node in outcome.nodes:
        if node.code != 0:
            out.append(f"{node.name} ended with exit code {node.code}, expected 0")
        if node.complaint:
            out.append(f"{node.name} says: {node.complaint}")
        if beyond := int((node.error > node.bound).sum()):
            out.append(f"{node.name}: {beyond} errors beyond the bound, expected none")
        if wrongly := sorted(set(node.accused) - set(outcome.hijacked)):
            out.append(f"{node.name} accuses {', '.join(wrongly)}, whom nobody attacks")
        if contradictions := node.status["counters"]["contradictions"] + node.status["counters"]["disowned"]:
            out.append(f"{node.name}: {contradictions} contradictions between what honest nodes signed and sent")
        if node.differ or not node.replayed:
            out.append(f"{node.name}: {node.differ} of {node.replayed} estimates differ in the replay of its log")
    return out


def _broken_shares(plan: Plan, outcome: Outcome) -> list[str]:
    return [
        f"{name}: {outcome.share(name):.2%} of the samples, expected {least:.2%} or more"
        for name, least in plan.expect.items()
        if outcome.share(name) < least
    ]


def _broken_bits(outcome: Outcome) -> list[str]:
    """As long as no node has missed anything, the network is the run in one process, bit for bit."""
    complete = np.all([node.complete for node in outcome.nodes], axis=0)
    whole = int(np.argmin(complete)) if not complete.all() else len(complete)
    return [
        f"{node.name}: {int((~node.same[:whole]).sum())} estimates other than in one process, before anything was lost"
        for node in outcome.nodes
        if not node.same[:whole].all()
    ]


def write_summary(outcome: Outcome, path: Path) -> None:
    """summary.json."""
    nodes = [
        {
            "name": node.name,
            "complete": float(node.complete.mean()),
            "samples": int(node.said.sum()),
            "same": int(node.same.sum()),
            "accused": node.accused,
            "replayed": node.replayed,
            "differ": node.differ,
            "counters": node.status["counters"],
        }
        for node in outcome.nodes
    ]
    whole = {"broken": outcome.broken, "relay": outcome.relay, "hijacked": outcome.hijacked, "nodes": nodes}
    path.write_text(json.dumps(whole, indent=1) + "\n")
