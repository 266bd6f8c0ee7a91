"""Code blocks of Markdown pages, and how they are run."""

import os
import re
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import garrison
from conftest import ROOT, node_programs

#: languages of blocks -> whether they are run or written; others are refused, so that no block escapes by its name
LANGUAGES = {"python", "shell", "toml", "text", "cpp", "cmake"}
_BLOCK = re.compile(r"^(?P<indent> *)```(?P<language>[^\n`]*)\n(?P<text>.*?)^ *```\s*$", re.DOTALL | re.MULTILINE)
_FILE = re.compile(r"# file: (\S+)( \(append\))?\n")


@dataclass
class Block:
    """One fenced block; line: where it starts in its page."""

    language: str
    text: str
    line: int


def pages() -> list[Path]:
    """The README and every hand-written page of the site."""
    docs = ROOT / "docs"
    return [ROOT / "README.md", *sorted(p for p in docs.rglob("*.md") if "generated" not in p.parts)]


def blocks(path: Path) -> list[Block]:
    """The blocks of a page; directives in braces are none."""
    text = path.read_text(encoding="utf-8")
    found = []
    for match in _BLOCK.finditer(text):
        language = match["language"].strip()
        if language.startswith("{"):
            continue
        body = re.sub(rf"^{match['indent']}", "", match["text"], flags=re.MULTILINE)
        found.append(Block(language, body, text[: match.start()].count("\n") + 1))
    return found


def run(page: Path, folder: Path) -> None:
    """Run the blocks of a page in order, in `folder`: one namespace for Python, `garrison` on the path of the shell."""
    (folder / "examples").symlink_to(ROOT / "examples")
    names: dict[str, object] = {}
    for block in blocks(page):
        if block.language == "python":
            source = "\n" * block.line + block.text  # tracebacks name the line of the page
            exec(compile(source, str(page), "exec"), names)
        elif block.language == "shell":
            _shell(block, page, folder)
        elif (head := _FILE.match(block.text)) is not None:
            with (folder / head[1]).open("a" if head[2] else "w", encoding="utf-8") as file:
                file.write(block.text[head.end() :])


def _shell(block: Block, page: Path, folder: Path) -> None:
    command = folder / "bin" / "garrison"
    command.parent.mkdir(exist_ok=True)
    command.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m garrison "$@"\n')
    command.chmod(0o755)
    package = Path(garrison.__file__).parents[1]  # the same garrison as here, built or installed
    environment = {
        **os.environ,
        "PATH": ":".join(str(p) for p in (command.parent, node_programs(), os.environ["PATH"]) if p),
        "PYTHONPATH": os.pathsep.join(p for p in (str(package), os.environ.get("PYTHONPATH", "")) if p),
    }
    done = subprocess.run(
        ["bash", "-euo", "pipefail", "-c", block.text], cwd=folder, env=environment, capture_output=True, text=True
    )
    assert done.returncode == 0, f"{page.name}:{block.line}: exit code {done.returncode}\n{done.stdout}\n{done.stderr}"
