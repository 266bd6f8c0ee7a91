import subprocess
import time
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).parents[2]

#: Five agents that watch two states: what scenarios of several tests begin with.
RING = """
[model]
A = [[1.0, 0.1], [0.0, 1.0]]
C = [[1, 0], [0, 1], [1, 0], [0, 1], [1, 0]]
process_bound = 0.02
measurement_bound = 0.01
[network]
kind = "ring"
"""


@pytest.fixture(scope="session")
def wind() -> Path:
    """Folder of the real data."""
    return ROOT / "examples" / "wind"


@pytest.fixture(scope="session")
def cases() -> Path:
    """Folder of the reference cases."""
    return ROOT / "tests" / "cases"


def title_of(figure: Any) -> str:
    """The title of a whole figure, as matplotlib 3.6 has it too; get_suptitle came with 3.8."""
    return str(figure._suptitle.get_text())


def node_programs() -> Path | None:
    """Folder of the node's programs in the newest build of this checkout, or None."""
    found = sorted(ROOT.glob("build/*/src/node/programs/garrison-node"), key=lambda path: path.stat().st_mtime)
    return found[-1].parent if found else None


@pytest.fixture(scope="session")
def programs() -> str:
    """The same, for tests that cannot do without."""
    found = node_programs()
    if found is None:
        pytest.skip("no programs of the node in build/: configure with -DGARRISON_BUILD_NODE=ON")
    return str(found)


@pytest.fixture
def folder(plan: Path, programs: str, tmp_path: Path) -> Path:
    """The files of the first node of the network in `plan`, whose first sample is an hour away."""
    from garrison.net.folder import write_network
    from garrison.net.plan import read_plan

    (tmp_path / "net").mkdir()
    write_network(read_plan(plan), tmp_path / "net", time.time() + 3600, programs)
    return tmp_path / "net" / "0"


def check(folder: Path, programs: str) -> "subprocess.CompletedProcess[str]":
    """What `garrison-node --check` says of the files of a node."""
    from garrison.net.programs import program

    command = [program("garrison-node", programs), "--check", str(folder / "node.toml")]
    return subprocess.run(command, capture_output=True, text=True, timeout=20)
