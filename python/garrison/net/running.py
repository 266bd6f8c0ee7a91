"""A plan carried out: files, processes, page, power cuts, and what came of it."""

import contextlib
import resource
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path

from garrison.certifying.plant import sources_of
from garrison.net.folder import NodeFolder, write_network
from garrison.net.kills import kill_some, seconds_back
from garrison.net.liars import judge_liar
from garrison.net.outcome import Outcome, read_outcome
from garrison.net.plan import Plan
from garrison.net.processes import Processes, wait_until
from garrison.net.web.scene import Scene
from garrison.net.web.server import Server
from garrison.net.web.watcher import Watcher

#: seconds between the start of the processes and sample 0
_LEAD = 2.0


def carry_out(
    plan: Plan,
    folder: Path,
    *,
    programs: str | None = None,
    page: int | None = None,
    kills: int = 0,
    meanwhile: Callable[[Processes, list[NodeFolder]], None] | None = None,
    say: Callable[[str], None] = lambda text: None,
) -> Outcome:
    """Run the plan in the empty `folder`, with a live page on port `page`; `say` hears how it goes.

    meanwhile: called when sample 0 begins, with processes and nodes; should end before the run does.
    """
    start = time.time() + _LEAD
    nodes = write_network(plan, folder, start, programs)
    before = _cpu()
    with Processes(plan, nodes, programs) as processes, _page(plan, nodes, page, say):
        how = (
            "with real-time priority" if processes.priority else "without real-time priority, which is not allowed here"
        )
        size = f"{len(nodes)} daemons, {plan.samples} samples of {plan.period_ms:g} ms"
        say(f"{size}: {plan.seconds:.0f} s, {how}")
        if meanwhile is not None:
            wait_until(processes, start)
            meanwhile(processes, nodes)
        killed = kill_some(processes, plan, start, kills)
        wait_until(processes, start + plan.seconds)
        ended = processes.end()
    outcome = read_outcome(plan, nodes, ended, shares=not kills)  # neighbours of a node that is away miss samples, too
    if plan.liar is not None:
        judge_liar(plan, nodes, outcome, start, programs)
    outcome.start = start
    outcome.cores = (_cpu() - before) / plan.seconds
    outcome.back = [seconds_back(kill, nodes) for kill in killed]
    outcome.broken += [
        f"{nodes[kill.node].name} was killed and had no complete sample after that"
        for kill, seconds in zip(killed, outcome.back, strict=True)
        if seconds is None
    ]
    return outcome


def _cpu() -> float:
    """Seconds of all processes that were started here and have ended."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


@contextlib.contextmanager
def _page(plan: Plan, nodes: list[NodeFolder], port: int | None, say: Callable[[str], None]) -> Iterator[None]:
    """The live page, as long as the context."""
    if port is None:
        yield
        return
    scenario, run = plan.scenario, plan.reference.run
    positions = (
        {} if scenario.positions is None else dict(zip(scenario.names, scenario.positions.tolist(), strict=True))
    )
    truth = None if run.truth is None else run.truth[0, 1:]
    sources = list(dict.fromkeys(sources_of(scenario.model, scenario.names)))
    scene = Scene(scenario.title, positions, [scenario.names[a] for a in scenario.hit], truth, sources)
    watcher = Watcher([node.socket for node in nodes], scene)
    with Server("127.0.0.1", port, watcher) as server:
        say(f"http://127.0.0.1:{server.server_port}/")
        watcher.start()
        serving = threading.Thread(target=server.serve_forever)
        serving.start()
        try:
            yield
        finally:
            server.shutdown()
            serving.join()
            watcher.end()
