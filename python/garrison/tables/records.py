"""Records of stations over time."""

import datetime as dt
from dataclasses import dataclass, field
from numbers import Real
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from garrison.result import Result
from garrison.tables.clock import Moment, of_number, seconds_of
from garrison.tables.columns import read_table
from garrison.words import count, hinted_methods, refusal, shown

Array = NDArray[np.float64]
_DAY = 86400.0
_DAYS_OF_A_YEAR = 365.25


@hinted_methods
@dataclass(frozen=True, eq=False, repr=False)
class Records(Result):
    """Regular records: times, and one column of numbers per station; nan = missing.

    dates: dates, dates with a time, or seconds. step: seconds between records. units: per station, "" = not said.
    notes: doubts about the file.
    """

    dates: list[Moment]
    stations: list[str]
    values: Array  # (samples, stations), nan = missing
    step: float = _DAY
    units: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)

    @property
    def first(self) -> int:
        """Records from the year 1 to the first one: the seasonal clock."""
        return round(seconds_of(self.dates[0]) / self.step)

    @property
    def samples_per_year(self) -> float:
        """Records of a year."""
        return _DAYS_OF_A_YEAR * _DAY / self.step

    def index(self, where: str, moment: Moment) -> int:
        """Index of the first record at or after `moment`; len(dates) when it is after the last."""
        moment = self.of_same_kind(where, moment)
        return int(np.searchsorted([seconds_of(d) for d in self.dates], seconds_of(moment) - 1e-6 * self.step))

    def of_same_kind(self, where: str, moment: Moment, *, last: bool = False) -> Moment:
        """As the records have theirs: a number among dates is a year (last: its last day) or counts since 1970.

        Raises InvalidInput for other numbers, and for a date where the records have plain seconds.
        """
        if isinstance(moment, bool) or not isinstance(moment, (dt.date, Real)):
            raise refusal(where, shown(moment), "a datetime.date or datetime.datetime, or a number of seconds")
        dated = isinstance(self.dates[0], dt.date)
        if dated and not isinstance(moment, dt.date) and (meant := of_number(float(moment), last)) is not None:
            return meant
        if isinstance(moment, dt.date) != dated:
            if dated:
                raise refusal(
                    where, f"the number {moment:g}", "a date YYYY-MM-DD, a month or a year, as the records have"
                )
            raise refusal(where, f"the date {moment}", "a number of seconds, as the records have")
        return moment

    def between(self, start: Moment | None, end: Moment | None) -> "Records":
        """The records from `start` to `end`, both included (a date means the whole day, a year all of it).

        Raises InvalidInput when there are less than two.
        """
        start = None if start is None else self.of_same_kind("from", start)
        first = 0 if start is None else self.index("from", start)
        last = len(self.dates)
        if end is not None:
            end = self.of_same_kind("to", end, last=True)
            day = isinstance(end, dt.date) and not isinstance(end, dt.datetime)
            limit = seconds_of(end) + (_DAY * (1 - 1e-9) if day else 1e-6 * self.step)
            last = int(np.searchsorted([seconds_of(d) for d in self.dates], limit, side="right"))
        if last - first < 2:
            span = f"{self.dates[0]}..{self.dates[-1]}"
            raise refusal(
                f"dates {'' if start is None else start}..{'' if end is None else end}",
                count(max(last - first, 0), "record"),
                f"at least 2; the file has {span}",
            )
        notes = [*self.notes, *self._beyond(start, end)]
        return Records(self.dates[first:last], self.stations, self.values[first:last], self.step, self.units, notes)

    def _beyond(self, start: Moment | None, end: Moment | None) -> list[str]:
        found = []
        if start is not None and seconds_of(start) < seconds_of(self.dates[0]):
            found.append(f"from {start}: the records begin later, at {self.dates[0]}")
        if end is not None and seconds_of(end) > seconds_of(self.dates[-1]):
            found.append(f"to {end}: the records end earlier, at {self.dates[-1]}")
        return found

    def of(self, stations: list[str]) -> "Records":
        """The records of `stations`, matched by name. Raises InvalidInput where one is missing."""
        if not isinstance(stations, (list, tuple)):
            raise refusal("stations", shown(stations), "a list of names of stations")
        missing = [s for s in stations if s not in self.stations]
        if missing:
            also = ", ".join(map(str, missing))
            raise refusal("stations", ", ".join(self.stations), f"also {also}, which the model has")
        columns = [self.stations.index(s) for s in stations]
        units = [self.units[c] for c in columns] if self.units else []
        return Records(self.dates, list(stations), self.values[:, columns], self.step, units, self.notes)


def read_records(path: str | Path) -> Records:
    """Read regular records: a header `date,STATION,STATION,...`, then a row per period.

    Any separator, decimal commas, dates or dates with times or seconds, any regular period; missing rows become missing
    records.

    Parameters
    ----------
    path : str or Path
        Of a CSV file.

    Returns
    -------
    Records
        dates, stations, values (samples, stations) with nan = missing, step (s), units, notes.

    Raises
    ------
    IoError
        The file cannot be read.
    InvalidInput
        With the line: its content does not fit.
    """
    table = read_table(path)
    if table.clock is None:
        raise refusal(
            str(path), f"the first column {table.names[0]!r} without times", "dates or seconds in the first column"
        )
    units = [c.unit for c in table.columns]
    return Records(table.clock.moments, table.names, table.values, table.clock.step, units, table.notes)
