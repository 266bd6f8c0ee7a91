"""Numbers from what people pass: lists, arrays, masked arrays, tables of pandas. What is masked or NA becomes nan."""

import operator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from garrison import _core
from garrison.sizes import require_room
from garrison.words import refusal, shown

Array = NDArray[np.float64]


def numbers(which: str, value: Any, *, flags: bool = False) -> Array:
    """`value` as an array of doubles; masked, NA and None entries are nan.

    flags: True and False in lists stand for 1 and 0. Raises InvalidInput for text, complex numbers, rows of different
    lengths and, without `flags`, for True and False in lists.
    """
    if not flags and (at := _flag_in(value)) is not None:
        raise refusal(f"{which}{at[0]}", shown(at[1]), "a number")
    require_room(which, value)
    try:
        found = np.asarray(_plain(value))
    except (ValueError, TypeError) as error:
        raise refusal(which, _why(error), "numbers, with rows of equal length") from None
    if found.dtype == object:
        found = _of_objects(which, found)
    if found.dtype.kind == "c":
        raise refusal(which, "complex numbers", "real numbers", "take .real if the imaginary part means nothing")
    if found.dtype.kind not in "biuf":
        kind = "text" if found.dtype.kind in "US" else f"entries of type {found.dtype.name}"
        raise refusal(which, kind, "numbers")
    return np.asarray(found, dtype=float)


def real(value: Any) -> float | None:
    """A Python or NumPy number as a double; None for anything else, and for whole numbers that no double holds."""
    if isinstance(value, (bool, complex)) or not isinstance(value, (int, float, np.number)):
        return None
    try:
        return float(value)
    except (OverflowError, TypeError):
        return None


def whole_of(value: Any) -> int | None:
    """A whole number, also one that is kept as a float (3.0); None for anything else."""
    value = value.item() if type(value) is np.ndarray and value.ndim == 0 else value
    if isinstance(value, (bool, np.bool_, np.ndarray)):
        return None
    if hasattr(value, "__index__"):
        try:
            return operator.index(value)
        except TypeError:
            return None
    found = real(value)
    return int(found) if found is not None and np.isfinite(found) and found == int(found) else None


def _plain(value: Any) -> Any:
    """Masked arrays and tables without their special missing values; lists of such likewise."""
    if value is np.ma.masked:
        return np.nan
    if isinstance(value, np.ma.MaskedArray):
        kind: type = complex if value.dtype.kind == "c" else float
        return np.ma.filled(value.astype(kind), np.nan)
    if hasattr(value, "to_numpy"):  # pandas: NA of nullable columns becomes an object, treated below
        return value.to_numpy()
    if hasattr(value, "toarray"):  # a sparse matrix
        return value.toarray()
    if isinstance(value, (list, tuple)):
        return [_plain(v) for v in value]
    return value


def _flag_in(value: Any) -> tuple[str, bool] | None:
    """Place and value of the first true or false in nested lists."""
    if isinstance(value, bool):
        return "", value
    if isinstance(value, (list, tuple)):
        for k, one in enumerate(value):
            if (found := _flag_in(one)) is not None:
                return f"[{k}]{found[0]}", found[1]
    return None


def _of_objects(which: str, found: NDArray[Any]) -> Array:
    out = np.empty(found.shape)
    for at, entry in np.ndenumerate(found):
        if entry is None or type(entry).__name__ in ("NAType", "NaTType"):
            out[at] = np.nan
        elif (value := real(entry)) is not None:
            out[at] = value
        else:
            place = "".join(f"[{k}]" for k in at)
            raise refusal(f"{which}{place}", shown(entry), "a number, or nan where there is none")
    return out


def _why(error: Exception) -> str:
    return "rows of different lengths" if "inhomogeneous" in str(error) else "something that is not an array of numbers"


def matched(which: str, value: Any, names: list[str] | None) -> Any:
    """A table of pandas with its columns in the order of `names`; anything else, and without names, as it is.

    Raises InvalidInput when the table's columns have other names.
    """
    if not names or not (hasattr(value, "columns") and hasattr(value, "to_numpy")):
        return value
    columns = value.columns
    found = [str(c) for c in columns]
    if found == [str(k) for k in range(len(names))]:
        return value  # numbered, not named
    if sorted(found) != sorted(names):
        raise refusal(f"{which}: columns", ", ".join(found), ", ".join(names), "columns are matched by name")
    return value[[columns[found.index(name)] for name in names]]


def output_names(model: _core.Model, network: _core.Network | None = None) -> list[str] | None:
    """Names of the columns of measurements: the outputs', or the agents' where each has one output; else None."""
    if names := getattr(model, "output_names", None):
        return [str(n) for n in names]
    names = getattr(network, "names", None)
    return [str(n) for n in names] if names and model.outputs == model.agents else None


def sparse(matrix: Array) -> dict[str, Any]:
    """A matrix as its size and its entries that are not zero: [row, column, value]."""
    rows, columns = np.nonzero(matrix)
    entries = [[int(i), int(j), float(matrix[i, j])] for i, j in zip(rows, columns, strict=True)]
    return {"size": list(matrix.shape), "entries": entries}
