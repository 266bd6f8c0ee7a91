"""The page of the structural paper comes to the known verdicts."""

import runpy
import sys
from pathlib import Path

import pytest
from conftest import ROOT


def test_verdicts_and_figures(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "argv", ["structural.py", "-o", str(tmp_path), "--runs", "60"])
    page = runpy.run_path(str(ROOT / "examples/papers/structural.py"))
    rows = page["main"]()
    refuted = {row[0] for row in rows if row[2] == "not confirmed"}
    assert refuted == {
        "without an alpha agent the error is unstable (Remark 8)",
        "the connectivity of Lemma 2 gives a Schur gain",
        "(16) bounds the errors: Q1 = 0.068, b = 0.682",
        "Q1 = |Q|/N bounds every agent's error",
        "(17) at m = 2 has a false-alarm rate of 4.6 %",
        "4: the other agents stay quiet (Lemma 6 isolates attacks)",
        "5: with false alarms at alpha1",
        "Remark 7: chi-square over T = 10 residuals at 1 %",
        "every attack that harms is detected",
    }
    assert all(row[3] for row in rows if row[2] == "not confirmed")
    assert {p.name for p in tmp_path.glob("*.png")} == {
        "fig4.png",
        "fig5.png",
        "fig6.png",
        "stealth.png",
        "structure.png",
    }
