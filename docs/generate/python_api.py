"""Public names of the Python package that the hand-written page does not name."""

import inspect
import re
from pathlib import Path

import garrison

_PAGE = Path(__file__).parents[1] / "api" / "python.md"


def rest() -> str:
    """A directive per public class and function that docs/api/python.md leaves out."""
    named = set(re.findall(r"^\.\. auto\w+:: garrison\.(\w+)$", _PAGE.read_text(encoding="utf-8"), flags=re.MULTILINE))
    for module in (garrison.filters, garrison.attacks):  # shown whole
        named |= set(module.__all__)
    lines = []
    for name in sorted(garrison.__all__):
        thing = getattr(garrison, name)
        if name in named or inspect.ismodule(thing) or isinstance(thing, str):
            continue
        kind = "autoexception" if inspect.isclass(thing) and issubclass(thing, Exception) else None
        kind = kind or ("autoclass" if inspect.isclass(thing) else "autofunction")
        lines.append(f".. {kind}:: garrison.{name}")
    return "```{eval-rst}\n" + "\n".join(lines) + "\n```\n"
