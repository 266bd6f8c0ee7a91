"""The JSON schema of scenarios: what the reader takes is valid, slips are not."""

import json
import math
import tomllib
from collections.abc import Callable
from typing import Any

import pytest
from conftest import ROOT
from garrison._commands.template import TEMPLATE
from garrison.cli import main
from garrison.scenario.reader import TABLES
from garrison.scenario.schema import schema

KINDS: dict[str, Callable[[Any], bool]] = {
    "object": lambda v: isinstance(v, dict),
    "array": lambda v: isinstance(v, list),
    "string": lambda v: isinstance(v, str),
    "boolean": lambda v: isinstance(v, bool),
    "integer": lambda v: isinstance(v, int) and not isinstance(v, bool),
    "number": lambda v: isinstance(v, (int, float)) and not isinstance(v, bool),
}


def valid(value: Any, rule: dict[str, Any]) -> bool:
    """The words of JSON schema that ours uses; any other fails here."""
    known = {"$schema", "title", "description", "type", "properties", "required", "additionalProperties"}
    assert set(rule) <= known | {"anyOf", "items", "const", "enum", "minimum", "exclusiveMinimum", "maximum"}
    kinds = rule.get("type", [])
    kinds = [kinds] if isinstance(kinds, str) else kinds
    inner = rule.get("properties", {})
    return (
        (not kinds or any(KINDS[kind](value) for kind in kinds))
        and ("anyOf" not in rule or any(valid(value, one) for one in rule["anyOf"]))
        and ("const" not in rule or value == rule["const"])
        and ("enum" not in rule or value in rule["enum"])
        and ("items" not in rule or all(valid(one, rule["items"]) for one in value))
        and all(key in value for key in rule.get("required", []))
        and (rule.get("additionalProperties", True) or set(value) <= set(inner))
        and all(valid(value[key], inner[key]) for key in inner if isinstance(value, dict) and key in value)
        and (not isinstance(value, float | int) or in_range(value, rule))
    )


def in_range(value: float, rule: dict[str, Any]) -> bool:
    above = "exclusiveMinimum" not in rule or value > rule["exclusiveMinimum"]
    return above and rule.get("minimum", -math.inf) <= value <= rule.get("maximum", math.inf)


#: all but networks of daemons, which name a scenario
SCENARIOS = [p for p in sorted(ROOT.glob("examples/**/*.toml")) if "scenario" not in tomllib.loads(p.read_text())]


@pytest.mark.parametrize("path", SCENARIOS, ids=lambda path: path.stem)
def test_the_examples_are_valid(path: Any) -> None:
    assert valid(tomllib.loads(path.read_text()), schema())


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("threshold = 0.5", "thresold = 0.5"),
        ("threshold = 0.5", "threshold = 0"),
        ("threshold = 0.5", 'threshold = "0.5"'),
        ('kind = "complete"', 'kind = "complet"'),
        ('kind = "complete"', 'kind = "complete"\nradius = 2'),
        ('kind = "bias"', 'kind = "ramp"'),  # its parameter is slope
        ("steps = 100", "steps = 100.5"),
        ("[run]", "[runs]"),
        ('name = "central_kalman"', 'name = "central_kalman"\ngates = 0.1'),
    ],
)
def test_slips_are_not(old: str, new: str) -> None:
    assert old in TEMPLATE
    assert valid(tomllib.loads(TEMPLATE), schema())
    assert not valid(tomllib.loads(TEMPLATE.replace(old, new, 1)), schema())


def test_it_has_the_tables_of_the_reader() -> None:
    assert list(schema()["properties"]) == ["title", *TABLES]


def test_the_command_prints_it(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["list", "schema"]) == 0
    assert json.loads(capsys.readouterr().out) == schema()
