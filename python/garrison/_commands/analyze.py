"""`garrison analyze`: how many may lie, which sensors and links must not fail, what to add."""

import argparse
import sys
from typing import Any

from garrison._commands.output import new_file, write_picture
from garrison._commands.terminal import NO, OK, Commands, console_for, number, print_json, print_table, tell_work
from garrison.answers import Analysis, analyze
from garrison.answers.text import limit_rows, sensor_rows, sentences
from garrison.scenario import read_scenario
from garrison.scenario.static import read_static_scenario

_MOST_ROWS = 60


def add(commands: Commands) -> None:
    """Declare the command."""
    command = commands.add_parser(
        "analyze",
        help="tell how many sensors may lie, which must not fail, who could drift without limit, unseen, and what to "
        "add; exit 1 if the sensors do not show the whole state",
        allow_abbrev=False,
    )
    command.add_argument("scenario", help="scenario file (TOML)")
    command.add_argument("--seconds", type=number, default=30.0, help="time for all searches together (default 30)")
    command.add_argument("-o", "--output", help="picture to write (.png, .svg, .pdf)")
    command.add_argument("--force", action="store_true", help="replace an existing picture")
    command.add_argument("--json", action="store_true", help="print JSON")
    command.set_defaults(do=do)


def do(args: argparse.Namespace) -> int:
    """Run the command."""
    target = new_file(args.output, args.force) if args.output else None
    found = _analysis(args)
    if target is not None:
        write_picture(target, found.plot())
    if args.json:
        print_json(found.report())
    else:
        _print(found, args.output)
    return NO if found.over_time.most == 0 else OK


def _analysis(args: argparse.Namespace) -> Analysis:
    options: dict[str, Any] = {
        "seconds": args.seconds,
        "progress": tell_work if sys.stderr.isatty() else None,
    }
    static = read_static_scenario(args.scenario)
    if static is not None:
        return analyze(static.plant, static.network, names=static.names, title=static.title, **options)
    scenario = read_scenario(args.scenario)
    scenario.require_constant("analyze")
    return analyze(
        scenario.model,
        scenario.network,
        scenario.filters[0][1],
        names=scenario.names,
        title=scenario.title,
        **options,
    )


def _print(found: Analysis, output: str | None) -> None:
    console = console_for()
    for line in sentences(found):
        console.print(line)
    console.print()
    print_table("guarantees", ["guarantee", "liars", "needs", "in the way of one more"], limit_rows(found), console)
    console.print()
    rows = sensor_rows(found)
    head = ["sensor", "critical", "unchecked share", "could measure instead"]
    print_table("sensors", head, rows[:_MOST_ROWS], console)
    if len(rows) > _MOST_ROWS:
        console.print(f"... and {len(rows) - _MOST_ROWS} more; see --json")
    if output:
        console.print(f"\nwritten to {output}")
