"""What goes wrong around a daemon is said and counted: output that nobody takes, states and addresses of others."""

import re
import shutil
import subprocess
import time
from pathlib import Path

import pytest
from conftest import ROOT
from garrison.net import Client
from garrison.net.folder import write_network
from garrison.net.plan import read_plan
from garrison.net.programs import program
from test_node import _patiently

PLAN = 'scenario = "scenario.toml"\n[run]\nperiod_ms = 100\n'


@pytest.fixture
def folder(programs: str, tmp_path: Path) -> Path:
    """The files of a node whose first sample is an hour away."""
    (tmp_path / "scenario.toml").write_text((ROOT / "tests" / "node" / "ring.toml").read_text())
    (tmp_path / "network.toml").write_text(PLAN)
    (tmp_path / "net").mkdir()
    write_network(read_plan(tmp_path / "network.toml"), tmp_path / "net", time.time() + 3600, programs)
    return tmp_path / "net" / "0"


def test_output_that_nobody_takes_is_an_error(folder: Path, programs: str, tmp_path: Path) -> None:
    def end(*command: str) -> tuple[int, str]:
        with Path("/dev/full").open("wb") as full:
            done = subprocess.run(command, stdout=full, stderr=subprocess.PIPE, text=True, timeout=20)
        return done.returncode, done.stderr

    node, ctl = program("garrison-node", programs), program("garrison-ctl", programs)
    keygen = program("garrison-keygen", programs)
    with subprocess.Popen([node, str(folder / "node.toml")], stdin=subprocess.DEVNULL) as process:
        try:
            _patiently(Client(folder / "node.sock"))
            status = end(ctl, "status", str(folder / "node.sock"))
        finally:
            process.terminate()
    ends = [status, end(node, "--check", str(folder / "node.toml")), end(keygen, str(tmp_path / "new.key"))]
    for one in [*ends, end(node, "--version"), end(ctl, "--help"), end(keygen, "--show", str(folder / "node.key"))]:
        assert one[0] == 2
        assert "standard output: got No space left on device" in one[1]


def test_the_state_of_another_node_is_not_taken_said_and_counted(folder: Path, programs: str) -> None:
    roster = folder / ".." / "roster.toml"
    text = re.sub(r"start = \d+", f"start = {int(time.time() * 1e6) + 500_000}", roster.read_text())
    roster.write_text(text)
    other = folder.parent / "1"
    command = [program("garrison-node", programs), str(other / "node.toml")]
    with subprocess.Popen(command, stdin=subprocess.DEVNULL) as process:
        time.sleep(2.0)
        process.terminate()
    (folder / "state").mkdir()
    shutil.copy(other / "state" / "state", folder / "state" / "state")
    command = [program("garrison-node", programs), str(folder / "node.toml")]
    with (folder / "said").open("wb") as said:
        process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stderr=said)
    with process:
        try:
            status = _patiently(Client(folder / "node.sock"))
        finally:
            process.terminate()
    assert process.returncode == 0
    assert status["states_refused"] == 1
    assert "state: got that of another node of this run" in (folder / "said").read_text()


@pytest.mark.parametrize(
    ("address", "words"),
    [
        ("192.0.2.1:7470", ["[listen].address = 192.0.2.1:7470", "Cannot assign requested address", "this machine"]),
        ("239.1.2.3:7470", ["[listen].address", '"239.1.2.3:7470", an address of many', "that of one machine"]),
    ],
)
def test_check_refuses_addresses_that_nobody_can_listen_at(
    folder: Path, programs: str, address: str, words: list[str]
) -> None:
    settings = folder / "node.toml"
    settings.write_text(re.sub(r'address = "127\.0\.0\.1:\d+"', f'address = "{address}"', settings.read_text()))
    done = subprocess.run(
        [program("garrison-node", programs), "--check", str(settings)], capture_output=True, text=True, timeout=20
    )
    assert done.returncode == 2
    for word in [*words, "got ", "expected "]:
        assert word in done.stderr
