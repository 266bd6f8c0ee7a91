"""The command line as a person meets it: exit codes, messages, files."""

import json
from pathlib import Path

import pytest
from conftest import RING
from garrison.cli import main

SCENARIO = (
    RING
    + """\
[filter]
name = "saturation"
threshold = 2.0
rounds = 6
[[attack]]
kind = "bias"
agents = [1]
value = 5.0
start = 10
[run]
steps = 30
trials = 3
seed = 4
x0 = [1.0, 1.0]
"""
)


@pytest.fixture
def scenario(tmp_path: Path) -> Path:
    path = tmp_path / "scenario.toml"
    path.write_text(SCENARIO)
    return path


def changed(path: Path, old: str, new: str) -> Path:
    assert old in path.read_text()
    path.write_text(path.read_text().replace(old, new))
    return path


def refused(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    assert main(list(arguments)) == 2
    captured = capsys.readouterr()
    assert "Traceback" not in captured.err
    return captured.err


def test_run_writes_summary_estimates_and_report(scenario: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    assert main(["run", str(scenario), "-o", str(out)]) == 0
    summary = json.loads((out / "summary.json").read_text())
    assert [row["attacked"] for row in summary["rows"]] == [True, False]
    assert (out / "estimates.csv").read_text().startswith("trial,time,agent,x0,x1,bound,bound_kind\n")
    page = (out / "report.html").read_text()
    assert "<svg" in page and "http" not in page.replace("http://www.w3.org", "").replace(
        "http://purl.org", ""
    ).replace("http://creativecommons.org", "").replace("https://matplotlib.org", "")


def test_run_never_overwrites_silently(scenario: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "out"
    assert main(["run", str(scenario), "-o", str(out)]) == 0
    assert "not empty" in refused(capsys, "run", str(scenario), "-o", str(out))
    assert main(["run", str(scenario), "-o", str(out), "--force"]) == 0
    mine = tmp_path / "mine"
    mine.mkdir()
    (mine / "thesis.tex").write_text("years of work")
    assert "will not replace" in refused(capsys, "run", str(scenario), "-o", str(mine), "--force")
    assert (mine / "thesis.tex").exists()


def test_same_scenario_gives_the_same_numbers(scenario: Path, tmp_path: Path) -> None:
    for name in ("a", "b"):
        assert main(["run", str(scenario), "-o", str(tmp_path / name)]) == 0
    assert (tmp_path / "a/estimates.csv").read_bytes() == (tmp_path / "b/estimates.csv").read_bytes()


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("threshold = 2.0", "treshold = 2.0", ["treshold", 'did you mean "threshold"']),
        ("threshold = 2.0", "threshold = -1.0", ["saturation.threshold", "-1", "> 0"]),
        ("threshold = 2.0", "threshold = 0", ["saturation.threshold", "0", "> 0"]),
        ("rounds = 6", "rounds = 2.5", ["rounds", "2.5", "whole number"]),
        ("[network]", "[netwrok]", ["netwrok", "network"]),
        ('kind = "ring"', 'kind = "rign"', ["rign", "ring"]),
        ('kind = "ring"', "edges = [[0, 1], [1, 2]]", ["connected", "lambda_2"]),
        ('kind = "ring"', "edges = [[0, 0], [1, 2]]", ["self-loop", "edges[0]"]),
        ('kind = "ring"', "edges = [[0, 7], [1, 2]]", ["(0, 7)", "0..4"]),
        ('name = "saturation"', 'name = "saturatoin"', ["saturatoin", "saturation"]),
        ('kind = "bias"', 'kind = "bais"', ["bais", "bias"]),
        ("agents = [1]", "agents = [9]", ["9", "0..4"]),
        ("steps = 30", "steps = 0", ["steps", "0", ">= 1"]),
        ("C = [[1, 0]", "C = [[1, 0, 0]", ["C[0]", "2 columns"]),
        ("rounds = 6", "rounds = 6\nattacked = 6", ["attacked", "6", "5"]),
        (
            "threshold = 2.0",
            "threshold = 2.0\ninitial_error = 1.0\ndetector = true\nattacked = 1",
            ["L is too small"],
        ),
        ("steps = 30", "", ["[run] steps"]),
        ("A = [[1.0, 0.1]", 'A = {file = "missing.csv"}\n# [[', ["missing.csv"]),
    ],
)
def test_bad_scenarios_say_which_got_expected(
    scenario: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], old: str, new: str, words: list[str]
) -> None:
    if "L is too small" in words:
        changed(scenario, "rounds = 6", "rounds = 0")
    message = refused(capsys, "run", str(changed(scenario, old, new)), "-o", str(tmp_path / "out"))
    for word in words:
        assert word in message, message


def test_missing_and_unreadable_files(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert "none.toml" in refused(capsys, "check", str(tmp_path / "none.toml"))
    (tmp_path / "broken.toml").write_text("[model\n")
    assert "TOML" in refused(capsys, "check", str(tmp_path / "broken.toml"))
    assert "none.csv" in refused(capsys, "fit", str(tmp_path / "none.csv"))
    (tmp_path / "words.csv").write_text("date,A\n2001-01-01,x\n2001-01-02,1\n")
    assert "line 2, column A: got 'x'" in refused(capsys, "fit", str(tmp_path / "words.csv"))
    (tmp_path / "gap.csv").write_text("date,A\n2001-01-01,1\n2001-01-03,1\n2001-01-06,1\n")
    assert "2001-01-06 after 2001-01-03" in refused(capsys, "fit", str(tmp_path / "gap.csv"))
    (tmp_path / "binary.csv").write_bytes(b"\xff\xfe\x00")
    assert "readable CSV" in refused(capsys, "fit", str(tmp_path / "binary.csv"))
    assert "no such folder or file" in refused(capsys, "verify", str(tmp_path / "nowhere"))


def test_check_exit_code_says_whether_conditions_hold(scenario: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", str(scenario)]) == 0  # no bound is asked for: nothing is required
    changed(scenario, "rounds = 6", "rounds = 6\ninitial_error = 1.0\nattacked = 1")
    capsys.readouterr()
    assert main(["check", str(scenario), "--json"]) == 1
    assert not json.loads(capsys.readouterr().out)["holds"]


def test_list_and_json(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["list"]) == 0
    text = capsys.readouterr().out
    assert "saturation" in text and "false_trajectory" in text
    assert main(["list", "filters", "--json"]) == 0
    assert {"saturation", "scalar_gain", "lfre"} <= {f["name"] for f in json.loads(capsys.readouterr().out)["filters"]}


def test_verify_reports_and_counts(cases: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["verify", str(cases)]) == 0
    assert capsys.readouterr().out.strip().endswith("0 missed")
    (tmp_path / "other.json").write_text('{"paper": "unheard_of", "inputs": {}, "expected": {}}')
    assert main(["verify", str(tmp_path)]) == 1
    assert "unheard_of" in capsys.readouterr().out


def test_estimates_are_named_as_the_states_are(scenario: Path, tmp_path: Path) -> None:
    changed(scenario, "[model]\n", '[model]\nstates = ["position", "time"]\n')
    assert main(["run", str(scenario), "-o", str(tmp_path / "out")]) == 0
    text = (tmp_path / "out" / "estimates.csv").read_text()
    assert text.startswith("trial,time,agent,position,state_time,bound,bound_kind\n")
