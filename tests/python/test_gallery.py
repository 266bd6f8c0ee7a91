"""Every script of the gallery runs and draws; the page shows all of them."""

from pathlib import Path

import pytest
from conftest import ROOT

SCRIPTS = sorted((ROOT / "examples" / "gallery").glob("*.py"))


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda script: script.stem)
def test_a_script_draws(script: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("matplotlib")
    monkeypatch.syspath_prepend(str(ROOT / "docs"))
    from generate import gallery

    monkeypatch.chdir(tmp_path)
    figure = gallery.figure_of(script)
    assert any(ax.lines or ax.images or ax.collections or ax.patches for ax in figure.axes)
    figure.savefig(tmp_path / "x.svg")
    assert (tmp_path / "x.svg").stat().st_size > 5_000


def test_scripts_are_short_and_titled(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(ROOT / "docs"))
    from generate import gallery

    for script in SCRIPTS:
        title, text = gallery._words(script.read_text())
        assert title and text, script.name
        assert len(script.read_text().splitlines()) <= 40, script.name
