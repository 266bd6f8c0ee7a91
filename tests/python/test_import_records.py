"""`garrison import csv`, and the model files that importers write."""

import json
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT
from garrison import _core
from garrison.cli import main
from garrison.importers.bundle import model_file, sparse
from garrison.importers.records import Choice, import_csv
from garrison.importers.toml import document
from garrison.scenario import read_scenario
from garrison.scenario.model_file import read_model_file


def test_the_wind_becomes_a_scenario(wind: Path, tmp_path: Path) -> None:
    out = tmp_path / "wind"
    command = ["import", "csv", str(wind / "irish_wind.csv"), "--to", "1970-12-31", "-o", str(out)]
    assert main([*command, "--stations", str(wind / "stations.csv"), "--radius", "180"]) == 0
    assert main(["check", str(out / "scenario.toml")]) == 0
    scenario = read_scenario(out / "scenario.toml")
    assert str(scenario.dates[0]) == "1971-01-01" and len(scenario.names) == 12
    assert (out / "records.csv").read_bytes() == (wind / "irish_wind.csv").read_bytes()
    assert read_scenario(out / "scenario.toml", {"model.harmonics": 0}).network.edges != []


def test_plain_seconds_and_short_records(tmp_path: Path) -> None:
    rng = np.random.default_rng(1)
    path = tmp_path / "tank.csv"
    level = np.cumsum(rng.normal(0, 0.3, 80))
    rows = [f"{0.5 * k}," + ",".join(f"{level[k] + rng.normal(0, 0.1):.3f}" for _ in range(4)) for k in range(80)]
    path.write_text("t,a,b,c,d\n" + "\n".join(rows) + "\n")
    assert main(["import", "csv", str(path), "-o", str(tmp_path / "out")]) == 0
    assert main(["check", str(tmp_path / "out" / "scenario.toml")]) == 0
    tables = import_csv(path, Choice(clean=24.5)).tables
    assert tables["model"] == {"fit": "records.csv", "to": 24.5, "factors": 1, "harmonics": 0}
    assert tables["data"]["from"] == 25.0


@pytest.mark.parametrize(
    ("text", "arguments", "message"),
    [
        ("t,a,b\n" + "".join(f"{k},1,2\n" for k in range(50)), [], "got 2 sensors, expected at least 3"),
        ("t,a,b,c\n0,1,2,3\n1,2,3,4\n", [], "got 2 records, expected at least 40"),
        ("t,a,b,c\n" + "".join(f"{k},1,2,3\n" for k in range(50)), ["--to", "48"], "--to: got 48"),
        ("t,a,b,c\n" + "".join(f"{k},1,2,3\n" for k in range(50)), ["--radius", "5"], "expected both or none"),
        ("t,a,b,c\n" + "".join(f"{k},1,2,x\n" for k in range(50)), [], "line 2, column c: got 'x'"),
    ],
    ids=["sensors", "records", "end", "radius", "text"],
)
def test_records_that_do_not_do_are_refused(
    tmp_path: Path, text: str, arguments: list[str], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "x.csv"
    path.write_text(text)
    assert main(["import", "csv", str(path), *arguments, "-o", str(tmp_path / "out")]) == 2
    assert message in capsys.readouterr().err


def _records(**columns: list[float]) -> str:
    """Sixty hours of three stations that go together, and these columns."""
    rng = np.random.default_rng(1)
    level = np.cumsum(rng.normal(size=60))
    all_ = {name: (level + rng.normal(0, 0.3, 60)).tolist() for name in "abc"} | columns
    rows = zip(*all_.values(), strict=True)
    return f"t,{','.join(all_)}\n" + "".join(f"{k},{','.join(map(str, row))}\n" for k, row in enumerate(rows))


@pytest.mark.parametrize(
    ("columns", "arguments", "message"),
    [
        ({"d": [5.0] * 60}, [], "station d: got records without variation"),
        ({}, ["--factors", "4"], "--factors: got 4, expected a number in 1..3"),
        ({}, ["--harmonics", "60"], "--harmonics: got 60 with 30 records, expected at least 122 records"),
        ({"d": [1e6 * k * k for k in range(60)]}, [], "; --standardise: every column in units of its own spread"),
        ({}, ["--stations", "places.csv", "--radius", "30"], "places.csv: got no station c, expected all of a, b, c"),
    ],
    ids=["constant", "factors", "harmonics", "units", "stations"],
)
def test_what_a_run_would_refuse_is_refused_at_once(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    columns: dict[str, list[float]],
    arguments: list[str],
    message: str,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("x.csv").write_text(_records(**columns))
    Path("places.csv").write_text("code,latitude,longitude\na,52,5\nb,52.1,5\n")
    assert main(["import", "csv", "x.csv", *arguments, "-o", "out"]) == 2
    assert message in capsys.readouterr().err
    assert not Path("out").exists()


def test_columns_of_different_sizes_can_be_standardised(tmp_path: Path) -> None:
    path = tmp_path / "x.csv"
    path.write_text(_records(d=[1e6 * k * k for k in range(60)]))
    assert main(["import", "csv", str(path), "--standardise", "-o", str(tmp_path / "out")]) == 0
    assert read_scenario(tmp_path / "out" / "scenario.toml").model.agents == 4


def plain_model() -> dict[str, object]:
    A, C = np.array([[1.0, 0.1], [0.0, 1.0]]), [np.array([[1.0, 0.0]]), np.array([[0.0, 1.0]])]
    return model_file(
        A,
        C,
        process_covariance=0.01 * np.eye(2),
        measurement_covariance=[np.array([[1.0]]), np.array([[0.1]])],
        agents=["gps", "odometer"],
        states=["p", "v"],
        outputs=["position", "speed"],
        units={"p": "m"},
    )


def written(folder: Path, plain: object) -> Path:
    path = folder / "model.json"
    path.write_text(json.dumps(plain))
    return path


def test_model_files_come_back(tmp_path: Path) -> None:
    model, names = read_model_file(written(tmp_path, plain_model()))
    assert names == ["gps", "odometer"] and model.state_names == ["p", "v"]
    assert np.array_equal(model.A, [[1.0, 0.1], [0.0, 1.0]])
    assert [np.asarray(c).tolist() for c in model.C] == [[[1.0, 0.0]], [[0.0, 1.0]]]
    assert np.asarray(model.measurement_covariance[1]).item() == 0.1
    dense = plain_model() | {"A": [[1.0, 0.1], [0.0, 1.0]], "C": [[[1.0, 0.0]], [[0.0, 1.0]]]}
    assert read_model_file(written(tmp_path, dense))[0] == model
    assert sparse(np.zeros((2, 3))) == {"size": [2, 3], "entries": []}


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"garrison_model": 2}, "garrison_model: got 2, expected 1"),
        ({"Q": 1}, "the unknown key 'Q'"),
        ({"C": 1}, "C: got 1, expected a list with a matrix per agent"),
        ({"A": {"size": [2], "entries": []}}, "A.size: got .*expected two numbers"),
        ({"A": {"size": [2, 2], "entries": [[0, 2, 1.0]]}}, r"an entry at \(0, 2\), expected one within 2 x 2"),
        ({"A": {"size": [2, 2], "entries": [[0, 0.5, 1.0]]}}, r"an entry at \(0, 0.5\)"),
        ({"A": {"size": [2, 2], "entries": [[0, 1]]}}, "expected triples"),
        ({"A": {"size": [10**6, 10**6]}}, "expected at most 8 GB"),
        ({"C": [[[1.0, 0.0, 0.0]], [[0.0, 1.0, 0.0]]]}, r"model\.json: C"),
    ],
    ids=lambda change: str(change)[:30],
)
def test_damaged_model_files_are_refused(tmp_path: Path, change: dict[str, object], message: str) -> None:
    with pytest.raises(_core.InvalidInput, match=message):
        read_model_file(written(tmp_path, plain_model() | change))


def test_toml_documents_are_read_back() -> None:
    import tomllib

    tables = {"title": 'a "b" \\ é', "model": {"A": [[1.0, 0.5]], "ok": True}, "attack": [{"k": 1e-6}, {"k": 2}]}
    assert tomllib.loads(document(tables, ["two\nlines"])) == tables


@pytest.mark.parametrize(
    ("command", "message"),
    [
        ("adsb adsb_sample.json.gz --period 0", "--period: got 0, expected a finite number > 0"),
        ("adsb adsb_sample.json.gz --position-noise -1", "--position-noise: got -1"),
        ("adsb adsb_sample.json.gz --false-alarm 1", "--false-alarm: got 1, expected a probability"),
        ("openacc openacc_sample.csv --measurement-noise nan", "--measurement-noise: got nan"),
        ("openacc openacc_sample.csv --from 1000", "--from, --to: got 0 samples, expected at least two"),
        ("mcap robot_sample_ros2/robot_sample_ros2.mcap --period inf", "--period: got inf"),
        ("rosbag robot_sample.bag --heading-noise 0", "--heading-noise: got 0"),
        ("csv openacc_sample.csv --factors 0", "--factors: got 0, expected a whole number >= 1"),
        ("pandapower case14 --steps 0", "--steps: got 0, expected a whole number >= 1"),
    ],
)
def test_options_without_sense_are_refused(
    tmp_path: Path, command: str, message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    kind, file, *options = command.split()
    source = file if kind == "pandapower" else str(ROOT / "examples" / "import" / file)
    assert main(["import", kind, source, *options, "-o", str(tmp_path / "out")]) == 2
    assert message in capsys.readouterr().err
    assert not (tmp_path / "out").exists()
