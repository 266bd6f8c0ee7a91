"""The page of the certificates with memory finds the reference's numbers, and no state outside a box."""

import runpy
import sys

import pytest
from conftest import ROOT


def test_verdicts(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "argv", ["certificates_memory.py", "--steps", "160"])
    rows = runpy.run_path(str(ROOT / "examples/papers/certificates_memory.py"))["main"]()
    assert not [row for row in rows if "OUTSIDE" in row[1]]
    assert not [row for row in rows if row[2] == "not confirmed"]
    assert len(rows) > 65
