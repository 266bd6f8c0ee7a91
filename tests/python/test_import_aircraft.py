"""`garrison import adsb`: every form of a track gives the same numbers; the spoofed sample is noticed."""

import csv
import datetime as dt
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
from garrison.importers.adsb_choice import Choice
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
    played = [
        {
            "Timestamp": row["timestamp"] // 1000,
            "UTC": f"{np.datetime64(row['timestamp'], 'ms')}Z",
            "Callsign": "SAMPLE1",
            "Position": f"{row['latitude']},{row['longitude']}",
            "Altitude": row["altitude"],
            "Speed": row["groundspeed"],
            "Direction": row["track"],
        }
        for row in rows
    ]
    as_csv(folder / "played.csv", played)
    return out | {name: folder / f"{name}.csv" for name in ("history", "iso", "played")}


@pytest.mark.parametrize("form", ["records", "lines", "split", "states", "trace", "history", "iso", "played"])
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


@pytest.mark.parametrize("jam", [60, 120, 300])
def test_a_lie_after_a_jam_is_noticed_when_no_turn_explains_it(tmp_path: Path, jam: int) -> None:
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
    # 40 km and 80 m/s off: a turn of 300 s may have led there, so that only the way back tells.
    assert accused[901:905].any() == (jam < 300)
    assert accused[1200:1205].any() and not accused[1260:].any()  # back within a minute


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
        (
            "time,lat,lon,speed,heading\n1,47,8,200,90\n2,47,8,200,90\n",
            r"\(knots\) or one of velocity \(m/s\); rename",
        ),
        (
            "time,lat,lon,velocity,heading\n1e21,47,8,200,90\n2,47,8,200,90\n",
            "the time 1e\\+12 s, expected seconds",
        ),
        ('time,lat,lon,velocity,heading\n1,"47"x\ry,8,200,90\n', "cells, expected 5|no table"),
        ("Timestamp,Position,Speed,Direction\n1,47 8,200,90\n2,47,200,90\n", "the position '47 8'"),
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
    assert dict(import_adsb(path, Choice("BBBBBB")).facts)["aircraft"] == "bbbbbb"
    with pytest.raises(_core.InvalidInput, match=r"2 aircraft: aaaaaa \(5 reports\), bbbbbb \(5 reports\), exp"):
        import_adsb(path)
    with pytest.raises(_core.InvalidInput, match=r"--aircraft: got cccccc, expected one of aaaaaa \(5 reports\), bbbb"):
        import_adsb(path, Choice("cccccc"))
    damaged = tmp_path / "cut.json.gz"
    damaged.write_bytes(SAMPLE.read_bytes()[:200])
    with pytest.raises(_core.IoError, match="ends early"):
        import_adsb(damaged)


def eastward(times: range | list[int], speed: float = 200.0, **more: Any) -> list[dict[str, Any]]:
    """Reports of a flight along a parallel at 200 m/s."""
    return [dict(icao24="aaaaaa", time=1_700_000_000 + t, lat=47.0, lon=8.0 + t * 200.0 / 76_057.0, velocity=speed,
                 heading=90.0) | more for t in times]  # fmt: skip


def test_many_aircraft_are_named_by_their_reports(tmp_path: Path) -> None:
    rows = [row | {"icao24": f"a{k:05d}"} for k in range(15) for row in eastward(range(k + 2))]
    as_csv(tmp_path / "many.csv", rows)
    with pytest.raises(_core.InvalidInput, match=r"15 aircraft: a00014 \(16 reports\).* and 3 more.*--aircraft a00014"):
        import_adsb(tmp_path / "many.csv")


def test_flights_of_different_days_are_told_apart(tmp_path: Path) -> None:
    path = tmp_path / "days.csv"
    as_csv(path, eastward([*range(50), *range(86_400, 86_430)]))
    expected = r"2 flights of aaaaaa, 6 h or more apart: 2023-11-14 22:13:20 to 2023-11-14 22:14:09 \(50 reports\)"
    with pytest.raises(_core.InvalidInput, match=expected):
        import_adsb(path)
    second = import_adsb(path, Choice(start=dt.date(2023, 11, 15)))
    assert dict(second.facts)["samples"] == "30"
    part = import_adsb(path, Choice(start=dt.datetime(2023, 11, 14, 22, 13, 30), end=dt.date(2023, 11, 14)))
    assert dict(part.facts)["samples"] == "40" and dict(part.facts)["reports"] == "40, usually 1 s apart"
    with pytest.raises(_core.InvalidInput, match="--from, --to: got 0 reports, expected at least two; aaaaaa has 2023"):
        import_adsb(path, Choice(end=dt.date(2023, 11, 1)))


def test_the_place_zero_zero_is_no_position(tmp_path: Path) -> None:
    rows = eastward(range(40))
    rows[20] |= {"lat": 0.0, "lon": 0.0}
    as_csv(tmp_path / "x.csv", rows)
    found = import_adsb(tmp_path / "x.csv").measurements
    assert found is not None
    assert np.isnan(found.values[20, 0]) and np.nanmax(np.abs(found.values[:, :2])) < 10_000


def test_velocities_that_positions_contradict_are_said(tmp_path: Path) -> None:
    as_csv(tmp_path / "right.csv", eastward(range(60)))
    as_csv(tmp_path / "knots.csv", eastward(range(60), speed=200.0 / KNOTS))
    as_csv(tmp_path / "radians.csv", eastward(range(60), heading=1.5708))
    assert not [n for n in import_adsb(tmp_path / "right.csv").notes if "reported" in n and "pairs" in n]
    assert [n for n in import_adsb(tmp_path / "radians.csv").notes if "reported tracks are 88 degrees off" in n]
    assert "contradict" not in import_adsb(tmp_path / "right.csv").tables["title"]
    assert "which contradict each other" in import_adsb(tmp_path / "knots.csv").tables["title"]
    assert [n for n in import_adsb(tmp_path / "knots.csv").notes if "reported speeds are 1.9 times" in n]


def test_turns_during_gaps_are_no_alarms(tmp_path: Path) -> None:
    """Standard turns (3 degrees/s) at 120 m/s of an aircraft that reports every 10 s, times rounded to seconds."""
    rng = np.random.default_rng(4)
    t = np.arange(0.0, 3000.0, 0.1)
    rate = np.where((t % 400) < 60, 3.0, 0.0) * np.where((t // 400) % 2 == 0, 1.0, -1.0)
    track = np.deg2rad(30.0 + np.cumsum(rate) * 0.1)
    way = np.cumsum(120.0 * np.column_stack([np.sin(track), np.cos(track)]), axis=0) * 0.1
    rows = []
    for k in range(0, len(t) - 20, 100):
        if 900 < t[k] < 970:
            continue  # a gap in which it turns
        j = k + int(rng.integers(0, 15))
        at = {"latitude": 47.0 + way[j, 1] / 111_200, "longitude": 8.0 + way[j, 0] / 75_800}
        heading = round(float(np.rad2deg(track[k])) % 360)
        rows.append({"timestamp": 1_700_000_000_000 + int(1000 * t[k]), "groundspeed": 233.0, "track": heading, **at})
    (tmp_path / "x.json").write_text(json.dumps(rows), encoding="utf-8")
    import_adsb(tmp_path / "x.json").write(tmp_path / "air")
    for row in run_scenario(read_scenario(tmp_path / "air" / "scenario.toml")):
        assert row.run is not None and not (np.asarray(row.run.verdict) == 2).any()
