"""What all figures share: axes, colours, markers, times, texts without markup."""

import datetime as dt
from typing import Any

import matplotlib.dates
import numpy as np
from numpy.typing import NDArray

from garrison.scenario import Scenario
from garrison.verdict import Verdict

_DATES: Any = matplotlib.dates  # matplotlib has no types for it
#: per verdict: marker, colour, word
LOOKS = {
    Verdict.CLEARED: ("o", "#0072B2", "cleared"),
    Verdict.SUSPECTED: ("^", "#E69F00", "suspected"),
    Verdict.ATTACKED: ("X", "#D55E00", "accused"),
    Verdict.SILENT: ("s", "#888888", "no measurement"),
    Verdict.NOT_TESTED: ("D", "#CC79A7", "not tested"),
}
_COLOURS = ("#0072B2", "#009E73", "#D55E00", "#444444", "#CC79A7", "#E69F00", "#56B4E9", "#8C6D31")
_DASHES = ("-", "--", "-.", ":", (0, (5, 1)), (0, (3, 1, 1, 1, 1, 1)), (0, (1, 1)))
#: eight colours and seven dashes in turn: 56 lines before two look alike
LINES = [(_COLOURS[k % len(_COLOURS)], _DASHES[k % len(_DASHES)]) for k in range(len(_COLOURS) * len(_DASHES))]


def axes(figure: Any, *place: int) -> Any:
    """Axes as all figures have them."""
    ax = figure.add_subplot(*place)
    ax.spines[["top", "right"]].set_visible(False)
    ax.grid(True, color="#dddddd", linewidth=0.6)
    ax.set_axisbelow(True)
    return ax


def legend_below(figure: Any, handles: Any, columns: int, place: str = "lower center") -> None:
    """One row of a legend below all panels of a constrained figure: "outside", which matplotlib has from 3.7 on."""
    row = _LEGEND / figure.get_figheight()
    figure.set_layout_engine("constrained", rect=(0.0, row, 1.0, 1.0 - row))
    figure.legend(handles=handles, fontsize=8, ncols=columns, loc=place, frameon=False)


_LEGEND = 0.28  # inches, one row of small letters
#: lines that are labelled at their ends; more are told apart in a legend
_MOST_DIRECT = 9
_ROW = 0.058  # of the height of the axes, from one label to the next


def log_scale(ax: Any, values: Any) -> None:
    """A logarithmic vertical axis, where something can be drawn on it."""
    found = np.asarray(values, dtype=float)
    if (np.isfinite(found) & (found > 0)).any():
        ax.set_yscale("log")


def dot_alone(line: Any) -> None:
    """Show the values of a line that have none beside them, which it would pass over, as dots."""
    known = np.isfinite(np.pad(np.asarray(line.get_ydata(orig=False), dtype=float), 1, constant_values=np.nan))
    alone = np.flatnonzero(known[1:-1] & ~known[:-2] & ~known[2:])
    line.set(marker=".", markersize=3, markevery=alone.tolist())


def label_ends(ax: Any) -> None:
    """Write the label of every line at its right end in its colour, none over another; of vertical ones at the top.

    With more lines than can be read that way: a legend below.
    """
    lines = [line for line in ax.get_lines() if not line.get_label().startswith("_") and len(line.get_xdata()) > 0]
    if len(lines) > _MOST_DIRECT:
        ax.legend(loc="upper center", bbox_to_anchor=(0.5, -0.1), ncols=3, frameon=False, fontsize=9)
        return
    ends = []
    for line in lines:
        if _is_vertical(line):
            place, level = line.get_xdata(orig=False)[0], ax.get_xaxis_transform()
            look = {"xytext": (3, -2), "textcoords": "offset points", "va": "top", "fontsize": 8}
            ax.annotate(line.get_label(), (place, 1.0), xycoords=level, color=line.get_color(), **look)
            continue
        y = np.asarray(line.get_ydata(orig=False), dtype=float)
        known = y[np.isfinite(y)]
        if len(known):
            at = ax.transAxes.inverted().transform(ax.transData.transform((0.0, known[-1])))[1]
            ends.append((float(np.clip(at, 0.0, 1.0)), line))
    taken = -1.0
    for at, line in sorted(ends, key=lambda end: end[0]):
        taken = max(at, taken + _ROW)
        look = {"xycoords": "axes fraction", "va": "center", "fontsize": 9, "annotation_clip": False}
        ax.annotate(line.get_label(), (1.01, taken), color=line.get_color(), **look)


def _is_vertical(line: Any) -> bool:
    x = line.get_xdata(orig=False)
    return len(x) == 2 and x[0] == x[1]


def plain(text: str) -> str:
    """Text of a user without mathtext: a dollar is a dollar."""
    return text.replace("$", r"\$")


def times(scenario: Scenario, samples: NDArray[np.int64]) -> Any:
    """Times of samples where the scenario has them (sample 1 is the first record), else the sample numbers."""
    found = scenario.dates
    if not found:
        return samples
    if not isinstance(found[0], dt.date):
        step = scenario.records.step if scenario.records else 1.0
        return [float(found[0]) + step * (int(t) - 1) for t in samples]
    before = found[0] - dt.timedelta(seconds=scenario.records.step if scenario.records else 0.0)
    return [found[int(t) - 1] if 1 <= t <= len(found) else before for t in samples]


def time_label(scenario: Scenario) -> str:
    """Label of the time axis."""
    if not scenario.dates:
        return "sample"
    return "" if isinstance(scenario.dates[0], dt.date) else "time (s)"


def date_ticks(ax: Any, scenario: Scenario, most: int | None = None) -> None:
    """Short dates below a time axis of moments, at most so many; other axes stay as they are."""
    if not scenario.dates or not isinstance(scenario.dates[0], dt.date):
        return
    locator = _DATES.AutoDateLocator(minticks=2 if most else 5, maxticks=most)
    ax.xaxis.set_major_locator(locator)
    ax.xaxis.set_major_formatter(_DATES.ConciseDateFormatter(locator))


def trial_words(trial: int, trials: int) -> str:
    """Which trial a figure shows: nothing where there is only one."""
    return f"trial {trial} of {trials} (numbered from 0)" if trials > 1 else ""
