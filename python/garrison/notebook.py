"""What notebooks show: short HTML tables of models, networks, checks, fits and runs."""

from __future__ import annotations

import html
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np

from garrison import _core
from garrison.words import count

if TYPE_CHECKING:
    from garrison.checks import Check
    from garrison.record import Run

#: rows of a matrix, or of a table, that are shown
_MOST = 12


def table(rows: Iterable[Iterable[Any]], head: Iterable[str] = ()) -> str:
    """An HTML table; every cell is escaped."""
    lines = ["<tr>" + "".join(f"<th>{html.escape(h)}</th>" for h in head) + "</tr>"] if head else []
    lines += ["<tr>" + "".join(f"<td>{html.escape(str(cell))}</td>" for cell in row) + "</tr>" for row in rows]
    return f"<table>{''.join(lines)}</table>"


def titled(title: str, body: str) -> str:
    """A table under its title."""
    return f"<div><strong>{html.escape(title)}</strong>{body}</div>"


def _number(value: float) -> str:
    return "not known" if np.isnan(value) else f"{value:.4g}"


def of_model(model: _core.Model, changes: str = "") -> str:
    """Sizes, the states with units and their row of A, and what is known of the noise; what changes in time."""
    units, A = model.units, np.asarray(model.A)
    sizes = (count(model.states, "state"), count(model.agents, "agent"), count(model.outputs, "output"))
    names = list(model.state_names)[:_MOST]
    rows = [(s, units.get(s, ""), " ".join(f"{v:.4g}" for v in A[k, :_MOST])) for k, s in enumerate(names)]
    bounds = np.asarray(model.measurement_bound)
    noise = [
        ("process bound", _number(float(model.process_bound))),
        ("measurement bound", _number(float(bounds.max())) if bounds.size else "not known"),
    ]
    title = f"Model: {', '.join(sizes)}" + (f"; {changes}" if changes else "")
    return titled(title, table(rows, ("state", "unit", "row of A")) + table(noise))


def of_network(network: _core.Network, changes: str = "") -> str:
    """Sizes, connectivity and who hears whom; what changes in time."""
    names = list(network.names) or [str(i) for i in range(network.agents)]
    links = len(network.edges)
    kind = "directed" if network.directed else "undirected"
    title = f"Network: {count(network.agents, 'agent')}, {count(links, 'link')} ({kind})"
    if not network.connected:
        title += ", NOT CONNECTED"
    title += f"; {changes}" if changes else ""
    shown = range(min(network.agents, _MOST))
    rows = [(names[i], ", ".join(names[j] for j in network.neighbours(i))) for i in shown]
    if network.agents > _MOST:
        rows.append(("...", ""))
    return titled(title, table(rows, ("agent", "hears")))


def of_check(check: Check, words: Iterable[str]) -> str:
    """Conditions with their verdicts, then quantities."""
    rows = [
        (word, c["name"], f"{c['value']:.6g}", f"needs {c['needed']}: {c['meaning']}")
        for word, c in zip(words, check.conditions, strict=True)
    ]
    rows += [("", q["name"], f"{q['value']:.6g}", q["meaning"]) for q in check.quantities]
    title = "Check: all required conditions are met" if check.holds else "Check: a required condition is NOT MET"
    return titled(title, table(rows, ("", "name", "value", "meaning")))


def of_run(run: Run) -> str:
    """The filter, errors and bounds, alarms, counters that are not zero, and warnings."""
    rows: list[tuple[str, str]] = [("filter", repr(run.filter))]
    if run.error is not None:
        rows.append(("error", f"mean {run.error[:, 1:].mean():.4g}, largest {run.error[:, 1:].max():.4g}"))
    if run.bound is not None:
        exists = np.isfinite(run.bound[:, 1:])
        words = f", least {run.bound[:, 1:][exists].min():.4g}" if exists.any() else ""
        rows.append(("certified bound", f"at {exists.mean():.0%} of the samples{words}"))
    if run.verdict is not None:
        alarms = run.alarms()
        agents = sorted({a.name or str(a.agent) for a in alarms})
        rows.append(("alarms", f"{len(alarms)}: {', '.join(agents)}" if alarms else "none"))
    rows += [(name, str(value)) for name, value in run.counters.items() if value]
    rows += [("warning", words) for words in run.warnings]
    return titled(repr(run), table(rows))
