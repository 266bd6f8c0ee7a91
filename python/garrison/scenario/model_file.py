"""Model files: what `garrison fit` writes, and what `garrison import` writes (docs/files.md#model-json)."""

import json
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from garrison import _core
from garrison.files import contents
from garrison.numeric import numbers
from garrison.scenario.section import whole
from garrison.sizes import require_memory
from garrison.words import only, refusal, shown

Array = NDArray[np.float64]
_FITTED = ("A", "C", "process_bound", "measurement_bound", "process_covariance", "measurement_variance")
_NOISE = ("process_bound", "measurement_bound", "process_covariance")
_NAMES = ("states", "outputs", "inputs", "sources", "exposed")
_KEYS = ("garrison_model", "A", "C", "B", *_NOISE, "measurement_covariance", *_NAMES, "agents", "units")
_EXPECTED = "a model file of garrison fit or garrison import (JSON)"


def read_model_file(path: Path) -> tuple[_core.Model, list[str] | None]:
    """The model of a file, and the names of its agents where they are known. Raises IoError or InvalidInput."""
    try:
        plain = json.loads(contents(path).decode("utf-8-sig"))
    except OSError as error:
        raise _core.IoError(f"{path}: got {error.strerror}, expected {_EXPECTED}") from None
    except (ValueError, RecursionError) as error:
        raise refusal(str(path), f"{error}", _EXPECTED) from None
    if isinstance(plain, dict) and "garrison_model" in plain:
        return _imported(str(path), plain)
    return _fitted(str(path), plain)


def _fitted(path: str, plain: Any) -> tuple[_core.Model, list[str] | None]:
    if not isinstance(plain, dict) or any(key not in plain for key in _FITTED):
        raise refusal(path, "a file without some of the keys", ", ".join(_FITTED))
    values = {key: numbers(f"{path}: {key}", plain[key]) for key in _FITTED}
    variances = values.pop("measurement_variance").ravel()
    model = _core.Model(
        np.atleast_2d(values["A"]),
        np.atleast_2d(values["C"]),
        process_bound=float(values["process_bound"]),
        measurement_bound=values["measurement_bound"],
        process_covariance=np.atleast_2d(values["process_covariance"]),
        measurement_covariance=[[[v]] for v in variances],
    )
    return model, _names(plain.get("stations"), model.agents)


def _imported(path: str, plain: dict[str, Any]) -> tuple[_core.Model, list[str] | None]:
    only(path, plain, _KEYS)
    if plain["garrison_model"] != 1:
        raise refusal(f"{path}: garrison_model", shown(plain["garrison_model"]), "1, the version of the form")
    for key in ("A", "C"):
        if key not in plain:
            raise refusal(path, f"no {key}", "A and C")
    if not isinstance(plain["C"], list):
        raise refusal(f"{path}: C", shown(plain["C"]), "a list with a matrix per agent")
    arguments: dict[str, Any] = {
        key: _matrix(f"{path}: {key}", plain[key]) for key in _NOISE if plain.get(key) is not None
    }
    if plain.get("measurement_covariance") is not None:
        arguments["measurement_covariance"] = plain["measurement_covariance"]
    arguments |= {key: plain[key] for key in (*_NAMES, "units") if plain.get(key) is not None}
    if plain.get("B") is not None:
        arguments["B"] = _matrix(f"{path}: B", plain["B"])
    C = [_matrix(f"{path}: C[{k}]", one) for k, one in enumerate(plain["C"])]
    try:
        model = _core.Model(_matrix(f"{path}: A", plain["A"]), C, **arguments)
    except _core.Error as error:
        raise type(error)(f"{path}: {error}") from None
    return model, _names(plain.get("agents"), model.agents)


def _matrix(where: str, given: Any) -> Array:
    """A dense matrix from rows of numbers, or from its size and its entries that are not zero."""
    if not isinstance(given, dict):
        return numbers(where, given)
    only(where, given, ("size", "entries"))
    size = given.get("size")
    if not isinstance(size, list) or len(size) != 2:
        raise refusal(f"{where}.size", shown(size), "two numbers: rows and columns")
    rows, columns = (whole(f"{where}.size", v) for v in size)
    require_memory(f"{where}.size", f"{rows} x {columns}", float(rows) * columns)
    out = np.zeros((rows, columns))
    entries = numbers(f"{where}.entries", given.get("entries", []))
    if entries.size == 0:
        return out
    if entries.ndim != 2 or entries.shape[1] != 3:
        raise refusal(f"{where}.entries", f"shape {entries.shape}", "triples [row, column, value]")
    at = entries[:, :2]
    wrong = (at != np.floor(at)) | (at < 0) | (at >= [rows, columns])
    if wrong.any():
        row = entries[int(np.argmax(wrong.any(axis=1)))]
        raise refusal(f"{where}.entries", f"an entry at ({row[0]:g}, {row[1]:g})", f"one within {rows} x {columns}")
    out[at[:, 0].astype(int), at[:, 1].astype(int)] = entries[:, 2]
    return out


def _names(given: Any, agents: int) -> list[str] | None:
    return [str(n) for n in given] if isinstance(given, list) and len(given) == agents else None
