"""What an importer makes: a scenario, a model, measurements, and where they come from."""

import csv
import io
import json
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from garrison.importers.toml import document
from garrison.numeric import sparse

Array = NDArray[np.float64]
#: digits of measurements in the CSV file: finer than any of the sensors
_DIGITS = 9


@dataclass(frozen=True)
class Measurements:
    """Columns of numbers over regular times; nan = missing.

    times: one text per row, seconds or ISO dates with a time. values: (rows, columns).
    """

    times: list[str]
    columns: list[str]
    values: Array

    def text(self) -> str:
        """As CSV: a missing value is an empty cell."""
        out = io.StringIO()
        writer = csv.writer(out, lineterminator="\n")
        writer.writerow(["time", *self.columns])
        for time, row in zip(self.times, self.values, strict=True):
            writer.writerow([time, *(f"{v:.{_DIGITS}g}" if np.isfinite(v) else "" for v in row)])
        return out.getvalue()


@dataclass
class Bundle:
    """Files of one import.

    tables: of scenario.toml, in order. model: content of model.json, where the scenario names it. facts: pairs of a
    name and a value, for people. notes: what was left out or assumed. source: where the data come from, and under
    whose licence they are.
    """

    tables: dict[str, Any]
    source: str
    measurements: Measurements | None = None
    model: dict[str, Any] | None = None
    facts: list[tuple[str, str]] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)

    def write(self, folder: Path) -> None:
        """scenario.toml, model.json and measurements.csv (where there are any), SOURCE.md; makes the folder."""
        folder.mkdir(parents=True, exist_ok=True)
        head = [f"Made by `garrison import`; {self.source}", *self.notes]
        (folder / "scenario.toml").write_text(document(self.tables, head), encoding="utf-8")
        if self.model is not None:
            (folder / "model.json").write_text(json.dumps(self.model), encoding="utf-8")
        if self.measurements is not None:
            (folder / "measurements.csv").write_text(self.measurements.text(), encoding="utf-8")
        lines = [f"# {self.tables['title']}", "", self.source, "", *(f"* {note}" for note in self.notes)]
        (folder / "SOURCE.md").write_text("\n".join(lines).rstrip() + "\n", encoding="utf-8")


def gate(label: str, false_alarm: float, *, isolate: bool) -> dict[str, Any]:
    """The [filter] table of recordings whose sensors all see the whole state: tests of innovations."""
    table = {"name": "structural", "label": label, "false_alarm": false_alarm, "test": "innovation"}
    return {**table, "isolate": True} if isolate else table


def model_file(
    A: Array | dict[str, Any],
    C: Sequence[Array | dict[str, Any]],
    *,
    process_covariance: Array | dict[str, Any],
    measurement_covariance: Sequence[Array],
    agents: Sequence[str],
    states: Sequence[str],
    outputs: Sequence[str],
    units: dict[str, str],
) -> dict[str, Any]:
    """The content of model.json, as docs/files.md describes it; matrices are stored without their zeros, and may be
    given so.
    """

    def stored(matrix: Array | dict[str, Any]) -> dict[str, Any]:
        return matrix if isinstance(matrix, dict) else sparse(matrix)

    return {
        "garrison_model": 1,
        "A": stored(A),
        "C": [stored(one) for one in C],
        "process_covariance": stored(process_covariance),
        "measurement_covariance": [one.tolist() for one in measurement_covariance],
        "agents": list(agents),
        "states": list(states),
        "outputs": list(outputs),
        "units": units,
    }
