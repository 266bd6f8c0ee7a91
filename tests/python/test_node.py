"""Real daemons on 127.0.0.1: a small network, its files, its programs. Needs a build with GARRISON_BUILD_NODE."""

import base64
import ctypes
import ctypes.util
import json
import os
import re
import resource
import shutil
import signal
import socket
import struct
import subprocess
import time
from contextlib import ExitStack
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest
from conftest import ROOT, check
from garrison import _core
from garrison.cli import main as garrison
from garrison.net import Client
from garrison.net.accept.load import Load
from garrison.net.command import main
from garrison.net.folder import NodeFolder, write_network
from garrison.net.plan import read_plan
from garrison.net.programs import LIAR, is_there, program
from garrison.net.soak import Soak
from test_node_web import status as example

SCENARIO = (ROOT / "tests" / "node" / "ring.toml").read_text()
PLAN = """
scenario = "scenario.toml"
[run]
period_ms = 100
[relay]
loss = 0.05
delay_ms = 0.5
"""


@pytest.fixture
def plan(tmp_path: Path) -> Path:
    (tmp_path / "scenario.toml").write_text(SCENARIO)
    path = tmp_path / "network.toml"
    path.write_text(PLAN)
    return path


def test_a_network_under_attack_does_what_one_process_does(
    plan: Path, programs: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "net"
    assert main(["up", str(plan), "-o", str(out), "--programs", programs, "--attack"]) == 0
    said = capsys.readouterr().out
    assert "held:" in said
    summary = json.loads((out / "summary.json").read_text())
    assert all(summary["relay"][what] > 0 for what in ("lost", "replayed", "mutated", "forged", "flooded"))
    refused = re.search(r"refused: (.*)", said)
    assert refused is not None
    for reason in ("tag", "replay", "size", "stranger"):
        assert re.search(rf"\d+ {reason}\b", refused[1])
    assert all(node["samples"] > 10 and node["replayed"] > 10 and node["differ"] == 0 for node in summary["nodes"])
    assert all(node["counters"]["statements"] > 0 for node in summary["nodes"])
    logs = [str(path) for path in sorted(out.glob("*/log/*.mcap"))]
    assert len(logs) == 6
    assert garrison(["replay", *logs]) == 0
    assert "was stopped" in capsys.readouterr().out


def test_killed_nodes_are_back_and_their_logs_are_read_to_the_end(
    plan: Path, programs: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "net"
    assert main(["up", str(plan), "-o", str(out), "--programs", programs, "--kills", "2"]) == 0
    assert re.search(r"kills: 2, back after [\d.]+ s", capsys.readouterr().out)
    lives = [
        [_core.replay_log(path.read_bytes()) for path in sorted(folder.glob("*.mcap"))] for folder in out.glob("*/log")
    ]
    logs = [log for logs in lives for log in logs]
    assert len(logs) == 6 + 2
    assert sum(not log["ended"] for log in logs) == 2
    assert all(log["differ"] == 0 for log in logs)
    # With the snapshot of the disk or, where that was not written yet, by joining: after what was sent before.
    assert all(log["estimates"] > 0 for log in logs)
    assert all(before["last"] < after["first"] for logs in lives for before, after in pairwise(logs))


def _all_complete(nodes: list[NodeFolder], samples: int, patience: float) -> bool:
    """Every node has had so many whole samples, before patience (seconds) ends."""
    end = time.monotonic() + patience
    while time.monotonic() < end:
        if all(_patiently(Client(node.socket))["counters"]["complete"] >= samples for node in nodes):
            return True
        time.sleep(0.1)
    return False


def test_a_network_that_starts_late_or_was_off_for_long_begins_by_itself(
    plan: Path, programs: str, tmp_path: Path
) -> None:
    """Nobody has anything from anybody: each waits for the others to speak, until all see that nobody does."""
    (tmp_path / "net").mkdir()
    nodes = write_network(read_plan(plan), tmp_path / "net", time.time() - 500, programs)
    roster = (tmp_path / "net" / "roster.toml").read_text()
    for node in nodes:  # directly to each other
        roster = roster.replace(f":{node.outside}", f":{node.port}")
    (tmp_path / "net" / "roster.toml").write_text(roster)
    for life in range(2):
        with ExitStack() as stack:
            running = []
            for node in nodes:
                command = [program("garrison-node", programs), str(node.settings)]
                running.append(stack.enter_context(subprocess.Popen(command, stdin=subprocess.DEVNULL)))
            try:
                assert _all_complete(nodes, 5, patience=20.0), f"life {life}"
                assert all(_patiently(Client(node.socket))["bound"] is None for node in nodes)  # start too long ago
            finally:
                for process in running:
                    process.kill()  # before a snapshot was written: the second life knows nothing, either
    logs = [_core.replay_log(path.read_bytes()) for path in sorted((tmp_path / "net").glob("*/log/*.mcap"))]
    assert len(logs) == 2 * len(nodes)
    assert all(log["differ"] == 0 for log in logs)


def test_a_client_measures_and_watches(folder: Path, programs: str) -> None:
    text = (folder / "node.toml").read_text()
    (folder / "node.toml").write_text(text.replace('source = "file"\npath = "sensor.csv"', 'source = "socket"'))
    command = [program("garrison-node", programs), str(folder / "node.toml")]
    with subprocess.Popen(command, stdin=subprocess.DEVNULL) as process:
        try:
            client = Client(folder / "node.sock")
            status = _patiently(client)
            assert status["node"] == "0"
            assert status["state"] == "waiting"
            assert [link["state"] for link in status["links"]] == ["down", "down"]
            assert status.keys() == example("0").keys()
            assert status["counters"].keys() == example("0")["counters"].keys()
            assert status["links"][0].keys() == example("0")["links"][0].keys()
            assert client.measure([1.5]) == {"ok": True}
            assert client.status()["sensor"]["taken"] == 1
            with pytest.raises(_core.InvalidInput, match="as many numbers as the agent has outputs"):
                client.measure([1.0, 2.0])
            with pytest.raises(_core.InvalidInput, match="an unknown request"):
                client._ask("what")
        finally:
            process.terminate()
    assert process.returncode == 0
    assert not (folder / "node.sock").exists()


def test_a_running_node_reads_its_sensor_anew(folder: Path, programs: str) -> None:
    settings = (folder / "node.toml").read_text()

    def reloaded(text: str) -> subprocess.CompletedProcess[str]:
        (folder / "node.toml").write_text(text)
        command = [program("garrison-ctl", programs), "reload", str(folder / "node.sock")]
        return subprocess.run(command, capture_output=True, text=True, timeout=20)

    command = [program("garrison-node", programs), str(folder / "node.toml")]
    with subprocess.Popen(command, stdin=subprocess.DEVNULL) as process:
        try:
            client = Client(folder / "node.sock")
            _patiently(client)
            with pytest.raises(_core.InvalidInput, match='source = "socket"'):
                client.measure([1.5])
            socketed = settings.replace('source = "file"\npath = "sensor.csv"', 'source = "socket"')
            assert reloaded(socketed).returncode == 0
            assert client.measure([1.5]) == {"ok": True}
            time.sleep(0.2)  # the loop has let go of the sensor before
            refused = reloaded(socketed.replace('"socket"', '"sokket"'))
            assert refused.returncode == 2
            assert "sokket" in refused.stderr
            refused = reloaded(socketed.replace("require_synchronised = false", "require_synchronised = true"))
            assert refused.returncode == 2
            assert "restart the node" in refused.stderr
            assert client.measure([2.5]) == {"ok": True}
        finally:
            process.terminate()
    assert process.returncode == 0


def test_a_hang_up_lets_a_service_read_its_files_anew(folder: Path, programs: str) -> None:
    settings = (folder / "node.toml").read_text()
    command = [program("garrison-node", programs), str(folder / "node.toml")]
    said = folder / "said"
    with said.open("wb") as stream:
        process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stderr=stream)
    with process:
        try:
            client = Client(folder / "node.sock")
            _patiently(client)
            socketed = settings.replace('source = "file"\npath = "sensor.csv"', 'source = "socket"')
            (folder / "node.toml").write_text(socketed)
            process.send_signal(signal.SIGHUP)
            time.sleep(0.3)
            assert client.measure([1.5]) == {"ok": True}
            (folder / "node.toml").write_text(socketed.replace('"socket"', '"sokket"'))
            process.send_signal(signal.SIGHUP)
            time.sleep(0.3)
            assert client.measure([2.5]) == {"ok": True}
        finally:
            process.terminate()
    assert process.returncode == 0
    good, bad = said.read_text().splitlines()
    assert good == "garrison-node: SIGHUP: files read anew"
    assert "SIGHUP: files not read: " in bad and "sokket" in bad


def test_only_the_journal_is_told_priorities(folder: Path, programs: str, tmp_path: Path) -> None:
    (folder / "node.toml").write_text("nonsense = 1\n")
    command = [program("garrison-node", programs), "--check", str(folder / "node.toml")]

    def said(named: bool) -> str:
        with (tmp_path / "journal").open("wb") as stream:
            of = os.fstat(stream.fileno())
            journal = {"JOURNAL_STREAM": f"{of.st_dev}:{of.st_ino if named else 1}"}
            assert subprocess.run(command, stderr=stream, env=os.environ | journal).returncode == 2
        return (tmp_path / "journal").read_text()

    assert said(named=True).startswith("<3>garrison-node: ")
    assert said(named=False).startswith("garrison-node: ")


def test_names_of_agents_may_be_anything(plan: Path, programs: str, tmp_path: Path) -> None:
    names = ['a "b"', "c/d", "..", "e\\f", "g\x7f\n", "h"]
    network = read_plan(plan)
    network.scenario.names = names
    (tmp_path / "net").mkdir()
    nodes = write_network(network, tmp_path / "net", time.time() + 3600, programs)
    assert sorted(path.name for path in (tmp_path / "net").iterdir()) == [*map(str, range(6)), "roster.toml"]
    assert [node.name for node in nodes] == names
    assert all(check(node.path, programs).returncode == 0 for node in nodes)


def test_a_liar_with_keys_is_convicted(
    plan: Path, programs: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    if not is_there(LIAR):
        pytest.skip("no garrison_node_liar in build/")
    scenario = plan.with_name("scenario.toml")
    scenario.write_text(SCENARIO.replace('kind = "ring"', 'kind = "band"\nrange = 2'))
    assert main(["up", str(plan), "--liar", "x"]) == 2
    assert "--liar" in capsys.readouterr().err
    assert main(["up", str(plan), "-o", str(tmp_path / "net"), "--liar", "3"]) == 0
    assert re.search(r"liar: proved by [2-5] nodes", capsys.readouterr().out)
    assert list(tmp_path.glob("net/*/state/proofs/3-1-*.proof"))


def test_a_service_is_told_where_files_are_and_tells_how_it_is(folder: Path, programs: str, tmp_path: Path) -> None:
    settings = (folder / "node.toml").read_text()
    for words in ('key = "node.key"\n', '[socket]\npath = "node.sock"\n'):
        assert words in settings
        settings = settings.replace(words, "")
    (folder / "node.toml").write_text(settings)
    places = {name: tmp_path / name.lower() for name in ("CREDENTIALS", "STATE", "LOGS", "RUNTIME")}
    for place in places.values():
        place.mkdir()
    (folder / "node.key").rename(places["CREDENTIALS"] / "node.key")
    manager = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
    manager.bind(str(tmp_path / "notify"))
    manager.settimeout(20)
    environment = {
        **os.environ,
        **{f"{name}_DIRECTORY": str(place) for name, place in places.items()},
        "NOTIFY_SOCKET": str(tmp_path / "notify"),
        "WATCHDOG_USEC": "100000",
    }
    command = [program("garrison-node", programs), str(folder / "node.toml")]
    with manager, subprocess.Popen(command, stdin=subprocess.DEVNULL, env=environment) as process:
        assert manager.recv(1000) == b"READY=1"
        assert manager.recv(1000).startswith(b"WATCHDOG=1\nSTATUS=")
        assert Client(places["RUNTIME"] / "node.sock").status()["boot"] == 1
        process.terminate()
        said = b""
        while said != b"STOPPING=1":
            said = manager.recv(1000)
    assert process.returncode == 0
    assert (places["STATE"] / "boot").read_text() == "1\n"
    assert [path.name for path in places["LOGS"].iterdir()] == ["0-000001-0000.mcap"]


def _patiently(client: Client) -> dict[str, Any]:
    for _ in range(200):
        try:
            return client.status()
        except (OSError, _core.Error):  # not there yet, or without a status yet
            time.sleep(0.05)
    return client.status()


def test_check_says_what_fits(folder: Path, programs: str) -> None:
    done = check(folder, programs)
    assert (done.returncode, done.stderr) == (0, "")
    assert "agent 0 of 6, saturation, 3 rounds every 100 ms, 2 neighbours" in done.stdout


@pytest.mark.parametrize(
    ("file", "old", "new", "words"),
    [
        ("node.toml", 'source = "file"', 'source = "flie"', ["line 10, [sensor].source", '"flie"', '"lines", "udp"']),
        (
            "node.toml",
            'source = "file"\npath = "sensor.csv"',
            'source = "procfs"\nread = ["lod"]',
            ["[sensor].read", '"lod"', '"load", "clock"'],
        ),
        ("node.toml", 'name = "0"', 'name = "9"', ["node.toml, name", "an agent of", "0, 1, 2"]),
        ("node.toml", "part.gdesign", "nothing.gdesign", ["nothing.gdesign", "No such file"]),
        (
            "node.toml",
            'path = "sensor.csv"',
            'path = "sensor.csv"\nleast = [2]\nmost = [1]',
            ["[sensor].least", "got 2", "less than 1"],
        ),
        ("node.toml", 'path = "sensor.csv"', 'path = "sensor.csv"\nscale = [0]', ["[sensor].scale", "not 0"]),
        (
            "node.toml",
            'path = "node.sock"',
            f'path = "/{"x" * 200}"',
            ["[socket].path", "201 characters", "at most 107"],
        ),
        ("../roster.toml", "start = ", "start = 1796069212 # ", ["[run].start", "microseconds since 1970"]),
        ("sensor.csv", "\n", "\nwords\n", ["sensor.csv, line 2", '"words"', "1 number"]),
        ("../roster.toml", "period_ms = 100.0", "period_ms = 2", ["3 rounds", "a longer period_ms"]),
        ("../roster.toml", "initial = [0.0, 0.0]", "initial = [0.0]", ["[run].initial", "got 1 number", "2, one per"]),
        ("../roster.toml", "hears = [1, 5]", "hears = [1]", ["hears", "a list without 5", "from the same design"]),
        ("../roster.toml", "period_ms", "perod_ms", ["line 3, [run].perod_ms", 'did you mean "period_ms"?']),
    ],
)
def test_check_refuses_what_does_not_fit(
    folder: Path, programs: str, file: str, old: str, new: str, words: list[str]
) -> None:
    path = folder / file
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new, 1))
    done = check(folder, programs)
    assert done.returncode == 2
    assert done.stdout == ""
    for word in [*words, "got ", "expected "]:
        assert word in done.stderr


@pytest.mark.parametrize(
    "file", ["node.toml", "node.key", "part.gdesign", "sensor.csv", "../roster.toml", "state/boot"]
)
def test_pipes_are_not_waited_for(folder: Path, programs: str, file: str) -> None:
    path = folder / file
    path.unlink(missing_ok=True)
    path.parent.mkdir(exist_ok=True)
    os.mkfifo(path, 0o600)
    done = check(folder, programs)
    assert done.returncode == 2
    assert "no plain file" in done.stderr


def test_a_log_that_the_disk_did_not_take_goes_on_in_a_new_file(folder: Path, programs: str) -> None:
    """The limit of a file's size stands in for a disk that is full, and is taken away again."""
    roster = folder / ".." / "roster.toml"
    roster.write_text(re.sub(r"start = \d+", f"start = {int(time.time() * 1e6) + 500_000}", roster.read_text()))
    command = [program("garrison-node", programs), str(folder / "node.toml")]
    with (folder / "said").open("wb") as said:
        process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stderr=said)
    with process:
        try:
            client = Client(folder / "node.sock")
            _patiently(client)
            resource.prlimit(process.pid, resource.RLIMIT_FSIZE, (4096, resource.RLIM_INFINITY))
            for _ in range(100):
                time.sleep(0.1)
                if client.status()["log_failed"] > 0:
                    break
            assert client.status()["log_failed"] > 0
            time.sleep(1.2)  # the next file is not taken, either, and that is not said again
            resource.prlimit(process.pid, resource.RLIMIT_FSIZE, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
            for _ in range(100):
                time.sleep(0.1)
                if len(list((folder / "log").glob("*.mcap"))) > 1:
                    break
            time.sleep(1.0)
        finally:
            process.terminate()
    assert process.returncode == 0
    assert (folder / "said").read_text().count("no log from here on, until there is room") == 1
    cut, *others = [_core.replay_log(path.read_bytes()) for path in sorted((folder / "log").glob("*.mcap"))]
    assert len(others) == 1
    assert not cut["ended"] and cut["differ"] == 0
    assert others[-1]["ended"] and others[-1]["differ"] == 0 and others[-1]["estimates"] > 0


def test_check_refuses_keys_that_others_may_read_or_that_are_not_its_own(folder: Path, programs: str) -> None:
    (folder / "node.key").chmod(0o644)
    assert "chmod 600" in check(folder, programs).stderr
    shutil.copy(folder.parent / "1" / "node.key", folder / "node.key")
    (folder / "node.key").chmod(0o600)
    done = check(folder, programs)
    assert done.returncode == 2
    assert "as " in done.stderr and "has for 0" in done.stderr
    shutil.copy(folder.parent / "1" / "part.gdesign", folder / "part.gdesign")
    (folder / "node.key").unlink()
    assert "garrison-keygen" in check(folder, programs).stderr


def test_another_part_is_refused(folder: Path, programs: str) -> None:
    shutil.copy(folder.parent / "1" / "part.gdesign", folder / "part.gdesign")
    assert "the part of agent 1" in check(folder, programs).stderr
    damaged = bytearray((folder.parent / "0" / "part.gdesign").read_bytes())
    damaged[50] ^= 1
    (folder / "part.gdesign").write_bytes(damaged)
    done = check(folder, programs)
    assert done.returncode == 2
    assert "part.gdesign" in done.stderr


def test_plans_are_refused_by_key(plan: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for old, new, word in [
        ("loss = 0.05", "loss = 1.5", "[relay].loss"),
        ("period_ms", "periodms", 'did you mean "period_ms"'),
        ("delay_ms = 0.5", "delay_ms = -1", "[relay].delay_ms"),
    ]:
        plan.write_text(PLAN.replace(old, new))
        assert main(["up", str(plan)]) == 2
        assert word in capsys.readouterr().err


def test_accept_measures_a_row_and_refuses_unknown_ones(programs: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["accept", "kils"]) == 2
    assert 'did you mean "kills"?' in capsys.readouterr().err
    assert main(["accept", "kills", "--seconds", "1"]) == 2
    assert "a number in 2..3600" in capsys.readouterr().err
    assert main(["accept", "kills", "--seconds", "2.5", "--programs", programs]) in (0, 1)  # 1: a busy machine
    assert re.search(r"kills: .*\n +5 of 5 back; median", capsys.readouterr().out)
    assert main(["accept", "--list"]) == 0
    listed = capsys.readouterr().out.splitlines()
    assert any(re.match(r"kills +100 s +2 kills a second", line) for line in listed)


def test_a_soak_says_what_grew_and_what_stayed_open(plan: Path) -> None:
    soak = Soak(read_plan(plan), end=0.0)
    assert soak.broken() == []
    soak.memory = {0: [9_000_000, 4_000_000, 4_100_000, 4_200_000], 2: [4_000_000, 4_000_000, 4_000_000, 6_000_000]}
    soak.files = {0: {12, 13}, 2: {12, 15}}
    assert soak.growth() == 2_000_000
    assert [re.sub(r"\D+", " ", line).split()[:1] for line in soak.broken()] == [["2000000"], ["2"]]


def test_another_load_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    machine = iter([100.0, 100.2, 100.0, 102.0])  # seconds of all processors
    monkeypatch.setattr("garrison.net.accept.load._machine", lambda: next(machine))
    monkeypatch.setattr("garrison.net.accept.load._ours", lambda: 5.0)
    clock = iter([0.0, 1.0, 0.0, 1.0])
    monkeypatch.setattr("garrison.net.accept.load.time.monotonic", lambda: next(clock))
    assert Load().words() == ""
    assert "others took 2.00 of" in Load().words()


def _signed(seed: bytes, run: bytes, first: int, digest: bytes) -> bytes:
    """A statement as docs/node.md has it: of agent 0, its first start, ten samples, thirty bodies."""
    name = ctypes.util.find_library("sodium")
    assert name is not None
    sodium = ctypes.CDLL(name)
    open_, secret, signature = (ctypes.create_string_buffer(size) for size in (32, 64, 64))
    sodium.crypto_sign_seed_keypair(open_, secret, seed)
    content = struct.pack("<HQqqI", 0, 1, first, first + 9, 30) + digest
    message = b"garrison root 1" + run + content
    sodium.crypto_sign_detached(signature, None, message, ctypes.c_ulonglong(len(message)), secret)
    return content + signature.raw


def test_a_proof_is_checked_offline(folder: Path, programs: str, tmp_path: Path) -> None:
    seed = base64.b64decode((folder / "node.key").read_text().split()[1])
    run, other_seed = b"r" * 32, b"s" * 32
    a, b = (_signed(seed, run, 10, letter * 32) for letter in (b"a", b"b"))
    cases = {
        0: b"GPROOF01" + run + a + b,
        1: b"GPROOF01" + run + a + a,
        2: b"GPROOF01" + run + a,
    }
    command = [
        program("garrison-ctl", programs),
        "verify-proof",
        str(tmp_path / "x.proof"),
        str(folder / "../roster.toml"),
    ]
    for code, content in cases.items():
        (tmp_path / "x.proof").write_bytes(content)
        done = subprocess.run(command, capture_output=True, text=True, timeout=20)
        assert done.returncode == code, done.stderr
    for content in (
        b"GPROOF01" + b"q" * 32 + a + b,  # of another run
        b"GPROOF01" + run + a + _signed(other_seed, run, 10, b"b" * 32),  # of another key
        b"GPROOF01" + run + a + _signed(seed, run, 20, b"b" * 32),  # of other samples
    ):
        (tmp_path / "x.proof").write_bytes(content)
        done = subprocess.run(command, capture_output=True, text=True, timeout=20)
        assert done.returncode == 1
        assert "has NOT signed" in done.stdout


def test_replay_refuses_what_is_no_log(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "x.mcap"
    path.write_bytes(b"nothing of the kind")
    assert garrison(["replay", str(path)]) == 2
    assert "x.mcap" in capsys.readouterr().err
