"""A run as an xarray.Dataset: names and units of agents, states and outputs as coordinates, the rest as attributes."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from garrison import _core
from garrison.families import family_of
from garrison.longform import agent_names, common_unit, state_names
from garrison.objects import described
from garrison.verdict import Verdict
from garrison.words import refusal

if TYPE_CHECKING:
    from garrison.record import Run

_PER_AGENT = ("trial", "time", "agent")
#: axis of an array of which only some times were kept
_THINNED = re.compile(r"(time|sample)_every_(\d+)")
_AXES = {
    "truth": (*_PER_AGENT, "state"),  # of one plant: without agents
    "estimate": (*_PER_AGENT, "state"),
    "box": (*_PER_AGENT, "state"),
    "measurements": ("trial", "sample", "output"),
    "log": ("record", "sample", "output"),
    "inputs": ("step", "input"),
    "varying_A": ("step", "state", "state_before"),
    "varying_B": ("step", "state", "input"),
    "varying_C": ("step", "row", "state"),
    "varying_process_covariance": ("step", "state", "state_before"),
    "varying_measurement_covariance": ("step", "row", "output_before"),
}
#: name of a reduction: array, statistic, axes that went
_REDUCED = re.compile(r"reduced_(.+)_[a-z0-9.]+_over_([a-z_]+)")


def thinned(axis: str, step: int) -> str:
    """Name of an axis of times of which only the multiples of `step` were kept."""
    return f"{axis}_every_{step}"


def axes(filter: _core.Filter, name: str) -> tuple[str, ...]:
    """Names of the axes of an array of a run, or of a reduction of one."""
    if match := _REDUCED.fullmatch(name):
        over = match[2].split("_")
        return tuple(axis for axis in axes(filter, match[1]) if axis not in over)
    return dimensions(filter).get(name, _PER_AGENT)


def axes_of_any(name: str) -> tuple[str, ...]:
    """All that an array of a run has with one filter or another."""
    return _AXES.get(name, _PER_AGENT)


def dimensions(filter: _core.Filter) -> dict[str, tuple[str, ...]]:
    """Names of the axes of a run's arrays, where they are not (trial, time, agent)."""
    return _AXES if family_of(filter).own_plants else _AXES | {"truth": ("trial", "time", "state")}


def _outputs(run: Run) -> list[str]:
    """Names of the measurements: given ones, else agent by agent ("3", or "3.0", "3.1" where it has several)."""
    if names := run.model.output_names:
        return list(names)
    agents = agent_names(run) or [str(i) for i in range(run.network.agents)]
    rows = [len(C) for C in run.model.C]
    return [a if m == 1 else f"{a}.{r}" for a, m in zip(agents, rows, strict=True) for r in range(m)]


def _coordinates(run: Run, lengths: Mapping[str, int]) -> dict[str, tuple[str, Any, dict[str, Any]]]:
    """Coordinates of axes of these lengths, by name."""
    agents: list[Any] = list(agent_names(run) or range(run.network.agents))
    units, model = run.model.units, run.model
    first = 0 if family_of(run.filter).own_plants else 1  # sample that is measured
    inputs = list(model.input_names) or [f"u{k}" for k in range(1, model.inputs + 1)]
    meanings = {
        "time": "sample; 0 is the start",
        "sample": "sample of the measurement",
        "step": "leads from this time to the next",
    }
    numbers = {"trial": 0, "time": 0, "sample": first, "step": 0}
    found: dict[str, tuple[str, Any, dict[str, Any]]] = {}
    for axis, length in lengths.items():
        base, step = axis, 1
        if match := _THINNED.fullmatch(axis):
            base, step = match[1], int(match[2])
        if base in numbers:
            start = -(-numbers[base] // step) * step
            told = {"long_name": meanings[base]} if base in meanings else {}
            found[axis] = (axis, start + step * np.arange(length), told)
    named = {"agent": agents, "state": state_names(run), "output": _outputs(run)}
    for axis, names in (named | {"input": inputs}).items():
        if axis in lengths:
            found[axis] = (axis, np.array(names), {})
            if axis != "agent":
                found[f"{axis}_unit"] = (axis, np.array([units.get(name, "") for name in names]), {})
    return found


def about(model: _core.Model, name: str) -> dict[str, Any]:
    """What a variable of the dataset says of its numbers."""
    if name == "verdict":
        return {
            "flag_values": [int(v) for v in Verdict],
            "flag_meanings": " ".join(v.name.lower() for v in Verdict),
        }
    unit = common_unit(model)
    return {"units": unit} if unit and name in ("truth", "estimate", "error", "bound", "box") else {}


def dataset(run: Run, arrays: dict[str, Any], elsewhere: Mapping[str, int] | None = None) -> Any:
    """The xarray.Dataset of a run; signals are variables with their own names.

    elsewhere: lengths of axes of arrays that are not in it, and yet to have coordinates.
    """
    try:
        import xarray as xr
    except ImportError:
        raise refusal("to_xarray", "no xarray", 'it installed: pip install "garrison[xarray]"') from None
    variables = {name: (axes(run.filter, name), values, about(run.model, name)) for name, values in arrays.items()}
    lengths = dict(elsewhere or {})
    for names, values, _ in variables.values():
        lengths |= zip(names, values.shape, strict=True)
    made_of = described(run.model, run.network, run.filter)
    told = {
        "title": f"garrison run: {run.filter.name}",
        "garrison": _core.__version__,
        **{name: json.dumps(part) for name, part in made_of.items()},
        "warnings": "\n".join(run.warnings),
        "bytes_per_step": run.bytes_per_step,
        **{f"count_{name}": value for name, value in run.counters.items()},
    }
    return xr.Dataset(variables, _coordinates(run, lengths), told)
