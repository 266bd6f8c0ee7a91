"""Other values in a scenario's document: `filter.threshold`, `attack[0].value`, `compare[1].rounds`."""

import copy
import hashlib
import json
import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from garrison import _core
from garrison.words import refusal, shown

_STEP = re.compile(r"([A-Za-z_][A-Za-z0-9_-]*)((?:\[\d+\])*)\Z")


def overridden(document: dict[str, Any], values: Mapping[str, Any]) -> dict[str, Any]:
    """A copy of the document with these values put in. Raises InvalidInput on a key that leads nowhere."""
    out = copy.deepcopy(document)
    for key, value in values.items():
        *path, (last, inner) = _steps(key)
        place: Any = out
        for name, indices in path:
            place = _inside(key, place, name, indices)
        if isinstance(place, list):
            place = _only(key, place)
        if not isinstance(place, dict):
            raise refusal(key, shown(place), "a table that holds the key")
        if inner:
            *before, index = inner
            target = _inside(key, place, last, before)
            if not isinstance(target, list) or index >= len(target):
                raise refusal(key, shown(target), f"a list with an entry {index}, from 0")
            target[index] = value
        else:
            place[last] = value
    return out


def _steps(key: str) -> list[tuple[str, list[int]]]:
    steps = []
    for part in key.split("."):
        found = _STEP.match(part)
        if found is None:
            raise refusal("set", repr(key), "a key of the scenario such as filter.threshold or attack[0].value")
        steps.append((found[1], [int(k) for k in re.findall(r"\d+", found[2])]))
    return steps


def _inside(key: str, place: Any, name: str, indices: list[int]) -> Any:
    if isinstance(place, list):
        place = _only(key, place)
    if not isinstance(place, dict):
        raise refusal(key, shown(place), f"a table that holds {name}")
    found = place.setdefault(name, {})
    for index in indices:
        if isinstance(found, dict) and index == 0:  # a single [attack]
            continue
        if not isinstance(found, list) or index >= len(found):
            has = len(found) if isinstance(found, list) else int(found != {})
            expected = f"an index below {has}, as the scenario has {has}, counted from 0"
            raise refusal(key, f"{name}[{index}]", expected, f"write another [[{name}]] into the scenario")
        found = found[index]
    return found


def _only(key: str, tables: list[Any]) -> Any:
    if len(tables) != 1:
        raise refusal(key, f"one of {len(tables)} tables", "its number, from 0: attack[0].value")
    return tables[0]


def digest(document: dict[str, Any], folder: Path) -> str:
    """Hash of a scenario: its document, the files that it names, and the version of garrison."""
    files = {
        name: hashlib.sha256((folder / name).read_bytes()).hexdigest()
        for name in sorted(set(_texts(document)))
        if _is_file(folder / name)
    }
    plain = json.dumps([_core.__version__, document, files], sort_keys=True, default=str)
    return hashlib.sha256(plain.encode()).hexdigest()[:16]


def _texts(value: Any) -> Iterator[str]:
    if isinstance(value, str):
        yield value
    elif isinstance(value, dict):
        for inner in value.values():
            yield from _texts(inner)
    elif isinstance(value, list):
        for inner in value:
            yield from _texts(inner)


def _is_file(path: Path) -> bool:
    try:
        return path.is_file()
    except (OSError, ValueError):
        return False
