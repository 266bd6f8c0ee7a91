"""Figures (extra: plot). Colours are colour-blind safe, and nothing is told apart by colour alone."""

from __future__ import annotations

import datetime as dt
from typing import TYPE_CHECKING, Any

import matplotlib

matplotlib.use("Agg")

import matplotlib.dates
import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

if TYPE_CHECKING:
    from garrison.job import Row
    from garrison.resilience import Resilience
    from garrison.run import Run
    from garrison.scenario import Scenario

_DATES: Any = matplotlib.dates  # matplotlib has no types for it
#: per verdict: marker, colour, word
LOOKS = {
    "cleared": ("o", "#0072B2", "cleared"),
    "suspected": ("^", "#E69F00", "suspected"),
    "attacked": ("X", "#D55E00", "proved attacked"),
    "silent": ("s", "#888888", "no measurement"),
}
_COLOURS = ("#0072B2", "#009E73", "#D55E00", "#444444", "#CC79A7", "#E69F00", "#56B4E9", "#8C6D31")
_DASHES = ("-", "--", "-.", ":", (0, (5, 1)), (0, (3, 1, 1, 1, 1, 1)), (0, (1, 1)))
#: eight colours and seven dashes in turn: 56 lines before two look alike
_LINES = [(_COLOURS[k % len(_COLOURS)], _DASHES[k % len(_DASHES)]) for k in range(len(_COLOURS) * len(_DASHES))]


def _axes(figure: Any, *place: int) -> Any:
    ax = figure.add_subplot(*place)
    ax.spines[["top", "right"]].set_visible(False)
    ax.grid(True, color="#dddddd", linewidth=0.6)
    ax.set_axisbelow(True)
    return ax


#: axes as all figures of the package have them
string_axes = _axes


def _times(scenario: Scenario, samples: NDArray[np.int64]) -> Any:
    """Dates where the scenario has them, else sample numbers."""
    if not scenario.dates:
        return samples
    first = scenario.dates[0] - dt.timedelta(days=1)
    return [first + dt.timedelta(days=int(t)) for t in samples]


def final_verdicts(scenario: Scenario, run: Run) -> list[str]:
    """Per agent: what the network says of it at the end of the first trial."""
    from garrison.run import VERDICTS

    assert run.verdict is not None
    words = [VERDICTS[v] for v in run.verdict[0, -1]]
    accused = run.first_accused()
    return ["attacked" if i in accused else word for i, word in enumerate(words)]


def overview_figure(scenario: Scenario, rows: list[Row], signal: float | None) -> Figure:
    """Map and errors side by side: the run in one picture."""
    figure = Figure(figsize=(13, 5.6), layout="constrained")
    parts: Any = figure.subfigures(1, 2, width_ratios=[1, 1.45])
    left, right = parts
    if rows[0].run is not None and rows[0].run.verdict is not None:
        map_figure(scenario, rows[0].run, left)
    if any(row.error is not None for row in rows):
        error_figure(scenario, rows, signal, right)
    figure.suptitle(scenario.title, fontsize=13)
    return figure


def map_figure(scenario: Scenario, run: Run, figure: Any = None) -> Any:
    """The network at its places: who is attacked in truth (ring), and what the network says of everybody."""
    figure = figure or Figure(figsize=(6.4, 6.2), layout="constrained")
    ax = figure.add_subplot()
    place = scenario.positions
    if place is None:
        angle = 2 * np.pi * np.arange(len(scenario.names)) / len(scenario.names)
        place = np.column_stack([np.sin(angle), np.cos(angle)])
    for i, j in scenario.network.edges:
        ax.plot(*place[[i, j]].T, color="#bbbbbb", linewidth=1, zorder=1)
    hit = {a for attack in scenario.attacks for a in attack.agents}
    verdicts = final_verdicts(scenario, run)
    for word, (marker, colour, label) in LOOKS.items():
        group = [i for i, v in enumerate(verdicts) if v == word]
        if group:
            ax.scatter(*place[group].T, s=170, marker=marker, color=colour, edgecolor="white", zorder=3, label=label)
    if hit:
        ring = sorted(hit)
        ax.scatter(
            *place[ring].T,
            s=520,
            facecolor="none",
            edgecolor="black",
            linewidth=1.4,
            zorder=2,
            label="hijacked in truth",
        )
    for i, name in enumerate(scenario.names):
        full = scenario.places[i] if scenario.places else name
        ax.annotate(
            full,
            place[i],
            xytext=(0, -19),
            textcoords="offset points",
            ha="center",
            va="top",
            fontsize=9,
            zorder=4,
        )
    if scenario.positions is None:
        ax.set_axis_off()
    else:
        ax.set_xlabel("kilometres east of the centre")
        ax.set_ylabel("kilometres north of the centre")
        ax.spines[["top", "right"]].set_visible(False)
    ax.set_aspect("equal")
    ax.margins(0.12)
    ax.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=3, frameon=False, fontsize=9)
    return figure


def error_figure(scenario: Scenario, rows: list[Row], signal: float | None, figure: Any = None) -> Any:
    """Mean error of every filter over time (30-sample mean), with the certified bound of the main one."""
    figure = figure or Figure(figsize=(9.2, 4.6), layout="constrained")
    ax = _axes(figure)
    shown = [row for row in rows if row.error is not None and (row.attacked or not scenario.attacks)]
    for row, (colour, style) in zip(shown, _LINES, strict=False):
        error = np.nanmean(row.error, axis=(0, 2))[1:]  # type: ignore[arg-type]
        width = max(1, min(30, len(error) // 20))
        smooth = np.convolve(error, np.ones(width) / width, mode="valid")
        at = np.arange(width, len(error) + 1)
        ax.plot(_times(scenario, at), smooth, color=colour, linestyle=style, linewidth=1.6, label=row.label)
    bounded = [
        row for row in shown if row.run is not None and row.run.bound is not None and np.isfinite(row.run.bound).any()
    ]
    for row in bounded[:1]:
        bound = row.run.bound[0].max(axis=1)  # type: ignore[union-attr, index]
        index = [r.label for r in shown].index(row.label)
        at = np.arange(1, len(bound))
        ax.plot(
            _times(scenario, at),
            bound[1:],
            color=_LINES[index][0],
            linewidth=3,
            alpha=0.35,
            label="certified bound of the first",
        )
    if signal is not None:
        ax.axhline(signal, color="#999999", linewidth=1)
        ax.annotate(
            "size of the signal itself",
            (1, signal),
            xycoords=("axes fraction", "data"),
            ha="right",
            va="bottom",
            fontsize=8,
            color="#666666",
        )
    for attack in scenario.attacks:
        ax.axvline(_times(scenario, np.array([attack.start]))[0], color="black", linewidth=0.8, linestyle=(0, (2, 2)))
        ax.annotate(
            " attack starts",
            (_times(scenario, np.array([attack.start]))[0], 1),
            xycoords=("data", "axes fraction"),
            va="top",
            fontsize=8,
        )
    ax.set_yscale("log")
    ax.set_ylabel("||estimate - reference||, log scale")
    ax.set_xlabel("" if scenario.dates else "sample")
    ax.legend(loc="upper center", bbox_to_anchor=(0.5, -0.1), ncols=3, frameon=False, fontsize=9)
    return figure


def innovation_figure(scenario: Scenario, run: Run, before: int = 30, after: int = 60) -> Figure:
    """|innovation| against the threshold, agent by agent, around the start of the attack."""
    assert run.statistic is not None and run.threshold is not None and run.verdict is not None
    samples = run.statistic.shape[1] - 1
    start = min((a.start for a in scenario.attacks), default=1)
    low, high = max(1, start - before), min(samples, start + after)
    at = np.arange(low, high + 1)
    agents = range(min(run.statistic.shape[2], 24))
    columns = 3
    lines = -(-len(agents) // columns)
    figure = Figure(figsize=(9.2, 1.55 * lines + 0.6), layout="constrained")
    hit = {a for attack in scenario.attacks for a in attack.agents}
    accused = run.first_accused()
    first = None
    for k in agents:
        ax = figure.add_subplot(lines, columns, k + 1, sharex=first, sharey=first)
        first = first or ax
        ax.spines[["top", "right"]].set_visible(False)
        ax.plot(_times(scenario, at), run.statistic[0, at, k], color="#0072B2", linewidth=1)
        ax.plot(_times(scenario, at), run.threshold[0, at, k], color="#D55E00", linewidth=1.4, linestyle="--")
        if k in accused and low <= accused[k] <= high:
            when = _times(scenario, np.array([accused[k]]))[0]
            ax.plot([when], [run.statistic[0, accused[k], k]], marker="X", color="#D55E00", markersize=8)
        note = " (hijacked)" if k in hit else ""
        ax.set_title(f"{scenario.names[k]}{note}", fontsize=9, loc="left", fontweight="bold" if k in hit else "normal")
        ax.set_yscale("log")
        ax.tick_params(labelsize=7)
        if scenario.dates:
            locator = _DATES.AutoDateLocator(maxticks=4)
            ax.xaxis.set_major_locator(locator)
            ax.xaxis.set_major_formatter(_DATES.ConciseDateFormatter(locator))
    figure.supylabel("|innovation| (solid), threshold (dashed), X = proved attacked", fontsize=9)
    return figure


def run_figure(run: Run, trial: int = 0) -> Figure:
    """Errors with their bounds, and statistics against thresholds, of one trial of any run."""
    figure = Figure(figsize=(8, 6), layout="constrained")
    if run.error is not None:
        ax = _axes(figure, 2, 1, 1)
        error = run.error[trial]
        ax.plot(error.max(axis=1), color="#0072B2", label="largest error of an agent")
        ax.plot(error.mean(axis=1), color="#009E73", linestyle="--", label="mean error")
        if run.bound is not None and np.isfinite(run.bound[trial]).any():
            ax.plot(run.bound[trial].max(axis=1), color="#D55E00", linestyle="-.", label="certified bound")
        ax.set_yscale("log")
        ax.set_ylabel("error")
        ax.legend(frameon=False, fontsize=9)
    if run.statistic is not None and run.threshold is not None:
        ax = _axes(figure, 2, 1, 2)
        ax.plot(run.statistic[trial], color="#0072B2", linewidth=0.6, alpha=0.6)
        ax.plot(run.threshold[trial].max(axis=1), color="#D55E00", linestyle="--", label="largest threshold")
        ax.set_yscale("log")
        ax.set_xlabel("sample")
        ax.set_ylabel("|innovation| per agent")
        ax.legend(frameon=False, fontsize=9)
    return figure


def resilience_figure(found: list[Resilience], title: str = "resilience per byte") -> Figure:
    """Bytes per sample against errors, with and without the worst attack (see garrison.resilience_per_byte)."""
    figure = Figure(figsize=(7, 4), layout="constrained")
    ax = _axes(figure, 1, 1, 1)
    stable = [r for r in found if np.isfinite(r.mse)]
    bytes_per_step = [r.bytes_per_step for r in stable]
    ax.plot(bytes_per_step, [r.mse for r in stable], color="#0072B2", marker="o", label="no attack")
    ax.plot(
        bytes_per_step, [r.mse_attacked for r in stable], color="#D55E00", marker="X", linestyle="--", label="attacked"
    )
    for r in stable:
        ax.annotate(
            f"l = {r.shared}", (r.bytes_per_step, r.mse_attacked), textcoords="offset points", xytext=(0, 6), fontsize=8
        )
    ax.set(xlabel="bytes per sample, all messages", ylabel="mean squared error", title=title)
    ax.margins(y=0.12)
    ax.legend(frameon=False, fontsize=9)
    return figure
