"""The page and the metrics of running nodes."""

import json
import re
import threading
import urllib.error
import urllib.request
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from garrison.net.web.command import main
from garrison.net.web.metrics import exposition
from garrison.net.web.scene import Scene
from garrison.net.web.server import Server
from garrison.net.web.watcher import Watcher

COUNTERS = [
    "samples",
    "complete",
    "unmeasured",
    "missing",
    "missed_samples",
    "overruns",
    "wants",
    "resent",
    "joins",
    "resets",
    "clock_steps",
    "clock_back",
    "unsent",
    "log_gaps",
    "statements",
    "contradictions",
    "disowned",
]


def status(name: str, **other: Any) -> dict[str, Any]:
    """As garrison-node says it; tests/python/test_node.py compares the keys with a real one."""
    link = {"id": 1, "name": 'b "x"\\', "state": "up", "age_s": 0.5, "skew_us": None, "delay_us": 20.0}
    return {
        "node": name,
        "id": 0,
        "family": "saturation",
        "boot": 1,
        "state": "waiting",
        "t": 2,
        "time": 1.0,
        "estimate": [1.0, 2.0],
        "bound": 0.25,
        "bound_kind": "witness",
        "verdict": "cleared",
        "statistic": None,
        "threshold": None,
        "control": None,
        "complete": True,
        "measured": True,
        "took_ms": 3.5,
        "accused": [1],
        "proved": [2, 7],
        "counters": dict.fromkeys(COUNTERS, 7),
        "sensor": {"taken": 5, "malformed": 1, "outside": 0, "restarts": 0},
        "snapshot_age_s": 0.5,
        "log_failed": 3,
        "states_refused": 1,
        "outside": {"stranger": 4},
        "links": [{**link, "fates": {"taken": 12, "replay": 3}}],
    } | other


def test_metrics_are_in_the_format_of_prometheus() -> None:
    text = exposition({"a": status("a"), "c": status("c", bound=None), "gone": None})
    name = r"garrison_[a-z_]+"
    sample = re.compile(name + r'\{(?:[a-z]+="(?:[^"\\\n]|\\.)*",?)+\} [-+0-9.eE]+')
    for line in text.splitlines():
        assert re.fullmatch(rf"# (HELP {name} .+|TYPE {name} (gauge|counter))", line) or sample.fullmatch(line), line
    assert text.count("# TYPE") == len(set(re.findall(r"# TYPE (\S+)", text)))
    assert 'garrison_up{node="gone"} 0' in text
    assert 'garrison_proved{node="a"} 2' in text
    assert 'garrison_log_failed_total{node="a"} 3' in text
    assert 'garrison_states_refused_total{node="a"} 1' in text
    assert 'garrison_bound{node="a"} 0.25' in text
    assert 'garrison_bound{node="c"}' not in text  # no bound is no number
    assert 'garrison_frames_total{node="a",peer="b \\"x\\"\\\\",fate="replay"} 3' in text
    assert 'garrison_frames_total{node="a",peer="",fate="stranger"} 4' in text


@contextmanager
def serving(watcher: Watcher) -> Iterator[str]:
    with Server("127.0.0.1", 0, watcher) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        try:
            yield f"http://127.0.0.1:{server.server_port}"
        finally:
            server.shutdown()
            thread.join()


@pytest.fixture
def watcher(monkeypatch: pytest.MonkeyPatch) -> Iterator[Watcher]:
    """Of a node that answers and one that does not."""
    answers: dict[str, dict[str, Any] | None] = {"a.sock": status("a"), "b.sock": None}
    monkeypatch.setattr(Watcher, "_ask", staticmethod(lambda client: answers[client.path.name]))
    truth = np.array([[0.0, 0.0], [1.0, 0.0]])
    scene = Scene("wind", {"a": (0.0, 1.0)}, ["a"], truth, ["a", "b", "gauge"])
    found = Watcher([Path("a.sock"), Path("b.sock")], scene, pause=0.01)
    found.start()
    yield found
    found.end()


def test_events_say_what_is_known_and_metrics_answer_beside_them(watcher: Watcher) -> None:
    with serving(watcher) as url, ExitStack() as stack:
        streams = [stack.enter_context(urllib.request.urlopen(f"{url}/events", timeout=10)) for _ in range(12)]
        for _ in range(3):
            line = streams[0].readline()
            event = json.loads(line.removeprefix(b"data: "))
            assert streams[0].readline() == b"\n"
        a, b = event["nodes"]
        assert a["error"] == 2.0
        assert a["proved"] == ["gauge", "source 7"]
        assert b["answers"] is False
        assert event["hijacked"] == ["a"]
        with pytest.raises(urllib.error.HTTPError) as refused:
            urllib.request.urlopen(f"{url}/events", timeout=10)
        assert refused.value.code == 503
        refused.value.close()
        with urllib.request.urlopen(f"{url}/metrics", timeout=10) as answer:
            assert b'garrison_up{node="a"} 1' in answer.read()


def test_the_page_is_one_file_that_asks_nobody_else(watcher: Watcher) -> None:
    with serving(watcher) as url:
        with urllib.request.urlopen(url, timeout=10) as answer:
            page = answer.read().decode()
        with pytest.raises(urllib.error.HTTPError) as refused:
            urllib.request.urlopen(f"{url}/../etc/passwd", timeout=10)
        assert refused.value.code == 404
        refused.value.close()
    assert len(page) < 60_000
    assert not re.findall(r"https?://", page.replace("http://www.w3.org/2000/svg", ""))
    assert "innerHTML" not in page  # names of nodes are text


def test_the_command_refuses_a_port_that_is_taken(watcher: Watcher, capsys: pytest.CaptureFixture[str]) -> None:
    with serving(watcher) as url:
        assert main(["--port", url.rpartition(":")[2], "a.sock"]) == 2
    assert "expected an address of this machine that is free" in capsys.readouterr().err
