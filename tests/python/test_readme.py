"""The README's examples run as printed."""

import re
from pathlib import Path

import pytest
from conftest import ROOT


def test_the_examples_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    text = (ROOT / "README.md").read_text()
    ten_lines, one_agent, own, certified = re.findall(r"```python\n(.*?)```", text, flags=re.DOTALL)
    save = re.search(r"`(gr\.prepare\(.*?\))`", text)
    assert save is not None
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {}
    exec(ten_lines, names)
    run = names["run"]
    assert (run.error <= run.bound).all()  # type: ignore[attr-defined]
    exec(certified, names)
    run = names["run"]
    assert (run.error <= run.bound)[:, 1:].all()  # type: ignore[attr-defined]
    exec(save.group(1), names)
    exec(one_agent, names)
    assert names["message"] is None  # it listens
    assert names["agent"].sample == 101  # type: ignore[attr-defined]
    exec(own, names)
    before, after = names["run"].error[:, 19].mean(), names["run"].error[:, -1, 3].mean()  # type: ignore[attr-defined]
    assert before < 0.1 < after  # it tracks until the attack, and does not resist
