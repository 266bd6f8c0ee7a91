"""The README as an index page shows it: pictures and pages by their absolute addresses. Read by scikit-build-core."""

import re
import tomllib
from pathlib import Path

ROOT = Path(__file__).parents[1]


def absolute(text: str, home: str) -> str:
    """The text with every relative target of a link or picture below `home`."""
    return re.sub(r"\]\((?![a-z]+:|#)([^)\s]+)\)", rf"]({home}/\1)", text)


def dynamic_metadata(field: str, settings: dict) -> dict[str, str]:
    """Called for `[tool.scikit-build.metadata.readme]`."""
    if field != "readme" or settings:
        raise ValueError(f"got {field} with {settings}, expected readme without settings")
    home = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["urls"]["Homepage"]
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    return {"content-type": "text/markdown", "text": absolute(text, home)}
