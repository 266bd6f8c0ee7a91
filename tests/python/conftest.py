from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="session")
def wind() -> Path:
    """Folder of the real data."""
    return ROOT / "examples" / "wind"


@pytest.fixture(scope="session")
def cases() -> Path:
    """Folder of the reference cases."""
    return ROOT / "tests" / "cases"
