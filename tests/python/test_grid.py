"""The 118-bus grid as a system to be watched (needs the extra `grid`)."""

import runpy
import sys
import warnings
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT

with warnings.catch_warnings():
    warnings.simplefilter("ignore")
    pytest.importorskip("pandapower")


@pytest.mark.filterwarnings("ignore")
def test_ieee118(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "argv", ["ieee118.py", "-o", str(tmp_path)])
    page = runpy.run_path(str(ROOT / "examples/grid/ieee118.py"))
    report = page["main"]()
    assert report["states"] == 118 + 54
    assert report["structural_rank"] == report["states"]  # every state has a link to itself
    assert report["parent_components"] == [list(range(report["states"]))]  # power flows both ways
    assert report["observable"]
    assert not any(a["necessary"] for a in report["agents"])  # any one unit sees the whole grid
    assert report["spectral_radius_of_A"] <= 1 + 1e-9
    assert (tmp_path / "ieee118.png").stat().st_size > 10_000
    A = page["system_matrix"](page["grid"]())
    assert np.allclose(A[:118, :118].sum(axis=1), 1.0)  # equal angles stay where they are
