"""Figures of the fuzz, printed at the end of `make fuzz`, and its seed."""

from pathlib import Path
from typing import Any

import pytest

_LINES: list[str] = []


def pytest_addoption(parser: Any) -> None:
    """`--fuzz-seed`."""
    parser.addoption("--fuzz-seed", type=int, default=0, help="another seed makes other calls and mutants")


@pytest.fixture(scope="session")
def seed(request: pytest.FixtureRequest) -> int:
    """What everything random starts from."""
    found: int = request.config.getoption("--fuzz-seed")
    return found


@pytest.fixture(scope="session")
def figures() -> list[str]:
    """Lines to be printed at the end."""
    return _LINES


@pytest.fixture(scope="session")
def wind() -> Path:
    """Folder of the real data."""
    return Path(__file__).parents[2] / "examples" / "wind"


def pytest_terminal_summary(terminalreporter: Any) -> None:
    """Print them."""
    for line in _LINES:
        terminalreporter.write_line(line)
