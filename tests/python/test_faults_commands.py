"""Slips on the command line: encodings, numbers of options, and what a design file shows."""

import errno
import os
import subprocess
import sys
from pathlib import Path

import garrison as gr
import numpy as np
import pytest
from conftest import RING, ROOT
from garrison.cli import main

SCENARIO = """
[model]
A = [[0.9]]
C = [[1.0], [1.0], [1.0]]
process_covariance = 0.1
measurement_covariance = 0.2
[network]
kind = "ring"
[filter]
name = "structural"
[run]
steps = 5
"""
RECORDS = "day,a,b\n" + "".join(f"2020-02-{k + 1:02},{k % 5},{(3 * k) % 7}\n" for k in range(28))


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
def test_scenarios_in_any_marked_encoding(tmp_path: Path, encoding: str) -> None:
    path = tmp_path / "s.toml"
    path.write_bytes(SCENARIO.encode(encoding))
    assert main(["check", str(path)]) == 0


def test_other_encodings_are_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "s.toml"
    path.write_bytes(f'title = "K\u00f6ln"\n{SCENARIO}'.encode("latin-1"))
    assert main(["check", str(path)]) == 2
    assert "no text in UTF-8 (byte 10), expected a TOML document; save it as UTF-8" in capsys.readouterr().err


def test_numbers_of_options(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "r.csv"
    path.write_text(RECORDS)
    assert main(["fit", str(path), "--factors", "1.0", "--harmonics", "0"]) == 0
    for option, value in (("--factors", "x"), ("--factors", "1.5"), ("--factors", "inf"), ("--scale", "2 m")):
        capsys.readouterr()
        assert main(["fit", str(path), option, value]) == 2
        assert f"argument {option}: got {value!r}, expected a" in capsys.readouterr().err


def test_places_in_a_scenario_are_named_once(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "s.toml"
    path.write_text(SCENARIO.replace("= 0.2", '= "0.2"'))
    assert main(["check", str(path)]) == 2
    assert capsys.readouterr().err.startswith("garrison: [model].measurement_covariance: got '0.2'")


def test_a_design_file_shows_model_and_network(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    model = gr.Model(
        [[0.9, 0.1], [0.0, 0.8]],
        [[1, 0], [0, 1], [1, 0]],
        process_covariance=0.1,
        measurement_covariance=0.2,
        states=["level", "speed"],
        outputs=["p", "q", "r"],
    )
    path = tmp_path / "x.gdesign"
    gr.prepare(model, gr.Network([(0, 1), (1, 2)], names=["a", "b", "c"]), gr.filters.Structural()).save(path)
    assert main(["design-file", "--show", str(path)]) == 0
    shown = capsys.readouterr().out
    for words in (
        "A = [[0.9, 0.1], [0.0, 0.8]]",
        "C[1] = [[0.0, 1.0]]",
        "states: level, speed",
        "outputs: p, q, r",
        "agents: a, b, c",
        "network, undirected, 2 edges",
        "0-1, 1-2",
        "hash ",
        "false_alarm = 0.01",
    ):
        assert words in shown, shown


@pytest.mark.parametrize(
    ("words", "meant"),
    [
        (["runn"], 'did you mean "run"?'),
        (["verfy", "."], 'did you mean "verify"?'),
        (["fit", "r.csv", "--factor", "2"], 'unrecognized arguments: --factor 2; did you mean "--factors"?'),
        (["fit", "r.csv", "--factor=2"], 'unrecognized arguments: --factor=2; did you mean "--factors"?'),
        (["run", "s.toml", "-o", "x", "--forse"], 'did you mean "--force"?'),
        (["import", "openac", "x"], 'did you mean "openacc"?'),
    ],
)
def test_misspelt_commands_and_options(capsys: pytest.CaptureFixture[str], words: list[str], meant: str) -> None:
    assert main(words) == 2
    assert meant in capsys.readouterr().err


def test_files_without_end_are_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    scenario = tmp_path / "s.toml"
    model = SCENARIO.replace("[run]\nsteps = 5\n", "[data]\nfile = 'FILE'\n")
    for file in ("/dev/zero", str(pipe)):
        scenario.write_text(model.replace("FILE", file))
        for command in (
            ["check", str(scenario)],
            ["check", file],
            ["fit", file],
            ["structure", f"{file}"],
            ["design-file", file],
            ["verify", file],
            ["replay", file],
        ):
            capsys.readouterr()
            assert main(command) in (1, 2), command
            said = capsys.readouterr()
            assert "a device or a pipe" in said.err + said.out or command[0] == "replay", (command, said)


def test_a_single_case_is_verified(cases: Path, capsys: pytest.CaptureFixture[str]) -> None:
    case = sorted(cases.rglob("*.json"))[0]
    assert main(["verify", str(case)]) == 0
    assert "verify: 1 file" in capsys.readouterr().out


def test_advice_on_output_folders_works(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "s.toml"
    path.write_text(SCENARIO)
    assert main(["run", str(path), "-o", str(tmp_path)]) == 2
    said = capsys.readouterr().err
    assert "--force" not in said and "choose a new or an empty one" in said
    assert main(["run", str(path), "-o", str(tmp_path / "o")]) == 0
    assert main(["run", str(path), "-o", str(tmp_path / "o")]) == 2
    assert "replace it with --force" in capsys.readouterr().err
    assert main(["run", str(path), "-o", str(tmp_path / "o"), "--force"]) == 0
    (tmp_path / "o" / "summary.json").write_text("mine")
    assert main(["run", str(path), "-o", str(tmp_path / "o")]) == 2
    assert "--force" not in capsys.readouterr().err


def test_a_matrix_with_a_gap_is_refused_with_its_place(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "A.csv"
    path.write_text("0.9,0.1\n0.0,nan\n")
    assert main(["structure", str(path)]) == 2
    assert f"{path}, line 2, column 2: got 'nan', expected a finite number" in capsys.readouterr().err


UNIT = (
    RING
    + """\
[filter]
name = "saturation"
threshold = 2.0
initial_error = 1.0
[run]
steps = 20
"""
)
SOURCES = UNIT.replace(
    'name = "saturation"\nthreshold = 2.0\ninitial_error = 1.0', 'name = "lfre"\nfaulty = 0'
).replace("C = [[1, 0], [0, 1], [1, 0], [0, 1], [1, 0]]", "C = [[1, 0], [1, 0], [1, 0], [1, 0], [1, 0]]")


@pytest.mark.parametrize(
    ("scenario", "old", "new", "words"),
    [
        (
            UNIT,
            "threshold = 2.0",
            "threshold = 1e308",
            "saturation.threshold: got 1e+308, expected a number of size at",
        ),
        (UNIT, "initial_error = 1.0", "initial_error = 1e200", "saturation.initial_error: got 1e+200"),
        (UNIT, "initial_error = 1.0", "step = 1.0", "saturation.step: got 1, expected a number in (0, 0.55"),
        (UNIT, "initial_error = 1.0", "step = 1e-300", "saturation.step: got 1e-300"),
        (
            UNIT,
            "initial_error = 1.0",
            "table = true",
            "saturation.table: got true, expected false without initial_error",
        ),
        (UNIT, "threshold = 2.0", "threshold = nan", "saturation.threshold: got no value, or nan"),
        (UNIT, "threshold = 2.0", "threshold = 2.0\nattacked = 2147483648", "got 2147483648, expected a whole number"),
        (UNIT, "A = [[1.0, 0.1]", "A = [[true, 0.1]", "[model].A[0][0]: got true, expected a number"),
        (UNIT, "C = [[1, 0]", "C = [[1, false]", "[model].C[0][1]: got false, expected a number"),
        (UNIT, "steps = 20", "steps = 20\nx0 = [true, 1]", "[run].x0[0]: got true, expected a number"),
        (UNIT, "steps = 20", "steps = 20\n[link]\ndelay_rounds = 2", "[link].delay_rounds: got a delay without its"),
        (UNIT, "steps = 20", "steps = 20\n[link]\ndelay = 0.1\ndelay_rounds = 0", "[link].delay_rounds: got 0"),
        (UNIT, "steps = 20", "steps = 20\nstart_error = 1e300", "[run].start_error: got 1e+300"),
        (UNIT, "A = [[1.0", "A = [[1e200", "[model] A[0, 0]: got 1e+200, expected a number of size at most 1e+150"),
        (
            UNIT,
            'kind = "ring"',
            "edges = [[0, 1], [1, 2], [2, 3], [3, 4]]\npresent = [[1, 1, 0, 1]]",
            "a network over 1 sa",
        ),
        (UNIT, "steps = 20", "steps = 20\n[link]\ncuts = [[0, 3, 1, 2]]", "[link]: got the unknown key 'cuts'"),
        (
            UNIT,
            "[run]",
            "[[attack]]\nkind = 'bias'\nvalue = 1.0\nagents = []\n[run]",
            "attack[0].agents: got no agents",
        ),
        (UNIT, "[run]", "[[attack]]\nkind = 'silence'\nagents = []\n[run]", "attack[0].agents: got no agents"),
        (
            UNIT,
            "[run]",
            "[[attack]]\nkind = 'bias'\nvalue = 1.0\nschedule = []\n[run]",
            "attack[0]: schedule: got no phase",
        ),
        (
            UNIT,
            "[run]",
            "[[attack]]\nkind = 'bias'\nvalue = 1.0\nschedule = [[3, []]]\n[run]",
            "attack[0].schedule: got no",
        ),
        (
            SOURCES,
            "faulty = 0",
            "faulty = 0\npoles = [0.5, 1.0]",
            "lfre.poles: got 1, expected numbers between -1 and 1",
        ),
        (
            SOURCES,
            "faulty = 0",
            "faulty = 0\npoles = [-1, 0.2]",
            "lfre.poles: got -1, expected numbers between -1 and 1",
        ),
        (
            SCENARIO,
            'name = "structural"',
            'name = "structural"\nalarm_after = 6',
            "structural.alarm_after: got 6, expected at",
        ),
    ],
)
def test_check_and_run_refuse_the_same(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], scenario: str, old: str, new: str, words: str
) -> None:
    path = tmp_path / "s.toml"
    assert old in scenario
    path.write_text(scenario)
    assert main(["check", str(path)]) in (0, 1), capsys.readouterr().err
    path.write_text(scenario.replace(old, new, 1))
    for command in (["check", str(path)], ["run", str(path), "-o", str(tmp_path / "o")]):
        capsys.readouterr()
        assert main(command) == 2, command
        said = capsys.readouterr().err
        assert said.count("\n") == 1 and words in said
    assert not (tmp_path / "o").exists()


DRIVEN = UNIT.replace("process_bound", "B = [[0], [1]]\nprocess_bound").replace(
    "steps = 20", "steps = 20\ninputs = [" + "[1.0]," * 20 + "]"
)
CHANGING = UNIT.replace("threshold = 2.0\ninitial_error = 1.0", "threshold = 2.0").replace(
    "process_bound", "A_over_time = [" + "[[1, 0.1], [0, 1]]," * 20 + "]\nprocess_bound"
)


@pytest.mark.parametrize(
    ("scenario", "old", "new", "words"),
    [
        (DRIVEN, "[1.0],]", "]", "[run].inputs: got 19 rows, expected 20, one per step of the run"),
        (DRIVEN, "[1.0],]", "[nan],]", "inputs[19][0]: got nan, expected a finite number"),
        (CHANGING, "[[1, 0.1], [0, 1]],]", "]", "[model]: got a model over 19 steps, expected at least 20"),
    ],
)
def test_check_looks_at_the_whole_run(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], scenario: str, old: str, new: str, words: str
) -> None:
    path = tmp_path / "s.toml"
    path.write_text(scenario)
    assert main(["check", str(path)]) in (0, 1), capsys.readouterr().err
    assert main(["run", str(path), "-o", str(tmp_path / "o")]) == 0, capsys.readouterr().err
    path.write_text(scenario.replace(old, new, 1))
    for command in (["check", str(path)], ["run", str(path), "-o", str(tmp_path / "p")]):
        capsys.readouterr()
        assert main(command) == 2, command
        assert words in capsys.readouterr().err or command[0] == "run"


RECORDED = """
[model]
A = [[0.9]]
C = [[1.0], [1.0], [1.0]]
names = ["a", "b", "c"]
process_covariance = 0.1
measurement_covariance = 0.2
[network]
kind = "ring"
[filter]
name = "dkf"
[data]
file = "d.csv"
"""


def test_columns_are_matched_by_name_or_not_at_all(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "s.toml").write_text(RECORDED)
    body = "".join(f"{k},{k % 3},{k % 5},{k % 7}\n" for k in range(20))
    other = "".join(f"{k},{k % 7},{k % 5},{k % 3}\n" for k in range(20))
    found = []
    for k, text in enumerate((f"t,a,b,c\n{body}", f"t,c,b,a\n{other}", f"t,x,y,z\n{body}")):
        (tmp_path / "d.csv").write_text(text)
        assert main(["run", str(tmp_path / "s.toml"), "-o", str(tmp_path / str(k))]) == 0
        found.append((tmp_path / str(k) / "estimates.csv").read_text())
    assert found[0] == found[1] == found[2]
    (tmp_path / "d.csv").write_text(f"t,c,b,z\n{other}")
    capsys.readouterr()
    assert main(["check", str(tmp_path / "s.toml")]) == 2
    assert "d.csv: got no column a, expected a, b, c; columns are matched by name" in capsys.readouterr().err


@pytest.mark.parametrize(("magic", "words"), [(b"\x1f\x8b\x08", "a gzip file"), (b"PK\x03\x04aa", "a spreadsheet")])
def test_packed_files_are_called_so(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], magic: bytes, words: str
) -> None:
    (tmp_path / "x.csv").write_bytes(magic)
    for command in ("fit", "structure", "check"):
        capsys.readouterr()
        assert main([command, str(tmp_path / "x.csv")]) == 2
        assert words in capsys.readouterr().err


@pytest.mark.parametrize("key", ["data.from", "data.to", "model.from", "model.to"])
@pytest.mark.parametrize("value", ["inf", "-inf", "nan"])
def test_ends_of_records_that_are_no_time_are_refused(key: str, value: str, capsys: pytest.CaptureFixture[str]) -> None:
    scenario = str(ROOT / "examples/wind/hijacked.toml")
    assert main(["check", scenario, "--set", f"{key}={value}"]) == 2
    assert key.split(".")[1] in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--scale", "nan"], "--scale: got nan"),
        (["--scale", "-1"], "--scale: got -1"),
        (["--failure", "0.1"], "--failure: got 0.1 without --attacked"),
        (["--failure", "2", "--attacked", "1"], "--failure: got 2, expected a rate"),
        (["--period", "0.5"], "fit.period: got 0.5, expected more than 4 samples"),
    ],
)
def test_options_of_fit_are_refused_by_their_names(
    wind: Path, words: list[str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["fit", str(wind / "irish_wind.csv"), *words]) == 2
    assert said in capsys.readouterr().err


def test_an_index_that_a_scenario_does_not_have(capsys: pytest.CaptureFixture[str]) -> None:
    scenario = str(ROOT / "examples/wind/hijacked.toml")
    assert main(["check", scenario, "--set", "attack[3].value=1"]) == 2
    assert "expected an index below 1, as the scenario has 1" in capsys.readouterr().err


def test_one_covariance_for_the_noises_of_all_agents() -> None:
    with pytest.raises(gr.InvalidInput, match="got 3 x 3 numbers, expected 3 matrices, one per agent; noises of diff"):
        gr.Model(0.9, [1.0] * 3, measurement_covariance=np.eye(3))
    with pytest.raises(gr.InvalidInput, match="give the block of each agent"):
        gr.Model(0.9 * np.eye(2), [np.eye(2)] * 3, measurement_covariance=np.eye(6))


def test_a_full_disk_is_called_so(
    wind: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def full(*_args: object, **_named: object) -> int:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(Path, "write_text", full)
    assert main(["fit", str(wind / "irish_wind.csv"), "-o", str(tmp_path / "m.json")]) == 2
    assert "got a disk that is full, expected room for it; free some" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ("kind = ring", ["line 8: got 'kind = ring' (invalid value)", "text stands in quotes"]),
        ('kind = "ring";', ["line 8", "lines such as key = value"]),
        ('kind: "ring"', ["line 8: got ", "(expected '=' after a key"]),
        ('kind = "ring"\nkind = "path"', ["line 9", "which is there already", "every key and every [table] once"]),
        ('kind = "ring"\n[model]', ["line 9: got '[model]', which is there already"]),
        ('kind = "ring', ["line 8"]),
        ('kind = "ring"\nagents = .5', ["line 9: got 'agents = .5'", "numbers are like 0.5"]),
    ],
)
def test_lines_that_are_no_toml_are_shown(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], wrong: str, said: list[str]
) -> None:
    path = tmp_path / "s.toml"
    path.write_text(SCENARIO.replace('kind = "ring"', wrong))
    assert main(["check", str(path)]) == 2
    error = capsys.readouterr().err
    for words in said:
        assert words in error, error


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("[run]", '[[compare]]\nname = "rdkf"\nweigth = 1\n[run]', "compare[0] rdkf: got the unknown key 'weigth'"),
        (
            "[run]",
            '[[compare]]\nname = "dkf"\n[[compare]]\nname = "rdkf"\nweight = -1\n[run]',
            "compare[1] rdkf.weight",
        ),
        ("[run]", '[[compare]]\nname = "central_kalman"\nlabel = "ideal"\ngate = -1\n[run]', "ideal gate: got -1"),
        (
            'kind = "ring"',
            'kind = "random_geometric"\nradius = -1',
            "[network] kind = 'random_geometric' radius: got -1",
        ),
        ('kind = "ring"', 'edges = [["a", "b"]]', "the agents have no names; the key names in [model]"),
        ("steps = 5", 'steps = 5\nx0 = "x0.csv"', "[run].x0: got 'x0.csv', expected numbers, or { file = "),
    ],
)
def test_refusals_name_the_table(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], old: str, new: str, said: str
) -> None:
    path = tmp_path / "s.toml"
    path.write_text(SCENARIO.replace(old, new))
    assert main(["check", str(path)]) == 2
    assert said in capsys.readouterr().err


def test_a_wrong_memory_limit_is_refused_not_a_crash(tmp_path: Path) -> None:
    path = tmp_path / "s.toml"
    path.write_text(SCENARIO)
    for command in (["check", str(path)], ["list"]):
        done = subprocess.run(
            [sys.executable, "-m", "garrison", *command],
            capture_output=True,
            text=True,
            env={**os.environ, "GARRISON_MEMORY_GB": "abc"},
            check=False,
        )
        assert "Traceback" not in done.stderr
        assert done.returncode == (2 if command[0] == "check" else 0), done.stderr


@pytest.mark.parametrize("content", ["", "hello", '{"family": 1', "\udcff"])
def test_a_case_that_is_no_json_is_called_so(tmp_path: Path, capsys: pytest.CaptureFixture[str], content: str) -> None:
    path = tmp_path / "case.json"
    path.write_bytes(content.encode("utf-8", "surrogateescape"))
    assert main(["verify", str(path)]) == 1
    said = capsys.readouterr().out
    assert "is no JSON" in said
    assert "Expecting" not in said and "codec" not in said
