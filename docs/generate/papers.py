"""The papers, claim by claim: every page of examples/papers that goes through one is run, and its table shown."""

import ast
import contextlib
import io
import re
import runpy
import sys
import tempfile
from pathlib import Path
from unittest import mock

from generate.markdown import cell, table

SCRIPTS = Path(__file__).parents[2] / "examples" / "papers"
PAPERS = ("saturation", "structural", "partial_sharing", "platoon", "rdkf")
_HEAD = """# Papers, claim by claim

Every number is computed when this page is built; the scripts in `examples/papers` also draw the figures. "Not
confirmed" comes with its reason. Errata on a filter's page are where the library leaves its paper.
"""


def page() -> str:
    """The page."""
    return "\n".join([_HEAD, *(section(SCRIPTS / f"{name}.py") for name in PAPERS)])


def section(script: Path) -> str:
    """What a script says of itself, and its claims."""
    doc = ast.get_docstring(ast.parse(script.read_text(encoding="utf-8"))) or ""
    title, _, text = doc.partition("\n")
    words, command = [], ""
    for paragraph in re.split(r"\n\s*\n", text.strip()):
        if paragraph.strip().startswith("python "):
            command = paragraph.strip()
        else:
            words.append(cell(paragraph))
    rows = [[cell(entry) for entry in row] for row in _claims(script)]
    found = table(["claim", "what came out", "verdict", "why"], rows)
    name = script.stem
    more = f"The filter: [its page](../filters/{name}.md). The figures: `{command}`"
    return "\n\n".join([f"## {name}", cell(title), *words, more, found])


def _claims(script: Path) -> list[list[str]]:
    with (
        tempfile.TemporaryDirectory() as folder,
        mock.patch.object(sys, "path", [str(script.parent), *sys.path]),
        mock.patch.object(sys, "argv", [script.name, "-o", folder]),
        contextlib.redirect_stdout(io.StringIO()),
    ):
        rows: list[list[str]] = runpy.run_path(str(script))["main"]()
    return rows
