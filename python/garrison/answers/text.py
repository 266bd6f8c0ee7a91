"""An analysis in words, and as rows of a table."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from garrison.answers.limits import Limit, listed
from garrison.words import count

if TYPE_CHECKING:
    from garrison.answers.additions import Addition
    from garrison.answers.analysis import Analysis

#: states whose widths are listed one by one
_MOST_STATES = 6


def sentences(analysis: Analysis) -> list[str]:
    """The answers, a sentence each, the most important first."""
    lines = [analysis.title] if analysis.title else []
    lines += [f"How many of the {count(len(analysis.sensors), 'sensor')} may lie:"]
    lines += [f"- {limit.guarantee}: {number(limit)}{reason(limit)}" for limit in analysis.limits]
    lines.append(_critical(analysis))
    lines.append(_links(analysis))
    lines += [_unseen(analysis)]
    if analysis.harm:
        level = analysis.harm[0]["failure"]
        harm = "; ".join(
            f"{count(h['liars'], 'liar')} {h['error']:.4g}{_per_state(h['per_state'])}" for h in analysis.harm
        )
        lines.append(
            "What liars who stay the same can do to a bank of Kalman filters at most, as an error in the long run, at "
            f"{level:g} a sample: {harm}."
        )
    lines += [f"So that {addition.goal}: {what_to_add(addition)}" for addition in analysis.additions]
    lines += analysis.advice
    lines += [f"The time was too short for: {words}." for words in analysis.unfinished]
    return lines


def _per_state(widths: dict[str, float]) -> str:
    """The same of every state, where a sentence holds them."""
    if not 1 < len(widths) <= _MOST_STATES:
        return ""
    return f" ({', '.join(f'{name} {width:.4g}' for name, width in widths.items())})"


def number(limit: Limit) -> str:
    """`2`, `at least 2`, `2 to 5`."""
    if limit.exact:
        return str(limit.holds)
    if limit.fails is None:
        if not limit.why:
            return "any number"
        return f"at least {limit.holds}" if limit.holds else "not known"
    if limit.fails == 0:
        return "none, not even without liars"
    return f"{limit.holds} to {limit.fails - 1}"


def reason(limit: Limit) -> str:
    """What stands in the way of one more, in brackets."""
    return f" ({limit.why})" if limit.why else ""


def what_to_add(addition: Addition) -> str:
    """Names, cost, and whether that is the cheapest."""
    if addition.sensors is None:
        if addition.cheapest:
            return "none of the sensors on offer helps, however many."
        return "nothing was found in the time given."
    if not addition.sensors:
        return "nothing, it is so already."
    names = [
        f"{name} (twice)" if k == 2 else f"{name} ({k} times)" if k > 2 else name for name, k in _counted(addition)
    ]
    word = "the cheapest choice" if addition.cheapest else "not proved the cheapest"
    return f"add {listed(names, 20)}, cost {addition.cost:g}; {word}."


def _counted(addition: Addition) -> list[tuple[str, int]]:
    names = addition.sensors or []
    return [(name, names.count(name)) for name in dict.fromkeys(names)]


def _critical(analysis: Analysis) -> str:
    if analysis.critical:
        return f"Must not fail: {listed(analysis.critical)}; without one of them part of the state is never seen."
    if analysis.over_time.most == 0:
        return "Not even all sensors together show the whole state."
    if analysis.over_time.spare < 1:
        return "Whether a single sensor is critical could not be determined."
    return f"No single sensor is critical: any {analysis.over_time.spare} may fail."


def _links(analysis: Analysis) -> str:
    if not analysis.critical_links and not analysis.critical_agents:
        if analysis.network.directed:
            return "Critical links are not worked out for directed networks."
        return (
            "No single link or agent parts the network." if analysis.network.connected else "The network is in parts."
        )
    links = listed([f"{a} - {b}" for a, b in analysis.critical_links]) or "none"
    agents = listed(analysis.critical_agents) or "none"
    return f"Links whose loss parts the network: {links}. Agents: {agents}."


def _unseen(analysis: Analysis) -> str:
    if analysis.unbounded:
        return f"Can drift without limit, unseen by any detector, alone: {listed(analysis.unbounded)}."
    return "Nobody alone can drift without limit unseen."


def limit_rows(analysis: Analysis) -> list[list[str]]:
    """Guarantee, number of liars, condition, what stands in the way."""
    return [[limit.guarantee, number(limit), limit.needs, limit.why or "-"] for limit in analysis.limits]


def sensor_rows(analysis: Analysis) -> list[list[str]]:
    """Sensor, critical, share that nobody else checks, what it could measure instead."""
    alone = analysis.leverage or [math.nan] * len(analysis.sensors)
    return [
        [
            name,
            "yes" if name in analysis.critical else "no",
            "-" if math.isnan(held) else f"{held:.2f}",
            listed(others) or "-",
        ]
        for name, held, others in zip(analysis.sensors, alone, analysis.substitutes, strict=True)
    ]
