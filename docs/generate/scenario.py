"""The reference of scenario files: every key that the reader takes; one without a meaning stops the build."""

import ast
from pathlib import Path

from garrison.scenario import network
from garrison.scenario import reader as _reader

from generate.markdown import code, table
from generate.scenario_keys import MEANINGS, TABLES

_READER = Path(_reader.__file__).parent


def page() -> str:
    """The page of all tables and keys."""
    _require_complete()
    parts = [
        "# Scenario reference\n",
        "A scenario is a TOML file. Paths in it are relative to it. An unknown key is refused with the nearest known "
        "one. `title` (a string) may stand at the top; `[model]`, `[network]` and `[filter]` must be there.\n",
    ]
    for name in _reader.TABLES:
        parts.append(f"## {_heading(name)}\n\n{TABLES[name]}\n")
        if name in MEANINGS:
            parts.append(table(["key", "meaning"], [[code(k), text] for k, text in MEANINGS[name].items()]))
        if name == "network":
            parts.append(_kinds())
    return "\n".join(parts)


def _heading(name: str) -> str:
    return f"[[{name}]]" if name in ("compare", "attack") else f"[{name}]"


def _kinds() -> str:
    rows = [[code(kind), ", ".join(code(key) for key in keys)] for kind, keys in network.GENERATORS.items()]
    return "Values of `kind` and the keys that each takes:\n\n" + table(["kind", "keys"], rows)


def _require_complete() -> None:
    described = {key for name, keys in MEANINGS.items() if name in _reader.TABLES for key in keys}
    described |= {key for keys in network.GENERATORS.values() for key in keys}
    missing = sorted(keys_of_the_reader() - described)
    if missing or set(TABLES) < set(_reader.TABLES):
        raise RuntimeError(f"docs/generate/scenario_keys.py: no meaning for {missing or 'a table'}, expected one")
    unknown = sorted(described - keys_of_the_reader() - {key for keys in network.GENERATORS.values() for key in keys})
    if unknown:
        raise RuntimeError(f"docs/generate/scenario_keys.py: meanings for {unknown}, which the reader does not take")


def keys_of_the_reader() -> set[str]:
    """Every key in a call of Section.only in garrison.scenario, constants of the modules looked up."""
    found: set[str] = set()
    for path in _READER.glob("*.py"):
        tree = ast.parse(path.read_text(encoding="utf-8"))
        lists = {
            target.id: _texts(node.value)
            for node in tree.body
            if isinstance(node, ast.Assign)
            for target in node.targets
            if isinstance(target, ast.Name) and isinstance(node.value, ast.List)
        }
        for node in ast.walk(tree):
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr == "only":
                for part in ast.walk(node):
                    found |= lists.get(part.id, set()) if isinstance(part, ast.Name) else set()
                    found |= _texts(part) if isinstance(part, ast.List) else set()
    return found


def _texts(node: ast.List) -> set[str]:
    return {c.value for c in node.elts if isinstance(c, ast.Constant) and isinstance(c.value, str)}
