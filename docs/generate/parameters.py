"""Tables of the parameters of filters and attacks, from their descriptions in the core."""

import math
from typing import Any

from garrison import _core

from generate.markdown import cell, code, table

_HEAD = ["parameter", "symbol", "unit", "range", "default", "meaning"]


def of_filters() -> dict[str, str]:
    """Name of a filter -> table of its parameters."""
    return {info["name"]: _table(info["params"]) for info in _core.filter_infos()}


def attacks_page() -> str:
    """The page of the attacks."""
    parts = [
        "# Attacks\n",
        "Measurement attacks change what a sensor says; message attacks change what an agent sends to its neighbours. "
        "Every attack takes `agents`, `start`, `stop`, `schedule` and `probability` besides its own parameters; in "
        "Python it is a function of `garrison.attacks` (`gr.attacks.Bias`), in a scenario a table "
        "`[[attack]]` with `kind`.\n",
    ]
    for info in _core.attack_infos():
        parts.append(f"## {info['name']}\n\n{info['target'].capitalize()} attack: {cell(info['doc'])}.\n")
        parts.append(_table(info["params"]))
    return "\n".join(parts)


def _table(params: list[dict[str, Any]]) -> str:
    if not params:
        return "No parameters.\n"
    rows = [
        [code(p["name"]), cell(p["symbol"]), cell(p["unit"]), _range(p), _default(p), cell(p["doc"])] for p in params
    ]
    used = [k for k in range(len(_HEAD)) if any(row[k] for row in rows)]  # columns that say nothing are left out
    return table([_HEAD[k] for k in used], [[row[k] for k in used] for row in rows])


def _range(p: dict[str, Any]) -> str:
    if p["choices"]:
        return ", ".join(code(choice) for choice in p["choices"])
    if isinstance(p["default"], bool):
        return "true, false"
    least = "" if p["least"] == -math.inf else f"{'>' if p['open'] else '>='} {p['least']:g}"
    most = "" if p["most"] == math.inf else f"<= {p['most']:g}"
    return cell(", ".join(end for end in (least, most) if end))


def _default(p: dict[str, Any]) -> str:
    if p["required"]:
        return "required"
    value = p["default"]
    if value == [] or (isinstance(value, float) and math.isnan(value)):
        return "left out"
    return code(str(value).lower() if isinstance(value, bool) else value)
