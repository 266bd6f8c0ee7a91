"""A sweep as a picture: errors over one key with bands, over two as maps."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from garrison.figures.style import LINES, axes, plain
from garrison.words import refusal

if TYPE_CHECKING:
    from garrison.sweeps import Sweep

_MOST_MAPS = 12


def sweep_figure(found: Sweep) -> Any:
    """Mean error of a trial: median and 5-95 % band over trials (one key), or medians as a map (two keys)."""
    from matplotlib.figure import Figure

    groups = _groups(found)
    if len(found.keys) == 1:
        figure = Figure(figsize=(7.5, 4.6), layout="constrained")
        _bands(axes(figure, 1, 1, 1), found.keys[0], groups)
    elif len(found.keys) == 2:
        few = dict(list(groups.items())[:_MOST_MAPS])
        top = max(float(np.median(v)) for rows in few.values() for v in _by(rows, found.keys).values())
        figure = Figure(figsize=(4.6 * min(len(few), 3), 3.9 * -(-len(few) // 3)), layout="constrained")
        for k, (label, rows) in enumerate(few.items()):
            _map(figure, top, figure.add_subplot(-(-len(few) // 3), min(len(few), 3), k + 1), found.keys, label, rows)
    else:
        raise refusal("plot", f"a sweep over {len(found.keys)} keys", "one over 1 or 2", "plot a part of trials.csv")
    figure.suptitle(plain(found.title), fontsize=12)
    return figure


def _groups(found: Sweep) -> dict[str, list[dict[str, Any]]]:
    """Trials with an error, by filter and condition."""
    out: dict[str, list[dict[str, Any]]] = {}
    for row in found.trials:
        if row["status"] == "ok" and row["mean_error"] != "":
            label = f"{row['filter']}, {'attacked' if row['attacked'] == 'True' else 'not attacked'}"
            out.setdefault(label, []).append(row)
    return out


def _by(rows: list[dict[str, Any]], keys: list[str]) -> dict[tuple[Any, ...], list[float]]:
    out: dict[tuple[Any, ...], list[float]] = {}
    for row in rows:
        out.setdefault(tuple(_text(row[key]) for key in keys), []).append(float(row["mean_error"]))
    return out


def _text(value: Any) -> Any:
    return value if isinstance(value, (int, float, str)) and not isinstance(value, bool) else str(value)


def _bands(ax: Any, key: str, groups: dict[str, list[dict[str, Any]]]) -> None:
    words = {v for rows in groups.values() for (v,) in _by(rows, [key]) if isinstance(v, str)}
    for (label, rows), (colour, dash) in zip(groups.items(), LINES, strict=False):
        values = _by(rows, [key])
        order = list(values) if words else sorted(values)
        x = range(len(order)) if words else [v for (v,) in order]
        low, middle, high = np.array([np.quantile(values[v], (0.05, 0.5, 0.95)) for v in order]).T
        ax.fill_between(x, low, high, color=colour, alpha=0.18, linewidth=0)
        ax.plot(x, middle, color=colour, linestyle=dash, marker="o", markersize=4, label=plain(label))
        if words:
            ax.set_xticks(list(x), [plain(str(v)) for (v,) in order])
    ax.set(xlabel=plain(key), ylabel="mean error of a trial", title="median, band: 5 % to 95 % of the trials")
    ax.set_ylim(bottom=0)
    ax.legend(frameon=False, fontsize=9)


def _map(figure: Any, top: float, ax: Any, keys: list[str], label: str, rows: list[dict[str, Any]]) -> None:
    values = _by(rows, keys)
    sides = [sorted({point[k] for point in values}, key=lambda v: (isinstance(v, str), v)) for k in (0, 1)]
    table = np.full((len(sides[1]), len(sides[0])), np.nan)
    for point, errors in values.items():
        table[sides[1].index(point[1]), sides[0].index(point[0])] = np.median(errors)
    image = ax.imshow(table, origin="lower", aspect="auto", cmap="viridis", vmin=0.0, vmax=top)
    figure.colorbar(image, ax=ax, label="median of the mean error")
    ax.set_xticks(range(len(sides[0])), [_short(v) for v in sides[0]], rotation=45 if len(sides[0]) > 5 else 0)
    ax.set_yticks(range(len(sides[1])), [_short(v) for v in sides[1]])
    ax.set(xlabel=plain(keys[0]), ylabel=plain(keys[1]))
    ax.set_title(plain(label), fontsize=10)


def _short(value: Any) -> str:
    return plain(f"{value:.4g}" if isinstance(value, float) else str(value))
