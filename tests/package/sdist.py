"""sdist.py FILE: the source distribution holds what git holds and nothing else, and its page has absolute addresses."""

import re
import subprocess
import sys
import tarfile
import tomllib
from pathlib import Path
from urllib.parse import urlsplit

ROOT = Path(__file__).parents[2]
NEEDED = {"CMakeLists.txt", "LICENSE", "PKG-INFO", "README.md", "VERSION", "pyproject.toml", "tools/readme.py"}


def known() -> set[str]:
    """What git holds, or would hold: not what it ignores."""
    names = subprocess.run(
        ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
        cwd=ROOT,
        check=True,
        capture_output=True,
        text=True,
    )
    return set(names.stdout.split("\0"))


def home() -> str:
    """The name of the project's address, which pyproject.toml says."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    return urlsplit(project["urls"]["Homepage"]).hostname or ""


def strange_maintainers() -> list[str]:
    """Maintainers of the Debian packages who are not at that address."""
    found = []
    for name in ("debian/control", "debian/changelog"):
        hosts = re.findall(r"<[^<>@\s]+@([^<>\s]+)>", (ROOT / name).read_text(encoding="utf-8"))
        found += [f"{name} has a maintainer at {host}, expected {home()}" for host in hosts if host != home()]
    return found


def complaints(path: Path) -> list[str]:
    """What is wrong with it; empty: nothing."""
    with tarfile.open(path) as archive:
        names = {name.partition("/")[2] for name in archive.getnames()}
        member = archive.extractfile(f"{path.name.removesuffix('.tar.gz')}/PKG-INFO")
        page = member.read().decode() if member else ""
    found = [f"{name} is missing" for name in sorted(NEEDED - names)]
    found += [f"{name} is junk" for name in sorted(names - known() - {"PKG-INFO"})]
    found += [f"{name} is for a checkout only" for name in sorted(names) if name.startswith((".", "debian/"))]
    found += strange_maintainers()
    found += [f"the page points to {target}" for target in re.findall(r"\]\((?![a-z]+:|#)([^)]*)\)", page)]
    return found


if __name__ == "__main__":
    wrong = complaints(Path(sys.argv[1]))
    print("\n".join(f"sdist: {line}" for line in wrong) or f"sdist: {Path(sys.argv[1]).name} is whole and has no junk")
    if home().endswith(".invalid"):
        print(f"sdist: the project has no address yet, {home()} is a reserved name: pyproject.toml, [project.urls]")
    sys.exit(bool(wrong))
