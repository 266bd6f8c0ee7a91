"""From the text of a cell to a date with a time: ISO, compact, slashes and points, months, clocks of 12 hours."""

import calendar
import datetime as dt
import re

from garrison import _core
from garrison.words import refusal

_HOURS = r"(?P<hour>\d{1,2})(?::(?P<minute>\d{2})(?::(?P<second>\d{2})(?:[.,](?P<part>\d+))?)?)?"
_ZONE = r"(?P<zone>Z|UTC|GMT|[+-]\d{2}(?::?\d{2})?)"
_CLOCK = re.compile(rf"{_HOURS}(?:\s*(?P<half>[ap]\.?m\.?))?(?:\s*{_ZONE})?", re.IGNORECASE)
_TIME_ALONE = re.compile(r"\d{1,2}:\d{2}(:\d{2}([.,]\d+)?)?(\s*[ap]\.?m\.?)?", re.IGNORECASE)
_ISO = re.compile(r"(?P<y>\d{4})-(?P<m>\d{1,2})-(?P<d>\d{1,2})")
_SLASHED = re.compile(r"(\d{1,4})([./-])(\d{1,2})\2(\d{1,4})")
_MONTH = re.compile(r"(?P<y>\d{4})[-/](?P<m>\d{1,2})|(?P<m2>\d{1,2})[-/](?P<y2>\d{4})")
_NAMES = ("jan", "feb", "mar", "apr", "may", "jun", "jul", "aug", "sep", "oct", "nov", "dec")
_NAMED = "|".join(f"{name}[a-z]*" for name in _NAMES)
_WRITTEN = re.compile(
    rf"(?P<d>\d{{1,2}})[ -](?P<m>{_NAMED})\.?[ -](?P<y>\d{{4}})|(?P<m2>{_NAMED})\.? (?P<d2>\d{{1,2}}),? (?P<y2>\d{{4}})"
    rf"|(?P<m3>{_NAMED})\.?[ -](?P<y3>\d{{4}})",
    re.IGNORECASE,
)
#: a date and a time, the date first
_BOTH = re.compile(r"(?P<date>[^:]*?\d{4}|\d{4}[^:]*?)(?:[T ]\s*(?P<clock>\d{1,2}(?::|\s*[ap]\.?m).*))?", re.IGNORECASE)
#: YYYYMMDD, and with hours, minutes, seconds, as digits; without a T only from 1900 to 2099, where no count of seconds
#: or milliseconds since 1970 looks like it
_COMPACT = re.compile(
    rf"(?P<y>(?:18|19|20)\d\d)(?P<m>0[1-9]|1[0-2])(?P<d>0[1-9]|[12]\d|3[01])"
    rf"(?P<t>[T ]?)(?:(?P<hour>[01]\d|2[0-3])(?:(?P<minute>[0-5]\d)"
    rf"(?:(?P<second>[0-5]\d)(?:[.,](?P<part>\d+))?)?)?{_ZONE}?)?"
)
EXPECTED = "YYYY-MM-DD in the first column, with HH:MM:SS if there is a time"


def spelt_out(cells: list[str]) -> list[str]:
    """Cells that are all dates without separators, as 20240131 or 20240131T1200Z, with them; others as they are."""
    found = [_COMPACT.fullmatch(cell.strip()) for cell in cells]
    if not all(found) or any(m is not None and m["hour"] and not m["t"] and m["y"] < "1900" for m in found):
        return cells
    return [_separated(m) for m in found if m is not None]


def _separated(m: re.Match[str]) -> str:
    date = f"{m['y']}-{m['m']}-{m['d']}"
    if not m["hour"]:
        return date
    part = f".{m['part']}" if m["part"] else ""
    return f"{date} {m['hour']}:{m['minute'] or '00'}:{m['second'] or '00'}{part}{m['zone'] or ''}"


def looks_like_time(cell: str) -> bool:
    """A date, with or without a time; a month; no plain number."""
    text = cell.strip()
    compact = _COMPACT.fullmatch(text)
    return _parts(text) is not None or (compact is not None and bool(compact["t"]))


def seconds_of_day(cell: str) -> float | None:
    """Seconds since midnight of a time with hours, minutes and seconds; None for anything else."""
    text = cell.strip()
    found = _CLOCK.fullmatch(text)
    if found is None or not is_time_of_day(text) or found["second"] is None:
        return None
    try:
        since = _with_clock(dt.datetime(1, 1, 1), text) - dt.datetime(1, 1, 1)
    except ValueError:
        return None
    return since.total_seconds()


def is_time_of_day(cell: str) -> bool:
    """A time without a date."""
    return _TIME_ALONE.fullmatch(cell.strip()) is not None


def _parts(text: str) -> tuple[str, str] | None:
    """Text of the date and of the clock ("" = none), where both have a form that is known."""
    found = _BOTH.fullmatch(text)
    if found is None:
        return None
    date, clock = found["date"].strip(), (found["clock"] or "").strip()
    known = any(form.fullmatch(date) for form in (_ISO, _SLASHED, _WRITTEN, *(() if clock else (_MONTH,))))
    return (date, clock) if known and (not clock or _CLOCK.fullmatch(clock)) else None


def read_end(text: str, last: bool) -> dt.datetime | None:
    """A date that is given to choose records, in any form with the year first; last: a month means its last day."""
    spelt = spelt_out([text.strip()])[0]
    parts = _parts(spelt)
    if parts is None or ((found := _SLASHED.fullmatch(parts[0])) and len(found[1]) != 4):
        return None
    moment = moment_of("", spelt, "ymd")
    if last and (_MONTH.fullmatch(parts[0]) or ((m := _WRITTEN.fullmatch(parts[0])) and m["m3"])):
        moment = moment.replace(day=calendar.monthrange(moment.year, moment.month)[1])
    return moment


def order_of(places: list[str], cells: list[str]) -> str:
    """Order of day and month in dates with slashes or points: the only one that fits all rows."""
    dates = [parts[0] for cell in cells if (parts := _parts(cell.strip()))]
    slashed = [m for date in dates if not _ISO.fullmatch(date) and (m := _SLASHED.fullmatch(date))]
    if not slashed or len(slashed[0][1]) == 4:
        return "ymd"
    if any(int(m[1]) > 12 for m in slashed) or slashed[0][2] == ".":
        return "dmy"
    if any(int(m[3]) > 12 for m in slashed):
        return "mdy"
    raise refusal(places[0], f"the date {cells[0]!r}, day and month in either order", "YYYY-MM-DD in the first column")


def moment_of(place: str, cell: str, order: str) -> dt.datetime:
    """What one cell says. order: of the numbers of dates with slashes or points. Raises InvalidInput."""
    found = _parts(cell.strip())
    try:
        if found is None:
            raise ValueError
        date, clock = found
        y, m, d = _date(date, order)
        return _with_clock(dt.datetime(y, m, d), clock) if clock else dt.datetime(y, m, d)
    except (ValueError, OverflowError):
        no_such = found is not None and found[1] == "" and _ISO.fullmatch(found[0]) is not None
        words = "a day of the calendar" if no_such else EXPECTED
        raise _core.InvalidInput(f"{place}: got the date {cell!r}, expected {words}") from None


def _date(text: str, order: str) -> tuple[int, int, int]:
    if m := _ISO.fullmatch(text):
        return int(m["y"]), int(m["m"]), int(m["d"])
    if m := _SLASHED.fullmatch(text):
        named = dict(zip(order, (m[1], m[3], m[4]), strict=True))
        if len(named["y"]) != 4:  # of which century?
            raise ValueError
        return int(named["y"]), int(named["m"]), int(named["d"])
    if m := _MONTH.fullmatch(text):
        return int(m["y"] or m["y2"]), int(m["m"] or m["m2"]), 1
    m = _WRITTEN.fullmatch(text)
    if m is None:
        raise ValueError
    month = _NAMES.index((m["m"] or m["m2"] or m["m3"])[:3].lower()) + 1
    return int(m["y"] or m["y2"] or m["y3"]), month, int(m["d"] or m["d2"] or 1)


def _with_clock(day: dt.datetime, text: str) -> dt.datetime:
    m = _CLOCK.fullmatch(text)
    if m is None:
        raise ValueError
    hour, minute, second = (int(m[key] or 0) for key in ("hour", "minute", "second"))
    if m["half"]:
        if not 1 <= hour <= 12:
            raise ValueError
        hour = hour % 12 + (12 if m["half"][0] in "pP" else 0)
    if hour == 24 and minute == second == 0:  # the end of the day
        day, hour = day + dt.timedelta(days=1), 0
    micro = round(float(f"0.{m['part'] or 0}") * 1e6)
    found = day.replace(hour=hour, minute=minute, second=second) + dt.timedelta(microseconds=micro)
    return found if not m["zone"] else found.replace(tzinfo=_zone(m["zone"]))


def _zone(text: str) -> dt.tzinfo:
    if text.upper() in ("Z", "UTC", "GMT"):
        return dt.UTC
    digits = text[1:].replace(":", "").ljust(4, "0")
    offset = dt.timedelta(hours=int(digits[:2]), minutes=int(digits[2:]))
    return dt.timezone(-offset if text[0] == "-" else offset)
