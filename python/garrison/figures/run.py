"""Any run, without a scenario."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from garrison.figures.style import LINES, axes, dot_alone, log_scale, plain, trial_words
from garrison.longform import common_unit
from garrison.record import Run

#: most agents whose statistics have a line with their name each
_NAMED = 8


def run_figure(run: Run, trial: int = 0, agents: list[int] | None = None, compare: Sequence[Run] = ()) -> Figure:
    """Errors with their bounds, and statistics against thresholds, of one trial; its title says which.

    agents: those that are shown; None: all. compare: other runs, whose errors are drawn beside.
    """
    figure = Figure(figsize=(8, 6), layout="constrained")
    shown = slice(None) if agents is None else agents
    panels = [draw for draw in (_errors, _statistics) if draw(run, trial, None, shown)]
    for k, draw in enumerate(panels, start=1):
        ax = axes(figure, len(panels), 1, k)
        draw(run, trial, ax, shown)
        if draw is _statistics and agents is not None and len(agents) <= _NAMED:
            _name_lines(run, ax, agents)
        if draw is _errors:
            _others(compare, trial, ax, shown)
        ax.set_xlabel("sample")
        ax.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=3, frameon=False, fontsize=8)
    names = _names(run)
    who = "" if agents is None else f"agents {', '.join(names[i] for i in agents)}"
    words = ": ".join(w for w in (run.filter.name, trial_words(trial, run.shape[0]), who) if w)
    figure.suptitle(words, fontsize=11)
    return figure


def _names(run: Run) -> list[str]:
    return [plain(n) for n in run.network.names] or [str(i) for i in range(run.network.agents)]


def _name_lines(run: Run, ax: Any, agents: list[int]) -> None:
    """A look and a name for the statistic of each agent, in place of one for all."""
    for line, agent, (colour, style) in zip(ax.get_lines(), agents, LINES, strict=False):
        line.set(color=colour, linestyle=style, alpha=0.9, label=f"statistic of {_names(run)[agent]}")


def _others(runs: Sequence[Run], trial: int, ax: Any, agents: Any) -> None:
    """Mean errors of other runs, in looks that none of this run's lines has."""
    for run, (colour, style) in zip(runs, LINES[4:], strict=False):
        if run.error is not None:
            mean = run.error[trial][:, agents].mean(axis=1)
            ax.plot(mean, color=colour, linestyle=style, label=f"mean error of {plain(run.filter.name)}")


def _drawn(bounds: Any) -> Any:
    """The largest bound of an agent; a gap where some agent has none."""
    largest = bounds.max(axis=1)
    return np.where(np.isfinite(largest), largest, np.nan)


def _errors(run: Run, trial: int, ax: Any, agents: Any) -> bool:
    if run.error is None:
        return False
    if ax is None:
        return True
    error = run.error[trial][:, agents]
    ax.plot(error.max(axis=1), color="#0072B2", label="largest error of an agent")
    ax.plot(error.mean(axis=1), color="#009E73", linestyle="--", label="mean error")
    if run.bound is not None and np.isfinite(run.bound[trial]).any():
        ax.plot(_drawn(run.bound[trial][:, agents]), color="#D55E00", linestyle="-.", label="certified bound")
        if run.published is not None and np.isfinite(run.published[trial]).any():
            published = _drawn(run.published[trial][:, agents])
            ax.plot(published, color="#666666", linestyle=":", label="published bound, where it holds")
    log_scale(ax, error)
    unit = common_unit(run.model)
    ax.set_ylabel(f"error ({plain(unit)})" if unit else "error")
    return True


def _statistics(run: Run, trial: int, ax: Any, agents: Any) -> bool:
    if run.statistic is None or run.threshold is None or not np.isfinite(run.statistic[trial]).any():
        return False
    if ax is None:
        return True
    lines = ax.plot(run.statistic[trial][:, agents], color="#0072B2", linewidth=0.6, alpha=0.6)
    lines[0].set_label("statistic, one line per agent")
    largest = np.fmax.reduce(run.threshold[trial][:, agents], axis=1)  # of those that were tested
    lines += ax.plot(largest, color="#D55E00", linestyle="--", label="largest threshold")
    for line in lines:
        dot_alone(line)
    log_scale(ax, run.statistic[trial])
    ax.set_ylabel("test statistic")
    return True
