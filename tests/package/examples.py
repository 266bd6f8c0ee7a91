"""examples.py FOLDER: the programs of examples/cpp, built in FOLDER, print what the pages about them say.

A page shows a program by a literalinclude of its source; the next block of text is what it prints.
"""

import re
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).parents[2]
_SHOWN = re.compile(
    r"```\{literalinclude\} ../../examples/cpp/(\w+)\.cpp\n.*?^```text\n(.*?)^```", re.DOTALL | re.MULTILINE
)


def said() -> dict[str, str]:
    """What the pages say, by program."""
    found: dict[str, str] = {}
    for page in sorted((ROOT / "docs/how-to").glob("*.md")):
        found |= dict(_SHOWN.findall(page.read_text(encoding="utf-8")))
    return found


def printed(build: Path) -> dict[str, str]:
    """What they print: design and node work on the same files."""
    with tempfile.TemporaryDirectory() as folder:

        def run(program: str, *arguments: str) -> str:
            return subprocess.run([build / program, *arguments], check=True, capture_output=True, text=True).stdout

        outputs = {"design": run("design", folder)}
        parts = sorted(str(part) for part in Path(folder).glob("*.part"))
        outputs["node"] = run("node", *parts)
        return outputs | {program: run(program) for program in ("simulate", "embed_agent")}


def main(build: Path) -> int:
    """Compare them."""
    expected, got = said(), printed(build)
    programs = {source.stem for source in (ROOT / "examples/cpp").glob("*.cpp")}
    wrong = [f"{name}: no page shows it" for name in sorted(programs - expected.keys())]
    wrong += [f"{name}: is not run" for name in sorted(programs - got.keys())]
    for name in sorted(programs & expected.keys() & got.keys()):
        if got[name] != expected[name]:
            wrong.append(f"{name}: the page says\n{expected[name]}but it prints\n{got[name]}")
    print("\n".join(wrong) or f"examples: {', '.join(sorted(programs))} print what their pages say")
    return bool(wrong)


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
