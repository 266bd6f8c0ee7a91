"""A JSON schema of scenario files, from the tables that the reader itself uses: editors complete and check by it."""

import math
from collections.abc import Iterable
from typing import Any

from garrison import _core
from garrison.scenario import attacks, data, filters, model, network, reader

Schema = dict[str, Any]

#: kinds of values; keys that are not here take several kinds, which the reader tells apart
_WHOLE = {"steps", "trials", "threads", "seed", "delay_rounds", "factors", "harmonics", "vehicles", "range", "rows"}
_NUMBERS = {
    "drop",
    "delay",
    "failure",
    "gate",
    "huber",
    "radius",
    "radius_km",
    "start_error",
    "factor",
    "period",
    "interval",
}
_WORDS = {"fit", "file", "stations", "spread", "law", "label"}
_FLAGS = {"root", "directed", "memory", "standardise"}


def schema() -> Schema:
    """The schema, draft 2020-12. What depends on several tables (sizes, dates, names of agents) only `check` sees."""
    filter_of = [_named("name", info, ["label"]) for info in _core.filter_infos()]
    kalman = _table(["name", "label", *filters.SCREENS], required=["name"])
    kalman["properties"]["name"] = {"enum": list(filters.BASELINES)}
    tables: dict[str, Schema] = {
        "model": {"anyOf": [_table(keys) for keys in model.KEYS]},
        "network": {"anyOf": [*(_table(keys) for keys in network.KEYS), *_generators()]},
        "filter": {"anyOf": filter_of},
        "compare": _one_or_more({"anyOf": [*filter_of, kalman]}),
        "attack": _one_or_more({"anyOf": [_named("kind", info, attacks.COMMON) for info in _core.attack_infos()]}),
        "link": _table(reader.LINK_KEYS),
        "noise": _table(reader.NOISE_KEYS),
        "data": _table(data.KEYS, required=["file"]),
        "run": _table(reader.RUN_KEYS),
        "certificate": _table(reader.CERTIFICATE_KEYS),
    }
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "scenario of garrison",
        "type": "object",
        "properties": {"title": {"type": "string"}} | tables,
        "required": ["model", "network", "filter"],
        "additionalProperties": False,
    }


def _table(keys: Iterable[str], required: Iterable[str] = ()) -> Schema:
    return {
        "type": "object",
        "properties": {key: _kind(key) for key in keys},
        "required": list(required),
        "additionalProperties": False,
    }


def _kind(key: str) -> Schema:
    if key in _WHOLE or key in _NUMBERS:
        return {"type": "integer" if key in _WHOLE else "number"}
    return {"type": "string"} if key in _WORDS else {"type": "boolean"} if key in _FLAGS else {}


def _one_or_more(one: Schema) -> Schema:
    return {"anyOf": [one, {"type": "array", "items": one}]}


def _generators() -> list[Schema]:
    found = []
    for kind, keys in network.GENERATORS.items():
        table = _table(["kind", *keys], required=["kind"])
        table["properties"]["kind"] = {"const": kind}
        found.append(table)
    return found


def _named(key: str, info: dict[str, Any], also: list[str]) -> Schema:
    """The table of one filter or attack."""
    needed = [p["name"] for p in info["params"] if p["required"]]
    table = _table(also, required=[key, *needed])
    table["description"] = info.get("title") or info["doc"]
    table["properties"] |= {key: {"const": info["name"]}} | {p["name"]: _parameter(p) for p in info["params"]}
    return table


def _parameter(info: dict[str, Any]) -> Schema:
    about = {"description": info["doc"]}
    default = info["default"]
    if isinstance(default, bool):
        return about | {"type": "boolean"}
    if isinstance(default, str):
        return about | ({"enum": info["choices"]} if info["choices"] else {"type": ["string", "number"]})
    if isinstance(default, list):
        return about  # numbers, nested or not, or one alone
    low = {"exclusiveMinimum" if info["open"] else "minimum": info["least"]} if math.isfinite(info["least"]) else {}
    high = {"maximum": info["most"]} if math.isfinite(info["most"]) else {}
    return about | {"type": "number"} | low | high
