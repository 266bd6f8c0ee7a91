"""`garrison list`: what exists, with parameters."""

import argparse
import math
from typing import Any

from garrison import _core
from garrison._commands.terminal import OK, Commands, console_for, print_json, print_table


def add(commands: Commands) -> None:
    command = commands.add_parser("list", help="what exists, with parameters, units, ranges, defaults")
    command.add_argument("what", nargs="?", choices=["filters", "attacks"])
    command.add_argument("--json", action="store_true", help="print the result for machines")
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


def do(args: argparse.Namespace) -> int:
    kinds = {"filters": _core.filter_infos(), "attacks": _core.attack_infos()}
    wanted = {args.what: kinds[args.what]} if args.what else kinds
    if args.json:
        print_json(wanted)
        return OK
    console = console_for()
    head = ["parameter", "symbol", "unit", "range", "default", "meaning"]
    for kind, infos in wanted.items():
        for info in infos:
            about = info.get("title") or f"{info['doc']} ({info['target']} attack)"
            console.print(f"\n[bold]{info['name']}[/bold]  {about}  [dim]{kind}[/dim]")
            if info["params"]:
                print_table("", head, _param_rows(info["params"]), console)
    return OK
