"""Model files: what `garrison fit` writes, and what `garrison import` writes (docs/files.md#model-json)."""

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from garrison import _core
from garrison.files import contents
from garrison.numeric import numbers, real
from garrison.scenario.section import whole
from garrison.sizes import require_memory
from garrison.static_plant import StaticPlant
from garrison.words import count, only, refusal, shown

Array = NDArray[np.float64]
_FITTED = ("A", "C", "process_bound", "measurement_bound", "process_covariance", "measurement_variance")
_NOISE = ("process_bound", "measurement_bound", "process_covariance")
_NAMES = ("states", "outputs", "inputs", "sources", "exposed")
_KEYS = ("garrison_model", "A", "C", "B", *_NOISE, "measurement_covariance", *_NAMES, "agents", "units")
_EXPECTED = "a model file of garrison fit or garrison import (JSON)"


def read_model_file(path: Path) -> tuple[_core.Model, list[str] | None]:
    """The model of a file, and the names of its agents where they are known. Raises IoError or InvalidInput."""
    plain = _plain(path)
    if isinstance(plain, dict) and "garrison_model" in plain:
        return _imported(str(path), plain)
    return _fitted(str(path), plain)


def read_static_plant(path: Path, least: int) -> tuple[StaticPlant, list[str] | None] | None:
    """The plant of an imported file that does not move and has `least` states or more, with the names of its agents.

    None: the file is another, and read_model_file() reads it. Raises IoError or InvalidInput.
    """
    plain = _plain(path)
    if not isinstance(plain, dict) or plain.get("garrison_model") != 1 or plain.get("exposed") is not None:
        return None
    A, C = plain.get("A"), plain.get("C")
    if not isinstance(A, dict) or not isinstance(C, list) or not C:
        return None
    (n, columns), entries = _sparse(f"{path}: A", A)
    if n < least or n != columns or not np.array_equal(np.unique(entries, axis=0), _identity(n)):
        return None
    blocks: list[Array] = [np.zeros((0, 3))]
    agent: list[int] = []
    for k, one in enumerate(C):
        (rows, columns), own = _sparse(f"{path}: C[{k}]", one) if isinstance(one, dict) else _listed(path, k, one)
        if columns != n:
            raise refusal(f"{path}: C[{k}]", f"{rows} x {columns}", f"rows of {count(n, 'number')}, one per state")
        blocks.append(own + np.array([len(agent), 0, 0]))
        agent += [k] * rows
    plant = StaticPlant(
        np.vstack(blocks), (len(agent), n), agent, plain.get("states") or [], plain.get("outputs") or []
    )
    return plant, _names(plain.get("agents"), len(C))


def _listed(path: Path, k: int, given: Any) -> tuple[tuple[int, int], Array]:
    table = np.atleast_2d(numbers(f"{path}: C[{k}]", given))
    at = np.nonzero(table)
    return (table.shape[0], table.shape[1]), np.column_stack([*at, table[at]])


def _identity(n: int) -> Array:
    each = np.arange(float(n))
    return np.column_stack([each, each, np.ones(n)])


def _plain(path: Path) -> Any:
    try:
        return json.loads(contents(path).decode("utf-8-sig"))
    except OSError as error:
        raise _core.IoError(f"{path}: got {error.strerror}, expected {_EXPECTED}") from None
    except (ValueError, RecursionError) as error:
        raise refusal(str(path), f"{error}", _EXPECTED) from None


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
    _require_room(path, plain)
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


def _require_room(path: str, plain: dict[str, Any]) -> None:
    """Refuse matrices that are small one by one and too large together, as those of large grids are."""
    matrices = [plain["A"], plain.get("process_covariance"), *plain["C"]]
    sizes = [one.get("size") for one in matrices if isinstance(one, dict)]
    together = 0.0
    for size in sizes:
        lengths = [real(length) for length in size] if isinstance(size, list) else []
        together += math.prod(length or 0.0 for length in lengths)  # what is no length is refused with its matrix
    advice = "garrison analyze reads a plant that does not move without these matrices; take a part of it for the rest"
    require_memory(path, f"{len(sizes)} matrices with all their zeros, kept twice", 2.0 * together, advice)


def _matrix(where: str, given: Any) -> Array:
    """A dense matrix from rows of numbers, or from its size and its entries that are not zero."""
    if not isinstance(given, dict):
        return numbers(where, given)
    (rows, columns), entries = _sparse(where, given)
    require_memory(f"{where}.size", f"{rows} x {columns}", float(rows) * columns)
    out = np.zeros((rows, columns))
    out[entries[:, 0].astype(int), entries[:, 1].astype(int)] = entries[:, 2]
    return out


def _sparse(where: str, given: dict[str, Any]) -> tuple[tuple[int, int], Array]:
    """The size of a matrix and its entries (k, 3): row, column, value."""
    only(where, given, ("size", "entries"))
    size = given.get("size")
    if not isinstance(size, list) or len(size) != 2:
        raise refusal(f"{where}.size", shown(size), "two numbers: rows and columns")
    rows, columns = (whole(f"{where}.size", v) for v in size)
    entries = numbers(f"{where}.entries", given.get("entries", []))
    if entries.size == 0:
        return (rows, columns), np.zeros((0, 3))
    if entries.ndim != 2 or entries.shape[1] != 3:
        raise refusal(f"{where}.entries", f"shape {entries.shape}", "triples [row, column, value]")
    at = entries[:, :2]
    wrong = (at != np.floor(at)) | (at < 0) | (at >= [rows, columns])
    if wrong.any():
        row = entries[int(np.argmax(wrong.any(axis=1)))]
        raise refusal(f"{where}.entries", f"an entry at ({row[0]:g}, {row[1]:g})", f"one within {rows} x {columns}")
    return (rows, columns), entries


def _names(given: Any, agents: int) -> list[str] | None:
    return [str(n) for n in given] if isinstance(given, list) and len(given) == agents else None
