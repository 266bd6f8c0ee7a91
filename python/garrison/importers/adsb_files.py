"""Tracks of one aircraft: state vectors (OpenSky, traffic), readsb and ADS-B Exchange traces."""

import csv
import datetime as dt
import io
import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from garrison.importers.texts import bytes_of
from garrison.numeric import real
from garrison.tables.text import decoded
from garrison.words import refusal, shown

Array = NDArray[np.float64]
_EXPECTED = "a track: state vectors (JSON or CSV), or a trace of readsb or ADS-B Exchange (JSON), also as .gz"
_KNOT, _FOOT = 1852.0 / 3600.0, 0.3048
#: what we need -> (names of its column, factor to SI) in the usual forms, first found first taken
_COLUMNS: dict[str, list[tuple[str, float]]] = {
    "time": [("timestamp", 1.0), ("time", 1.0), ("t", 1.0), ("now", 1.0), ("snapshot", 1.0)],
    "aircraft": [("icao24", 1.0), ("icao", 1.0), ("hex", 1.0), ("address", 1.0)],
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
#: of an OpenSky state vector, in their order
_STATE = (
    "icao24",
    "callsign",
    "origin_country",
    "time_position",
    "last_contact",
    "longitude",
    "latitude",
    "baro_altitude",
    "on_ground",
    "velocity",
    "true_track",
    "vertical_rate",
    "sensors",
    "geo_altitude",
    "squawk",
    "spi",
    "position_source",
)
#: of a trace point of readsb: seconds after the file's timestamp, degrees, feet, knots, degrees, flags
_TRACE = ("offset", "lat", "lon", "alt", "gs", "track", "flags")
_STALE = 1
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


def read_track(path: Path, aircraft: str | None = None) -> Track:
    """The track of a file. aircraft: whose, where the file has several. Raises IoError or InvalidInput."""
    text = decoded(path, bytes_of(path, _EXPECTED), _EXPECTED)
    if not text.strip():
        raise refusal(str(path), "an empty file", _EXPECTED)
    rows = _rows_of_json(path, text) if text.lstrip()[:1] in "[{" else _rows_of_csv(path, text)
    names = {name: k for k, name in enumerate(rows[0])} if rows else {}
    if len(rows) < 2:
        raise refusal(str(path), "no report", _EXPECTED)
    found = {what: _chosen(names, known) for what, known in _COLUMNS.items()}
    needed = [w for w in ("time", "latitude", "longitude", "speed", "track") if found[w] is None]
    if needed:
        expected = "; ".join(f"{w}: one of {', '.join(n for n, _ in _COLUMNS[w])}" for w in needed)
        raise refusal(str(path), f"no column of {', '.join(needed)} among {', '.join(rows[0])[:200]}", expected)
    body, who = _of_one(path, rows[1:], found["aircraft"], aircraft)
    return _track(path, who, body, found)


def _chosen(names: dict[str, int], known: list[tuple[str, float]]) -> tuple[int, float] | None:
    lower = {name.strip().lower(): k for name, k in names.items()}
    return next(((lower[name], factor) for name, factor in known if name in lower), None)


def _of_one(
    path: Path, rows: list[list[Any]], at: tuple[int, float] | None, wanted: str | None
) -> tuple[list[list[Any]], str]:
    """The rows of one aircraft and its address."""
    if at is None:
        return rows, wanted or path.name.partition(".")[0]
    addresses = list(dict.fromkeys(str(row[at[0]]).strip().lower() for row in rows))
    if wanted is None and len(addresses) > 1:
        shown_ = ", ".join(addresses[:8])
        raise refusal(
            str(path), f"{len(addresses)} aircraft ({shown_}, ..)", "one", "choose with --aircraft and its address"
        )
    who = (wanted or addresses[0]).strip().lower()
    if who not in addresses:
        raise refusal("--aircraft", who, f"one of {', '.join(addresses[:20])}")
    return [row for row in rows if str(row[at[0]]).strip().lower() == who], who


def _track(path: Path, who: str, rows: list[list[Any]], found: dict[str, tuple[int, float] | None]) -> Track:
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
    order = np.flatnonzero(known)[np.argsort(t[known], kind="stable")]
    if len(order) < 2:
        raise refusal(str(path), f"{len(order)} reports with a time", "at least two")
    parts = ("latitude", "longitude", "speed", "track")
    arrays = [t, *(column[p] for p in parts), column.get("altitude", nothing), position_time]
    t, latitude, longitude, speed, track, altitude, position_time = (a[order] for a in arrays)
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


def _rows_of_csv(path: Path, text: str) -> list[list[Any]]:
    lines = text.splitlines()
    separator = max(",;\t|", key=lines[0].count)
    rows: list[list[Any]] = [row for row in csv.reader(io.StringIO(text), delimiter=separator) if row]
    for k, row in enumerate(rows[1:], start=2):
        if len(row) != len(rows[0]):
            raise refusal(f"{path}, row {k}", f"{len(row)} cells", f"{len(rows[0])}, as the header has")
    return rows


def _rows_of_json(path: Path, text: str) -> list[list[Any]]:
    try:
        plain = json.loads(text)
    except ValueError as error:
        try:
            plain = [json.loads(line) for line in text.splitlines() if line.strip()]  # JSON lines
        except ValueError:
            raise refusal(str(path), f"{error}", _EXPECTED) from None
    if isinstance(plain, dict) and isinstance(plain.get("trace"), list):
        return _of_trace(path, plain)
    if isinstance(plain, dict) and "path" in plain:
        raise refusal(
            str(path), "waypoints of the OpenSky tracks interface, without speeds", "state vectors, or a trace"
        )
    if isinstance(plain, dict) and "states" in plain:
        plain = [plain]
    if isinstance(plain, list) and plain and isinstance(plain[0], dict) and "states" in plain[0]:
        return _of_snapshots(path, plain)
    if isinstance(plain, dict) and isinstance(plain.get("columns"), list) and isinstance(plain.get("data"), list):
        return [[str(c) for c in plain["columns"]], *plain["data"]]  # pandas, orient="split"
    if isinstance(plain, dict):
        return _of_columns(path, plain)
    if isinstance(plain, list) and plain and all(isinstance(one, dict) for one in plain):
        names = list(dict.fromkeys(name for one in plain for name in one))
        return [names, *([one.get(name) for name in names] for one in plain)]
    raise refusal(str(path), shown(type(plain).__name__), _EXPECTED)


def _of_columns(path: Path, plain: dict[str, Any]) -> list[list[Any]]:
    """pandas, orient="columns": name -> index -> value; or name -> list."""
    columns = {k: list(v.values()) if isinstance(v, dict) else v for k, v in plain.items()}
    columns = {k: v for k, v in columns.items() if isinstance(v, list)}
    if not columns or len({len(v) for v in columns.values()}) > 1:
        raise refusal(str(path), f"the keys {', '.join(map(str, plain))[:200]}", _EXPECTED)
    return [list(columns), *(list(row) for row in zip(*columns.values(), strict=True))]


def _of_snapshots(path: Path, plain: list[dict[str, Any]]) -> list[list[Any]]:
    """Answers of the OpenSky states interface, one per time."""
    rows = []
    for one in plain:
        for state in one.get("states") or []:
            if not isinstance(state, list) or len(state) < len(_STATE):
                raise refusal(str(path), f"the state {shown(state)}", f"{len(_STATE)} values: {', '.join(_STATE)}")
            rows.append([one.get("time"), *state[: len(_STATE)]])
    return [["time", *_STATE], *rows]


def _of_trace(path: Path, plain: dict[str, Any]) -> list[list[Any]]:
    """readsb and ADS-B Exchange: points that were received, stale ones marked."""
    first = real(plain.get("timestamp"))
    if first is None:
        raise refusal(str(path), "a trace without timestamp", "seconds since 1970 in timestamp")
    rows: list[list[Any]] = []
    for point in plain["trace"]:
        if not isinstance(point, list) or len(point) < len(_TRACE):
            raise refusal(str(path), f"the point {shown(point)}", f"a list that starts with {', '.join(_TRACE)}")
        values: dict[str, Any] = dict(zip(_TRACE, point, strict=False))
        offset = real(values["offset"])
        if offset is None:
            raise refusal(str(path), f"the point {shown(point)}", "seconds after the timestamp, as its first value")
        t = first + offset
        rows.append([t, *(values[n] for n in ("lat", "lon", "alt", "gs", "track")), t])
    who = str(plain.get("icao", path.name.partition(".")[0]))
    head = ["time", "lat", "lon", "alt", "gs", "track", "last_position"]
    return [[*head, "icao"], *([*row, who] for row in rows)]
