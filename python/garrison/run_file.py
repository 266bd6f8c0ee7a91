"""A run in a file: its arrays by name, and everything else as plain data."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from numpy.typing import NDArray

from garrison import _core
from garrison.objects import described, filter_of, model_of, network_of
from garrison.paths import read, write
from garrison.shapes import require_arrays, require_lists

if TYPE_CHECKING:
    from garrison.record import Run

#: arrays of a run, in the order of its text
ARRAYS = (
    "truth",
    "measurements",
    "log",
    "inputs",
    "estimate",
    "error",
    "bound",
    "bound_kind",
    "box",
    "published",
    "statistic",
    "threshold",
    "verdict",
)

#: what a run keeps besides arrays and objects
LISTS = ("accusations", "proved", "details", "counters", "warnings", "bytes_per_step")
#: beginning of a signal's name in a saved run
SIGNAL = "signal_"
#: and of what changed of the plant
VARYING = "varying_"
#: and of a reduction
REDUCED = "reduced_"
#: names that a dataset of the run has for other things than signals
_TAKEN = {*ARRAYS, "trial", "time", "agent", "state", "sample", "output", "input", "step"}
_TAKEN |= {"state_unit", "output_unit", "input_unit"}
#: and names that netCDF has for types
_TAKEN |= {
    "byte",
    "char",
    "short",
    "ushort",
    "int",
    "uint",
    "int64",
    "uint64",
    "float",
    "real",
    "double",
    "bool",
    "string",
}


def lists_of(run: Run) -> dict[str, Any]:
    """What a run keeps besides arrays and objects, by name."""
    return {name: getattr(run, name) for name in LISTS}


def arrays_of(run: Run) -> dict[str, NDArray[Any]]:
    """Arrays that a run holds, by name; signals and what changed of the plant by their prefix."""
    arrays = {name: getattr(run, name) for name in ARRAYS if getattr(run, name) is not None}
    arrays |= {f"{VARYING}{name}": value for name, value in run.varying.items()}
    arrays |= {f"{REDUCED}{name}": value for name, value in run.reduced.items()}
    return arrays | {f"{SIGNAL}{name}": value for name, value in run.signals.items()}


def reduced_name(array: str, statistic: str, over: list[str]) -> str:
    """ "error_q95_over_agent": what Run.reduced calls a statistic of an array."""
    return f"{array}_{statistic}_over_{'_'.join(over)}"


def marked(arrays: dict[str, NDArray[Any]], prefix: str) -> dict[str, NDArray[Any]]:
    """Those of `arrays_of` whose names begin so, by what follows."""
    return {name.removeprefix(prefix): value for name, value in arrays.items() if name.startswith(prefix)}


def labelled(run: Run) -> dict[str, NDArray[Any]]:
    """Arrays as a dataset holds them: signals by their own names where these are free."""
    return {label(name): value for name, value in arrays_of(run).items()}


def save(run: Run, to: Path) -> None:
    """Write all of a run, in the format that the name's ending says."""
    if to.suffix == ".nc":
        from garrison.labelled_files import to_netcdf

        to_netcdf(run, to, document(run), labelled(run))
    elif to.suffix == ".zarr":
        from garrison.labelled_files import to_zarr

        to_zarr(run, to, document(run), labelled(run))
    else:
        from garrison.storage import pack

        write("path", to, pack(document(run), arrays_of(run)))


def load(path: Path, make: Callable[..., Run]) -> Run:
    """The run that `save` wrote; `make` takes model, network, filter, what made it, its lists, and its arrays."""
    if path.suffix in (".nc", ".zarr"):
        from garrison.labelled_files import from_netcdf, from_zarr

        said, found = (from_netcdf if path.suffix == ".nc" else from_zarr)(path)
        found = {_unlabelled(name): value for name, value in found.items()}
    else:
        from garrison.storage import unpack

        said, found = unpack(read("path", path, "a run written by Run.save"), str(path))
    return _assembled(said, found, str(path), make)


def opened(path: Path, make: Callable[..., Run]) -> Run:
    """The run in a folder of zarr that was written as it went; its arrays are read where they are indexed."""
    from garrison.labelled_files import opened as opened_zarr

    said, found = opened_zarr(path)
    return _assembled(said, {_unlabelled(name): value for name, value in found.items()}, str(path), make)


def document(run: Run) -> dict[str, Any]:
    """Everything but the arrays, as plain data."""
    return {"objects": described(run.model, run.network, run.filter), "made": run.made} | lists_of(run)


def label(name: str) -> str:
    """What a dataset calls an array of a saved run."""
    own = name.removeprefix(SIGNAL)
    first = own[:1]
    fit = first.isalnum() or first == "_" or first > "\x7f"  # how names of netCDF begin
    return own if fit and own not in _TAKEN and not own.startswith((SIGNAL, VARYING, REDUCED)) else name


def _unlabelled(label: str) -> str:
    return label if label in ARRAYS or label.startswith((SIGNAL, VARYING, REDUCED)) else f"{SIGNAL}{label}"


def _assembled(document: dict[str, Any], found: dict[str, NDArray[Any]], name: str, make: Callable[..., Run]) -> Run:
    """The run of a document and arrays, signals marked by their prefix."""
    from garrison.labelled import axes

    try:
        objects, document = document["objects"], {"proved": []} | document
        made = document.get("made", {})
        content: dict[str, Any] = {key: document[key] for key in LISTS}
        require_lists(content | {"made": made})
        content["accusations"] = [(k, t, sets) for k, t, sets in content["accusations"]]
        content["proved"] = [(k, t, sets) for k, t, sets in content["proved"]]
        content["details"] = [(k, t, agent, key, values) for k, t, agent, key, values in content["details"]]
        parts = model_of(objects["model"]), network_of(objects["network"]), filter_of(objects["filter"])
        run = make(*parts, made, content, found)
        require_arrays(found, {name: axes(run.filter, name) for name in found}, run.network.agents)
    except (AttributeError, KeyError, RecursionError, TypeError, ValueError) as error:
        raise _core.IoError(f"{name}: got {error!r}, expected a run written by Run.save") from None
    return run
