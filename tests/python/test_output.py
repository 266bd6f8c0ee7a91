"""Output appears whole or not at all, and never in place of something that garrison did not write."""

import hashlib
import json
from pathlib import Path
from typing import Any

import garrison._commands.run as command
import pytest
from garrison.cli import main

SCENARIO = """
[model]
A = [[1.0]]
C = [[1], [1], [1]]
process_bound = 0.02
measurement_bound = 0.01
[network]
kind = "ring"
[filter]
name = "saturation"
threshold = 2.0
[run]
steps = 10
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The working directory: a scenario and the notes of a user."""
    (tmp_path / "x.toml").write_text(SCENARIO)
    (tmp_path / "notes.txt").write_text("years of work")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def contents(folder: Path) -> dict[str, bytes]:
    return {str(p.relative_to(folder)): p.read_bytes() for p in sorted(folder.rglob("*")) if p.is_file()}


def test_here_with_force_loses_nothing(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "summary.json").write_text("{}")  # not ours: there is no manifest
    before = contents(folder)
    assert main(["run", "x.toml", "-o", ".", "--force"]) == 2
    assert "no run of garrison has written" in capsys.readouterr().err
    assert contents(folder) == before


def test_a_forged_manifest_deletes_nothing_else(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    outside = folder / "notes.txt"
    out = folder / "out"
    out.mkdir()
    for files in ({"../notes.txt": hashlib.sha256(outside.read_bytes()).hexdigest()}, [], {"/etc/passwd": ""}):
        (out / "manifest.json").write_text(json.dumps({"program": "garrison", "files": files}))
        assert main(["run", "x.toml", "-o", "out", "--force"]) == 2
    assert outside.read_text() == "years of work"


def test_the_manifest_has_the_hashes(folder: Path) -> None:
    assert main(["run", "x.toml", "-o", "out"]) == 0
    manifest = json.loads((folder / "out/manifest.json").read_text())
    assert set(manifest["files"]) == {"estimates.csv", "overview.png", "report.html", "summary.json"}
    for name, known in manifest["files"].items():
        assert hashlib.sha256((folder / "out" / name).read_bytes()).hexdigest() == known


def test_force_replaces_our_files_and_only_them(folder: Path) -> None:
    assert main(["run", "x.toml", "-o", "out", "--npz"]) == 0
    (folder / "out/thesis.tex").write_text("mine")
    assert (folder / "out/estimates.npz").exists()
    assert main(["run", "x.toml", "-o", "out", "--force"]) == 0
    assert not (folder / "out/estimates.npz").exists() and (folder / "out/estimates.csv").exists()
    assert (folder / "out/thesis.tex").read_text() == "mine"


def test_a_changed_result_and_a_strangers_file_are_not_replaced(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["run", "x.toml", "-o", "out"]) == 0
    (folder / "out/report.html").write_text("with my remarks")
    assert main(["run", "x.toml", "-o", "out", "--force"]) == 2
    assert "changed after the run" in capsys.readouterr().err
    assert (folder / "out/report.html").read_text() == "with my remarks"
    assert main(["run", "x.toml", "-o", "out2"]) == 0
    (folder / "out2/estimates.npz").write_text("mine")
    before = contents(folder)
    assert main(["run", "x.toml", "-o", "out2", "--npz", "--force"]) == 2
    assert contents(folder) == before


def test_a_refused_run_keeps_the_old_results(folder: Path) -> None:
    assert main(["run", "x.toml", "-o", "out"]) == 0
    before = contents(folder / "out")
    (folder / "x.toml").write_text(SCENARIO.replace("threshold = 2.0", "threshold = 2.0\nattacked = 9"))
    assert main(["run", "x.toml", "-o", "out", "--force"]) == 2
    assert contents(folder / "out") == before


@pytest.mark.parametrize("error", [KeyboardInterrupt, MemoryError, RuntimeError])
def test_an_interrupted_run_leaves_no_trace(
    folder: Path, monkeypatch: pytest.MonkeyPatch, error: type[BaseException]
) -> None:
    def stop(*arguments: Any, **more: Any) -> None:
        raise error

    before = contents(folder)
    monkeypatch.setattr(command, "run_scenario", stop)
    assert main(["run", "x.toml", "-o", "out"]) in (2, 70, 130)
    assert contents(folder) == before
    assert sorted(p.name for p in folder.iterdir()) == ["notes.txt", "x.toml"]


def test_odd_targets(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", "x.toml", "-o", "notes.txt"]) == 2
    assert main(["run", "x.toml", "-o", "notes.txt/out"]) == 2
    assert (folder / "notes.txt").read_text() == "years of work"
    assert main(["run", "x.toml", "-o", "a/b/c"]) == 0
    (folder / "empty").mkdir()
    assert main(["run", "x.toml", "-o", "empty"]) == 0
    assert "Traceback" not in capsys.readouterr().err


def test_single_files_are_replaced_whole(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["structure", "x.toml", "-o", "p.png"]) == 0
    old = (folder / "p.png").read_bytes()
    assert main(["structure", "x.toml", "-o", "p.png"]) == 2
    assert main(["structure", "x.toml", "-o", "p.xyz"]) == 2
    assert main(["structure", "x.toml", "-o", "nowhere/p.png"]) == 2
    assert main(["structure", "x.toml", "-o", "."]) == 2
    assert (folder / "p.png").read_bytes() == old
    assert sorted(p.name for p in folder.iterdir()) == ["notes.txt", "p.png", "x.toml"]
    assert main(["structure", "x.toml", "-o", "p.png", "--force"]) == 0


def test_a_link_to_a_folder_and_an_unwritable_parent(folder: Path) -> None:
    (folder / "locked" / "out").mkdir(parents=True)
    (folder / "link").symlink_to(folder / "locked" / "out")
    (folder / "locked").chmod(0o555)
    try:
        assert main(["run", "x.toml", "-o", "link"]) == 0
        assert main(["run", "x.toml", "-o", "link", "--force"]) == 0
    finally:
        (folder / "locked").chmod(0o755)
    names = sorted(p.name for p in (folder / "locked" / "out").iterdir())
    assert names == ["estimates.csv", "manifest.json", "overview.png", "report.html", "summary.json"]
    assert (folder / "link").is_symlink()


def test_a_run_without_a_folder_prints_and_writes_nothing(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    scenario = str(Path(__file__).parents[2] / "examples" / "wind" / "rdkf.toml")
    assert main(["run", scenario]) == 0
    said = capsys.readouterr().out
    assert "Kalman" in said
    assert "nothing was written; -o FOLDER keeps" in said
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("words", [["--npz"], ["--force"], ["--all-estimates"], ["-o", ""]])
def test_how_to_write_without_where_is_refused(words, capsys):
    assert main(["run", "no_such_file.toml", *words]) == 2
    assert "-o: got " in capsys.readouterr().err
