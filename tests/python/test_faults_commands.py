"""Slips on the command line: encodings, numbers of options, and what a design file shows."""

from pathlib import Path

import garrison as gr
import pytest
from garrison.cli import main

SCENARIO = """
[model]
A = [[0.9]]
C = [[1.0], [1.0], [1.0]]
process_covariance = 0.1
measurement_covariance = 0.2
[network]
kind = "ring"
[filter]
name = "structural"
[run]
steps = 5
"""
RECORDS = "day,a,b\n" + "".join(f"2020-02-{k + 1:02},{k % 5},{(3 * k) % 7}\n" for k in range(28))


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
def test_scenarios_in_any_marked_encoding(tmp_path: Path, encoding: str) -> None:
    path = tmp_path / "s.toml"
    path.write_bytes(SCENARIO.encode(encoding))
    assert main(["check", str(path)]) == 0


def test_other_encodings_are_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "s.toml"
    path.write_bytes(f'title = "K\u00f6ln"\n{SCENARIO}'.encode("latin-1"))
    assert main(["check", str(path)]) == 2
    assert "no text in UTF-8 (byte 10), expected a TOML document; save it as UTF-8" in capsys.readouterr().err


def test_numbers_of_options(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "r.csv"
    path.write_text(RECORDS)
    assert main(["fit", str(path), "--factors", "1.0", "--harmonics", "0"]) == 0
    for option, value in (("--factors", "x"), ("--factors", "1.5"), ("--factors", "inf"), ("--scale", "2 m")):
        capsys.readouterr()
        assert main(["fit", str(path), option, value]) == 2
        assert f"argument {option}: got {value!r}, expected a" in capsys.readouterr().err


def test_places_in_a_scenario_are_named_once(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "s.toml"
    path.write_text(SCENARIO.replace("= 0.2", '= "0.2"'))
    assert main(["check", str(path)]) == 2
    assert capsys.readouterr().err.startswith("garrison: [model].measurement_covariance: got '0.2'")


def test_a_design_file_shows_model_and_network(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    model = gr.Model(
        [[0.9, 0.1], [0.0, 0.8]],
        [[1, 0], [0, 1], [1, 0]],
        process_covariance=0.1,
        measurement_covariance=0.2,
        states=["level", "speed"],
        outputs=["p", "q", "r"],
    )
    path = tmp_path / "x.gdesign"
    gr.prepare(model, gr.Network([(0, 1), (1, 2)], names=["a", "b", "c"]), gr.filters.Structural()).save(path)
    assert main(["design-file", "--show", str(path)]) == 0
    shown = capsys.readouterr().out
    for words in (
        "A = [[0.9, 0.1], [0.0, 0.8]]",
        "C[1] = [[0.0, 1.0]]",
        "states: level, speed",
        "outputs: p, q, r",
        "agents: a, b, c",
        "network, undirected, 2 edges",
        "0-1, 1-2",
        "hash ",
        "false_alarm = 0.01",
    ):
        assert words in shown, shown
