"""The README's example runs as printed."""

import re

from conftest import ROOT


def test_the_ten_lines_run() -> None:
    blocks = re.findall(r"```python\n(.*?)```", (ROOT / "README.md").read_text(), flags=re.DOTALL)
    assert len(blocks) == 1
    names: dict[str, object] = {}
    exec(blocks[0], names)
    run = names["run"]
    assert (run.error <= run.bound).all()  # type: ignore[attr-defined]
