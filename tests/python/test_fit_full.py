"""fit(states="all"): every station a state, known inputs, the order that the records have."""

import dataclasses
from pathlib import Path
from typing import Any

import garrison as gr
import numpy as np
import pytest
from garrison.cli import main
from garrison.scenario.model_file import read_model_file
from garrison.tables import read_records

A1, A2, B = np.array([[0.5, 0.2], [-0.1, 0.3]]), np.array([[0.3, 0.0], [0.1, 0.4]]), np.array([1.0, -2.0])


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Hourly records of two stations that a valve drives, around means of 20 and 50."""
    rng, T = np.random.default_rng(5), 3000
    e, u, z = 0.3 * rng.normal(size=(T, 2)), rng.normal(size=T), np.zeros((T, 2))
    for t in range(2, T):
        z[t] = A1 @ z[t - 1] + A2 @ z[t - 2] + B * u[t] + e[t]
    stamps = np.datetime64("2020-01-01T00:00") + np.arange(T) * np.timedelta64(1, "h")
    lines = ["time,east [K],west [K],valve"]
    lines += [f"{s},{a + 20!r},{b + 50!r},{v!r}" for s, (a, b), v in zip(stamps, z.tolist(), u.tolist(), strict=True)]
    path = tmp_path_factory.mktemp("full")
    (path / "records.csv").write_text("\n".join(lines) + "\n")
    return path


def test_order_and_matrices_are_those_of_the_records(folder: Path) -> None:
    found: Any = gr.fit(read_records(folder / "records.csv"), states="all", inputs=["valve"], harmonics=0)
    assert found.autoregression.order == 2 and np.argmax(found.autoregression.held_out) == 1
    model = found.model
    assert model.states == 4 and model.inputs == 1 and model.input_names == ["valve"]
    assert model.state_names == ["east", "west", "east, 1 before", "west, 1 before"] and model.units["east"] == "K"
    assert np.allclose(model.A[:2, :2], A1, atol=0.06) and np.allclose(model.A[:2, 2:], A2, atol=0.06)
    assert np.allclose(model.B[:2, 0], B, atol=0.03) and not model.B[2:].any()
    assert found.whiteness().p_value > 0.01
    short: Any = gr.fit(read_records(folder / "records.csv"), states="all", inputs=["valve"], harmonics=0, order=1)
    assert short.autoregression.order == 1 and short.whiteness().p_value < 1e-6


def test_it_predicts_what_it_was_not_fitted_to(folder: Path) -> None:
    records = read_records(folder / "records.csv")
    first, last = records.dates[1500], records.dates[1501]
    found: Any = gr.fit(records.between(None, first), states="all", inputs=["valve"], harmonics=0)
    later = records.between(last, None)
    y, u, x = found.measurements(later), found.known(later), found.reference(later)
    told = gr.central_kalman(found.model, y, inputs=u, start_variance=1.0)
    assert np.linalg.norm(told[10:, :2] - y[9:], axis=1).mean() < 0.1
    ahead = x[5:-1] @ found.model.A.T + u[6:] @ found.model.B.T
    assert 0.2 < np.sqrt(np.mean((ahead[:, :2] - y[6:]) ** 2)) < 0.4  # the noise of the records is 0.3


def test_scenarios_fit_and_replay_with_inputs(folder: Path) -> None:
    from garrison.jobs import run_scenario
    from garrison.scenario import read_scenario

    path = folder / "s.toml"
    path.write_text(
        """
[model]
fit = "records.csv"
to = 2020-02-15
states = "all"
inputs = ["valve"]
harmonics = 0
[network]
edges = [["east", "west"]]
[filter]
name = "scalar_gain"
[[compare]]
name = "central_kalman"
[data]
file = "records.csv"
from = 2020-03-01
to = 2020-03-10
"""
    )
    scenario = read_scenario(path)
    assert scenario.inputs is not None and scenario.inputs.shape == (scenario.steps, 1)
    rows = run_scenario(scenario)
    assert np.nanmean(rows[1].error[:, 5:]) < 0.2  # type: ignore[index]
    assert scenario.names == ["east", "west"]


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"inputs": ["vane"]}, "fit.inputs: got vane, expected columns of the records: east, west, valve"),
        ({"inputs": ["east", "west", "valve"]}, "some must be stations"),
        ({"factors": 2}, "fit.factors: got 2 with states = 'all'"),
        ({"order": -1}, "fit.order"),
        ({"held_out": 1.0}, "fit.held_out: got 1"),
        ({"noise": 0.0}, "fit.noise: got 0"),
        ({"most": 2000}, "fit.most: got 2000"),
    ],
)
def test_what_does_not_fit_is_refused(folder: Path, given: dict[str, Any], words: str) -> None:
    with pytest.raises(gr.InvalidInput, match=words):
        gr.fit(read_records(folder / "records.csv"), states="all", **given)
    with pytest.raises(gr.InvalidInput, match=r"fit\.states"):
        gr.fit(read_records(folder / "records.csv"), states="some")


def test_the_command_writes_a_model_that_scenarios_read(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    records, file = str(folder / "records.csv"), folder / "model.json"
    words = ["fit", records, "--states", "all", "--input", "valve", "--harmonics", "0", "-o", str(file)]
    assert main(words) == 0
    out = capsys.readouterr().out
    assert "a vector autoregression with 2 samples of the past" in out and "east" in out and "valve" not in out
    model, names = read_model_file(file)
    fitted = gr.fit(read_records(records), states="all", inputs=["valve"], harmonics=0)
    assert model == fitted.model and names == ["east", "west"]
    with pytest.raises(gr.InvalidInput, match="attacked: got 1"):
        fitted.to_json(1)


def test_missing_records_are_left_out(folder: Path) -> None:
    records = read_records(folder / "records.csv")
    whole = gr.fit(records, states="all", inputs=["valve"], harmonics=0, order=2)
    values = records.values.copy()
    values[100, 0] = values[200:220, 1] = np.nan
    found: Any = gr.fit(
        dataclasses.replace(records, values=values), states="all", inputs=["valve"], harmonics=0, order=2
    )
    assert np.allclose(found.model.A, whole.model.A, atol=0.02)
    assert np.isnan(found.autoregression.residuals[100:103]).any(axis=1).all()


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--states", "all", "--factors", "2"], "--factors: got 2 beside --states all"),
        (["--states", "all", "--attacked", "1"], "--attacked: got 1 beside --states all"),
        (["--order", "2"], "--order: got 2, expected --states all"),
        (["--input", "valve"], "--input: got ['valve'], expected --states all"),
        (["--states", "all", "--input", "vane"], "fit.inputs: got vane"),
    ],
)
def test_options_that_do_not_go_together(
    folder: Path, capsys: pytest.CaptureFixture[str], words: list[str], message: str
) -> None:
    assert main(["fit", str(folder / "records.csv"), *words]) == 2
    assert message in capsys.readouterr().err
