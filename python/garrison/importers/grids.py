"""A power grid as a scenario: phasor units at buses, linear (DC) power flow, angles that wander slowly.

State: the voltage angle of every bus. A phasor unit measures the angle of its bus and, by the currents of its lines,
the angle at the other end of each (A. G. Phadke, J. S. Thorp, Synchronized Phasor Measurements, 2008, chapter 7):
theta_k = theta_i - x f, with the error of its own angle in all of them.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from garrison.importers.areas import areas_of, links_of
from garrison.importers.bundle import Bundle, model_file
from garrison.importers.grid_files import Grid, read_grid_case
from garrison.importers.limits import require_positive
from garrison.sizes import limit_bytes
from garrison.words import count, refusal

Array = NDArray[np.float64]
SOURCE = (
    "a grid in the form of pandapower. The cases that pandapower ships are under its licence (BSD-3-Clause; pegase and "
    "rte cases: CC BY 4.0, name their authors); a grid of your own is yours."
)
#: up to here every bus is an agent; up to the second number areas are, whose filter is designed for all states
_SMALL, _MIDDLE, _AREAS = 40, 200, 8
#: standard deviations of an innovation that are usual
_SIGMAS = 3.0
_NOTES = [
    "a grid file holds no recordings: the run is simulated, from the angles of the linear (DC) power flow; recordings "
    "go into [data] file, one column per measurement in the order of outputs in model.json",
    "garrison analyze tells how many measurements may lie, which are necessary, and where the next one helps most",
]
_UNSEEN = (
    "nobody estimates the buses that no unit sees, so the filter is plain consensus (Kalman gains do not exist); "
    "garrison analyze says which units would show them"
)


@dataclass(frozen=True)
class Assumptions:
    """angle, flow: standard deviations of phasor units, rad and per unit. wander: of an angle per sample, rad.

    steps: samples to simulate; None: 50, or 10 of a large grid, whose estimates take room. areas: agents that the buses
    are divided among; None: by the size of the grid.
    """

    angle: float = 0.002
    flow: float = 0.02
    wander: float = 0.001
    steps: int | None = None
    areas: int | None = None

    def __post_init__(self) -> None:
        require_positive(angle_noise=self.angle, flow_noise=self.flow, wander=self.wander)
        if self.steps is not None and self.steps < 1:
            raise refusal("--steps", str(self.steps), "a whole number >= 1")


def import_pandapower(
    case: str, units: Sequence[str] | int | None = None, assumed: Assumptions | None = None
) -> Bundle:
    """A power grid (extra: grid).

    Parameters
    ----------
    case : str
        A JSON file of pandapower, or the name of one of its cases ("case118", "case1354pegase").
    units : sequence of str, or int, optional
        Names of the buses with a phasor unit, or how many (those with most lines); default: all.
    assumed : Assumptions, optional
        Noise (rad, per unit), how far angles wander per sample (rad), samples, areas.

    Returns
    -------
    Bundle
        What `write(folder)` writes: scenario.toml and the files beside it; facts and notes for people.

    Raises
    ------
    IoError
        A file cannot be read.
    InvalidInput
        There is no such case or bus, or pandapower is missing.
    """
    assumed = assumed or Assumptions()
    grid = read_grid_case(case)
    n = len(grid.names)
    chosen = _chosen(grid, units)
    members = _members(grid, chosen, assumed.areas)
    agents = [f"area {k}" if len(b) > 1 else f"bus {grid.names[b[0]]}" for k, b in enumerate(members, start=1)]
    blocks = [[_unit(grid, bus, assumed) for bus in buses] for buses in members]
    seen = [[bus for buses, _, _ in one for bus in buses] for one in blocks]
    outputs = [name for one in blocks for _, _, names in one for name in names]
    states = [f"angle {name}" for name in grid.names]
    model = model_file(
        _diagonal(n, 1.0),
        [{"size": [len(one), n], "entries": [[r, bus, 1.0] for r, bus in enumerate(one)]} for one in seen],
        process_covariance=_diagonal(n, assumed.wander**2),
        measurement_covariance=[_block_diagonal([R for _, R, _ in one]) for one in blocks],
        agents=agents,
        states=states,
        outputs=outputs,
        units=dict.fromkeys([*states, *outputs], "rad"),
    )
    angles = [float(v) for v in grid.angles]
    shown = {bus for one in seen for bus in one}
    unseen = [name for b, name in enumerate(grid.names) if b not in shown]
    tables = {
        "title": f"{grid.title}: {n} buses, {count(sum(map(len, members)), 'phasor unit')}",
        "model": {"file": "model.json"},
        "network": {"edges": [list(e) for e in links_of(grid, members)]},
        "filter": _filter(n, max(map(len, seen)), detected=not unseen),
        "run": {"steps": assumed.steps or (50 if n <= _MIDDLE else 10), "x0": angles, "start": angles},
    }
    facts = [
        ("buses, branches", f"{n}, {len(grid.branches)}"),
        ("phasor units", f"{sum(map(len, members))} with {len(outputs)} measurements"),
        ("agents", f"{len(members)}: {', '.join(agents[:6])}{', ..' if len(agents) > 6 else ''}"),
        ("buses that no unit sees", f"{len(unseen)}: {', '.join(unseen[:20])}" if unseen else "none"),
    ]
    notes = [*_NOTES, *([_UNSEEN] if unseen else []), *_too_large(n, len(outputs))]
    return Bundle(tables, SOURCE, None, model, facts, notes)


def _diagonal(n: int, value: float) -> dict[str, Any]:
    return {"size": [n, n], "entries": [[k, k, value] for k in range(n)]}


def _too_large(n: int, measured: int) -> list[str]:
    """A note where a run would keep more numbers than garrison allows."""
    needed = 8.0 * 2.0 * (measured + 2 * n) * n
    if needed <= limit_bytes():
        return []
    return [
        f"matrices of all states would take {needed / 1e9:.3g} GB, so that only garrison analyze reads this scenario: "
        "it works with sparse rows; for check and run take a part of the grid, or fewer --units"
    ]


def _filter(n: int, rows: int, *, detected: bool) -> dict[str, Any]:
    """The filter of n buses; rows: measurements of the largest agent, whose whole innovation is clipped at once.

    detected: units see all buses, as Kalman gains need.
    """
    if n <= _MIDDLE and detected:
        weight = round(_SIGMAS * float(np.sqrt(rows)), 1)
        return {"name": "rdkf", "label": "resilient Kalman", "penalty": "huber", "weight": weight}
    return {"name": "scalar_gain", "label": "consensus, unprotected", "rounds": 5}


def _chosen(grid: Grid, units: Sequence[str] | int | None) -> list[int]:
    """Numbers of the buses with a phasor unit."""
    n = len(grid.names)
    if units is None:
        return list(range(n))
    if isinstance(units, int):
        if not 1 <= units <= n:
            raise refusal("--units", str(units), f"1..{n}, the number of buses")
        degree = np.bincount([b for i, k, _ in grid.branches for b in (i, k)], minlength=n)
        return sorted(sorted(range(n), key=lambda b: (-degree[b], b))[:units])
    places = {name: k for k, name in enumerate(grid.names)} | grid.same
    unknown = [name for name in units if name not in places]
    if unknown:
        raise refusal("--at", ", ".join(unknown), f"names of buses, as {', '.join(grid.names[:8])}, ..")
    return sorted({places[name] for name in units})


def _members(grid: Grid, chosen: list[int], areas: int | None) -> list[list[int]]:
    """The buses with a unit, by agent: one each, or divided into areas."""
    if areas is None:
        areas = _AREAS if _SMALL < len(grid.names) <= _MIDDLE and len(chosen) > _SMALL else len(chosen)
    if not 1 <= areas <= len(chosen):
        raise refusal("--areas", str(areas), f"1..{len(chosen)}, the number of phasor units")
    return [[b] for b in chosen] if areas == len(chosen) else areas_of(grid, chosen, areas)


def _unit(grid: Grid, bus: int, assumed: Assumptions) -> tuple[list[int], Array, list[str]]:
    """Buses whose angles one phasor unit measures, covariance and names of the measurements."""
    near = grid.near[bus]
    seen = [bus, *sorted(near)]
    R = np.full((len(seen), len(seen)), assumed.angle**2)
    R += np.diag([0.0, *((assumed.flow / near[k]) ** 2 for k in seen[1:])])
    R += np.diag([1e-4 * assumed.angle**2] * len(seen))  # rounding: without it two rows of one strong line are one
    name = grid.names[bus]
    names = [f"angle at {name}", *(f"angle at {grid.names[k]} from {name}" for k in seen[1:])]
    return seen, R, names


def _block_diagonal(blocks: list[Array]) -> Array:
    size = sum(len(b) for b in blocks)
    out, at = np.zeros((size, size)), 0
    for b in blocks:
        out[at : at + len(b), at : at + len(b)] = b
        at += len(b)
    return out
