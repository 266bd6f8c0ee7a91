"""What is known besides the model's constant part: inputs, matrices over time, links that come and go."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from garrison import _core
from garrison.numeric import numbers
from garrison.scenario.section import Section, renamed
from garrison.tables import read_matrix, read_table
from garrison.tables.cells import number
from garrison.tables.text import read_rows
from garrison.varying import VaryingModel, parted
from garrison.varying_network import VaryingNetwork
from garrison.words import count, refusal

Array = NDArray[np.float64]
_R = "measurement_covariance_over_time"
#: keys of [model] with one matrix per step, and what each replaces
OVER_TIME = ["A_over_time", "B_over_time", "C_over_time", "process_covariance_over_time", _R]


def changing_keys(section: Section) -> list[str]:
    """Keys of [model] that make the plant change in time."""
    return [key for key in (*OVER_TIME, "times") if key in section]


def read_varying(section: Section, plant: _core.Model | VaryingModel) -> VaryingModel | None:
    """The plant over time, where [model] says so: arrays (T, rows, n), or files with the matrices below each other."""
    model, moving = parted(plant)
    if "interval" in section:
        _require_sampled(section)
    n, p, m = model.states, model.inputs, model.outputs
    shapes = {"A": (n, n), "B": (n, p), "C": (m, n), "process_covariance": (n, n)}
    parts: dict[str, Any] = {}
    for key in OVER_TIME:
        if key in section and key != _R:
            part = key.removesuffix("_over_time")
            parts[part] = _below_each_other(section.place(key), section.numbers(key), shapes[part])
    if _R in section:
        parts["measurement_covariance"] = _noises(section, m, max(len(c) for c in model.C))
    for part in moving.keys() & parts.keys():
        raise refusal(section.place(f"{part}_over_time"), "times beside it", "one of them: it follows from the times")
    parts = moving | parts
    if not parts:
        return None
    try:
        return VaryingModel(model, **parts)
    except _core.Error as error:
        raise renamed(error, section.where) from None


def _require_sampled(section: Section) -> None:
    """Beside `interval`, A, B and the intensity are those of dx/dt; what changes over time is of steps."""
    rests = {"A_over_time": "A", "B_over_time": "B", "process_covariance_over_time": "process_intensity"}
    for key, whose in rests.items():
        if key in section and whose in section:
            expected = f"one of them: {whose} is in continuous time, {key} is of steps"
            advice = "leave interval out and give the matrices of steps, or give `times`"
            raise refusal(section.place(key), f"interval and {whose} beside it", expected, advice)


def _noises(section: Section, outputs: int, most: int) -> Array:
    """Variances of all outputs, a row per sample; or the blocks of all agents below each other, in every sample."""
    given = section.numbers(_R)
    if given.ndim == 3 or (given.ndim == 2 and given.shape[1] == outputs):
        return given
    if given.ndim == 2 and given.shape[1] == most and len(given) % outputs == 0:
        return given.reshape(-1, outputs, most)
    expected = f"{count(outputs, 'variance')} per sample, or {outputs} x {most} numbers (in a file: below each other)"
    raise refusal(section.place(_R), f"shape {given.shape}", expected)


def _below_each_other(where: str, given: Array, shape: tuple[int, int]) -> Array:
    rows, columns = shape
    if given.ndim == 3 and given.shape[1:] == shape:
        return given
    if given.ndim != 2 or rows == 0 or given.shape[1] != columns or len(given) % rows:
        expected = f"matrices of {rows} x {columns}, one per step (in a file: below each other)"
        raise refusal(where, f"shape {given.shape}", expected)
    return given.reshape(-1, rows, columns)


def read_present(section: Section, network: _core.Network) -> VaryingNetwork | None:
    """The network over time, where [network] has `present`."""
    if "present" not in section:
        return None
    try:
        return VaryingNetwork(
            network, np.atleast_2d(numbers(section.place("present"), section.array("present"), flags=True))
        )
    except _core.Error as error:
        raise renamed(error, section.where) from None


def read_inputs(section: Section, model: _core.Model, recorded: Array | None) -> Array | None:
    """Known inputs (steps, p): of [run].inputs, a list or a CSV file, or columns of [data]; None without B."""
    where = section.place("inputs")
    if "inputs" in section and recorded is not None:
        raise refusal(where, "inputs in [run] and in [data]", "one of them")
    if recorded is not None:
        return recorded
    if "inputs" not in section:
        if model.inputs:
            advice = "give [run].inputs, or name columns of [data]"
            raise refusal(
                "scenario", "a model with B and no inputs", f"{count(model.inputs, 'known input')} per step", advice
            )
        return None
    if not model.inputs:
        raise refusal(where, "inputs", "none, because [model] has no B")
    found = _file_or_numbers(section, list(model.input_names))
    found = found[:, None] if found.ndim == 1 and model.inputs == 1 else np.atleast_2d(found)
    if found.ndim != 2 or found.shape[1] != model.inputs:
        raise refusal(where, f"shape {found.shape}", f"{count(model.inputs, 'number')} per step, one per column of B")
    return found


def _file_or_numbers(section: Section, names: list[str]) -> Array:
    """A CSV file with a header is matched by name where the inputs have names."""
    value: Any = section.table["inputs"]
    if not (isinstance(value, dict) and set(value) == {"file"}):
        return section.numbers("inputs")
    path = Section(section.place("inputs"), value, section.folder).file("file")
    if all(number(cell) is not None for cell in read_rows(path).cells[0]):
        return read_matrix(path)
    table = read_table(path)
    return columns_of(str(path), table.names, table.values, names) if names else table.values


def columns_of(where: str, have: list[str], values: Array, wanted: list[str]) -> Array:
    """Columns of a table by name."""
    missing = [name for name in wanted if name not in have]
    if missing:
        raise refusal(where, f"no column {', '.join(missing)}", f"columns {', '.join(wanted)} among {', '.join(have)}")
    return values[:, [have.index(name) for name in wanted]]
