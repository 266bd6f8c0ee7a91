"""The network at its places, and the run in one picture."""

from typing import Any

import numpy as np
from matplotlib.figure import Figure

from garrison.families import family_of
from garrison.figures.errors import error_figure
from garrison.figures.style import LOOKS, plain
from garrison.figures.verdicts import verdict_figure
from garrison.jobs import Row
from garrison.record import Run
from garrison.scenario import Scenario
from garrison.verdict import Verdict


def final_verdicts(run: Run) -> list[Verdict]:
    """Per agent: what the network says of it at the end of the first trial."""
    assert run.verdict is not None
    accused = run.first_accused() if family_of(run.filter).proves else {}  # a proof holds for ever, an alarm does not
    return [Verdict.ATTACKED if i in accused else Verdict(int(v)) for i, v in enumerate(run.verdict[0, -1])]


def overview_figure(scenario: Scenario, rows: list[Row], signal: float | None) -> Figure:
    """Map and errors side by side; where the true state is not known, the verdicts over time in place of errors."""
    figure = Figure(figsize=(13, 5.6), layout="constrained")
    parts: Any = figure.subfigures(1, 2, width_ratios=[1, 1.45])
    left, right = parts
    if rows[0].run is not None and rows[0].run.verdict is not None:
        map_figure(scenario, rows[0].run, left)
    if any(row.error is not None for row in rows):
        error_figure(scenario, rows, signal, right)
    elif rows[0].run is not None and rows[0].run.verdict is not None:
        verdict_figure(scenario, rows[0].run, right)
    figure.suptitle(plain(scenario.title), fontsize=13)
    return figure


#: most agents whose names can be read
_READABLE = 40
#: agents on a circle that a small picture has room for
_FEW = 12
#: where the name of an agent stands
_BELOW = {"xytext": (0, -19), "textcoords": "offset points", "ha": "center", "va": "top"}


def _outside(place: Any) -> dict[str, Any]:
    """Beside an agent on the circle, away from its lines."""
    side = "center" if abs(place[0]) < 0.3 else "left" if place[0] > 0 else "right"
    level = "center" if abs(place[1]) < 0.3 else "bottom" if place[1] > 0 else "top"
    return {"xytext": tuple(13.0 * place), "textcoords": "offset points", "ha": side, "va": level}


def map_figure(scenario: Scenario, run: Run, figure: Any = None) -> Any:
    """Who is attacked (ring, where that is declared), and what the network says of everybody (marker)."""
    place = scenario.positions
    small = place is None and len(scenario.names) <= _FEW
    figure = figure or Figure(figsize=(5.6, 4.4) if small else (6.4, 6.2), layout="constrained")
    ax = figure.add_subplot()
    if place is None:
        angle = 2 * np.pi * np.arange(len(scenario.names)) / len(scenario.names)
        place = np.column_stack([np.sin(angle), np.cos(angle)])
    scale = min(1.0, _READABLE / len(scenario.names))  # of marks and lines: many agents are small
    for i, j in scenario.network.edges:
        ax.plot(*place[[i, j]].T, color="#bbbbbb", linewidth=max(scale, 0.25), zorder=1)
    verdicts = final_verdicts(run)
    for verdict, (marker, colour, label) in LOOKS.items():
        group = [i for i, v in enumerate(verdicts) if v == verdict]
        if group:
            ax.scatter(
                *place[group].T,
                s=max(170 * scale, 5),
                marker=marker,
                color=colour,
                edgecolor="white" if scale == 1.0 else "none",
                zorder=3,
                label=label,
            )
    if ring := scenario.hit:
        look = {"facecolor": "none", "edgecolor": "black", "linewidth": 1.4}
        ax.scatter(*place[ring].T, s=max(520 * scale, 16), zorder=2, label="actually attacked", **look)
    for i, name in enumerate(scenario.names if len(scenario.names) <= _READABLE else []):
        full = plain(scenario.places[i] if scenario.places else name)
        spot = _outside(place[i]) if scenario.positions is None else _BELOW
        ax.annotate(full, place[i], fontsize=9, zorder=4, **spot)
    if scenario.positions is None:
        ax.set_axis_off()
    else:
        ax.set_xlabel("kilometres east of the centre")
        ax.set_ylabel("kilometres north of the centre")
        ax.spines[["top", "right"]].set_visible(False)
    ax.set_aspect("equal")
    ax.margins(0.12 if scenario.positions is not None else 0.22)
    room = {"handleheight": 2.4, "scatteryoffsets": [0.3], "borderpad": 1.0}  # for the ring
    ax.legend(
        loc="lower center",
        bbox_to_anchor=(0.5, 1.0),
        ncols=3,
        frameon=False,
        fontsize=9,
        markerscale=scale**-0.5,
        **room,
    )
    return figure
