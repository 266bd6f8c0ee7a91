"""The command `garrison-net`: a network of real daemons on this machine."""

import argparse
import contextlib
import sys
import tempfile
import threading
import time
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from garrison import _core
from garrison._commands.terminal import NO, OK, REFUSED, console_for, print_table
from garrison.net.folder import NodeFolder, write_network
from garrison.net.kills import kill_some, seconds_back
from garrison.net.outcome import Outcome, read_outcome, write_summary
from garrison.net.plan import Plan, read_plan
from garrison.net.processes import Processes, wait_until
from garrison.net.web.scene import Scene
from garrison.net.web.server import Server
from garrison.net.web.watcher import Watcher

#: what --attack adds at the relay: shares of all datagrams, and datagrams per second
_ATTACK = {"replay": 0.2, "mutate": 0.2, "forge": 0.2, "flood": 5000.0}
#: seconds between the start of the processes and sample 0
_LEAD = 2.0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="garrison-net",
        description="Networks of real daemons on this machine (127.0.0.1 only).",
        epilog="Exit codes: 0 everything held, 1 something did not, 2 input refused.",
        allow_abbrev=False,
    )
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    up = commands.add_parser("up", help="run a scenario as a network of daemons, and check it", allow_abbrev=False)
    up.add_argument("file", help="network.toml: a scenario, periods, what the network loses")
    up.add_argument("-o", "--out", help="folder for keys, logs and summary.json; default: a temporary one, removed")
    up.add_argument("--page", type=int, metavar="PORT", help="serve a live page on this port of 127.0.0.1; 0 = any")
    up.add_argument(
        "--attack",
        action="store_true",
        help="with somebody in between who has no key: replays, mutants and forgeries, each for a fifth of the "
        "datagrams, and a flood of 5000 a second",
    )
    up.add_argument("--kills", type=int, default=0, help="kill a daemon, and start it again, so many times")
    up.add_argument("--programs", help="folder of garrison-node, garrison-keygen and garrison-relay")
    return parser


def main(argv: list[str] | None = None) -> int:
    """Run the command line; returns the exit code."""
    try:
        args = _parser().parse_args(argv)
    except SystemExit as usage:
        return int(usage.code or 0)
    try:
        plan = read_plan(args.file)
        plan.relay |= _ATTACK if args.attack else {}
        if args.out is not None:
            return up(plan, _empty(Path(args.out)), args.programs, args.page, args.kills)
        with tempfile.TemporaryDirectory(prefix="garrison-net-") as folder:
            return up(plan, Path(folder), args.programs, args.page, args.kills)
    except (_core.Error, OSError) as error:
        print(f"garrison-net: {' '.join(str(error).split())}", file=sys.stderr)
        return REFUSED
    except KeyboardInterrupt:
        return 130


def up(plan: Plan, folder: Path, programs: str | None = None, page: int | None = None, kills: int = 0) -> int:
    """Run the plan in `folder`, with a live page on port `page`; 1 when anything did not hold."""
    if kills:
        plan.expect = {}  # a node that is away misses samples, and so do its neighbours
    start = time.time() + _LEAD
    nodes = write_network(plan, folder, start, programs)
    with Processes(plan, nodes, programs) as processes, _page(plan, nodes, page):
        how = (
            "with real-time priority" if processes.priority else "without real-time priority, which is not allowed here"
        )
        size = f"{len(nodes)} daemons, {plan.samples} samples of {plan.period_ms:g} ms"
        print(f"{size}: {plan.seconds:.0f} s, {how}", flush=True)
        killed = kill_some(processes, plan, start, kills)
        wait_until(processes, start + plan.seconds)
        ended = processes.end()
    outcome = read_outcome(plan, nodes, ended)
    back = [seconds_back(kill, nodes) for kill in killed]
    outcome.broken += [
        f"{nodes[kill.node].name} was killed and had no complete sample after that"
        for kill, seconds in zip(killed, back, strict=True)
        if seconds is None
    ]
    write_summary(outcome, folder / "summary.json")
    show(plan, outcome)
    if known := sorted(seconds for seconds in back if seconds is not None):
        print(f"kills: {len(back)}, back after {np.median(known):.2f} s (median), {known[-1]:.2f} s (longest)")
    return NO if outcome.broken else OK


@contextlib.contextmanager
def _page(plan: Plan, nodes: list[NodeFolder], port: int | None) -> Iterator[None]:
    """The live page, as long as the context."""
    if port is None:
        yield
        return
    scenario, run = plan.scenario, plan.reference.run
    positions = (
        {} if scenario.positions is None else dict(zip(scenario.names, scenario.positions.tolist(), strict=True))
    )
    truth = None if run.truth is None else run.truth[0, 1:]
    scene = Scene(scenario.title, positions, [scenario.names[a] for a in scenario.hit], truth)
    watcher = Watcher([node.socket for node in nodes], scene)
    with Server("127.0.0.1", port, watcher) as server:
        print(f"http://127.0.0.1:{server.server_port}/", flush=True)
        watcher.start()
        serving = threading.Thread(target=server.serve_forever)
        serving.start()
        try:
            yield
        finally:
            server.shutdown()
            serving.join()
            watcher.end()


def show(plan: Plan, outcome: Outcome) -> None:
    """The table, what the relay did, and what did not hold."""
    head = [
        "node",
        "complete",
        "missing",
        "asked",
        "same bits",
        "bound",
        "median",
        "error",
        "worst",
        "accuses",
        "replay",
    ]
    rows = []
    for node in outcome.nodes:
        counters = node.status["counters"]
        rows.append(
            [
                node.name + (" (hijacked)" if node.name in outcome.hijacked else ""),
                f"{int(node.complete.sum())}/{plan.samples}",
                str(counters["missing"]),
                str(counters["wants"]),
                f"{int(node.same.sum())}",
                f"{np.isfinite(node.bound).mean():.1%}",
                _number(np.nanmedian(node.bound)) if np.isfinite(node.bound).any() else "",
                _number(np.nanmean(node.error)) if np.isfinite(node.error).any() else "",
                _number(np.nanmax(node.error)) if np.isfinite(node.error).any() else "",
                " ".join(node.accused),
                f"{node.replayed - node.differ}/{node.replayed}",
            ]
        )
    print_table(plan.scenario.title, head, rows, console_for())
    relay = outcome.relay
    print(
        f"relay: {relay['came']} datagrams, {relay['lost']} lost, {relay['doubled']} doubled; "
        f"complete {outcome.share('complete'):.2%}, with bound {outcome.share('bound'):.2%}"
    )
    if attacks := {word: relay[word] for word in ("replayed", "mutated", "forged", "flooded") if relay[word]}:
        print(
            f"attack: {', '.join(f'{count} {word}' for word, count in attacks.items())}; refused: {_refused(outcome)}"
        )
    for line in outcome.broken:
        print(f"DOES NOT HOLD: {line}")
    if not outcome.broken:
        print("held: errors within bounds, nobody accused wrongly, every log gives the same estimates again")


def _refused(outcome: Outcome) -> str:
    """All nodes' datagrams that nothing came of, by reason."""
    found: Counter[str] = Counter()
    for node in outcome.nodes:
        found.update(node.status["outside"])
        for link in node.status["links"]:
            found.update(link["fates"])
    return ", ".join(f"{count} {fate}" for fate, count in found.most_common() if fate not in ("taken", "handshake"))


def _number(value: np.floating[Any]) -> str:
    return f"{float(value):.3g}"


def _empty(path: Path) -> Path:
    path.mkdir(parents=True, exist_ok=True)
    if any(path.iterdir()):
        raise _core.IoError(f"{path}: got a folder that is not empty, expected a new or an empty one")
    return path
