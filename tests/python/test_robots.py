"""A robot team with odometry and sightings that come and go, in at most thirty lines; a landmark lies by 3 m."""

import contextlib
import io
from typing import Any

import garrison as gr
import numpy as np
import pytest
from conftest import ROOT

SCRIPT = ROOT / "examples" / "robots" / "team.py"


@pytest.fixture(scope="module")
def team() -> dict[str, Any]:
    """Everything that the example leaves behind."""
    found: dict[str, Any] = {}
    with contextlib.redirect_stdout(io.StringIO()) as printed:
        exec(compile(SCRIPT.read_text(), str(SCRIPT), "exec"), found)
    found["printed"] = printed.getvalue()
    return found


def test_it_takes_thirty_lines() -> None:
    lines = [line for line in SCRIPT.read_text().splitlines()[1:] if line.strip() and not line.strip().startswith("#")]
    assert len(lines) <= 30


def test_sightings_and_links_come_and_go(team: dict[str, Any]) -> None:
    seen = np.isfinite(team["y"])
    assert 0.2 < seen.mean() < 0.95 and (seen.any(axis=0) & ~seen.all(axis=0)).any()
    present = team["net"].present
    assert not present.all() and present.any()


def test_a_lie_of_three_metres_is_bounded(team: dict[str, Any]) -> None:
    run = team["run"]
    assert np.isfinite(run.bound[0, 1:]).all() and (run.error <= run.bound).all()
    assert run.error[0, 60:].max() < 0.6 and run.bound[0, 60:].max() < 1.5
    believed = gr.central_kalman(team["model"], team["y"], inputs=team["moves"], start=team["truth"][0])
    assert np.linalg.norm(believed - team["truth"], axis=1)[60:].max() > 2.0
    assert "error 0." in team["printed"]


def test_without_odometry_the_team_is_lost(team: dict[str, Any]) -> None:
    still = gr.replay(
        team["model"],
        team["net"],
        gr.filters.Saturation(threshold=0.05, rounds=4),
        **team["log"] | {"inputs": 0 * team["moves"]},
    )
    assert still.error[0, 60:].max() > 3 * team["run"].error[0, 60:].max()
