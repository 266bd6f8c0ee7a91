"""What a filter says of every sensor, over the whole run."""

import datetime as dt
from typing import Any

import matplotlib.dates
import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from numpy.typing import NDArray

from garrison.figures.style import LOOKS, axes, date_ticks, plain, time_label, times
from garrison.record import Run
from garrison.scenario import Scenario
from garrison.verdict import Verdict

_DATES: Any = matplotlib.dates  # matplotlib has no types for it
#: rows that can be read; of more agents those are shown that are accused first
_MOST = 24
#: height of a bar by its verdict: no two differ by colour alone, and nothing is drawn where nothing is measured
_HEIGHTS = {Verdict.CLEARED: 0.1, Verdict.NOT_TESTED: 0.25, Verdict.SUSPECTED: 0.5, Verdict.ATTACKED: 0.8}


def verdict_figure(scenario: Scenario, run: Run, figure: Any = None) -> Any:
    """A row per sensor with a bar where it is accused, a lower one where it is not (first trial)."""
    assert run.verdict is not None
    verdicts = np.asarray(run.verdict)[0, 1:]
    accused = run.first_accused()
    agents = sorted(sorted(range(verdicts.shape[1]), key=lambda k: accused.get(k, len(verdicts)))[:_MOST])
    figure = figure or Figure(figsize=(9.2, 0.32 * len(agents) + 1.5), layout="constrained")
    ax = axes(figure)
    at = _numbers(times(scenario, np.arange(1, len(verdicts) + 2)))
    found = [v for v in _HEIGHTS if (verdicts[:, agents] == v).any()]
    for row, agent in enumerate(agents):
        for verdict in found:
            spells = [(at[a], at[b] - at[a]) for a, b in _spells(verdicts[:, agent] == verdict)]
            look = {"color": LOOKS[verdict][1], "linewidth": 0.8}
            ax.broken_barh(spells, (row - _HEIGHTS[verdict] / 2, _HEIGHTS[verdict]), **look)
    for attack in scenario.attacks:
        ax.axvline(at[min(attack.start, len(at)) - 1], color="black", linewidth=0.8, linestyle=(0, (2, 2)))
    ax.set_yticks(range(len(agents)), [plain(scenario.names[k]) for k in agents], fontsize=8)
    ax.set_ylim(len(agents) - 0.4, -0.6)
    ax.set_xlim(at[0], at[-1])
    ax.set_xlabel(time_label(scenario))
    date_ticks(ax, scenario)
    handles = [Patch(color=LOOKS[v][1], label=LOOKS[v][2]) for v in found]
    ax.legend(handles=handles, loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=4, frameon=False, fontsize=8)
    return figure


def _numbers(moments: Any) -> NDArray[np.float64]:
    """Times as numbers of the axis, one more than there are samples: where the last one ends."""
    if isinstance(moments[0], dt.date):
        found = np.asarray(_DATES.date2num(moments), dtype=float)
        found[-1] = 2 * found[-2] - found[-3] if len(found) > 2 else found[-2] + 1.0
        return found
    return np.asarray(moments, dtype=float)


def _spells(holds: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """First sample of every uninterrupted stretch, and the one after it."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], holds, [False]]).astype(int)))
    return [(int(a), int(b)) for a, b in edges.reshape(-1, 2)]
