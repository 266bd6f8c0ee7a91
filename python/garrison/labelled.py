"""A run as an xarray.Dataset: names and units of agents, states and outputs as coordinates, the rest as attributes."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from garrison import _core
from garrison.families import family_of
from garrison.longform import agent_names, common_unit, state_names
from garrison.objects import described
from garrison.paths import whole_file, whole_folder
from garrison.storage import digest, require_digest
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
        "box": (*_PER_AGENT, "state"),
        "measurements": ("trial", "sample", "output"),
        "log": ("record", "sample", "output"),
        "inputs": ("step", "input"),
        "varying_A": ("step", "state", "state_before"),
        "varying_B": ("step", "state", "input"),
        "varying_C": ("step", "row", "state"),
        "varying_process_covariance": ("step", "state", "state_before"),
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
    if run.inputs is not None:
        names = list(run.model.input_names) or [f"u{k}" for k in range(1, run.model.inputs + 1)]
        found["input"] = ("input", np.array(names), {})
        found["input_unit"] = ("input", np.array([units.get(u, "") for u in names]), {})
        found["step"] = ("step", np.arange(len(run.inputs)), {"long_name": "leads from this time to the next"})
    return found


def dataset(run: Run, arrays: dict[str, Any]) -> Any:
    """The xarray.Dataset of a run; signals are variables with their own names."""
    try:
        import xarray as xr
    except ImportError:
        raise refusal("to_xarray", "no xarray", 'it installed: pip install "garrison[xarray]"') from None
    dims, unit = dimensions(run), common_unit(run.model)
    variables: dict[str, Any] = {}
    for name, values in arrays.items():
        about: dict[str, Any] = (
            {"units": unit} if unit and name in ("truth", "estimate", "error", "bound", "box") else {}
        )
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


#: attributes of a file: everything but the arrays, and a digest of it and them
_DOCUMENT, _DIGEST = "run", "run_digest"
#: arrays of small numbers, which older netCDF holds with a sign only
_BYTES = ("verdict", "bound_kind")


def _marked(run: Run, document: dict[str, Any], arrays: dict[str, Any]) -> Any:
    """The dataset of a run, with everything that makes the run again in an attribute."""
    text = json.dumps(document | {"arrays": list(arrays)})
    return dataset(run, arrays).assign_attrs({_DOCUMENT: text, _DIGEST: digest(text, arrays)})


def to_netcdf(run: Run, path: Path, document: dict[str, Any], arrays: dict[str, Any]) -> None:
    """Write the dataset of a run, with everything that makes the run again, as netCDF."""
    data = _marked(run, document, arrays)
    # What older netCDF cannot hold: unsigned bytes, and attributes of 64 bits.
    for name in set(_BYTES) & set(data):
        about = data[name].attrs
        data[name] = data[name].astype(np.int8)
        data[name].attrs = {k: np.array(v, dtype=np.int8) if k == "flag_values" else v for k, v in about.items()}
    data.attrs = {k: str(v) for k, v in data.attrs.items()}
    with whole_file(path) as temporary:
        data.to_netcdf(temporary)


def to_zarr(run: Run, path: Path, document: dict[str, Any], arrays: dict[str, Any]) -> None:
    """The same as a folder of zarr, of format 2: names of fixed width have no place in format 3 yet."""
    _require_zarr("save")
    data = _marked(run, document, arrays)
    data.attrs = {k: str(v) for k, v in data.attrs.items()}
    with whole_folder(path, _is_run) as temporary:
        data.to_zarr(temporary, mode="w", consolidated=False, zarr_format=2)


#: files of zarr: descriptions, and pieces by their numbers
_ZARR = re.compile(r"\.zattrs|\.zgroup|\.zarray|\d+(\.\d+)*")


def _is_run(folder: Path) -> bool:
    """Whether `to_zarr` wrote a folder, and nobody put anything else into it."""
    try:
        about = json.loads((folder / ".zattrs").read_text(encoding="utf-8"))
        files = (one.name for one in folder.rglob("*") if not one.is_dir())
        return _DOCUMENT in about and all(_ZARR.fullmatch(name) for name in files)
    except (OSError, ValueError, TypeError):
        return False


def _require_zarr(which: str) -> None:
    try:
        import zarr  # noqa: F401  (xarray finds it)
    except ImportError:
        raise refusal(which, "a folder of zarr and no zarr", 'it installed: pip install "garrison[store]"') from None


def from_netcdf(path: Path) -> tuple[dict[str, Any], dict[str, Any]]:
    """Document and arrays of a run that `to_netcdf` wrote. Raises IoError for any other file."""
    return _read(path, {})


def from_zarr(path: Path) -> tuple[dict[str, Any], dict[str, Any]]:
    """Document and arrays of a run that `to_zarr` wrote. Raises IoError for any other folder."""
    _require_zarr("load")
    return _read(path, {"engine": "zarr", "consolidated": False})


def _read(path: Path, how: dict[str, Any]) -> tuple[dict[str, Any], dict[str, Any]]:
    try:
        import xarray as xr
    except ImportError:
        raise refusal("load", f"{path.name} and no xarray", 'it installed: pip install "garrison[xarray]"') from None
    try:
        with xr.open_dataset(path, **how) as data:
            text, given = data.attrs[_DOCUMENT], data.attrs[_DIGEST]
            document = json.loads(text)
            arrays = {name: np.array(data[name].values) for name in document.pop("arrays")}
    except Exception as error:  # each backend has its own for what is damaged
        raise _core.IoError(f"{path}: got {error}, expected a run written by Run.save") from None
    arrays |= {name: arrays[name].astype(np.uint8) for name in _BYTES if name in arrays}
    require_digest(given, text, arrays, str(path))
    return document, arrays
