"""The forms of a track, JSON or CSV, as rows under a header."""

import csv
import io
import json
from pathlib import Path
from typing import Any

from garrison.numeric import real
from garrison.words import count, refusal, shown

EXPECTED = "a track: state vectors (JSON or CSV), or a trace of readsb or ADS-B Exchange (JSON), also as .gz"
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
#: columns that tell a download of Flightradar24, and what the others call them
_PLAYED_BACK = {"timestamp", "position", "speed", "direction"}
_PLAYED_NAMES = {"speed": "groundspeed", "direction": "track"}


def rows_of(path: Path, text: str) -> list[list[Any]]:
    """Names of columns, then a row per report. Raises InvalidInput where the text is no track."""
    if not text.strip():
        raise refusal(str(path), "an empty file", EXPECTED)
    rows = _rows_of_json(path, text) if text.lstrip()[:1] in "[{" else _rows_of_csv(path, text)
    if len(rows) < 2:
        raise refusal(str(path), "no report", EXPECTED)
    return rows


def _rows_of_csv(path: Path, text: str) -> list[list[Any]]:
    lines = text.splitlines()
    separator = max(",;\t|", key=lines[0].count)
    try:
        rows: list[list[Any]] = [row for row in csv.reader(io.StringIO(text, newline=""), delimiter=separator) if row]
    except csv.Error as error:
        raise refusal(str(path), f"no table ({error})", EXPECTED) from None
    for k, row in enumerate(rows[1:], start=2):
        if len(row) != len(rows[0]):
            raise refusal(f"{path}, row {k}", f"{count(len(row), 'cell')}", f"{len(rows[0])}, as the header has")
    names = [name.strip().lower() for name in rows[0]]
    return _of_flightradar24(path, names, rows[1:]) if set(names) >= _PLAYED_BACK else rows


def _of_flightradar24(path: Path, names: list[str], rows: list[list[Any]]) -> list[list[Any]]:
    """Downloads of Flightradar24: a pair of degrees in one column, knots, feet."""
    at = names.index("position")
    out = [[_PLAYED_NAMES.get(name, name) for name in names] + ["latitude", "longitude"]]
    for row in rows:
        latitude, comma, longitude = row[at].partition(",")
        if not comma:
            raise refusal(str(path), f"the position {shown(row[at])}", "latitude,longitude")
        out.append([*row, latitude, longitude])
    return out


def _rows_of_json(path: Path, text: str) -> list[list[Any]]:
    try:
        plain = json.loads(text)
    except ValueError as error:
        try:
            plain = [json.loads(line) for line in text.splitlines() if line.strip()]  # JSON lines
        except ValueError:
            raise refusal(str(path), f"{error}", EXPECTED) from None
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
    raise refusal(str(path), shown(type(plain).__name__), EXPECTED)


def _of_columns(path: Path, plain: dict[str, Any]) -> list[list[Any]]:
    """pandas, orient="columns": name -> index -> value; or name -> list."""
    columns = {k: list(v.values()) if isinstance(v, dict) else v for k, v in plain.items()}
    columns = {k: v for k, v in columns.items() if isinstance(v, list)}
    if not columns or len({len(v) for v in columns.values()}) > 1:
        raise refusal(str(path), f"the keys {', '.join(map(str, plain))[:200]}", EXPECTED)
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
    """readsb and ADS-B Exchange: points that were received."""
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
