"""Pictures of a string of vehicles: positions, gaps, errors, sets over time, and an animation."""

from pathlib import Path
from typing import Any

import matplotlib
import matplotlib.lines
import matplotlib.patches
import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from garrison.families.platoon import SETS, world_of
from garrison.figures.style import LOOKS, axes, legend_below, trial_words
from garrison.record import Run
from garrison.verdict import Verdict

Array = NDArray[np.float64]
#: set of a vehicle that a sensor is in -> colour
_COLOURS = dict(zip(SETS, (LOOKS[v][1] for v in (Verdict.CLEARED, Verdict.SUSPECTED, Verdict.ATTACKED)), strict=True))


def _shares(run: Run, name: str, trial: int = 0) -> Array:
    """Share of vehicles that hold each sensor in their set `name`, (time, sensor); needs keep="details"."""
    assert run.bound is not None
    steps, N = run.bound.shape[1:]
    held = np.zeros((N, N))
    out = np.zeros((steps, N))
    entries = iter([d for d in run.details if d[0] == trial and d[3] == name])
    entry = next(entries, None)
    for t in range(steps):
        while entry is not None and entry[1] <= t:
            held[entry[2]] = 0.0
            held[entry[2], [int(v) for v in entry[4]]] = 1.0
            entry = next(entries, None)
        out[t] = held.mean(axis=0)
    return out


def _beliefs(run: Run, trial: int) -> Array:
    """Colours (sensor, time, rgb): white = in no set; stronger the more vehicles agree."""
    from matplotlib.colors import to_rgb

    image = np.ones((*_shares(run, "free", trial).T.shape, 3))
    for name in SETS:
        share = _shares(run, name, trial).T[..., None]
        image = image * (1.0 - share) + np.array(to_rgb(_COLOURS[name])) * share
    return image


def _line(k: int, N: int) -> dict[str, Any]:
    shades = matplotlib.colormaps["viridis"](np.linspace(0.0, 0.85, N))
    return {"color": shades[k], "linewidth": 1.2}


def string_figure(run: Run, trial: int = 0) -> Figure:
    """Four panels over time: distance to the reference vehicle, gaps, errors with bounds, the sets of sensors."""
    assert run.truth is not None and run.error is not None and run.bound is not None
    x, N = run.truth[trial], run.model.agents
    world = world_of(run.model, run.filter)
    time = np.arange(len(x)) * world.period
    figure = Figure(figsize=(11, 7.4), layout="constrained")
    place, gap, error, sets = (axes(figure, 2, 2, k) for k in (1, 2, 3, 4))
    for k in range(N):
        place.plot(time, x[:, k, 0] - x[:, 0, 0], **_line(k, N))
    place.set(title="position behind the leader (m)", xlabel="time (s)")
    least = run.signals.get("least_gap")
    for k in range(1, N):
        gap.plot(time, x[:, k - 1, 0] - x[:, k, 0], **_line(k, N))
        if least is not None:
            gap.plot(time, least[trial, :, k], **(_line(k, N) | {"linewidth": 0.6, "linestyle": ":"}))
    gap.axhline(world.spacing, color="#888888", linewidth=0.8, linestyle="--")
    gap.set(title="gap ahead (m); dotted: certified; dashed: wanted", xlabel="time (s)")
    for k in range(N):
        error.plot(time, np.maximum(run.error[trial, :, k], 1e-6), **_line(k, N))
        error.plot(time, run.bound[trial, :, k], **(_line(k, N) | {"linewidth": 0.8, "linestyle": "--"}))
    error.set(title="estimation error; dashed: certified bound", xlabel="time (s)", yscale="log")
    sets.imshow(
        _beliefs(run, trial), aspect="auto", interpolation="nearest", extent=(0, time[-1], N - 0.5, -0.5), zorder=1
    )
    sets.grid(False)
    title = "share of vehicles that have a sensor in a set"
    sets.set(title=title, xlabel="time (s)", ylabel="sensor", yticks=range(0, N, 1 + N // 12))
    handles = [matplotlib.patches.Patch(color=c, label=n) for n, c in _COLOURS.items()]
    sets.legend(handles=handles, fontsize=8, ncols=3, loc="upper center", bbox_to_anchor=(0.5, -0.16), frameon=False)
    vehicles = [matplotlib.lines.Line2D([], [], **_line(k, N), label=f"vehicle {k}") for k in range(N)]
    legend_below(figure, vehicles[:: 1 + N // 12], 13)
    if words := trial_words(trial, run.shape[0]):
        figure.suptitle(words, fontsize=11)
    return figure


def animate(run: Run, path: str | Path, trial: int = 0, frames: int = 80) -> None:
    """Write a GIF of the string: vehicles coloured by their sensors' sets (white: in none), and the measured places.

    Sets need keep="details".
    """
    from matplotlib.animation import FuncAnimation, PillowWriter

    assert run.truth is not None and run.measurements is not None
    x, y, N = run.truth[trial], run.measurements[trial], run.model.agents
    world = world_of(run.model, run.filter)
    claimed = y[:, world.places]
    known = {name: _shares(run, name, trial) for name in _COLOURS}
    spacing = world.spacing
    figure = Figure(figsize=(8, 2.6), layout="constrained")
    ax = figure.add_subplot()
    ax.spines[["top", "right", "left"]].set_visible(False)
    width = max(1.0, float(np.ptp(x[..., 0], axis=1).max())) + spacing
    ax.set(ylim=(-1, 1.6), xlim=(-width, spacing), yticks=[], xlabel="position relative to the leader (m)")
    ax.axhline(0, color="#cccccc", linewidth=6, zorder=0)
    cars = ax.scatter(np.zeros(N), np.zeros(N), s=120, marker="s", zorder=3, edgecolors="#333333")
    ghosts = ax.scatter(np.zeros(N), np.full(N, 0.7), s=40, marker="v", zorder=2, color="#555555")
    ax.text(0.01, 0.93, "triangles: where the absolute sensors claim to be", transform=ax.transAxes, fontsize=8)
    if run.details:
        handles = [matplotlib.patches.Patch(facecolor=c, edgecolor="#333333", label=n) for n, c in _COLOURS.items()]
        legend_below(figure, handles, 3, "lower right")
    text = ax.text(0.99, 0.93, "", transform=ax.transAxes, ha="right", fontsize=8)

    def draw(t: int) -> tuple[Any, ...]:
        colours = ["#ffffff"] * N
        for name in ("suspected", "free", "attacked"):  # the last one that applies wins
            for k in range(N):
                if known[name][t, k] > 0.5:
                    colours[k] = _COLOURS[name]
        cars.set_offsets(np.column_stack([x[t, :, 0] - x[t, 0, 0], np.zeros(N)]))
        cars.set_facecolor(colours)
        ghosts.set_offsets(np.column_stack([np.clip(claimed[t] - x[t, 0, 0], -width, spacing), np.full(N, 0.7)]))
        text.set_text(f"{t * world.period:.2f} s")
        return cars, ghosts, text

    figure.draw_without_rendering()
    figure.set_layout_engine("none")  # the layout of one frame is that of all, and takes most of the time
    times = np.unique(np.linspace(0, len(x) - 1, min(frames, len(x))).astype(int))
    FuncAnimation(figure, draw, frames=times, blit=False).save(str(path), writer=PillowWriter(fps=12), dpi=80)
