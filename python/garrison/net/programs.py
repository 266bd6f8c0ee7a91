"""Where the node's programs are: on the PATH, or in a build of this checkout."""

import os
import shutil
from pathlib import Path

from garrison import _core

NODE, KEYGEN, RELAY, CTL = "garrison-node", "garrison-keygen", "garrison-relay", "garrison-ctl"
#: of the tests, which are not installed
HOSTILE, SIMULATION, UNITS = "garrison_node_hostile", "garrison_node_sim", "garrison_node_tests"
BODIES, FUZZ, LIAR = "garrison_tests", "garrison_node_fuzz", "garrison_node_liar"
LATENCY, WRONG_CLOCK = "garrison_node_latency", "garrison_node_wrong_clock.so"
#: environment variable that names their folder
VARIABLE = "GARRISON_PROGRAMS"


def is_there(name: str, folder: str | None = None) -> bool:
    """Whether `program` finds it; the node's own programs always count as there, so that a lack of them is refused."""
    try:
        return name == NODE or bool(program(name, folder))
    except _core.IoError:
        return False


def program(name: str, folder: str | None = None) -> str:
    """The path of one of them: in `folder`, in $GARRISON_PROGRAMS, on the PATH, or in build/ of a checkout."""
    given = folder or os.environ.get(VARIABLE)
    found = shutil.which(name, path=given) if given else shutil.which(name) or _built(name)
    if found is None:
        place = given or f"the PATH, ${VARIABLE} or build/"
        raise _core.IoError(
            f"{name}: got no such program in {place}, expected the node's programs; install the package "
            "garrison-node, or run `make dev` in a checkout and repeat there, or name the folder with --programs"
        )
    return found


def _built(name: str) -> str | None:
    roots = {Path(__file__).resolve().parents[3], Path.cwd()}  # an installed garrison knows of no checkout
    folders = ("src/node/programs", "tests/node", "tests/cpp")
    places = [place for root in roots for folder in folders for place in root.glob(f"build/*/{folder}/{name}")]
    found = sorted(places, key=lambda path: path.stat().st_mtime)
    return str(found[-1]) if found else None
