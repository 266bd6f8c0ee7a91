"""A run as an xarray.Dataset: names and units of agents, states and outputs as coordinates, the rest as attributes."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from garrison import _core
from garrison.families import family_of
from garrison.longform import agent_names, state_names
from garrison.objects import described
from garrison.verdict import Verdict
from garrison.words import refusal

if TYPE_CHECKING:
    from garrison.record import Run

_PER_AGENT = ("trial", "time", "agent")


def dimensions(run: Run) -> dict[str, tuple[str, ...]]:
    """Names of the axes of a run's arrays, where they are not (trial, time, agent)."""
    own = family_of(run.filter).own_plants
    return {
        "truth": ("trial", "time", "agent", "state") if own else ("trial", "time", "state"),
        "estimate": (*_PER_AGENT, "state"),
        "measurements": ("trial", "sample", "output"),
    }


def _outputs(run: Run) -> list[str]:
    """Names of the measurements: given ones, else agent by agent ("3", or "3.0", "3.1" where it has several)."""
    if names := run.model.output_names:
        return list(names)
    agents = agent_names(run) or [str(i) for i in range(run.network.agents)]
    rows = [len(C) for C in run.model.C]
    return [a if m == 1 else f"{a}.{r}" for a, m in zip(agents, rows, strict=True) for r in range(m)]


def _coordinates(run: Run) -> dict[str, tuple[str, Any, dict[str, Any]]]:
    trials, times, agents = run.shape
    states, outputs, units = state_names(run), _outputs(run), run.model.units
    found: dict[str, tuple[str, Any, dict[str, Any]]] = {
        "trial": ("trial", np.arange(trials), {}),
        "time": ("time", np.arange(times), {"long_name": "sample; 0 is the start"}),
        "agent": ("agent", np.array(agent_names(run) or range(agents)), {}),
        "state": ("state", np.array(states), {}),
        "state_unit": ("state", np.array([units.get(s, "") for s in states]), {}),
    }
    if run.measurements is not None:
        first = times - run.measurements.shape[1]
        found["sample"] = ("sample", np.arange(first, times), {"long_name": "sample of the measurement"})
        found["output"] = ("output", np.array(outputs), {})
        found["output_unit"] = ("output", np.array([units.get(o, "") for o in outputs]), {})
    return found


def _common_unit(run: Run) -> str:
    """The unit of all states, where they have one and the same: then errors and bounds have it too."""
    found = {run.model.units.get(s, "") for s in state_names(run)}
    return found.pop() if len(found) == 1 else ""


def dataset(run: Run, arrays: dict[str, Any]) -> Any:
    """The xarray.Dataset of a run; signals are variables with their own names."""
    try:
        import xarray as xr
    except ImportError:
        raise refusal("to_xarray", "no xarray", 'it installed: pip install "garrison[xarray]"') from None
    dims, unit = dimensions(run), _common_unit(run)
    variables: dict[str, Any] = {}
    for name, values in arrays.items():
        about: dict[str, Any] = {"units": unit} if unit and name in ("truth", "estimate", "error", "bound") else {}
        if name == "verdict":
            about = {
                "flag_values": [int(v) for v in Verdict],
                "flag_meanings": " ".join(v.name.lower() for v in Verdict),
            }
        variables[name] = (dims.get(name, _PER_AGENT), values, about)
    made_of = described(run.model, run.network, run.filter)
    about = {
        "title": f"garrison run: {run.filter.name}",
        "garrison": _core.__version__,
        **{name: json.dumps(part) for name, part in made_of.items()},
        "warnings": "\n".join(run.warnings),
        "bytes_per_step": run.bytes_per_step,
        **{f"count_{name}": value for name, value in run.counters.items()},
    }
    used = {d for v in variables.values() for d in v[0]}
    coordinates = {name: c for name, c in _coordinates(run).items() if c[0] in used}
    return xr.Dataset(variables, coordinates, about)


#: attribute of a netCDF file that holds everything but the arrays
_DOCUMENT = "run"


def to_netcdf(run: Run, path: Path, document: dict[str, Any], arrays: dict[str, Any]) -> None:
    """Write the dataset of a run, with everything that makes the run again, as netCDF."""
    data = dataset(run, arrays).assign_attrs({_DOCUMENT: json.dumps(document | {"arrays": list(arrays)})})
    # What older netCDF cannot hold: unsigned bytes, and attributes of 64 bits.
    if "verdict" in data:
        data["verdict"] = data.verdict.astype(np.int8)
        data.verdict.attrs["flag_values"] = np.array(data.verdict.attrs["flag_values"], dtype=np.int8)
    data.attrs = {k: str(v) for k, v in data.attrs.items()}
    data.to_netcdf(path)


def from_netcdf(path: Path) -> tuple[dict[str, Any], dict[str, Any]]:
    """Document and arrays of a run that `to_netcdf` wrote. Raises IoError for any other file."""
    try:
        import xarray as xr
    except ImportError:
        raise refusal("load", "a netCDF file and no xarray", 'it installed: pip install "garrison[xarray]"') from None
    try:
        with xr.open_dataset(path) as data:
            document = json.loads(data.attrs[_DOCUMENT])
            arrays = {name: np.array(data[name].values) for name in document.pop("arrays")}
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise _core.IoError(f"{path}: got {error}, expected a run written by Run.save") from None
    if "verdict" in arrays:
        arrays["verdict"] = arrays["verdict"].astype(np.uint8)
    return document, arrays
