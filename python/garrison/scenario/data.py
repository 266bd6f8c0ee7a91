"""[data]: recorded measurements, with a reference state where the model was fitted."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from garrison import _core
from garrison.fitting import Fit
from garrison.scenario.model import between
from garrison.scenario.section import Section
from garrison.tables import Records, read_matrix, read_records, read_table
from garrison.tables.cells import number
from garrison.tables.text import read_rows
from garrison.words import refusal

Array = NDArray[np.float64]


KEYS = ["file", "from", "to"]


@dataclass
class Recording:
    """Measurements (samples, outputs); reference (samples + 1, n): what errors are measured from, or None."""

    measurements: Array
    reference: Array | None = None
    robust: Array | None = None  # another reference, which a minority of wrong sensors does not pull
    records: Records | None = None
    notes: list[str] = field(default_factory=list)


def read_data(section: Section, model: _core.Model, fitted: Fit | None, names: list[str]) -> Recording:
    """The recording of a scenario; names: of the agents."""
    section.only(KEYS)
    section.require("file", "a CSV file with recorded measurements")
    if fitted is not None:
        return _of_fit(section, fitted)
    path = section.file("file")
    head = read_rows(path).cells[0]
    if all(number(cell) is not None for cell in head):
        if "from" in section or "to" in section:
            raise refusal(section.where, "from or to", "none, because the file has no header and no times")
        return _require_width(Recording(read_matrix(path)), path.name, model)
    table = read_table(path)
    values = table.values
    if model.outputs == model.agents and sorted(table.names) == sorted(names):
        values = values[:, [table.names.index(name) for name in names]]
    if table.clock is None:
        if "from" in section or "to" in section:
            raise refusal(section.where, "from or to", "none, because the file has no column of times")
        return _require_width(Recording(values, notes=table.notes), path.name, model)
    records = Records(
        table.clock.moments, table.names, values, table.clock.step, [c.unit for c in table.columns], table.notes
    )
    records = between(section, records)
    return _require_width(Recording(records.values, records=records, notes=records.notes), path.name, model)


def _of_fit(section: Section, fitted: Fit) -> Recording:
    records = between(section, read_records(section.file("file")))
    measured = fitted.measurements(records)
    reference = fitted.reference(records)
    # The state before the first record is not known; its error is not counted (see `first` in the summary).
    robust = fitted.robust_reference(records)
    whole, other = (np.vstack([states[:1], states]) for states in (reference, robust))
    return Recording(measured, whole, other, records, records.notes)


def _require_width(found: Recording, name: str, model: _core.Model) -> Recording:
    got = found.measurements.shape[1]
    if got != model.outputs:
        advice = "one column per row of the C_i, agent by agent"
        raise refusal(f"[data].file {name}", f"{got} columns of measurements", str(model.outputs), advice)
    return found
