"""What is measured, row by row, with the bar of each: `garrison-net accept`."""

import subprocess
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from garrison.net.outcome import Outcome
from garrison.net.plan import Plan, read_plan
from garrison.net.programs import HOSTILE, NODE, SIMULATION, program
from garrison.net.running import carry_out

#: what an attacker without keys adds at the relay: shares of all datagrams, and datagrams per second
ATTACK = {"replay": 0.2, "mutate": 0.2, "forge": 0.2, "flood": 5000.0}

_PLANT = """
[model]
A = [[0.99, 0.05], [-0.05, 0.97]]
C = {rows}
process_bound = 0.02
measurement_bound = 0.01
[network]
kind = "band"
range = 2
[filter]
name = "saturation"
threshold = 1.5
rounds = {rounds}
[run]
steps = {steps}
seed = 1
x0 = [1.0, 1.0]
"""


@dataclass
class Row:
    """One row. bar: what has to be met; run(seconds): what was measured, and whether it is met."""

    name: str
    bar: str
    run: Callable[[float, str | None], tuple[str, bool]]
    needs: str = NODE  # a program; rows of programs that are not installed are left out unless they are named


#: where the examples are: in a checkout, or from the package garrison-doc
_EXAMPLES = (Path(__file__).parents[3] / "examples", Path("/usr/share/doc/garrison/examples"))


def _wind() -> Plan:
    paths = [folder / "wind" / "network.toml" for folder in _EXAMPLES]
    plan = read_plan(next((path for path in paths if path.is_file()), paths[0]))
    plan.expect = {"complete": 0.999, "bound": 1.0}
    return plan


def _made(folder: Path, agents: int, rounds: int, period_ms: float, seconds: float) -> Plan:
    """A plan of so many agents on a band, for so long."""
    rows = [[1, 0] if i % 2 == 0 else [0, 1] for i in range(agents)]
    steps = max(20, int(1000 * seconds / period_ms))
    (folder / "scenario.toml").write_text(_PLANT.format(rows=rows, rounds=rounds, steps=steps))
    (folder / "network.toml").write_text(f'scenario = "scenario.toml"\n[run]\nperiod_ms = {period_ms}\n')
    return read_plan(folder / "network.toml")


def _carried_out(plan: Plan, programs: str | None, kills: int = 0) -> Outcome:
    with tempfile.TemporaryDirectory(prefix="garrison-net-") as folder:
        return carry_out(plan, Path(folder), programs=programs, kills=kills)


def _said(outcome: Outcome, text: str, met: bool = True) -> tuple[str, bool]:
    return "; ".join([text, *outcome.broken]), met and not outcome.broken


def _shares(outcome: Outcome) -> str:
    return f"complete {outcome.share('complete'):.2%}, with bound {outcome.share('bound'):.2%}"


def _loss(seconds: float, programs: str | None) -> tuple[str, bool]:
    outcome = _carried_out(_wind(), programs)
    return _said(outcome, f"{_shares(outcome)}; {outcome.relay['lost']} of {outcome.relay['came']} datagrams lost")


def _attack(seconds: float, programs: str | None) -> tuple[str, bool]:
    plan = _wind()
    plan.relay |= ATTACK
    outcome = _carried_out(plan, programs)
    hostile = sum(outcome.relay[what] for what in ("replayed", "mutated", "forged", "flooded"))
    return _said(outcome, f"{_shares(outcome)}; {hostile} hostile datagrams")


def _kills(seconds: float, programs: str | None) -> tuple[str, bool]:
    with tempfile.TemporaryDirectory(prefix="garrison-net-") as folder:
        outcome = _carried_out(_made(Path(folder), 10, 3, 100.0, seconds), programs, kills=int(2 * seconds))
    back = sorted(seconds for seconds in outcome.back if seconds is not None)
    text = f"{len(back)} of {len(outcome.back)} back; median {np.median(back):.2f} s, longest {back[-1]:.2f} s"
    return _said(outcome, text, back[-1] <= 1.0)


def _thirty(seconds: float, programs: str | None) -> tuple[str, bool]:
    with tempfile.TemporaryDirectory(prefix="garrison-net-") as folder:
        outcome = _carried_out(_made(Path(folder), 30, 5, 50.0, seconds), programs)
    took = np.concatenate([node.took[np.isfinite(node.took)] for node in outcome.nodes])
    late = float(np.quantile(took, 0.999))
    incomplete = sum(int((~node.complete).sum()) for node in outcome.nodes)
    text = f"{incomplete} of {len(took)} incomplete or missed, p99.9 {late:.1f} ms, {outcome.cores:.2f} cores"
    return _said(outcome, text, incomplete == 0 and late <= 10.0 and outcome.cores <= 0.5)


def _flood(seconds: float, programs: str | None) -> tuple[str, bool]:
    with tempfile.TemporaryDirectory(prefix="garrison-net-") as folder:
        plan = _made(Path(folder), 10, 5, 50.0, seconds)
    plan.relay["flood"] = 20_000.0
    outcome = _carried_out(plan, programs)
    incomplete = sum(int((~node.complete).sum()) for node in outcome.nodes)
    return _said(
        outcome, f"{outcome.relay['flooded']} datagrams of junk; {incomplete} samples incomplete", incomplete == 0
    )


def _outsiders(seconds: float, programs: str | None) -> tuple[str, bool]:
    return _printed([program(HOSTILE, programs)])


def _seeds(seconds: float, programs: str | None) -> tuple[str, bool]:
    return _printed([program(SIMULATION, programs), "1", str(int(10 * seconds))])


def _printed(command: list[str]) -> tuple[str, bool]:
    done = subprocess.run(command, capture_output=True, text=True)
    return "\n      ".join(done.stdout.splitlines()), done.returncode == 0


ROWS = (
    Row("outsiders", "1e5 replayed, 1e6 forged, 1e6 mutated, 1e6 strangers: none taken", _outsiders, HOSTILE),
    Row("seeds", "10 seeds of simulated faults per second of --seconds: nothing wrong", _seeds, SIMULATION),
    Row("loss", "wind, 10 % loss: 99.9 % complete, a bound throughout, logs replay to the bit", _loss),
    Row("attack", "the same with replays, mutants, forgeries, a flood: the same bits", _attack),
    Row("kills", "2 kills a second, 10 nodes: all back within a second, logs replay", _kills),
    Row("thirty", "30 nodes, 100 rounds/s: all complete, p99.9 <= 10 ms, <= 0.5 cores", _thirty),
    Row("flood", "10 nodes, 100 rounds/s, 2e4 datagrams/s of junk: all complete", _flood),
)
