"""Rows of real daemons: what they have to meet under loss, attacks, power cuts, floods and load."""

import numpy as np

from garrison.net.accept.clock import clock
from garrison.net.accept.flood import Flood
from garrison.net.accept.plans import band, carried_out, wind
from garrison.net.accept.row import Measured, Row
from garrison.net.outcome import Outcome
from garrison.net.programs import LIAR, WRONG_CLOCK

#: what an attacker without keys adds at the relay: shares of all datagrams, and datagrams per second
ATTACK = {"replay": 0.2, "mutate": 0.2, "forge": 0.2, "flood": 5000.0}

_FLOOD_RATE = 1e5
_MOST_MEMORY = 5.0  # MB


def _said(outcome: Outcome, text: str, met: bool = True) -> Measured:
    return Measured("; ".join([text, *outcome.broken]), met and not outcome.broken)


def _shares(outcome: Outcome) -> str:
    return f"complete {outcome.share('complete'):.2%}, with bound {outcome.share('bound'):.2%}"


def _incomplete(outcome: Outcome) -> int:
    return sum(int((~node.complete).sum()) for node in outcome.nodes)


def _loss(seconds: float, programs: str | None) -> Measured:
    plan = wind(seconds)
    plan.relay |= {"delay_ms": 5.0, "jitter_ms": 2.0}
    outcome = carried_out(plan, programs)
    replayed = sum(node.replayed for node in outcome.nodes)
    lost = f"{outcome.relay['lost']} of {outcome.relay['came']} datagrams lost, {outcome.relay['doubled']} doubled"
    return _said(outcome, f"{_shares(outcome)}; {lost}; {replayed} estimates replayed")


def _attack(seconds: float, programs: str | None) -> Measured:
    plan = wind(seconds)
    plan.relay |= ATTACK
    outcome = carried_out(plan, programs)
    hostile = sum(outcome.relay[what] for what in ("replayed", "mutated", "forged", "flooded"))
    return _said(outcome, f"{_shares(outcome)}; {hostile} hostile datagrams")


def _kills(seconds: float, programs: str | None) -> Measured:
    plan = band(10, 3, 100.0, seconds)
    plan.state_every_s = 1.0
    outcome = carried_out(plan, programs, kills=int(2 * seconds))
    back = sorted(seconds for seconds in outcome.back if seconds is not None)
    text = f"{len(back)} of {len(outcome.back)} back; median {np.median(back):.2f} s, longest {back[-1]:.2f} s"
    return _said(outcome, text, back[-1] <= 1.0)


def _thirty(seconds: float, programs: str | None) -> Measured:
    outcome = carried_out(band(30, 5, 50.0, seconds), programs)
    took = np.concatenate([node.took[np.isfinite(node.took)] for node in outcome.nodes])
    late, incomplete = float(np.quantile(took, 0.999)), _incomplete(outcome)
    text = f"{incomplete} of {len(took)} incomplete or missed, p99.9 {late:.1f} ms, {outcome.cores:.2f} cores"
    return _said(outcome, text, incomplete == 0 and late <= 10.0 and outcome.cores <= 0.5)


def _flood(seconds: float, programs: str | None) -> Measured:
    flood = Flood(_FLOOD_RATE, seconds, programs)
    outcome = carried_out(band(10, 5, 50.0, seconds), programs, meanwhile=flood.on_first)
    rate, incomplete = flood.sent / seconds, _incomplete(outcome)
    text = f"{flood.sent} datagrams of junk at {rate:.0f}/s; {incomplete} samples incomplete, {outcome.cores:.2f} cores"
    return _said(outcome, text, incomplete == 0 and rate >= 0.95 * _FLOOD_RATE)


def _memory(seconds: float, programs: str | None) -> Measured:
    outcome = carried_out(band(10, 5, 50.0, seconds), programs)
    most = max(node.memory for node in outcome.nodes) / 1e6
    return _said(outcome, f"{most:.2f} MB at the end in the largest of {len(outcome.nodes)}", most <= _MOST_MEMORY)


def _equivocation(seconds: float, programs: str | None) -> Measured:
    plan = band(8, 3, 100.0, max(seconds, 10.0))
    plan.relay["loss"] = 0.05
    plan.liar = 3
    outcome = carried_out(plan, programs)
    first = ", ".join(f"{moment:.2f}" for moment in outcome.proved)
    return _said(outcome, f"proofs on {len(outcome.proved)} of 7 honest nodes, after {first} s; verify-proof agrees")


ROWS = (
    Row(
        "loss",
        "wind, 10 % loss, 5 +- 2 ms, 2 % twice: 99.9 % complete, a bound throughout, logs replay to the bit",
        _loss,
        600.0,
    ),
    Row("attack", "wind, loss, and replays, mutants, forgeries, a flood: the same bits", _attack, 60.0),
    Row("kills", "2 kills a second, 10 nodes: all back within a second, states whole, logs replay", _kills, 100.0),
    Row("thirty", "30 nodes, 100 rounds/s: all complete, p99.9 <= 10 ms, <= 0.5 cores", _thirty, 600.0),
    Row("flood", "10 nodes, 100 rounds/s, 1e5 datagrams/s of junk at one of them: all complete", _flood, 60.0),
    Row(
        "equivocation",
        "8 daemons, one tells some neighbours something else and signs both: proved by two within 3 s",
        _equivocation,
        20.0,
        LIAR,
    ),
    Row(
        "clock",
        "10 daemons, one clock steps by an hour both ways: no round with two bodies, back in three samples",
        clock,
        needs=WRONG_CLOCK,
    ),
    Row("memory", "10 nodes, 100 rounds/s: at most 5 MB resident each", _memory, 60.0),
)
