"""dist_info.py FOLDER COMMAND: what pip would write beside the package, from pyproject.toml, for installs without pip.

FOLDER becomes garrison-VERSION.dist-info (importlib.metadata finds version, requirements, command), COMMAND the script
that starts the command line.
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


def main(folder: Path, command: Path) -> None:
    """Write both."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    folder.mkdir(parents=True, exist_ok=True)
    version = (ROOT / "VERSION").read_text(encoding="utf-8").strip()
    (folder / "METADATA").write_text(metadata(project, version), encoding="utf-8")
    (folder / "INSTALLER").write_text("cmake\n", encoding="utf-8")
    (name, entry), *others = project["scripts"].items()
    if others or name != command.name:
        sys.exit(f"dist_info.py: got the commands {list(project['scripts'])}, expected {command.name} alone")
    (folder / "entry_points.txt").write_text(f"[console_scripts]\n{name} = {entry}\n", encoding="utf-8")
    module, function = entry.split(":")
    command.write_text(
        f"#!/usr/bin/python3\nimport sys\n\nfrom {module} import {function}\n\nsys.exit({function}())\n",
        encoding="utf-8",
    )


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
