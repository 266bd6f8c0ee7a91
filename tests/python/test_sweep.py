"""gr.sweep: the same table for any workers, blocks, deaths and restarts."""

import csv
import json
import os
import signal
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import garrison as gr
import pytest
from garrison.cli import main
from garrison.scenario.overrides import overridden
from garrison.sweeps import grid, pool
from garrison.sweeps.work import Task, work

SCENARIO = """
title = "a pair of states"
[model]
A = [[1.0, 0.1], [0.0, 0.9]]
C = [[1.0, 0.0], [0.0, 1.0], [1.0, 0.0], [0.0, 1.0], [1.0, 0.0], [0.0, 1.0]]
process_bound = 0.02
measurement_bound = 0.01
[network]
kind = "ring"
agents = 6
[filter]
name = "saturation"
rounds = 6
attacked = 1
initial_error = 2.0
threshold = 1.0
detector = true
[[compare]]
name = "scalar_gain"
rounds = 2
[[attack]]
kind = "bias"
agents = [3]
start = 10
value = 5.0
probability = 0.8
[link]
drop = 0.05
[run]
steps = 30
start_error = 1.0
seed = 4
"""
SET = {"filter.threshold": [0.5, 1.0], "attack.value": [1, 5, 25]}


@pytest.fixture
def scenario(tmp_path: Path) -> Path:
    path = tmp_path / "pair.toml"
    path.write_text(SCENARIO, encoding="utf-8")
    return path


def table(folder: Path) -> list[dict[str, str]]:
    """trials.csv without the seconds."""
    with (folder / "trials.csv").open(encoding="utf-8", newline="") as file:
        return [{k: v for k, v in row.items() if k != "seconds"} for row in csv.DictReader(file)]


def test_workers_and_blocks_do_not_change_the_table(scenario: Path, tmp_path: Path) -> None:
    one = gr.sweep(scenario, set=SET, trials=20, out=tmp_path / "one", block=20)
    reference = table(one.folder)
    assert len(reference) == 6 * 2 * 2 * 20
    assert [row["trial"] for row in reference[:20]] == [str(k) for k in range(20)]
    assert (one.refused, one.lost) == ([], [])
    for k, (workers, block) in enumerate(((1, 7), (2, 8), (1, None))):
        other = gr.sweep(scenario, set=SET, trials=20, out=tmp_path / str(k), workers=workers, block=block)
        assert table(other.folder) == reference
        points = [(folder / "points.csv").read_bytes() for folder in (one.folder, other.folder)]
        assert points[0] == points[1]


def test_the_numbers_are_those_of_simulate(scenario: Path, tmp_path: Path) -> None:
    found = gr.sweep(scenario, set={"attack[0].value": [25.0]}, trials=3, out=tmp_path / "out", block=2)
    read = __import__("garrison.scenario", fromlist=["read_scenario"]).read_scenario(scenario, {"attack.value": 25.0})
    run = gr.simulate(
        read.model, read.network, read.filters[0][1], steps=30, attack=read.attacks, trials=3, seed=4, start_error=1.0,
        link=read.link,
    )  # fmt: skip
    rows = [r for r in found.trials if r["filter"] == "saturation" and r["attacked"] == "True"]
    assert [float(r["mean_error"]) for r in rows] == [float(e[10:].mean()) for e in run.error]
    assert [float(r["final_error"]) for r in rows] == [float(e[-1].max()) for e in run.error]


def test_what_is_there_is_not_run_again_and_other_sweeps_are_refused(scenario: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    first = gr.sweep(scenario, set=SET, trials=10, out=out, block=5)
    reference, parts = table(out), sorted((out / "parts").iterdir())
    for part in parts[::3]:
        part.unlink()
    stamps = {part: part.stat().st_mtime_ns for part in parts[1::3]}
    counted: list[tuple[int, int]] = []
    gr.sweep(scenario, set=SET, trials=10, out=out, progress=lambda done, total: counted.append((done, total)))
    assert table(out) == reference
    assert counted[0] == (len(parts) - len(parts[::3]), len(parts))
    assert all(part.stat().st_mtime_ns == stamp for part, stamp in stamps.items())
    assert first.folder == out
    with pytest.raises(gr.InvalidInput, match="differs in trials"):
        gr.sweep(scenario, set=SET, trials=11, out=out)
    with pytest.raises(gr.InvalidInput, match="differs in points"):
        gr.sweep(scenario, set={"attack.value": [1]}, trials=10, out=out)
    scenario.write_text(SCENARIO.replace("steps = 30", "steps = 31"), encoding="utf-8")
    with pytest.raises(gr.InvalidInput, match="differs in scenario"):
        gr.sweep(scenario, set=SET, trials=10, out=out)
    strange = tmp_path / "strange"
    strange.mkdir()
    (strange / "diary.txt").write_text("dear diary", encoding="utf-8")
    with pytest.raises(gr.InvalidInput, match="something else"):
        gr.sweep(scenario, out=strange)
    (strange / "sweep.json").write_text("[]", encoding="utf-8")
    with pytest.raises(gr.InvalidInput, match="something else"):
        gr.sweep(scenario, out=strange)
    for no_folder in (scenario, scenario / "below", "\0"):
        with pytest.raises(gr.IoError, match="expected the name of a folder"):
            gr.sweep(scenario, out=no_folder)


def test_a_refused_point_is_a_row_and_the_others_go_on(scenario: Path, tmp_path: Path) -> None:
    found = gr.sweep(scenario, set={"filter.threshold": [1.0, -1.0]}, trials=10, out=tmp_path / "out", block=5)
    bad = [row for row in found.trials if row["point"] == 1]
    assert len(bad) == 1
    assert bad[0]["status"].startswith("refused: ")
    assert "threshold" in bad[0]["status"]
    assert sum(row["status"] == "ok" for row in found.trials) == 2 * 2 * 10
    assert len(found.refused) == 1
    with pytest.raises(gr.InvalidInput, match="set: "):
        gr.sweep(scenario, set={"attack[4].value": [1]}, out=tmp_path / "nowhere")


def dies(task: Task) -> float:
    """A worker that dies once per marker file that is missing, and always at the point that must be lost."""
    marker = Path(task.out) / f"died-{task.name}"
    if task.point == 1 or (task.point == 0 and task.first == 0 and not marker.exists()):
        marker.touch()
        os._exit(9)
    return work(task)


def test_a_worker_that_dies_is_tried_again_then_its_trials_are_lost(
    scenario: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    whole = gr.sweep(scenario, set={"attack.value": [1, 5, 25]}, trials=8, out=tmp_path / "whole", block=4)
    monkeypatch.setattr(pool, "work", dies)
    out = tmp_path / "out"
    found = gr.sweep(scenario, set={"attack.value": [1, 5, 25]}, trials=8, out=out, block=4, workers=2)
    assert len(found.lost) == 2
    assert all("died 3 times" in words for words in found.lost)
    kept = [row for row in table(out) if not row["status"].startswith("lost")]
    assert kept == [row for row in table(whole.folder) if row["point"] != "1"]
    monkeypatch.undo()
    gr.sweep(scenario, set={"attack.value": [1, 5, 25]}, trials=8, out=out)
    assert table(out) == table(whole.folder)


class Cluster:
    """As much of a dask.distributed client as a sweep uses."""

    def __init__(self) -> None:
        self.threads = ThreadPoolExecutor(2)
        self.keys: list[str] = []

    def submit(self, function, task, *, key, retries, pure):
        assert retries == 2
        assert pure
        self.keys.append(key)
        return self.threads.submit(function, task)


def test_a_client_gets_the_tasks(scenario: Path, tmp_path: Path) -> None:
    client = Cluster()
    one = gr.sweep(scenario, set=SET, trials=10, out=tmp_path / "one", block=10)
    two = gr.sweep(scenario, set=SET, trials=10, out=tmp_path / "two", block=4, client=client)
    assert table(one.folder) == table(two.folder)
    assert len(set(client.keys)) == 18


@pytest.mark.parametrize(("how", "code"), [(signal.SIGKILL, -9), (signal.SIGINT, 130)])
def test_a_sweep_that_is_ended_goes_on_later(scenario: Path, tmp_path: Path, how: int, code: int) -> None:
    out = tmp_path / "out"
    options = ["--set", "attack.value=1:9:9", "--trials", "120", "--block", "12", "-o"]
    command = [sys.executable, "-m", "garrison", "sweep", str(scenario), *options]
    environment = os.environ | {"PYTHONPATH": str(Path(gr.__file__).parents[1])}
    # A shell starts what it runs in the background deaf to Ctrl-C, tests too.
    heard = signal.signal(signal.SIGINT, signal.default_int_handler)
    process = subprocess.Popen([*command, str(out)], env=environment, stderr=subprocess.PIPE, text=True)
    signal.signal(signal.SIGINT, heard)
    deadline = time.monotonic() + 60
    while len(list(out.glob("parts/*.csv"))) < 3 and time.monotonic() < deadline:
        time.sleep(0.01)
    process.send_signal(how)
    _, said = process.communicate(timeout=30)
    assert process.returncode == code
    assert not (out / "trials.csv").exists()
    if code == 130:
        assert "go on with: garrison sweep" in said
    assert subprocess.run([*command, str(out)], env=environment, capture_output=True, check=False).returncode == 0
    whole = tmp_path / "whole"
    assert subprocess.run([*command, str(whole)], env=environment, capture_output=True, check=False).returncode == 0
    assert table(out) == table(whole)


def test_values_from_the_command_line() -> None:
    assert grid.parsed("filter.threshold=0.5:2:4") == ("filter.threshold", [0.5, 1.0, 1.5, 2.0])
    assert grid.parsed("a.b=log:1:100:3")[1] == pytest.approx([1.0, 10.0, 100.0])
    assert grid.parsed("a.b=1,2.5,true,word") == ("a.b", [1, 2.5, True, "word"])
    for wrong in ("a.b", "=3", "a=", "a=1:2", "a=log:0:1:3", "a=1:2:0"):
        with pytest.raises(gr.InvalidInput):
            grid.parsed(wrong)
    assert grid.points_of({"a": [1, 2], "b": ["x"]}) == [{"a": 1, "b": "x"}, {"a": 2, "b": "x"}]
    document = {"attack": [{"value": 1}, {"value": 2}], "run": {"x0": [1, 2]}}
    assert overridden(document, {"attack[1].value": 7})["attack"][1]["value"] == 7
    assert overridden(document, {"run.x0[0]": 7})["run"]["x0"] == [7, 2]
    assert document["attack"][1]["value"] == 2
    for key in ("attack.value", "attack[2].value", "run.x0[5]", "a b"):
        with pytest.raises(gr.InvalidInput):
            overridden(document, {key: 1})


def test_the_command(scenario: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    from garrison.cli import main

    out = tmp_path / "out"
    command = [
        "sweep",
        str(scenario),
        "--set",
        "filter.threshold=0.5,1",
        "--set",
        "attack.value=1:9:3",
        "--trials",
        "8",
    ]
    assert main([*command, "-o", str(out), "--dry-run"]) == 0
    assert "6 points, 48 trials in all" in capsys.readouterr().out
    assert not out.exists()
    assert main([*command, "-o", str(out)]) == 0
    assert "filter.threshold" in capsys.readouterr().out
    assert (out / "sweep.png").stat().st_size > 10_000
    assert json.loads((out / "sweep.json").read_text())["trials"] == 8
    assert main([*command, "-o", str(out), "--json"]) == 0
    assert len(json.loads(capsys.readouterr().out)["points"]) == 6 * 2 * 2
    assert main(["sweep", str(scenario), "--set", "filter.threshold=-1", "-o", str(tmp_path / "bad")]) == 2
    points = tmp_path / "points.csv"
    points.write_text("filter.threshold,attack.value\n0.5,1\n0.7,3\n", encoding="utf-8")
    assert main(["sweep", str(scenario), "--points", str(points), "-o", str(tmp_path / "rows")]) == 0
    assert main(["sweep", str(scenario), "--points", str(points), "--set", "a=1", "-o", str(tmp_path / "both")]) == 2


def test_sweeps_of_no_end_are_refused_at_once(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["init", str(tmp_path / "s.toml")]) == 0
    given = ["sweep", str(tmp_path / "s.toml"), "-o", str(tmp_path / "sw"), "--set"]
    assert main([*given, "filter.threshold=0.5:1:1000000000"]) == 2
    assert "filter.threshold: got 1000000000 values, expected at most 1000000" in capsys.readouterr().err
    assert main([*given, "filter.threshold=0.5:1:2000", "--set", "run.seed=1:2000:2000"]) == 2
    assert "got 4000000 points in all" in capsys.readouterr().err


def test_a_key_whose_values_are_words_is_a_column_of_texts(scenario: Path, tmp_path: Path) -> None:
    pq = pytest.importorskip("pyarrow.parquet")
    words = {"network.kind": ["ring", "complete"], "filter.rounds": [6, "x"], "attack.value": [1, 5]}
    found = gr.sweep(scenario, out=tmp_path / "words", set=words, trials=1)
    assert len(found.refused) == 4  # rounds = "x", one row for each
    table = pq.read_table(tmp_path / "words" / "trials.parquet").to_pydict()
    assert set(table["network.kind"]) == {"ring", "complete"}
    assert set(table["filter.rounds"]) == {"6", "x"}
    assert set(table["attack.value"]) == {1.0, 5.0}
    assert all(isinstance(text, str) for text in table["scenario_hash"])
