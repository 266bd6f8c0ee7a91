"""What a filter tests, agent by agent."""

import numpy as np
from matplotlib.figure import Figure

from garrison.figures.style import date_ticks, dot_alone, log_scale, plain, time_label, times
from garrison.record import Run
from garrison.scenario import Scenario

_MOST_AGENTS = 24


def innovation_figure(scenario: Scenario, run: Run, before: int = 30, after: int = 60) -> Figure:
    """Statistic against threshold, agent by agent, around the first attack, else the first accusation (first trial).

    Without both, over the whole run. At most 24 agents.

    Parameters
    ----------
    scenario : Scenario
        Of the run: names, dates, attacks.
    run : Run
        With reports (keep "report").
    before, after : int
        Samples that are shown before and after.

    Returns
    -------
    matplotlib Figure
    """
    assert run.statistic is not None and run.threshold is not None
    samples = run.statistic.shape[1] - 1
    hit, accused = set(scenario.hit), run.first_accused()
    start = scenario.first_attack if scenario.attacks else min(accused.values(), default=None)
    low, high = (1, samples) if start is None else (max(1, min(start - before, samples)), min(samples, start + after))
    at = np.arange(low, high + 1)
    agents = range(min(run.statistic.shape[2], _MOST_AGENTS))
    columns = 3
    lines = -(-len(agents) // columns)
    figure = Figure(figsize=(9.2, max(1.55 * lines + 0.9, 2.8)), layout="constrained")
    first = None
    for k in agents:
        ax = figure.add_subplot(lines, columns, k + 1, sharex=first, sharey=first)
        first = first or ax
        ax.spines[["top", "right"]].set_visible(False)
        ax.plot(times(scenario, at), run.statistic[0, at, k], color="#0072B2", linewidth=1, label="statistic")
        ax.plot(
            times(scenario, at),
            run.threshold[0, at, k],
            color="#D55E00",
            linewidth=1.4,
            linestyle="--",
            label="threshold",
        )
        for line in ax.get_lines():
            dot_alone(line)
        if k in accused and low <= accused[k] <= high:
            when = times(scenario, np.array([accused[k]]))[0]
            ax.plot([when], [run.statistic[0, accused[k], k]], marker="X", color="#D55E00", markersize=8)
        note = " (attacked)" if k in hit else ""
        weight = "bold" if k in hit else "normal"
        ax.set_title(f"{plain(scenario.names[k])}{note}", fontsize=9, loc="left", fontweight=weight)
        log_scale(ax, run.statistic[0, at, k])
        ax.tick_params(labelsize=7)
        date_ticks(ax, scenario, most=5)
    figure.supylabel("test statistic", fontsize=9)
    figure.supxlabel(f"{time_label(scenario) or 'date'} (solid: statistic; dashed: threshold; X: accused)", fontsize=9)
    return figure
