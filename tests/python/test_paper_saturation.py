"""The page of the saturation paper comes to the known verdicts."""

import runpy
import sys
from pathlib import Path

import pytest
from conftest import ROOT


def test_verdicts_and_figures(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "argv", ["saturation.py", "-o", str(tmp_path)])
    page = runpy.run_path(str(ROOT / "examples/papers/saturation.py"))
    rows = page["main"]()
    refuted = {row[0] for row in rows if row[2] == "not confirmed"}
    assert refuted == {
        "4b: more rounds, smaller error",
        "5c: beta = 5 is a good choice",
        "6: unstable from half of the sensors on",
        "7: all attacked sensors are detected",
        "condition (9) can be met with s = 6",
    }
    assert all(row[3] for row in rows if row[2] == "not confirmed")
    assert len(list(tmp_path.glob("fig*.png"))) == 8
