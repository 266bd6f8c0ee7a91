"""Times of the rows: dates, dates with a time, or plain seconds; any regular period."""

import calendar
import datetime as dt
import math
import re
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from garrison.tables.cells import is_missing, number
from garrison.tables.moments import looks_like_time, moment_of, order_of, seconds_of_day, spelt_out
from garrison.tables.text import Rows
from garrison.words import count, refusal

Array = NDArray[np.float64]
#: a date for daily (or slower) records, a date with a time (UTC where a zone was given), or seconds
Moment: TypeAlias = dt.date | float
_DAY = 86400.0
_EPOCH = dt.datetime(1970, 1, 1)
_MONTH = 365.25 / 12 * _DAY
#: part of a period by which times with a clock may be off a regular grid
_JITTER = 0.05
#: missing rows that are filled in, per row that is there
_MOST_FILLED = 50
#: seconds of the units that a header may name, for plain numbers
_UNITS = {
    **dict.fromkeys(("ns", "nanoseconds"), 1e-9),
    **dict.fromkeys(("us", "\N{MICRO SIGN}s", "\N{GREEK SMALL LETTER MU}s", "microseconds"), 1e-6),
    **dict.fromkeys(("ms", "msec", "milliseconds"), 1e-3),
    **dict.fromkeys(("min", "minutes"), 60.0),
    **dict.fromkeys(("h", "hr", "hours"), 3600.0),
    **dict.fromkeys(("d", "days"), _DAY),
    **dict.fromkeys(("a", "yr", "years"), 365.25 * _DAY),
}
#: units that a name implies, and names of columns that hold more than a number
_IMPLIED = {"minute": "min", "minutes": "min", "hour": "h", "hours": "h", "day": "d", "days": "d"} | {
    "year": "a",
    "jahr": "a",
}
_DATES = ("date", "datum")
#: plain numbers from which on they count parts of a second since 1970 (from 1973 to the year 5138), and these parts
_EPOCHS = ((1e17, 1e20, 1e-9), (1e14, 1e17, 1e-6), (1e11, 1e14, 1e-3), (1e8, 1e11, 1.0))
#: units of the header that whole seconds since 1970 may have
_SECONDS = ("", "s", "sec", "seconds", "unix", "epoch")
#: counts of days by which programs keep dates -> those of the years 1954 to 2091
_DAYS = {
    "day numbers of a spreadsheet": (20000.0, 70000.0),
    "MATLAB's day numbers": (714000.0, 764000.0),
    "Julian days": (2434800.0, 2484800.0),
}
#: a year, in a column of years
_YEAR = re.compile(r"[12]\d{3}")


@dataclass(frozen=True)
class Clock:
    """Regular times. moments: of all rows, the missing ones included; step: s, or nan for calendar months."""

    moments: list[Moment]
    step: float
    at: list[int]  # row of the clock of each row of the file

    def fill(self, values: Array) -> tuple[Array, int]:
        """Rows for all moments, nan where the file has none; and how many were missing."""
        filled = np.full((len(self.moments), values.shape[1]), np.nan)
        filled[self.at] = values
        return filled, len(self.moments) - len(self.at)


def read_clock(rows: Rows, cells: list[str], name: str = "", unit: str = "") -> Clock:
    """The regular clock that the first column tells, gaps filled in. Raises InvalidInput with the line.

    name, unit: of the column, for plain numbers: days in a column `day`, no numbers at all in a column `date`, seconds
    where no unit of time is said. Numbers of the size of seconds (or milli-, micro-, nanoseconds) since 1970 are dates
    with a time.
    """
    places = [f"{rows.path}, line {line}" for line in rows.lines[1:]]
    for place, cell, row in zip(places, cells, rows.cells[1:], strict=True):
        if is_missing(cell):
            words = all(number(other, True) is None for other in row[1:]) and not all(map(is_missing, row[1:]))
            advice = "units belong into the header: A [unit]" if words else ""
            raise refusal(place, "no time", "a date or a number of seconds in the first column", advice)
    cells = spelt_out(cells)
    if _IMPLIED.get(name.lower()) == "a" and all(_YEAR.fullmatch(c.strip()) for c in cells):
        cells = [f"{c.strip()}-01-01" for c in cells]
    alone = [seconds_of_day(c) for c in cells]
    plain = [number(c, True) for c in cells] if None in alone else alone
    moments: list[Moment]
    if plain[0] is not None and not looks_like_time(cells[0]):
        moments = _seconds(places, cells, plain, unit or _IMPLIED.get(name.lower(), ""))
        if name.lower() in _DATES and not isinstance(moments[0], dt.date):
            raise refusal(
                places[0],
                f"the date {cells[0]!r}",
                "YYYY-MM-DD in the first column",
                f"{kind}: format the column as a date before you save it" if (kind := _day_numbers(plain)) else "",
            )
    else:
        moments = _dates(places, cells)
    return _regular(places, moments)


def doubt(cells: list[str], name: str, unit: str) -> list[str]:
    """A line where times that are read as seconds look like counts of days."""
    if unit or name.lower() in _IMPLIED or looks_like_time(cells[0]):
        return []
    kind = _day_numbers([number(c, True) for c in cells])
    if kind is None:
        return []
    return [
        f"column {name}: {cells[0].strip()} to {cells[-1].strip()} are read as seconds; if they are {kind}, name the "
        f"column `{name} [d]`, or format it as a date before you save it"
    ]


def _day_numbers(plain: list[float | None]) -> str | None:
    """Whose counts of days all of them may be, as dates of our time."""
    for kind, (least, most) in _DAYS.items():
        if all(value is not None and least <= value < most for value in plain):
            return kind
    return None


def _seconds(places: list[str], cells: list[str], plain: list[float | None], unit: str) -> list[Moment]:
    out: list[float] = []
    for place, cell, value in zip(places, cells, plain, strict=True):
        if value is None or not np.isfinite(value):
            raise refusal(place, f"the time {cell!r}", "a number of seconds, as in the rows before")
        out.append(value)
    unit = unit.strip().lower()
    if (part := _part_since_1970(out)) is not None and (part < 1 or unit in _SECONDS):
        return _plain_dates([_at_epoch(value, part) for value in out])
    factor = _UNITS.get(unit, 1.0)
    return [value * factor for value in out]


def _part_since_1970(values: list[float]) -> float | None:
    """The part of a second that numbers of this size count since 1970; None where they are too small or too large."""
    return next((part for least, most, part in _EPOCHS if all(least <= value < most for value in values)), None)


def _at_epoch(value: float, part: float) -> dt.datetime:
    return _EPOCH + dt.timedelta(microseconds=round(value * part * 1e6))


def of_number(value: float, last: bool) -> dt.date | None:
    """The date that a number among dates means: a year (last: its last day), or a time since 1970; None for others."""
    if not math.isfinite(value):
        return None
    if value == int(value) and 1000 <= value <= 9999:
        return dt.date(int(value), 12, 31) if last else dt.date(int(value), 1, 1)
    part = _part_since_1970([value])
    return None if part is None else _at_epoch(value, part)


def _dates(places: list[str], cells: list[str]) -> list[Moment]:
    order = order_of(places, cells)
    found = [moment_of(place, cell, order) for place, cell in zip(places, cells, strict=True)]
    zoned = [m.tzinfo is not None for m in found]
    if any(zoned) and not all(zoned):
        raise refusal(places[zoned.index(False)], "a time without a time zone", "one with a zone, as other rows have")
    utc = [m.astimezone(dt.UTC).replace(tzinfo=None) if m.tzinfo else m for m in found]
    return _plain_dates(utc)


def _plain_dates(moments: list[dt.datetime]) -> list[Moment]:
    """As dates where all of them are at midnight."""
    return [m.date() for m in moments] if all(m.time() == dt.time() for m in moments) else list(moments)


def seconds_of(moment: Moment) -> float:
    """Seconds since the beginning of the year 1; of plain seconds themselves."""
    if isinstance(moment, dt.datetime):
        return (moment - dt.datetime(1, 1, 1)).total_seconds() + _DAY
    return moment.toordinal() * _DAY if isinstance(moment, dt.date) else float(moment)


def _since(first: Moment, moment: Moment) -> float:
    """Seconds; without the rounding of a difference of two large numbers."""
    if isinstance(moment, dt.datetime) and isinstance(first, dt.datetime):
        return (moment - first).total_seconds()
    return seconds_of(moment) - seconds_of(first)


def _regular(places: list[str], moments: list[Moment]) -> Clock:
    times = np.array([_since(moments[0], m) for m in moments])
    steps = np.diff(times)
    for k, step in enumerate(steps):
        if step <= 0:
            what = "the same time as" if step == 0 else "a time before"
            advice = "remove the duplicate" if step == 0 else "sort the rows by time"
            if isinstance(moments[k], dt.datetime):
                advice += "; where clocks change, give the times in UTC or with their zone"
            raise refusal(places[k + 1], f"{moments[k + 1]}, {what} the row before", "a later one", advice)
    if months := _months(moments):
        return months
    least = float(np.min(steps))
    if times[-1] - times[0] > _MOST_FILLED * len(moments) * least:
        got = f"{(times[-1] - times[0]) / least:.3g} periods of {_words(least)} with {count(len(moments), 'row')}"
        raise refusal(places[-1], got, "fewer gaps")
    at = np.concatenate([[0], np.cumsum(np.rint(steps / least))]).astype(int)
    step = float((times[-1] - times[0]) / at[-1])
    off = np.abs(times - times[0] - at * step)
    daily = all(isinstance(m, dt.date) and not isinstance(m, dt.datetime) for m in moments)
    # Dates are exact; clocks and printed seconds are rounded.
    if (off > (1e-6 if daily else _JITTER) * step).any():
        wrong, period = _first_off(steps, least)
        raise refusal(
            places[wrong],
            f"{moments[wrong]} after {moments[wrong - 1]}",
            f"a whole number of periods of {_words(period)} later",
            "resample the records to a regular period (in UTC where clocks change)",
        )
    return Clock(
        _whole(moments, at.tolist(), [_later(moments[0], k, step) for k in range(at[-1] + 1)]), step, at.tolist()
    )


def _first_off(steps: Array, least: float) -> tuple[int, float]:
    """The first row that breaks the period, and the period: the step of most rows, or the least of all."""
    kinds, counts = np.unique(np.round(steps, 6), return_counts=True)
    usual = float(kinds[np.argmax(counts)]) if counts.max() > len(steps) / 2 else least
    off = np.abs(steps / usual - np.rint(steps / usual))
    return int(np.argmax(off > _JITTER) if (off > _JITTER).any() else np.argmax(off)) + 1, usual


def _whole(moments: list[Moment], at: list[int], regular: list[Moment]) -> list[Moment]:
    """The regular times, those that the file has as it has them."""
    for k, moment in zip(at, moments, strict=True):
        regular[k] = moment
    return regular


def _words(step: float) -> str:
    for size, unit in ((_DAY, "day"), (3600.0, "hour"), (60.0, "minute")):
        if step >= size:
            return f"{step / size:g} {unit if step == size else unit + 's'}"
    return f"{step:g} s"


def _later(first: Moment, count: int, step: float) -> Moment:
    if isinstance(first, dt.datetime):
        return first + dt.timedelta(seconds=round(count * step, 6))
    if isinstance(first, dt.date):
        return first + dt.timedelta(days=round(count * step / _DAY))
    return first + count * step


def _months(moments: list[Moment]) -> Clock | None:
    """Monthly (or yearly) records: always the same day of the month, or always the last one."""
    dates = [m for m in moments if isinstance(m, dt.date) and not isinstance(m, dt.datetime)]
    if len(dates) < len(moments) or len(moments) < 3:
        return None
    last = all(d.day == calendar.monthrange(d.year, d.month)[1] for d in dates)
    if not last and (len({d.day for d in dates}) > 1 or dates[0].day > 28):
        return None
    months = np.array([12 * d.year + d.month - 1 for d in dates])
    step = int(np.diff(months).min())
    if step < 1 or (np.diff(months) % step).any():
        return None
    at = (months - months[0]) // step
    if at[-1] + 1 > _MOST_FILLED * len(moments):
        return None
    regular: list[Moment] = []
    for index in months[0] + step * np.arange(at[-1] + 1):
        year, month = int(index) // 12, int(index) % 12 + 1
        day = calendar.monthrange(year, month)[1] if last else dates[0].day
        regular.append(dt.date(year, month, day))
    return Clock(regular, step * _MONTH, at.tolist())
