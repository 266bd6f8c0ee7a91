"""`garrison list`: the filters and attacks with their parameters."""

import argparse
import math
from typing import Any

from garrison import _core
from garrison._commands.terminal import OK, Commands, console_for, print_json, print_table
from garrison.scenario.schema import schema
from garrison.words import near, refusal


def add(commands: Commands) -> None:
    """Declare the command."""
    command = commands.add_parser("list", help="list the filters and attacks with their parameters", allow_abbrev=False)
    command.add_argument(
        "what",
        nargs="?",
        help="filters, attacks, the name of one (default: all), or schema: the JSON schema of scenarios",
    )
    command.add_argument("--json", action="store_true", help="print JSON")
    command.set_defaults(do=do)


def _range(p: dict[str, Any]) -> str:
    if p["choices"]:
        return " | ".join(p["choices"])
    low = f"{'>' if p['open'] else '>='} {p['least']:g}" if math.isfinite(p["least"]) else ""
    high = f"<= {p['most']:g}" if math.isfinite(p["most"]) else ""
    return ", ".join(x for x in (low, high) if x)


def _default(p: dict[str, Any]) -> str:
    value = p["default"]
    if p["required"]:
        return "required"
    return "-" if isinstance(value, float) and math.isnan(value) else str(value)


def _param_rows(params: list[dict[str, Any]]) -> list[list[str]]:
    return [[p["name"], p["symbol"], p["unit"], _range(p), _default(p), p["doc"]] for p in params]


def _wanted(what: str | None) -> dict[str, list[dict[str, Any]]]:
    kinds = {"filters": _core.filter_infos(), "attacks": _core.attack_infos()}
    if what is None:
        return kinds
    if what in kinds:
        return {what: kinds[what]}
    named = {kind: [info for info in infos if info["name"] == what] for kind, infos in kinds.items()}
    found = {kind: infos for kind, infos in named.items() if infos}
    if not found:
        known = [*kinds, "schema", *(info["name"] for infos in kinds.values() for info in infos)]
        raise refusal("list", repr(what), "filters, attacks, the name of one, or schema", near(what, known))
    return found


def do(args: argparse.Namespace) -> int:
    """Run the command."""
    if args.what == "schema":
        print_json(schema())
        return OK
    wanted = _wanted(args.what)
    if args.json:
        print_json(wanted)
        return OK
    console = console_for()
    head = ["parameter", "symbol", "unit", "range", "default", "meaning"]
    for kind, infos in wanted.items():
        for info in infos:
            about = info.get("title") or f"{info['doc']} ({info['target']} attack)"
            console.print(f"\n{info['name']}: {about} [{kind}]")
            if info["params"]:
                print_table("", head, _param_rows(info["params"]), console)
    return OK
