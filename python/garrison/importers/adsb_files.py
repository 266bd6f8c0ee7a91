"""Tracks of one aircraft: columns by their names, in SI units, in order of time."""

import datetime as dt
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from garrison.importers.adsb_choice import Choice, of_one
from garrison.importers.adsb_forms import EXPECTED, rows_of
from garrison.importers.texts import bytes_of
from garrison.numeric import real
from garrison.tables.text import decoded
from garrison.words import count, refusal, shown

Array = NDArray[np.float64]
_KNOT, _FOOT = 1852.0 / 3600.0, 0.3048
#: what we need -> (names of its column, factor to SI) in the usual forms, first found first taken
_COLUMNS: dict[str, list[tuple[str, float]]] = {
    "time": [("timestamp", 1.0), ("time", 1.0), ("t", 1.0), ("now", 1.0), ("snapshot", 1.0)],
    "aircraft": [("icao24", 1.0), ("icao", 1.0), ("hex", 1.0), ("address", 1.0), ("callsign", 1.0)],
    "latitude": [("latitude", 1.0), ("lat", 1.0)],
    "longitude": [("longitude", 1.0), ("lon", 1.0), ("lng", 1.0), ("long", 1.0)],
    "speed": [("groundspeed", _KNOT), ("ground_speed", _KNOT), ("gs", _KNOT), ("velocity", 1.0), ("gspeed", _KNOT)],
    "track": [("track", 1.0), ("heading", 1.0), ("true_track", 1.0), ("trk", 1.0)],
    "altitude": [
        ("altitude", _FOOT),
        ("alt_baro", _FOOT),
        ("alt", _FOOT),
        ("baroaltitude", 1.0),
        ("baro_altitude", 1.0),
        ("geoaltitude", 1.0),
        ("geo_altitude", 1.0),
    ],
    "last_position": [("last_position", 1.0), ("lastposupdate", 1.0), ("time_position", 1.0)],
    "seen_position": [("seen_pos", 1.0)],
}
_UNITS: dict[str, dict[float, str]] = {"speed": {_KNOT: " (knots)", 1.0: " (m/s)"}}
_LATEST = 2.5e11  # s since 1970: the year 9892
_MILLISECONDS = 1e11  # epochs above this are not in seconds


@dataclass(frozen=True)
class Track:
    """Reports of one aircraft in order of time.

    t: s since 1970. latitude, longitude: degrees. speed: m/s over ground. track: degrees from north, clockwise.
    altitude: m. position_time: s since 1970, when the position was received. nan = missing.
    """

    path: Path
    aircraft: str
    t: Array
    latitude: Array
    longitude: Array
    speed: Array
    track: Array
    altitude: Array
    position_time: Array


def read_track(path: Path, choice: Choice | None = None) -> Track:
    """The track of a file. choice: of what it has several. Raises IoError or InvalidInput."""
    choice = choice or Choice()
    rows = rows_of(path, decoded(path, bytes_of(path, EXPECTED), EXPECTED))
    names = {name: k for k, name in enumerate(rows[0])}
    found = {what: _chosen(names, known) for what, known in _COLUMNS.items()}
    needed = [w for w in ("time", "latitude", "longitude", "speed", "track") if found[w] is None]
    if needed:
        expected = "; ".join(f"{w}: {_known(w)}" for w in needed)
        got = f"no column of {', '.join(needed)} among {', '.join(filter(None, rows[0]))[:200]}"
        raise refusal(str(path), got, expected, "rename the column that holds it")
    body, who = of_one(path, rows[1:], None if found["aircraft"] is None else found["aircraft"][0], choice.aircraft)
    return _track(path, who, body, found, choice)


def _known(what: str) -> str:
    """Names of a column, by their units where they have several."""
    units = _UNITS.get(what, {1.0: ""})
    return " or ".join(
        f"one of {', '.join(name for name, factor in _COLUMNS[what] if factor == unit)}{label}"
        for unit, label in units.items()
    )


def _chosen(names: dict[str, int], known: list[tuple[str, float]]) -> tuple[int, float] | None:
    lower = {name.strip().lower(): k for name, k in names.items()}
    return next(((lower[name], factor) for name, factor in known if name in lower), None)


def _track(
    path: Path, who: str, rows: list[list[Any]], found: dict[str, tuple[int, float] | None], choice: Choice
) -> Track:
    column = {
        what: np.array([_number(path, row[at[0]], what) for row in rows]) * at[1]
        for what, at in found.items()
        if at is not None and what != "aircraft"
    }
    t = _seconds(column["time"])
    nothing = np.full(len(t), np.nan)
    position_time = _seconds(column.get("last_position", nothing))
    if "seen_position" in column:
        position_time = t - column["seen_position"]
    known = np.isfinite(t)
    if (np.abs(t[known]) > _LATEST).any():
        late = float(t[known][np.argmax(np.abs(t[known]))])
        raise refusal(str(path), f"the time {late:g} s", "seconds since 1970, or milli-, micro- or nanoseconds")
    order = np.flatnonzero(known)[np.argsort(t[known], kind="stable")]
    if len(order) < 2:
        raise refusal(str(path), f"{count(len(order), 'report')} with a time", "at least two")
    order = order[choice.part(path, who, t[order])]
    parts = ("latitude", "longitude", "speed", "track")
    arrays = [t, *(column[p] for p in parts), column.get("altitude", nothing), position_time]
    t, latitude, longitude, speed, track, altitude, position_time = (a[order] for a in arrays)
    nowhere = (latitude == 0.0) & (longitude == 0.0)  # how some write that there is no position
    latitude, longitude = (np.where(nowhere, np.nan, a) for a in (latitude, longitude))
    wrong = (np.abs(latitude) > 90) | (np.abs(longitude) > 360)
    if wrong.any():
        k = int(np.argmax(wrong))
        raise refusal(f"{path}, report {k + 1}", f"the position {latitude[k]:g}, {longitude[k]:g}", "degrees")
    return Track(path, who, t, latitude, longitude, speed, track, altitude, position_time)


def _number(path: Path, value: Any, what: str) -> float:
    """A cell as a number; times may be dates; "ground" is an altitude."""
    if value is None or value == "" or (isinstance(value, str) and value.lower() in ("nan", "none", "null", "nat")):
        return float("nan")
    if (found := real(value)) is not None:
        return found
    if what == "altitude" and value == "ground":
        return 0.0
    try:
        return float(value)
    except (TypeError, ValueError):
        pass
    if what in ("time", "last_position"):
        try:
            moment = dt.datetime.fromisoformat(str(value).strip())
            return (moment if moment.tzinfo else moment.replace(tzinfo=dt.UTC)).timestamp()
        except ValueError:
            pass
    raise refusal(str(path), f"the {what} {shown(value)}", "a number" if what != "time" else "seconds or an ISO date")


def _seconds(t: Array) -> Array:
    """Epochs in seconds, milliseconds, microseconds or nanoseconds as seconds."""
    out = np.array(t, dtype=float)
    for _ in range(3):
        out = np.where(np.abs(out) > _MILLISECONDS, out / 1000.0, out)
    return out
