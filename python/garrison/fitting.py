"""Models from recorded data: CSV in, model out."""

import csv
import datetime as dt
import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from garrison import _core

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Records:
    """A CSV table of one date column and one column of numbers per station; an empty cell is a missing record."""

    dates: list[dt.date]
    stations: list[str]
    values: Array  # (samples, stations), nan = missing

    @property
    def first(self) -> int:
        """Days from the year 1 to the first record: the seasonal clock."""
        return self.dates[0].toordinal()

    def between(self, start: dt.date | None, end: dt.date | None) -> "Records":
        """The records from `start` to `end`, both included. Raises InvalidInput when there are none."""
        keep = [k for k, d in enumerate(self.dates) if (not start or d >= start) and (not end or d <= end)]
        if len(keep) < 2:
            span = f"{self.dates[0]}..{self.dates[-1]}"
            raise _core.InvalidInput(
                f"dates {start or ''}..{end or ''}: got {len(keep)} records, expected at least 2; the file has {span}"
            )
        return Records([self.dates[k] for k in keep], self.stations, self.values[keep])


def _cell(path: Path, line: int, column: str, cell: str) -> float:
    if not cell.strip():
        return float("nan")
    try:
        return float(cell)
    except ValueError:
        raise _core.InvalidInput(
            f"{path}, line {line}, column {column}: got {cell!r}, expected a number or an empty cell"
        ) from None


def _date(path: Path, line: int, cell: str) -> dt.date:
    try:
        return dt.date.fromisoformat(cell.strip())
    except ValueError:
        raise _core.InvalidInput(
            f"{path}, line {line}: got the date {cell!r}, expected YYYY-MM-DD in the first column"
        ) from None


def read_records(path: str | Path) -> Records:
    """Read daily records: a header `date,STATION,STATION,...`, then a row per day without gaps in the dates.

    Raises IoError when the file cannot be read, InvalidInput with the line when its content does not fit.
    """
    path = Path(path)
    try:
        with path.open(newline="", encoding="utf-8") as file:
            rows = list(csv.reader(file))
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise _core.IoError(f"{path}: got {error}, expected a readable CSV file") from error
    if len(rows) < 3 or len(rows[0]) < 2:
        raise _core.InvalidInput(f"{path}: got {len(rows)} line(s), expected a header and at least two rows of records")
    stations = [name.strip() for name in rows[0][1:]]
    dates, values = [], []
    for line, row in enumerate(rows[1:], start=2):
        if len(row) != len(stations) + 1:
            raise _core.InvalidInput(f"{path}, line {line}: got {len(row)} columns, expected {len(stations) + 1}")
        dates.append(_date(path, line, row[0]))
        values.append([_cell(path, line, name, cell) for name, cell in zip(stations, row[1:], strict=True)])
        if len(dates) > 1 and dates[-1] - dates[-2] != dt.timedelta(days=1):
            raise _core.InvalidInput(
                f"{path}, line {line}: got {dates[-1]} after {dates[-2]}, expected the next day; "
                "add the missing days with empty cells"
            )
    return Records(dates, stations, np.array(values))


@dataclass(frozen=True)
class Fit:
    """A model identified from clean records.

    model: with unit rows, noise bounds and covariances. records: what it was fitted to.
    """

    model: _core.Model
    identified: _core.Identified
    records: Records

    def measurements(self, records: Records) -> Array:
        """Measurements (samples, stations) of other records of the same stations."""
        if records.stations != self.records.stations:
            raise _core.InvalidInput(f"stations: got {records.stations}, expected {self.records.stations}")
        return self.identified.measurements(records.values, records.first)

    def reference(self, records: Records) -> Array:
        """What we call truth: the least-squares state (samples, n) of clean records of the same day."""
        return self.identified.reference_states(self.measurements(records))

    def to_json(self) -> str:
        """The model as text: everything a scenario or another program needs."""
        i = self.identified
        arrays: dict[str, Any] = {
            name: np.asarray(getattr(i, name)).tolist()
            for name in (
                "A",
                "C",
                "process_covariance",
                "measurement_variance",
                "measurement_bound",
                "scale",
                "season",
                "share",
            )
        }
        span = [str(self.records.dates[0]), str(self.records.dates[-1])]
        return json.dumps(
            {"stations": self.records.stations, "fitted": span, "process_bound": i.process_bound} | arrays,
            indent=1,
        )


def fit(records: Records, **options: Any) -> Fit:
    """Identify seasonal cycle, factors, A, C, noise levels and bounds from clean records.

    options: factors (state dimension, default 2), harmonics (2), period (365.25 samples), root (False: True works
    on square roots), factor (1: unit conversion). Raises InvalidInput when the records do not suffice.
    """
    i = _core.identify(records.values, records.first, **options)
    variances = np.asarray(i.measurement_variance)
    model = _core.Model(
        i.A,
        i.C,
        process_bound=i.process_bound,
        measurement_bound=i.measurement_bound,
        process_covariance=i.process_covariance,
        measurement_covariance=[[[v]] for v in variances],
    )
    return Fit(model, i, records)
