"""`garrison import openacc`: original files, files per follower, what is refused."""

import csv
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT
from garrison import _core
from garrison.cli import main
from garrison.importers.openacc import Noise, import_openacc
from garrison.jobs import rehearse, run_scenario
from garrison.scenario import read_scenario

SAMPLE = ROOT / "examples" / "import" / "openacc_sample.csv"


def columns() -> dict[str, np.ndarray]:
    """The columns of the sample."""
    rows = list(csv.reader(SAMPLE.read_text().splitlines()))
    start = next(k for k, row in enumerate(rows) if row[0] == "Time")
    values = np.array(rows[start + 1 :], dtype=float)
    return dict(zip(rows[start], values.T, strict=True))


def write(path: Path, table: dict[str, np.ndarray]) -> Path:
    with path.open("w", newline="") as file:
        out = csv.writer(file)
        out.writerow(table)
        out.writerows(zip(*table.values(), strict=True))
    return path


def follower_files(folder: Path, names: tuple[str, ...]) -> list[Path]:
    """The sample as one file per follower, columns named as given: t, v and a of the follower, v of the leader, gap."""
    c, out = columns(), []
    for k in range(1, 5):
        v, lead = c[f"Speed{k + 1}"], c[f"Speed{k}"]
        values = (c["Time"], v, np.gradient(v, 0.1), lead, c[f"IVS{k}"])
        out.append(write(folder / f"pair{k}.csv", dict(zip(names, values, strict=True))))
    return out


def test_the_sample_accuses_the_car_whose_odometer_drifts(tmp_path: Path) -> None:
    assert main(["import", "openacc", str(SAMPLE), "-o", str(tmp_path / "cars")]) == 0
    assert main(["check", str(tmp_path / "cars" / "scenario.toml")]) == 0
    scenario = read_scenario(tmp_path / "cars" / "scenario.toml")
    assert scenario.names == [f"CAR_{k}" for k in range(1, 6)]
    row = run_scenario(scenario)[0]
    assert set(row.summary["detected"]) == {"CAR_3"}
    assert row.run is not None and not row.run.warnings


def test_positions_are_integrals_and_gaps_are_negative() -> None:
    bundle = import_openacc([SAMPLE])
    assert bundle.measurements is not None
    table = dict(zip(bundle.measurements.columns, bundle.measurements.values.T, strict=True))
    c = columns()
    assert np.allclose(table["CAR_2 relative position [m]"], -c["IVS1"])
    assert np.allclose(table["CAR_3 velocity [m/s]"], c["Speed3"])
    moved = np.diff(table["CAR_4 position [m]"])
    assert np.allclose(moved, 0.05 * (c["Speed4"][1:] + c["Speed4"][:-1]))
    assert np.isclose(table["CAR_3 position [m]"][0], -c["IVS1"][0] - c["IVS2"][0])
    assert np.allclose(table["CAR_1 acceleration [m/s^2]"][:-1], np.diff(c["Speed1"]) / 0.1, atol=1e-6)


@pytest.mark.parametrize(
    "names",
    [
        ("t", "v_follower", "a_follower", "v_leader", "spacing"),
        ("Time", "followerSpeed", "followerAcc", "leaderSpeed", "gap"),
        ("Time_Index", "Speed_FAV", "Acc_FAV", "Speed_LV", "Spatial_Gap"),
        ("time", "vf", "af", "vl", "s"),
        ("t", "v", "a", "v_lead [m/s]", "IVS"),
    ],
    ids=lambda names: names[1],
)
def test_a_file_per_follower_is_the_same_recording(tmp_path: Path, names: tuple[str, ...]) -> None:
    paths = follower_files(tmp_path, names)
    whole, pairs = import_openacc([SAMPLE]).measurements, import_openacc([paths[k] for k in (2, 0, 3, 1)]).measurements
    assert whole is not None and pairs is not None
    kept = [k for k, name in enumerate(whole.columns) if "acceleration" not in name]
    assert np.allclose(whole.values[:, kept], pairs.values[:, kept], atol=1e-6)  # whatever the order of the files


def test_gaps_may_be_differences_of_positions(tmp_path: Path) -> None:
    c = columns()
    x = 100.0 + np.cumsum(c["Speed2"]) * 0.1
    table = {"t": c["Time"], "x_follower": x, "v_follower": c["Speed2"]}
    table |= {"x_leader": x + c["IVS1"], "v_leader": c["Speed1"]}
    first = write(tmp_path / "one.csv", table)
    rest = follower_files(tmp_path, ("t", "v_follower", "a_follower", "v_leader", "spacing"))[1:]
    bundle = import_openacc([first, *rest])
    assert bundle.measurements is not None
    assert np.allclose(bundle.measurements.values[:, 5], -c["IVS1"], atol=1e-6)
    assert any("differences of the recorded positions" in note for note in bundle.notes)


def test_cars_without_data_are_left_out_and_gaps_in_time_are_cut(tmp_path: Path) -> None:
    c = columns()
    c["Speed1"] = np.full(600, np.nan)
    c["IVS3"][:100] = np.nan
    path = tmp_path / "holes.csv"
    write(path, c)
    bundle = import_openacc([path])
    assert dict(bundle.facts)["samples"] == "500, every 0.1 s"
    assert [n for n in bundle.notes if "Speed1" in n] and [n for n in bundle.notes if "10 to 59.9 s" in n]
    part = import_openacc([path], between=(20.0, 30.0))
    assert dict(part.facts)["samples"] == "101, every 0.1 s"


def test_gaps_of_places_in_a_straight_line_are_said(tmp_path: Path) -> None:
    c = columns()
    at = {1: 500.0 + np.cumsum(c["Speed1"]) * 0.1}
    for k in range(2, 6):
        at[k] = at[k - 1] - c[f"IVS{k - 1}"] - 4.4
    c |= {f"E{k}": x * np.cos(0.3) for k, x in at.items()} | {f"N{k}": x * np.sin(0.3) for k, x in at.items()}
    assert [n for n in import_openacc([write(tmp_path / "x.csv", c)]).notes if "a straight line" in n]
    bends = np.cumsum(c["Speed1"]) * 0.001
    c |= {f"N{k}": x * np.sin(0.3) + 3.0 * np.cos(bends * k) for k, x in at.items()}
    assert not [n for n in import_openacc([write(tmp_path / "y.csv", c)]).notes if "a straight line" in n]


def test_late_times_keep_their_parts_of_seconds(tmp_path: Path) -> None:
    c = columns()
    c["Time"] = c["Time"] + 123456.0
    found = import_openacc([write(tmp_path / "late.csv", c)]).measurements
    assert found is not None
    assert found.times[:2] == ["123456", "123456.1"]


def test_more_drift_than_assumed_is_said() -> None:
    bundle = import_openacc([SAMPLE], Noise(measurement=0.05))
    assert any("--measurement-noise" in note and "may contradict" in note for note in bundle.notes)
    assert not import_openacc([SAMPLE]).notes


def test_odometers_that_all_drift_widen_the_noise_and_contradict_nothing(tmp_path: Path) -> None:
    """Speeds that are wrong by up to 0.7 percent each, as those of recorded cars: one more than all others."""
    c = columns()
    for k, scale in enumerate((0.993, 1.006, 0.995, 1.02, 0.997), start=1):
        c[f"Speed{k}"] = scale * c[f"Speed{k}"]
    path = write(tmp_path / "x.csv", c)
    bundle = import_openacc([path])
    assert bundle.tables["filter"]["measurement_noise"] > 2.5
    assert dict(bundle.facts)["measurement noise"].endswith("explains all cars but car 4")
    assert not bundle.notes
    bundle.write(tmp_path / "cars")
    row = run_scenario(read_scenario(tmp_path / "cars" / "scenario.toml"))[0]
    assert row.run is not None and not row.run.warnings
    assert set(row.summary["detected"]) <= {"car 4"} and row.summary["share_with_bound"] == 1.0
    import_openacc([path], Noise(measurement=2.0, initial=20.0)).write(tmp_path / "narrow")
    narrow = run_scenario(read_scenario(tmp_path / "narrow" / "scenario.toml"))[0]
    assert narrow.run is not None and any("contradict" in warning for warning in narrow.run.warnings)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda c: {k: v for k, v in c.items() if not k.startswith("IVS")}, "expected at least 3"),
        (lambda c: {k: v for k, v in c.items() if k != "Time"}, "expected a header with a column"),
        (lambda c: c | {"Time": c["Time"][::-1]}, "sort the rows by time"),
        (lambda c: {"Time": c["Time"], "speed": c["Speed1"]}, "a speed of the leader"),
        (lambda c: {"t": c["Time"], "v": c["Speed2"], "v_leader": c["Speed1"]}, "expected the gap to the leader"),
    ],
    ids=["no gaps", "no times", "backwards", "no leader", "no spacing"],
)
def test_files_that_are_none_are_refused(tmp_path: Path, change, message: str) -> None:  # type: ignore[no-untyped-def]
    path = write(tmp_path / "x.csv", change(columns()))
    with pytest.raises(_core.InvalidInput, match=message):
        import_openacc([path])


def test_strangers_in_a_string_are_refused(tmp_path: Path) -> None:
    paths = follower_files(tmp_path, ("t", "v_follower", "a_follower", "v_leader", "spacing"))
    c = columns()
    odd = {"t": c["Time"], "v_follower": c["Speed2"], "v_leader": c["Speed1"] + 7.0, "spacing": c["IVS1"]}
    paths[2] = write(tmp_path / "odd.csv", odd)
    with pytest.raises(_core.InvalidInput, match="follower of no other file"):
        import_openacc(paths)
    with pytest.raises(_core.InvalidInput, match="one such file, or one file per follower"):
        import_openacc([SAMPLE, SAMPLE])
    with pytest.raises(_core.IoError, match="No such file"):
        import_openacc([tmp_path / "absent.csv"])
    with pytest.raises(
        _core.InvalidInput, match=r"--attacked: got 3, expected 1\.\.\d: at most half of the other cars"
    ):
        import_openacc([SAMPLE], Noise(attacked=3))


def test_vehicles_have_names_in_scenarios(tmp_path: Path) -> None:
    import_openacc([SAMPLE]).write(tmp_path)
    path = tmp_path / "scenario.toml"
    rehearse(read_scenario(path))
    path.write_text(path.read_text().replace('"CAR_2"', '"CAR_1"', 1))
    with pytest.raises(_core.InvalidInput, match=r"\[model\].names: .*5 different names"):
        read_scenario(path)
