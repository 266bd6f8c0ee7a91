"""`garrison import adsb`: every form of a track gives the same numbers; the spoofed sample is noticed."""

import csv
import gzip
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import ROOT
from garrison import _core
from garrison.cli import main
from garrison.importers.adsb import import_adsb
from garrison.importers.earth import Plane
from garrison.jobs import run_scenario
from garrison.scenario import read_scenario

SAMPLE = ROOT / "examples" / "import" / "adsb_sample.json.gz"
FEET, KNOTS = 0.3048, 1852.0 / 3600.0


def reports(most: int = 200) -> list[dict[str, Any]]:
    """The first reports of the sample as records; those that were received."""
    plain = json.loads(gzip.decompress(SAMPLE.read_bytes()))
    rows = [{name: values[str(k)] for name, values in plain.items()} for k in range(most)]
    return [row for row in rows if row["last_position"] == row["timestamp"]]


def opensky(row: dict[str, Any]) -> list[Any]:
    """A state vector of the OpenSky interface."""
    t, si = row["timestamp"] // 1000, row["altitude"] * FEET
    return [
        row["icao24"], "SAMPLE1 ", "Nowhere", t, t, row["longitude"], row["latitude"], si, False,
        row["groundspeed"] * KNOTS, row["track"], 0.0, None, si, None, False, 0,
    ]  # fmt: skip


def columns_of(rows: list[dict[str, Any]]) -> dict[str, list[Any]]:
    return {name: [row[name] for row in rows] for name in rows[0]}


def as_csv(path: Path, rows: list[dict[str, Any]]) -> None:
    with path.open("w", newline="") as file:
        out = csv.DictWriter(file, rows[0])
        out.writeheader()
        out.writerows(rows)


def forms(folder: Path) -> dict[str, Path]:
    """The same reports in every form that is read."""
    rows, out = reports(), {}

    def put(name: str, text: str, ending: str = "json") -> None:
        out[name] = folder / f"{name}.{ending}"
        out[name].write_text(text)

    put("columns", json.dumps(columns_of(rows)))
    put("records", json.dumps(rows))
    put("lines", "\n".join(json.dumps(row) for row in rows))
    head = list(rows[0])
    put("split", json.dumps({"columns": head, "index": [], "data": [[row[n] for n in head] for row in rows]}))
    states = [{"time": row["timestamp"] // 1000, "states": [opensky(row)]} for row in rows]
    put("states", json.dumps(states))
    first = rows[0]["timestamp"] / 1000.0
    trace = [
        [r["timestamp"] / 1000 - first, r["latitude"], r["longitude"], 36000, r["groundspeed"], r["track"], 0, 0, None]
        for r in rows
    ]
    put("trace", json.dumps({"icao": "abcdef", "timestamp": first, "trace": trace}))
    names = ["time", "icao24", "lat", "lon", "velocity", "heading", "baroaltitude", "lastposupdate"]
    table = []
    for row in rows:
        s = opensky(row)
        table.append(dict(zip(names, [s[4], s[0], s[6], s[5], s[9], s[10], s[7], s[3]], strict=True)))
    as_csv(folder / "history.csv", table)
    iso = [row | {"timestamp": f"{np.datetime64(row['timestamp'], 'ms')}Z"} for row in rows]
    as_csv(folder / "iso.csv", iso)
    return out | {"history": folder / "history.csv", "iso": folder / "iso.csv"}


@pytest.mark.parametrize("form", ["records", "lines", "split", "states", "trace", "history", "iso"])
def test_all_forms_say_the_same(tmp_path: Path, form: str) -> None:
    found = forms(tmp_path)
    expected, got = import_adsb(found["columns"]).measurements, import_adsb(found[form]).measurements
    assert expected is not None and got is not None
    assert got.times == expected.times
    assert np.allclose(got.values, expected.values, rtol=1e-6, atol=0.05, equal_nan=True)


def test_the_spoofed_sample_is_noticed_and_forgiven(tmp_path: Path) -> None:
    assert main(["import", "adsb", str(SAMPLE), "-o", str(tmp_path / "air")]) == 0
    assert main(["check", str(tmp_path / "air" / "scenario.toml")]) == 0
    scenario = read_scenario(tmp_path / "air" / "scenario.toml")
    run = run_scenario(scenario)[0].run
    assert run is not None and run.verdict is not None
    accused = np.asarray(run.verdict)[0, 1:] == 2  # Verdict.attacked
    assert not accused[:900].any()  # spoofed from sample 900 on
    assert accused[900:905, 0].any()
    assert not accused[-100:].any()  # right again since sample 1200


@pytest.mark.parametrize("jam", [120, 300])
def test_a_lie_after_a_jam_is_noticed_at_once(tmp_path: Path, jam: int) -> None:
    columns = json.loads(gzip.decompress(SAMPLE.read_bytes()))
    start = columns["timestamp"]["0"]
    jammed = [k for k, time in columns["timestamp"].items() if 0 <= 900 - (time - start) / 1000 <= jam]
    heard = {name: {k: v for k, v in column.items() if k not in jammed} for name, column in columns.items()}
    (tmp_path / "jammed.json").write_text(json.dumps(heard), encoding="utf-8")
    import_adsb(tmp_path / "jammed.json").write(tmp_path / "air")
    run = run_scenario(read_scenario(tmp_path / "air" / "scenario.toml"))[0].run
    assert run is not None and run.verdict is not None
    accused = np.asarray(run.verdict)[0, 1:] == 2  # Verdict.attacked
    assert not accused[:900].any()  # spoofed from sample 900 on
    assert accused[901:905].any()  # by position or by velocity
    assert not accused[-100:].any()


def test_the_plane_keeps_velocities_derivatives_of_positions() -> None:
    plane = Plane(47.0, 8.0)
    latitude, longitude = np.array([55.0, 55.001]), np.array([20.0, 20.003])
    moved = np.diff(plane.position(latitude, longitude), axis=0)[0]
    # Lengths of a degree at 55 degrees north on WGS 84: 111.32 km north, 63.995 km east.
    speed, track = np.hypot(0.001 * 111_323.9, 0.003 * 63_994.6), np.arctan2(0.003 * 63_994.6, 0.001 * 111_323.9)
    middle = np.array([55.0005])
    found = plane.velocity(middle, np.zeros(1), np.array([speed]), np.rad2deg(np.array([track])))[0]
    assert np.allclose(found, moved, rtol=2e-4)


def test_the_plane_is_true_to_known_lengths() -> None:
    quarter = Plane(0.0, 0.0).position(np.array([90.0]), np.array([0.0]))[0, 1]
    assert quarter == pytest.approx(10_001_965.729, abs=0.01)  # WGS 84 meridian quadrant
    equator = Plane(0.0, 0.0).position(np.array([0.0]), np.array([90.0]))[0, 0]
    assert equator == pytest.approx(6378137.0 * np.pi / 2, abs=1e-3)
    assert Plane(0.0, 179.9).position(np.array([0.0]), np.array([-179.9]))[0, 0] == pytest.approx(22_263.9, abs=0.1)


def test_old_positions_and_repeated_velocities_are_missing(tmp_path: Path) -> None:
    rows = reports(60)[:20]
    for k, row in enumerate(rows):
        row["timestamp"] = rows[0]["timestamp"] + 1000 * k
        row["last_position"] = row["timestamp"]
    for row in rows[10:]:  # nothing is heard any more: everything is repeated
        row |= {n: rows[9][n] for n in ("latitude", "longitude", "groundspeed", "track", "last_position")}
    path = tmp_path / "x.json"
    path.write_text(json.dumps(rows))
    found = import_adsb(path).measurements
    assert found is not None
    assert np.isfinite(found.values[:12, 0]).all() and np.isnan(found.values[12:, 0]).all()  # older than 2 s
    assert np.isnan(found.values[12:, 2]).all()


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "an empty file"),
        ("[1, 2", "expected a track"),
        ("[]", "expected a track"),
        ('{"a": {"0": 1}}', "no column of time, latitude, longitude, speed, track|no report"),
        ('{"icao24": "a", "path": []}', "without speeds"),
        ('{"icao": "a", "trace": [[0, 1]], "timestamp": 5}', "a list that starts with"),
        ('{"icao": "a", "trace": []}', "without timestamp"),
        ('{"icao": "a", "trace": [[null, 1, 2, 3, 4, 5, 0]], "timestamp": 5}', "as its first value"),
        ("time,lat,lon,velocity,heading\n1,x,8,200,90\n2,47,8,200,90\n", "the latitude 'x'"),
        ("time,lat,lon,velocity,heading\n1,97,8,200,90\n2,47,8,200,90\n", "the position 97, 8"),
        ("time,icao24,lat,lon,velocity,heading\n1,a,47,8,200,90\n2,b,47,8,200,90\n", "choose with --aircraft"),
    ],
)
def test_files_that_are_no_track_are_refused(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "x"
    path.write_text(text)
    with pytest.raises(_core.InvalidInput, match=message):
        import_adsb(path)


def test_one_of_several_aircraft(tmp_path: Path) -> None:
    path = tmp_path / "two.csv"
    rows = [dict(icao24=who, time=t, lat=47.0, lon=8.0 + 0.003 * t, velocity=225.0, heading=90.0)
            for t in range(5) for who in ("aaaaaa", "bbbbbb")]  # fmt: skip
    as_csv(path, rows)
    assert dict(import_adsb(path, "BBBBBB").facts)["aircraft"] == "bbbbbb"
    with pytest.raises(_core.InvalidInput, match="--aircraft: got cccccc, expected one of aaaaaa, bbbbbb"):
        import_adsb(path, "cccccc")
    damaged = tmp_path / "cut.json.gz"
    damaged.write_bytes(SAMPLE.read_bytes()[:200])
    with pytest.raises(_core.IoError, match="ends early"):
        import_adsb(damaged)
