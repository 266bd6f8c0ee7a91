"""[model] in continuous time: regular and irregular samples are those of `from_continuous`."""

from pathlib import Path

import garrison as gr
import numpy as np
import pytest
from garrison.cli import main
from garrison.scenario import read_scenario

TIMES = [0.0, 0.1, 0.35, 0.4, 1.1]
F = [[0.0, 1.0], [-2.0, -0.4]]
PARTS = {"measurement_covariance": 0.05, "B": [[0.0], [1.0]], "states": ["angle", "rate"]}


def scenario(folder: Path, lines: str) -> Path:
    """A scenario of an oscillator that two agents watch."""
    path = folder / "s.toml"
    path.write_text(
        f"""
[model]
A = {F}
C = [[1, 0], [0, 1]]
B = [[0.0], [1.0]]
states = ["angle", "rate"]
measurement_covariance = 0.05
{lines}
[network]
kind = "complete"
[filter]
name = "partial_sharing"
gain = 0.1
gains = "varying"
[run]
steps = 4
inputs = [[1.0], [0.0], [-1.0], [2.0]]
"""
    )
    return path


def test_irregular_samples_are_those_of_the_times(tmp_path: Path) -> None:
    found = read_scenario(scenario(tmp_path, f"times = {TIMES}\nprocess_intensity = 0.3"))
    assert found.plant == gr.VaryingModel.from_continuous(F, np.eye(2), TIMES, process_intensity=0.3, **PARTS)
    (tmp_path / "t.csv").write_text("\n".join(map(str, TIMES)))
    of_a_file = read_scenario(
        scenario(tmp_path, 'times = { file = "t.csv" }\nprocess_intensity = [[0.3, 0.0], [0, 0.3]]')
    )
    assert of_a_file.plant == found.plant
    assert main(["run", str(tmp_path / "s.toml"), "-o", str(tmp_path / "out")]) == 0


def test_regular_samples_are_a_constant_model(tmp_path: Path) -> None:
    found = read_scenario(scenario(tmp_path, "interval = 0.25\nprocess_intensity = 0.3"))
    assert found.plant == gr.Model.from_continuous(F, np.eye(2), 0.25, process_intensity=0.3, **PARTS)


def test_rows_may_change_beside_the_times(tmp_path: Path) -> None:
    C = [[[1.0, 0.1 * t], [0.0, 1.0]] for t in range(4)]
    found = read_scenario(scenario(tmp_path, f"times = {TIMES}\nprocess_intensity = 1\nC_over_time = {C}"))
    assert set(found.varying.parts) == {"A", "B", "C", "process_covariance"}
    assert np.array_equal(found.varying.parts["C"], C)


@pytest.mark.parametrize(
    ("lines", "words"),
    [
        (f"times = {TIMES}\ninterval = 0.1", "interval and times"),
        ("process_intensity = 1.0", "no interval and no times"),
        ("interval = 0.1\nprocess_covariance = 1.0", "process_covariance beside interval"),
        (f"times = {TIMES}\nA_over_time = {[F] * 4}", "A_over_time: got times beside it"),
        (f"interval = 0.1\nA_over_time = {[F] * 4}", "A_over_time: got interval and A beside it.*leave interval out"),
        (f"interval = 0.1\nB_over_time = {[[[0.0], [1.0]]] * 4}", "B_over_time: got interval and B beside it"),
        (
            f"interval = 0.1\nprocess_intensity = 1.0\nprocess_covariance_over_time = {[[[1.0, 0.0], [0.0, 1.0]]] * 4}",
            "process_covariance_over_time: got interval and process_intensity beside it",
        ),
        ("times = [0.0, 1.0, 0.5]", "times"),
        ("interval = 0.0", r"\[model\].interval: got 0"),
    ],
)
def test_what_does_not_fit_is_refused(tmp_path: Path, lines: str, words: str) -> None:
    with pytest.raises(gr.InvalidInput, match=words):
        read_scenario(scenario(tmp_path, lines))


def test_commands_about_a_constant_plant_name_the_times(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["analyze", str(scenario(tmp_path, f"times = {TIMES}\nprocess_intensity = 1.0"))]) == 2
    assert "[model]: got times, expected a constant plant" in " ".join(capsys.readouterr().err.split())
