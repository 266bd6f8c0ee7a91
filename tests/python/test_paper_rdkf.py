"""The page of the RDKF paper comes to the known verdicts."""

import runpy
import sys
from pathlib import Path

import pytest
from conftest import ROOT


def test_verdicts_and_figures(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "argv", ["rdkf.py", "-o", str(tmp_path), "--seeds", "3"])
    rows = runpy.run_path(str(ROOT / "examples/papers/rdkf.py"))["main"]()
    refuted = {row[0] for row in rows if row[2] == "not confirmed"}
    assert refuted == {
        "Fig. 2 for any random A",
        "the simulations start inside theorem III.3",
        "theorem III.3 with 2 lambda, as printed",
        "bad initial estimates converge in practice",
        "the error does not depend on the number of compromised agents",
    }
    assert all(row[3] for row in rows if row[2] == "not confirmed")
    assert len(list(tmp_path.glob("*.png"))) == 5
