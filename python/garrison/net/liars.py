"""What must hold of a network in which one daemon lies with its keys: it is convicted, and nobody else is."""

import subprocess
from pathlib import Path

import numpy as np

from garrison.net.folder import NodeFolder
from garrison.net.outcome import Outcome
from garrison.net.plan import Plan
from garrison.net.programs import CTL, program

#: statements are about a second or a sample, whichever is longer, and at most so many samples (docs/node.md)
_MOST_IN_BATCH = 64
#: batches from the first lie to the proof, and nodes that must have one
_WITHIN, _WITNESSES = 3, 2


def judge_liar(plan: Plan, nodes: list[NodeFolder], outcome: Outcome, start: float, programs: str | None) -> None:
    """Write into `outcome` what did not hold, and the seconds from the first lie to every node's first proof.

    start: of sample 0, seconds since 1970. Bounds and bits are not asked for: filters take senders for honest.
    """
    assert plan.liar is not None
    honest = [node for node in nodes if node.id != plan.liar]
    found = {node.name: _proofs(node) for node in honest}
    outcome.broken += [line for node in honest for line in _wrong(outcome, node)]
    for paths in found.values():
        outcome.broken += [f"{path.name} convicts an honest node" for path in paths if _convicted(path) != plan.liar]
        outcome.broken += [f"{path.name}: verify-proof refuses it" for path in paths if not _verified(path, programs)]
    period = plan.period_ms / 1000
    firsts = [min(path.stat().st_mtime for path in paths) for paths in found.values() if paths]
    outcome.proved = sorted(moment - (start + period) for moment in firsts)
    allowed = _WITHIN * period * min(_MOST_IN_BATCH, max(1, int(1 / period)))
    in_time = sum(seconds <= allowed for seconds in outcome.proved)
    if in_time < _WITNESSES:
        outcome.broken.append(f"{in_time} nodes have a proof within {allowed:g} s, expected {_WITNESSES} or more")


def _proofs(node: NodeFolder) -> list[Path]:
    return sorted((node.path / "state" / "proofs").glob("*.proof"))


def _convicted(path: Path) -> int:
    """The file's name is SENDER-START-SAMPLE."""
    return int(path.name.split("-")[0])


def _verified(path: Path, programs: str | None) -> bool:
    roster = path.parents[3] / "roster.toml"
    command = [program(CTL, programs), "verify-proof", str(path), str(roster)]
    return subprocess.run(command, capture_output=True).returncode == 0


def _wrong(outcome: Outcome, node: NodeFolder) -> list[str]:
    found = outcome.nodes[node.id]
    out = []
    if found.code != 0:
        out.append(f"{node.name} ended with exit code {found.code}, expected 0")
    if found.differ or not found.replayed:
        out.append(f"{node.name}: {found.differ} of {found.replayed} estimates differ in the replay of its log")
    if infinite := int((~np.isfinite(found.estimate[found.said])).sum()):
        out.append(f"{node.name}: {infinite} numbers of its estimates are not finite")
    return out
