"""dist_info.py FOLDER COMMANDS: what pip would write beside the package, from pyproject.toml, for installs without pip.

FOLDER becomes garrison-VERSION.dist-info (importlib.metadata finds version, requirements, commands), COMMANDS a folder
with the scripts that start the commands.
"""

import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).parents[1]


def metadata(project: dict, version: str) -> str:
    """The core metadata, version 2.1."""
    lines = [
        "Metadata-Version: 2.1",
        f"Name: {project['name']}",
        f"Version: {version}",
        f"Summary: {project['description']}",
        f"License: {project['license']}",
        f"Requires-Python: {project['requires-python']}",
        *(f"Classifier: {c}" for c in project["classifiers"]),
        *(f"Requires-Dist: {r}" for r in project["dependencies"]),
    ]
    return "\n".join(lines) + "\n"


def main(folder: Path, commands: Path) -> None:
    """Write both."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    folder.mkdir(parents=True, exist_ok=True)
    version = (ROOT / "VERSION").read_text(encoding="utf-8").strip()
    (folder / "METADATA").write_text(metadata(project, version), encoding="utf-8")
    (folder / "INSTALLER").write_text("cmake\n", encoding="utf-8")
    entries = "".join(f"{name} = {entry}\n" for name, entry in project["scripts"].items())
    (folder / "entry_points.txt").write_text(f"[console_scripts]\n{entries}", encoding="utf-8")
    commands.mkdir(exist_ok=True)
    for name, entry in project["scripts"].items():
        module, function = entry.split(":")
        (commands / name).write_text(
            f"#!/usr/bin/python3\nimport sys\n\nfrom {module} import {function}\n\nsys.exit({function}())\n",
            encoding="utf-8",
        )


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
