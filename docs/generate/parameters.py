"""Tables of the parameters of filters and attacks, from their descriptions in the core."""

import math
from typing import Any

from garrison import _core

from generate.markdown import cell, code, table


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
    rows = [[_name(p), cell(p["doc"]), "; ".join(part for part in (_range(p), _default(p)) if part)] for p in params]
    return table(["parameter (symbol, unit)", "meaning", "range; default"], rows)


def _name(p: dict[str, Any]) -> str:
    """The name, below it symbol and unit where there are any; few columns fit on a phone."""
    more = ", ".join(cell(p[key]) for key in ("symbol", "unit") if p[key] not in ("", "1"))
    return code(p["name"]) + (f"<br>{more}" if more else "")


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
        return "**required**"
    value = p["default"]
    if value == [] or (isinstance(value, float) and math.isnan(value)):
        return ""
    return "default " + code(str(value).lower() if isinstance(value, bool) else value)
