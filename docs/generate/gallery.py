"""The gallery: every script of examples/gallery is run, and shown with its figure; last, a page of real nodes."""

import ast
import runpy
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[2]
SCRIPTS = ROOT / "examples" / "gallery"
_HEAD = """# Gallery

Every picture is made by the code above it when this page is built, and is its `figure`: in a script of your own,
`figure.savefig("picture.png")` writes it. The scripts are in `examples/gallery`, beside the files that they read.
[Examples](../examples.md) lists the larger ones.
"""
_NODES = """## Twelve daemons on a lossy network

`garrison-net up examples/wind/network.toml --page 9470` runs the wind stations as twelve programs that talk by sealed
datagrams. A tenth of the datagrams is lost, and three sensors lie. This is their page; for networks of your own see
[Deploy three nodes](../how-to/deploy-three-nodes.md).

![Live page: a map of twelve stations, bound against error, verdicts and link ages](../images/network.png)
"""


def scripts() -> list[Path]:
    """The scripts in the order of the page."""
    return sorted(SCRIPTS.glob("*.py"))


def figure_of(script: Path) -> Any:
    """Run a script and take its `figure`."""
    return runpy.run_path(str(script))["figure"]


def page(folder: Path) -> str:
    """The page; pictures are written to `folder`."""
    parts = [_HEAD]
    for script in scripts():
        source = script.read_text(encoding="utf-8")
        title, text = _words(source)
        picture = folder / f"gallery_{script.stem}.svg"
        figure_of(script).savefig(picture)
        code = "\n".join(source.splitlines()[ast.parse(source).body[0].end_lineno :]).strip()
        parts.append(f"## {title}\n\n{text}\n\n```python\n{code}\n```\n\n![{title}]({picture.name})\n")
    return "\n".join([*parts, _NODES])


def _words(source: str) -> tuple[str, str]:
    title, _, text = (ast.get_docstring(ast.parse(source)) or "").partition("\n")
    return title, text.strip()
