"""Which aircraft of a file, and which of its flights."""

import datetime as dt
from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from garrison.tables.clock import Moment
from garrison.words import count, refusal

#: s without a report, after which another flight begins
_PAUSE = 6 * 3600.0
#: aircraft and flights that a refusal names
_NAMED = 12


@dataclass(frozen=True)
class Choice:
    """aircraft: its ICAO address (or call sign, where the file has no addresses). start, end: first and last time, UTC.

    None: what the file has, if it is one.
    """

    aircraft: str | None = None
    start: Moment | None = None
    end: Moment | None = None

    def part(self, path: Path, who: str, t: NDArray[np.float64]) -> slice:
        """Of times in order, s since 1970, those chosen. Raises InvalidInput where these are several flights."""
        if self.start is None and self.end is None:
            _require_one_flight(path, who, t)
            return slice(0, len(t))
        first = 0 if self.start is None else int(np.searchsorted(t, _seconds(self.start)))
        last = len(t) if self.end is None else int(np.searchsorted(t, _seconds(self.end, end=True), side="right"))
        if last - first < 2:
            raise refusal("--from, --to", count(max(last - first, 0), "report"), f"at least two; {_span(who, t)}")
        return slice(first, last)


def of_one(path: Path, rows: list[list[Any]], at: int | None, wanted: str | None) -> tuple[list[list[Any]], str]:
    """The rows of one aircraft and its name. at: column of names."""
    if at is None:
        return rows, wanted or path.name.partition(".")[0]
    names = [str(row[at] or "").strip().lower() for row in rows]
    reports = Counter(name for name in names if name)
    if not reports:
        return rows, wanted or path.name.partition(".")[0]
    most = reports.most_common(_NAMED)
    shown = [f"{name} ({count(number, 'report')})" for name, number in most]
    listed = ", ".join(shown) + _rest(len(reports))
    if wanted is None and len(reports) > 1:
        raise refusal(
            str(path),
            f"{len(reports)} aircraft: {listed}",
            "one",
            f"choose with --aircraft, as --aircraft {most[0][0]}",
        )
    who = wanted.strip().lower() if wanted is not None else most[0][0]
    if who not in reports:
        raise refusal("--aircraft", who, f"one of {listed}")
    return [row for row, name in zip(rows, names, strict=True) if name == who], who


def _require_one_flight(path: Path, who: str, t: NDArray[np.float64]) -> None:
    parts = np.split(t, np.flatnonzero(np.diff(t) > _PAUSE) + 1)
    if len(parts) == 1:
        return
    longest = sorted(sorted(parts, key=len, reverse=True)[:_NAMED], key=lambda part: float(part[0]))
    listed = ", ".join(f"{_time(p[0])} to {_time(p[-1])} ({count(len(p), 'report')})" for p in longest)
    raise refusal(
        str(path),
        f"{len(parts)} flights of {who}, {_PAUSE / 3600:g} h or more apart: {listed}{_rest(len(parts))}",
        "one",
        "choose with --from and --to, in UTC",
    )


def _rest(number: int) -> str:
    return f" and {number - _NAMED} more" if number > _NAMED else ""


def _span(who: str, t: NDArray[np.float64]) -> str:
    return f"{who} has {_time(t[0])} to {_time(t[-1])} UTC"


def _time(seconds: float) -> str:
    return f"{dt.datetime.fromtimestamp(float(seconds), dt.UTC):%Y-%m-%d %H:%M:%S}"


def _seconds(moment: Moment, *, end: bool = False) -> float:
    """Seconds since 1970; a date is meant from its first to its last second."""
    if isinstance(moment, dt.datetime):
        return moment.replace(tzinfo=dt.UTC).timestamp()
    if isinstance(moment, dt.date):
        midnight = dt.datetime(moment.year, moment.month, moment.day, tzinfo=dt.UTC) + dt.timedelta(days=end)
        return midnight.timestamp() - (1e-3 if end else 0.0)
    return float(moment)
