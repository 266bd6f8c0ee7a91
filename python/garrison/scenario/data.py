"""[data]: recorded measurements, with a reference state where the model was fitted."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from garrison import _core
from garrison.fitting import Fit
from garrison.scenario.known import columns_of
from garrison.scenario.model import between
from garrison.scenario.section import Section
from garrison.tables import Records, read_matrix, read_records, read_table
from garrison.tables.cells import number
from garrison.tables.text import read_rows
from garrison.words import count, refusal, shown

Array = NDArray[np.float64]


KEYS = ["file", "from", "to", "inputs"]


@dataclass
class Recording:
    """Measurements (samples, outputs); reference (samples + 1, n): what errors are measured from, or None.

    inputs (samples, p): known ones, of columns of the same file; the row of a sample holds what led to it.
    """

    measurements: Array
    reference: Array | None = None
    robust: Array | None = None  # another reference, which a minority of wrong sensors does not pull
    records: Records | None = None
    notes: list[str] = field(default_factory=list)
    inputs: Array | None = None


def read_data(section: Section, model: _core.Model, fitted: Fit | None, names: list[str]) -> Recording:
    """The recording of a scenario; names: of the agents."""
    section.only(KEYS)
    section.require("file", "a CSV file with recorded measurements")
    wanted = _input_columns(section, model)
    if fitted is not None:
        return _of_fit(section, fitted)
    path = section.file("file")
    head = read_rows(path).cells[0]
    if all(number(cell, True) is not None for cell in head):
        if wanted:
            raise refusal(section.place("inputs"), "names", "none, because the file has no header")
        if "from" in section or "to" in section:
            raise refusal(section.where, "from or to", "none, because the file has no header and no times")
        doubts: list[str] = []
        values = read_matrix(path, notes=doubts)
        return _require_width(Recording(values, notes=[f"{path.name}: {d}" for d in doubts]), path.name, model)
    table = read_table(path)
    names_of, values, known = list(table.names), table.values, None
    if wanted:
        known = columns_of(path.name, names_of, values, wanted)
        rest = [k for k, name in enumerate(names_of) if name not in wanted]
        names_of, values = [names_of[k] for k in rest], values[:, rest]
    agents = names if model.outputs == model.agents else []
    columns, doubt = _by_name(path.name, names_of, agents, list(model.output_names))
    values, notes = values[:, columns], table.notes + doubt
    if table.clock is None:
        if "from" in section or "to" in section:
            raise refusal(section.where, "from or to", "none, because the file has no column of times")
        return _require_width(Recording(values, notes=notes, inputs=known), path.name, model)
    kept = [k for k, name in enumerate(table.names) if name not in wanted]
    units = [table.columns[k].unit for k in kept]
    # Inputs go through the choice of times beside the measurements.
    both = values if known is None else np.hstack([values, known])
    records = Records(
        table.clock.moments, [*names_of, *wanted], both, table.clock.step, [*units, *[""] * len(wanted)], notes
    )
    records = between(section, records)
    if known is not None:
        known = records.values[:, -len(wanted) :]
        records = records.of(names_of)
    found = Recording(records.values, records=records, notes=records.notes, inputs=known)
    return _require_width(found, path.name, model)


def _by_name(file: str, have: list[str], agents: list[str], outputs: list[str]) -> tuple[list[int], list[str]]:
    """The columns in the order of the agents, or of the outputs, where they have these names; else as they come.

    Capitals do not matter where they tell no names apart. With a line where names of agents are passed over. Raises
    InvalidInput where only some columns have them: then it is not the order that is meant.
    """
    known = [wanted for wanted in (agents, outputs) if wanted]
    for wanted in known:
        for folded in (str, str.casefold):
            there, meant = [folded(name) for name in have], [folded(name) for name in wanted]
            if len(set(there)) == len(there) and sorted(there) == sorted(meant):
                return [there.index(name) for name in meant], []
    for wanted in known:
        there = [name.casefold() for name in have]
        missing = [name for name in wanted if name.casefold() not in there]
        if len(have) == len(wanted) > len(missing):
            advice = "columns are matched by name"
            raise refusal(f"[data].file {file}", f"no column {', '.join(missing)}", ", ".join(wanted), advice)
    told = next((wanted for wanted in known if wanted != [str(k) for k in range(len(wanted))]), [])
    doubt = f"{file}: columns {', '.join(have)} are taken in this order for {', '.join(told)}"
    return list(range(len(have))), [doubt] if len(told) == len(have) else []


def _input_columns(section: Section, model: _core.Model) -> list[str]:
    """Names of the columns that hold known inputs: of [data].inputs, else of the model's inputs."""
    if "inputs" not in section:
        return []
    given = section.table["inputs"]
    if not isinstance(given, list) or not all(isinstance(name, str) for name in given) or len(given) != model.inputs:
        expected = f"{count(model.inputs, 'name')} of columns, one per column of B"
        raise refusal(section.place("inputs"), shown(given), expected)
    return list(given)


def _of_fit(section: Section, fitted: Fit) -> Recording:
    records = between(section, read_records(section.file("file")))
    measured = fitted.measurements(records)
    reference = fitted.reference(records)
    # The state before the first record is not known; its error is not counted (see `first` in the summary).
    robust = fitted.robust_reference(records)
    whole, other = (np.vstack([states[:1], states]) for states in (reference, robust))
    return Recording(measured, whole, other, records.of(fitted.records.stations), records.notes, fitted.known(records))


def _require_width(found: Recording, name: str, model: _core.Model) -> Recording:
    got = found.measurements.shape[1]
    if got != model.outputs:
        advice = "one column per row of the C_i, agent by agent"
        raise refusal(f"[data].file {name}", f"{got} columns of measurements", str(model.outputs), advice)
    return found
