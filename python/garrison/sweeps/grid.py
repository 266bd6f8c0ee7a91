"""The points of a sweep: all combinations of values, or the rows of a file."""

import csv
import io
import itertools
import math
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from garrison.arguments import entries
from garrison.files import contents
from garrison.words import refusal

Point = dict[str, Any]
#: runs beyond which nobody waits; each of them takes about a kilobyte before it starts
_MOST = 1_000_000


def points_of(values: Mapping[str, Iterable[Any]]) -> list[Point]:
    """Every combination; the last key changes fastest. No keys: one point that changes nothing."""
    lists = []
    for key, given in values.items():
        found = [_plain(v) for v in entries(f"set[{key!r}]", given, "a list of values")]
        if not found:
            raise refusal(f"set[{key!r}]", "no values", "one at least")
        lists.append(found)
    points = math.prod(len(found) for found in lists)
    if points > _MOST:
        raise refusal("set", f"{points} points in all", f"at most {_MOST}", "fewer values per key, or a CSV of points")
    return [dict(zip(values, some, strict=True)) for some in itertools.product(*lists)]


def _plain(value: Any) -> Any:
    if isinstance(value, np.generic):
        return value.item()
    return value.tolist() if isinstance(value, np.ndarray) else value


def parsed(text: str) -> tuple[str, list[Any]]:
    """`key=a:b:n` (evenly spaced), `key=log:a:b:n` (by equal factors), `key=1,5,25`."""
    key, equals, words = text.partition("=")
    if not equals or not key.strip() or not words.strip():
        raise refusal("--set", repr(text), "KEY=VALUES such as filter.threshold=0.5:2.0:8 or attack.value=1,5,25")
    key = key.strip()
    return key, _range(key, words.strip()) if ":" in words else [_value(w) for w in words.split(",")]


def _range(key: str, words: str) -> list[float]:
    parts = words.split(":")
    log = parts[0].strip() == "log"
    try:
        first, last, many = parts[1:] if log else parts
        a, b, n = float(first), float(last), int(many)
    except ValueError:
        raise refusal(f"--set {key}", repr(words), "a:b:n or log:a:b:n, n values from a to b") from None
    if n < 1 or not np.isfinite([a, b]).all() or (log and not (a > 0 and b > 0)):
        raise refusal(f"--set {key}", repr(words), "finite ends (> 0 with log) and n >= 1")
    if n > _MOST:
        raise refusal(f"--set {key}", f"{n} values", f"at most {_MOST}")
    return [float(v) for v in (np.geomspace(a, b, n) if log else np.linspace(a, b, n))]


def _value(word: str) -> Any:
    word = word.strip()
    if word in ("true", "false"):
        return word == "true"
    for kind in (int, float):
        try:
            return kind(word)
        except ValueError:
            continue
    return word


def read_points(path: str | Path) -> list[Point]:
    """One point per row of a CSV file whose header names keys of the scenario."""
    try:
        text = contents(Path(path)).decode("utf-8-sig")
        head, *rows = [row for row in csv.reader(io.StringIO(text, newline="")) if row]
    except OSError as error:
        raise refusal("--points", f"{path}: {error.strerror}", "a CSV file that can be read") from None
    except (ValueError, UnicodeDecodeError):
        raise refusal(
            "--points", f"{path}: no rows", "a header with keys of the scenario, and a row per point"
        ) from None
    for number, row in enumerate(rows, start=2):
        if len(row) != len(head):
            raise refusal("--points", f"{path} row {number} with {len(row)} cells", f"{len(head)}, as in the header")
    return [{key.strip(): _value(cell) for key, cell in zip(head, row, strict=True)} for row in rows]
