"""What a network of daemons did, for people: the table, what the relay did, and what did not hold."""

from collections import Counter
from typing import Any

import numpy as np

from garrison._commands.terminal import console_for, print_table
from garrison.net.outcome import Outcome
from garrison.net.plan import Plan


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
    if known := sorted(seconds for seconds in outcome.back if seconds is not None):
        print(f"kills: {len(outcome.back)}, back after {np.median(known):.2f} s (median), {known[-1]:.2f} s (longest)")
    if outcome.proved:
        print(f"liar: proved by {len(outcome.proved)} nodes, {outcome.proved[0]:.2f} s after its first lie and later")
    for line in outcome.broken:
        print(f"DOES NOT HOLD: {line}")
    if not outcome.broken and plan.liar is not None:
        print("held: estimates finite, nobody else convicted, every log gives the same estimates again")
    elif not outcome.broken:
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
