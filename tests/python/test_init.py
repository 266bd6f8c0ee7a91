"""`garrison init` and `--set`: a scenario to start from, and other values for its keys."""

import json
from pathlib import Path

import garrison as gr
import numpy as np
import pytest
from garrison.cli import main
from garrison.jobs import run_scenario
from garrison.scenario import read_scenario

Capture = pytest.CaptureFixture[str]


@pytest.fixture
def scenario(tmp_path: Path, capsys: Capture) -> Path:
    path = tmp_path / "mine.toml"
    assert main(["init", str(path)]) == 0
    capsys.readouterr()
    return path


def test_what_init_writes_runs_and_finds_the_liar(scenario: Path, tmp_path: Path, capsys: Capture) -> None:
    assert "garrison run mine.toml" in scenario.read_text()
    assert main(["check", str(scenario)]) == 0
    assert main(["run", str(scenario), "-o", str(tmp_path / "out")]) == 0
    rows = json.loads((tmp_path / "out" / "summary.json").read_text())["rows"]
    assert (rows[0]["filter"], rows[0]["detected"], rows[0]["inside_bound"]) == ("saturation", {"2": 30}, 1.0)
    assert 10 * rows[0]["mean_error"] < rows[1]["mean_error"]  # the central Kalman filter believes the liar
    capsys.readouterr()


def test_every_key_that_the_scenario_offers_is_one(scenario: Path, tmp_path: Path, capsys: Capture) -> None:
    """What stands behind a # as a key is taken where the # is removed."""
    text = scenario.read_text()
    (tmp_path / "measurements.csv").write_text("\n".join(["0,0,0,0,0,0"] * 60) + "\n")
    for commented, removed in (
        ("# stop = 60", ""),
        ("# [link]", ""),
        ("# [data]", "steps = 100\ntrials = 10\nseed = 0"),
    ):
        at = text.index(commented)
        block = text[at : text.index("\n\n", at)] if commented.startswith("# [") else commented
        plain = block.replace("# ", "")
        changed = text.replace(block, plain.replace("  messages", "  # messages").replace("  recorded", "  # recorded"))
        scenario.write_text(changed.replace(removed, "") if removed else changed)
        assert main(["check", str(scenario)]) == 0, capsys.readouterr().err
    capsys.readouterr()


def test_init_replaces_nothing_unasked(scenario: Path, capsys: Capture) -> None:
    scenario.write_text("mine")
    assert main(["init", str(scenario)]) == 2
    assert scenario.read_text() == "mine"
    assert "exists already" in capsys.readouterr().err
    assert main(["init", str(scenario), "--force"]) == 0
    assert "[model]" in scenario.read_text()


def test_set_gives_other_values(scenario: Path, tmp_path: Path, capsys: Capture) -> None:
    out = tmp_path / "out"
    given = ["--set", "run.trials=2", "--set", "attack.agents=[4]", "--set", "compare[0].name=scalar_gain"]
    assert main(["run", str(scenario), "-o", str(out), *given]) == 0
    summary = json.loads((out / "summary.json").read_text())
    assert summary["set"] == {"run.trials": 2, "attack.agents": [4], "compare[0].name": "scalar_gain"}
    assert list(summary["rows"][0]["detected"]) == ["4"] and summary["rows"][1]["filter"] == "scalar_gain"
    assert main(["check", str(scenario), "--set", "filter.initial_error=0.01"]) == 1  # (9) fails
    capsys.readouterr()


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ("filter.threshold", "--set: got 'filter.threshold', expected KEY=VALUE"),
        ("filter.thresold=1", 'did you mean "threshold"'),
        ("attack[3].value=1", "attack[3]"),
        ("filter.threshold=x", "saturation.threshold"),
        ("a b=1", "'a b'"),
    ],
)
def test_set_refuses(scenario: Path, given: str, words: str, capsys: Capture) -> None:
    assert main(["check", str(scenario), "--set", given]) == 2
    assert words in capsys.readouterr().err


def test_a_key_set_twice_is_refused(scenario: Path, capsys: Capture) -> None:
    assert main(["check", str(scenario), "--set", "run.seed=1", "--set", "run.seed=2"]) == 2
    assert "run.seed twice" in capsys.readouterr().err


def test_the_central_kalman_filter_of_a_simulated_scenario(scenario: Path) -> None:
    """It gets the measurements of the main filter's runs, trial by trial."""
    read = read_scenario(scenario, {"run.trials": 3, "run.start": [1.0, -1.0]})
    main_row, central = run_scenario(read)[:2]
    assert main_row.run is not None and main_row.run.measurements is not None and main_row.run.truth is not None
    for k in range(3):
        estimate = gr.central_kalman(read.model, main_row.run.measurements[k], start=[1.0, -1.0])
        right = np.linalg.norm(estimate - main_row.run.truth[k], axis=1)
        assert central.error is not None
        np.testing.assert_array_equal(central.error[k, :, 0], right)


def test_protected_central_kalman_filters(scenario: Path, capsys: Capture) -> None:
    text = scenario.read_text()
    extra = '[[compare]]\nname = "central_kalman"\nlabel = "gated"\ngate = 0.001\n'
    extra += '[[compare]]\nname = "central_kalman"\nhuber = 1.345\n'
    scenario.write_text(text + extra)
    rows = {row.label: row.summary["mean_error"] for row in run_scenario(read_scenario(scenario)) if row.attacked}
    assert list(rows) == ["saturation", "central_kalman", "gated", "central_kalman (2)"]
    assert rows["gated"] < 0.1 * rows["central_kalman"]
    assert rows["central_kalman (2)"] < 0.5 * rows["central_kalman"]
    for wrong, words in (("gate = 2", "gate: got 2"), ("gate = 0.1\nhuber = 1.0", "expected one of them")):
        scenario.write_text(f'{text}[[compare]]\nname = "central_kalman"\n{wrong}\n')
        assert main(["check", str(scenario)]) == 2
        assert words in capsys.readouterr().err
