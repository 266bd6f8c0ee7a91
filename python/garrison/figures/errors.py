"""Errors of all filters over time."""

from typing import Any

import numpy as np
from matplotlib.figure import Figure

from garrison.figures.style import LINES, axes, label_ends, log_scale, plain, time_label, times
from garrison.jobs import Row
from garrison.longform import common_unit
from garrison.scenario import Scenario


def smoothing_width(samples: int) -> int:
    """Samples that a drawn error is a mean over."""
    return max(1, min(30, samples // 20))


def error_figure(scenario: Scenario, rows: list[Row], signal: float | None, figure: Any = None) -> Any:
    """Mean error of every filter over time (moving mean), with the bounds of the main one."""
    figure = figure or Figure(figsize=(9.2, 4.6), layout="constrained")
    ax = axes(figure)
    shown = _shown(scenario, rows)
    for row, (colour, style) in zip(shown, LINES, strict=False):
        error = np.nanmean(row.error, axis=(0, 2))[1:]  # type: ignore[arg-type]
        width = smoothing_width(len(error))
        smooth = np.convolve(error, np.ones(width) / width, mode="valid")
        at = np.arange(width, len(error) + 1)
        ax.plot(times(scenario, at), smooth, color=colour, linestyle=style, linewidth=1.6, label=plain(row.label))
    _draw_bounds(ax, scenario, shown)
    if signal is not None:
        ax.axhline(signal, color="#999999", linewidth=1, label="size of the signal itself")
    for k, attack in enumerate(scenario.attacks):
        start = times(scenario, np.array([attack.start]))[0]
        label = "attack starts" if k == 0 else None
        ax.axvline(start, color="black", linewidth=0.8, linestyle=(0, (2, 2)), label=label)
    if ax.get_lines():
        log_scale(ax, np.concatenate([np.ravel(np.asarray(row.error)) for row in shown]))
    unit = common_unit(scenario.model)
    ax.set_ylabel(f"mean error ({plain(unit)}), log scale" if unit else "mean error, log scale")
    ax.set_xlabel(time_label(scenario))
    label_ends(ax)
    return figure


def bounded(scenario: Scenario, rows: list[Row]) -> Row | None:
    """The row whose bounds the picture shows: the first filter that has one."""
    return next((r for r in _shown(scenario, rows) if r.run is not None and _drawn(r.run.bound)), None)


def _shown(scenario: Scenario, rows: list[Row]) -> list[Row]:
    return [row for row in rows if row.error is not None and (row.attacked or not scenario.attacks)]


def _drawn(bounds: Any) -> bool:
    """Some sample has a bound of every agent, which is what is drawn."""
    return bounds is not None and bool(np.isfinite(bounds[0, 1:]).all(axis=1).any())


def _draw_bounds(ax: Any, scenario: Scenario, shown: list[Row]) -> None:
    """Bounds of the first filter that has one: what is certified, and beside it what its paper alone promises."""
    for row, (colour, _) in zip(shown, LINES, strict=False):
        if row.run is None or row.run.bound is None or not _drawn(row.run.bound):
            continue
        _draw_bound(ax, scenario, row.run.bound, "certified bound", color=colour, linewidth=3, alpha=0.35)
        if row.run.published is not None:
            look = {"color": "#666666", "linewidth": 1.2, "linestyle": (0, (6, 2))}
            _draw_bound(ax, scenario, row.run.published, "published bound, where it holds", **look)
        return


def _draw_bound(ax: Any, scenario: Scenario, bounds: Any, label: str, **look: Any) -> None:
    """The largest bound of an agent in the first trial, smoothed as the errors are; a gap where some agent has none."""
    bound = bounds[0, 1:].max(axis=1)
    bound[~np.isfinite(bound)] = np.nan
    if np.isnan(bound).all():
        return
    width = smoothing_width(len(bound))
    smooth = np.convolve(bound, np.ones(width) / width, mode="valid")
    ax.plot(times(scenario, np.arange(width, len(bound) + 1)), smooth, label=label, **look)
