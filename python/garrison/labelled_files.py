"""The dataset of a run in a file: netCDF, or a folder of zarr."""

from __future__ import annotations

import json
import re
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from garrison import _core
from garrison.growing import StoredArray
from garrison.labelled import dataset
from garrison.paths import whole_file, whole_folder
from garrison.sizes import require_memory
from garrison.storage import digest, require_digest
from garrison.words import refusal

if TYPE_CHECKING:
    from garrison.record import Run

#: attributes of a file: everything but the arrays, and a digest of it and them
DOCUMENT, DIGEST = "run", "run_digest"
#: entry of the document: arrays that were written as the run went. The digest is not of them: their chunks have sums
STREAMED = "streamed"
#: and those of which only some times were kept, which no run holds
THINNED = "thinned"
_PARTS = "read parts of it (xarray.open_zarr, xarray.open_dataset)"
#: arrays of small numbers, which older netCDF holds with a sign only
_BYTES = ("verdict", "bound_kind")


def _marked(run: Run, document: dict[str, Any], arrays: dict[str, Any]) -> Any:
    """The dataset of a run, with everything that makes the run again in an attribute."""
    text = json.dumps(document | {"arrays": list(arrays)})
    return dataset(run, arrays).assign_attrs({DOCUMENT: text, DIGEST: digest(text, arrays)})


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
    require_zarr("save")
    data = _marked(run, document, arrays)
    data.attrs = {k: str(v) for k, v in data.attrs.items()}
    with whole_folder(path, is_run) as temporary:
        data.to_zarr(temporary, mode="w", consolidated=False, zarr_format=2)


#: files of zarr: descriptions, and pieces by their numbers
_ZARR = re.compile(r"\.zattrs|\.zgroup|\.zarray|\d+(\.\d+)*")


def is_run(folder: Path) -> bool:
    """Whether `to_zarr` wrote a folder, and nobody put anything else into it."""
    try:
        about = json.loads((folder / ".zattrs").read_text(encoding="utf-8"))
        files = (one.name for one in folder.rglob("*") if not one.is_dir())
        return DOCUMENT in about and all(_ZARR.fullmatch(name) for name in files)
    except (OSError, ValueError, TypeError):
        return False


def require_zarr(which: str) -> None:
    """Refuse what needs the package zarr where it is not installed."""
    try:
        import_module("zarr")
    except ImportError:
        raise refusal(which, "a folder of zarr and no zarr", 'it installed: pip install "garrison[store]"') from None


def from_netcdf(path: Path) -> tuple[dict[str, Any], dict[str, Any]]:
    """Document and arrays of a run that `to_netcdf` wrote. Raises IoError for any other file."""
    return _read(path, {})


def from_zarr(path: Path) -> tuple[dict[str, Any], dict[str, Any]]:
    """Document and arrays of a run that `to_zarr` wrote. Raises IoError for any other folder."""
    require_zarr("load")
    return _read(path, {"engine": "zarr", "consolidated": False})


def _read(path: Path, how: dict[str, Any]) -> tuple[dict[str, Any], dict[str, Any]]:
    try:
        import xarray as xr
    except ImportError:
        raise refusal("load", f"{path.name} and no xarray", 'it installed: pip install "garrison[xarray]"') from None
    try:
        with xr.open_dataset(path, **how) as data:
            text, given = data.attrs[DOCUMENT], data.attrs[DIGEST]
            document = json.loads(text)
            names, streamed = document.pop("arrays"), document.pop(STREAMED, [])
            _require_whole(path, document.pop(THINNED, []))
            require_memory("load", str(path), sum(data[name].nbytes for name in names) / 8.0, _PARTS)
            arrays = {name: np.array(data[name].values) for name in names}
        if streamed:
            _require_chunks(path, streamed)
    except _core.Error:
        raise
    except Exception as error:  # each backend has its own for what is damaged
        raise _core.IoError(f"{path}: got {error}, expected a run written by Run.save") from None
    arrays |= {name: arrays[name].astype(np.uint8) for name in _BYTES if name in arrays}
    require_digest(given, text, {name: one for name, one in arrays.items() if name not in streamed}, str(path))
    return document, arrays


def _require_whole(path: Path, rest: list[str]) -> None:
    """Refuse a run of which some arrays lack times."""
    if rest:
        lacks = "lacks" if len(rest) == 1 else "lack"
        got = f"{path}, whose {', '.join(rest)} {lacks} times (garrison.every)"
        raise refusal("load", got, "a run that has all times", "xarray.open_zarr reads it")


def _require_chunks(path: Path, names: list[str]) -> None:
    """Raise ValueError where a chunk is missing, which zarr takes for one that was never written."""
    import zarr

    group: Any = zarr.open_group(path, mode="r")
    for name in names:
        if group[name].nchunks_initialized != group[name].nchunks:
            raise ValueError(f"{name} without some of its chunks")


def lazily(path: Path) -> Any:
    """The dataset in a folder of zarr, of which only what is asked for is read."""
    import xarray as xr

    return xr.open_zarr(path, consolidated=False)


def opened(path: Path) -> tuple[dict[str, Any], dict[str, Any]]:
    """Document and arrays of a run that was written as it went; these are read where they are indexed."""
    require_zarr("load")
    import zarr

    try:
        group: Any = zarr.open_group(path, mode="r")
        text, given = group.attrs[DOCUMENT], group.attrs[DIGEST]
        document = json.loads(text)
        names, streamed, _ = document.pop("arrays"), document.pop(STREAMED), document.pop(THINNED)
        arrays: dict[str, Any] = {
            name: StoredArray(group[name], name) if name in streamed else group[name][...] for name in names
        }
    except Exception as error:  # as above
        raise _core.IoError(f"{path}: got {error}, expected a run written as it went (to=)") from None
    require_digest(given, text, {name: one for name, one in arrays.items() if name not in streamed}, str(path))
    return document, arrays
