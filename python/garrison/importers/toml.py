"""Plain values as a TOML document."""

import json
from typing import Any


def document(tables: dict[str, Any], head: list[str]) -> str:
    """Tables, lists of tables and plain keys, in their order; head: comment lines above."""
    lines = [f"# {line}" for text in head for line in text.splitlines()]
    plain = {k: v for k, v in tables.items() if not _is_table(v)}
    lines += ["", *_keys(plain)] if plain else []
    for name, value in tables.items():
        if isinstance(value, dict):
            lines += ["", f"[{name}]", *_keys(value)]
        elif _is_table(value):
            for one in value:
                lines += ["", f"[[{name}]]", *_keys(one)]
    return "\n".join(lines).lstrip("\n") + "\n"


def _is_table(value: Any) -> bool:
    return isinstance(value, dict) or (isinstance(value, list) and bool(value) and isinstance(value[0], dict))


def _keys(table: dict[str, Any]) -> list[str]:
    return [f"{key} = {_value(value)}" for key, value in table.items()]


def _value(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")  # the one that JSON lets stand
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(_value(v) for v in value) + "]"
    return repr(value)
