"""`garrison verify` reads any shape: what does not fit is reported in words, blocks per agent are compared as such."""

import copy
import json
import random
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from garrison.verify import verify_file
from garrison.verify.compare import Within, compare

#: words of Python and of its bindings, none of which may reach a person
PYTHON = re.compile(
    r"[A-Z][a-z]+Error|Exception|ambiguous|inhomogeneous|has no attribute|object is not|Unable to cast|operand"
    r"|broadcast|incompatible|convert string|subscript|positional"
)
BAD = ["x", "nan", None, {}, [], [[]], [1, 2], True, -1, 0, 1e308, 2.5, [[1, 2], [3]], "zeros", {"a": 1}]
SEED, MUTANTS = 7, 150


def places(value: Any, path: tuple[Any, ...], depth: int = 5) -> list[tuple[Any, ...]]:
    keys: Any = value if isinstance(value, dict) else range(min(len(value), 3)) if isinstance(value, list) else ()
    deeper = [p for key in keys for p in places(value[key], (*path, key), depth - 1)] if depth > 1 else []
    return [path, *deeper]


def mutated(case: dict[str, Any], rng: random.Random) -> dict[str, Any]:
    """Another value, one entry less, one more, or a key lost."""
    out = copy.deepcopy(case)
    top = rng.choice(["inputs", "expected"])
    *way, last = rng.choice(places(out[top], (top,)))
    parent: Any = out
    for key in way:
        parent = parent[key]
    how, value = rng.randrange(4), parent[last]
    if how == 1 and isinstance(value, list) and value:
        del value[rng.randrange(len(value))]
    elif how == 2 and isinstance(value, list) and value:
        value.append(copy.deepcopy(value[0]))
    elif how == 3:
        del parent[last]
    else:
        parent[last] = rng.choice(BAD)
    return out


def test_mutated_cases_are_judged_in_words(cases: Path, tmp_path: Path) -> None:
    files = [f for f in sorted(cases.rglob("*.json")) if f.stat().st_size < 60_000]
    known = [
        c for f in files if isinstance(c := json.loads(f.read_text()), dict) and {"inputs", "expected"} <= c.keys()
    ]
    rng = random.Random(SEED)
    missed = 0
    for _ in range(MUTANTS):
        path = tmp_path / "case.json"
        path.write_text(json.dumps(mutated(rng.choice(known), rng)))
        result = verify_file(path)
        assert result is not None
        missed += result.misses > 0
        for field in result.fields:
            assert not PYTHON.search(field.note), field.note
    assert missed > MUTANTS / 4


@pytest.mark.parametrize(
    "content", ["", "[1, 2]", "3", '"x"', "{}", '{"inputs": 3, "expected": 4}', "[" * 5000, "\ufeff{}", "nul"]
)
def test_files_that_are_no_cases(tmp_path: Path, content: str) -> None:
    path = tmp_path / "case.json"
    path.write_text(content, encoding="utf-8")
    result = verify_file(path)
    assert result is not None and result.misses == 1
    assert not PYTHON.search(result.fields[0].note)


BLOCKS = [[[1.0, 2.0]], [[3.0], [4.0]], []]


@pytest.mark.parametrize(
    ("got", "ok"),
    [
        ([np.array([[1.0, 2.0]]), np.array([[3.0], [4.0]]), np.zeros(0)], True),
        (BLOCKS, True),
        ([np.array([[1.0, 2.0]]), np.array([[3.0], [4.0 + 1e-10]]), np.zeros(0)], True),
        ([np.array([[1.0, 2.0]]), np.array([[3.0], [4.1]]), np.zeros(0)], False),
        ([np.array([[1.0], [2.0]]), np.array([[3.0, 4.0]]), np.zeros(0)], False),  # the same numbers, other blocks
        ([np.array([[1.0, 2.0]]), np.array([[3.0], [4.0]])], False),
        (np.array([1.0, 2.0, 3.0, 4.0]), False),
        (None, False),
        ("x", False),
        ({}, False),
        (3.0, False),
    ],
)
def test_blocks_of_different_sizes(got: Any, ok: bool) -> None:
    (result,) = compare({"K": got}, {"K": BLOCKS}, {})
    assert result.ok is ok
    assert not PYTHON.search(result.note)


def test_blocks_are_measured_by_their_largest_entry() -> None:
    (result,) = compare({"K": [[1.0, 200.0], [4.0 + 1e-8]]}, {"K": [[1.0, 200.0], [4.0]]}, {})
    assert result.ok and result.deviation == pytest.approx(5e-11)
    (result,) = compare({"s": [[1, 2], [3]]}, {"s": [[1, 2], [4]]}, {})
    assert not result.ok


@pytest.mark.parametrize(
    ("got", "expected"),
    [
        (np.zeros(3), "same"),
        (np.zeros(3), True),
        (np.zeros(3), None),
        ([np.zeros(2), np.zeros(3)], [1.0, 2.0]),
        (Within(np.zeros(3), np.zeros(2)), [0.0, 0.0]),
        ([1, "x"], [1, 2]),
        (1.0, [1.0, "x"]),
        (True, 1.0),
    ],
)
def test_other_kinds_are_misses(got: Any, expected: Any) -> None:
    (result,) = compare({"v": got}, {"v": expected}, {})
    assert not result.ok
    assert not PYTHON.search(result.note)


def test_ragged_input_that_must_be_refused_is_refused_by_name(cases: Path, tmp_path: Path) -> None:
    case = json.loads((cases / "saturation" / "he_secure_05_one_agent.json").read_text())
    case["inputs"]["y"][2] = case["inputs"]["y"][2] * 2
    bad = {"paper": "he_secure", "must": "refuse", "names": ["y"], "inputs": case["inputs"]}
    (tmp_path / "bad.json").write_text(json.dumps(bad))
    result = verify_file(tmp_path / "bad.json")
    assert result is not None and result.misses == 0, result.fields
    assert "rows of different lengths" in result.fields[0].note
