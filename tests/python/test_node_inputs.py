"""Daemons of a plant with known inputs: the bits of one process, and an end with the last row."""

import json
import re
import subprocess
import time
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT, check
from garrison import _core
from garrison.net.command import main
from garrison.net.folder import write_network
from garrison.net.plan import read_plan
from garrison.net.programs import program

SCENARIO = (
    (ROOT / "tests" / "node" / "ring.toml")
    .read_text()
    .replace("[network]", 'B = [[0.0, 0.3], [0.1, -0.2]]\ninputs = ["thrust", "wind"]\n\n[network]')
    .replace("[run]", "[run]\ninputs = { file = 'u.csv' }")
)
PLAN = 'scenario = "scenario.toml"\n[run]\nperiod_ms = 100\n[relay]\nloss = 0.05\n'


@pytest.fixture
def plan(tmp_path: Path) -> Path:
    (tmp_path / "scenario.toml").write_text(SCENARIO)
    u = np.column_stack([np.sin(0.3 * np.arange(30)), np.full(30, 1 / 3)])
    np.savetxt(tmp_path / "u.csv", u, fmt="%.17g", delimiter=",", header="thrust,wind", comments="")
    path = tmp_path / "network.toml"
    path.write_text(PLAN)
    return path


def test_a_network_with_inputs_does_what_one_process_does(
    plan: Path, programs: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "net"
    assert main(["up", str(plan), "-o", str(out), "--programs", programs]) == 0, capsys.readouterr().out
    run = read_plan(plan).reference.run
    assert run.estimate is not None and run.inputs is not None
    lines = [json.loads(line) for line in (out / "0" / "samples.jsonl").read_text().splitlines()]
    samples = [line for line in lines if 1 <= line["t"] <= 30]
    assert len(samples) > 20
    shift = max(np.abs(run.estimate[0, 1:, 0] - np.array([line["estimate"] for line in samples[:1]])).ravel())
    assert shift > 0.1  # the inputs do something
    for line in samples:
        assert line["input"] == run.inputs[line["t"] - 1].tolist()
        assert np.linalg.norm(np.array(line["estimate"]) - run.truth[0, line["t"]]) <= line["bound"]
    logs = [_core.replay_log(path.read_bytes()) for path in out.glob("*/log/*.mcap")]
    assert len(logs) == 6 and all(log["estimates"] > 0 and log["differ"] == 0 for log in logs)


def test_inputs_are_wanted_where_the_design_has_them_and_refused_where_not(folder: Path, programs: str) -> None:
    assert check(folder, programs).returncode == 0
    settings = folder / "node.toml"
    text = settings.read_text()
    section = '[input]\nsource = "file"\npath = "inputs.csv"\n'
    assert section in text
    settings.write_text(text.replace(section, ""))
    done = check(folder, programs)
    assert done.returncode == 2
    assert '[input]: got none, expected source = "file"' in done.stderr and "2 numbers a row" in done.stderr
    settings.write_text(text)
    (folder / "inputs.csv").write_text("1,2\n1,nan\n")
    done = check(folder, programs)
    assert done.returncode == 2
    assert "inputs.csv, line 2" in done.stderr


def test_a_part_without_inputs_takes_none(tmp_path: Path, programs: str) -> None:
    (tmp_path / "scenario.toml").write_text((ROOT / "tests" / "node" / "ring.toml").read_text())
    (tmp_path / "network.toml").write_text(PLAN)
    (tmp_path / "net").mkdir()
    write_network(read_plan(tmp_path / "network.toml"), tmp_path / "net", time.time() + 3600, programs)
    settings = tmp_path / "net" / "0" / "node.toml"
    settings.write_text(settings.read_text() + '[input]\nsource = "file"\npath = "u.csv"\n')
    done = check(settings.parent, programs)
    assert done.returncode == 2
    assert "the model of the design has no B" in done.stderr


def test_a_node_ends_with_its_inputs_and_does_not_start_behind_them(folder: Path, programs: str) -> None:
    roster = folder / ".." / "roster.toml"
    text = roster.read_text()
    (folder / "inputs.csv").write_text("1,2\n" * 5)
    roster.write_text(re.sub(r"start = \d+", f"start = {int(time.time() * 1e6) + 300_000}", text))
    command = [program("garrison-node", programs), "--print", str(folder / "node.toml")]
    done = subprocess.run(command, capture_output=True, text=True, timeout=20)
    assert done.returncode == 0
    assert "the known inputs end with sample 5, and the node with them" in done.stderr
    assert json.loads(done.stdout.splitlines()[-1])["t"] == 5
    roster.write_text(re.sub(r"start = \d+", f"start = {int(time.time() * 1e6) - 2_000_000}", text))
    done = subprocess.run(command, capture_output=True, text=True, timeout=20)
    assert done.returncode == 2
    assert "inputs.csv: got 5 rows" in done.stderr and "the same on all nodes" in done.stderr
