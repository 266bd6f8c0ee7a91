"""The page of the platoon paper comes to the known verdicts."""

import runpy
import sys
from pathlib import Path

import pytest
from conftest import ROOT


def test_verdicts_and_figures(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "argv", ["platoon.py", "-o", str(tmp_path), "--runs", "4"])
    page = runpy.run_path(str(ROOT / "examples/papers/platoon.py"))
    rows = page["main"]()
    refuted = {row[0] for row in rows if row[2] == "not confirmed"}
    assert refuted == {
        "4b: velocities reach v_0 (noise as printed)",
        "5a: phi falls with the noise, at every time",
        "6: Algorithms 1-3 beat PBE",
        "6: Algorithms 1-3 are best at all times",
        "section 7: beta = 3 is admissible for b = 2",
        "Theorem 1: alpha1 tells where the error goes, static beta = 3",
        "Theorem 4: a useful bound on phi, N = 5",
        "Proposition 1: the printed (17) is a bound",
        "Lemma 1: no false accusation with the printed (17)",
    }
    assert all(row[3] for row in rows if row[2] == "not confirmed")
    assert len(list(tmp_path.glob("*.png"))) == 8
    assert (tmp_path / "string.gif").is_file()
