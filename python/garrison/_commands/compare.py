"""`garrison compare`: all families and baselines against all attacks on a scenario's plant."""

import argparse
import sys
from typing import Any

from garrison import _core
from garrison._commands.output import new_file, write_picture
from garrison._commands.terminal import (
    OK,
    Commands,
    console_for,
    in_options,
    number,
    print_json,
    print_table,
    tell_work,
    whole_number,
)
from garrison.comparison import Comparison, compare
from garrison.comparison.table import COLUMNS
from garrison.scenario import Scenario, read_scenario
from garrison.words import refusal


def add(commands: Commands) -> None:
    """Declare the command."""
    command = commands.add_parser(
        "compare",
        help="run all filters and baselines against all attacks on a scenario's plant; one table, one picture",
        allow_abbrev=False,
    )
    command.add_argument("scenario", help="scenario file (TOML); the agents of its attacks lie")
    command.add_argument("--agents", help="agents that lie, by number or name, e.g. 2,5 (default: the scenario's)")
    command.add_argument("--steps", type=whole_number, default=100, help="samples of a trial (default 100)")
    command.add_argument("--start", type=whole_number, default=20, help="first sample under attack (default 20)")
    command.add_argument("--trials", type=whole_number, default=20, help="trials (default 20)")
    command.add_argument(
        "--size", type=number, help="size of the lies, in the measurement's unit (default ten times the noise)"
    )
    command.add_argument("-o", "--output", help="picture to write (.png, .svg, .pdf)")
    command.add_argument("--full", action="store_true", help="print a row per filter and attack, not one per filter")
    command.add_argument("--force", action="store_true", help="replace an existing picture")
    command.add_argument("--json", action="store_true", help="print JSON")
    command.set_defaults(do=do)


def do(args: argparse.Namespace) -> int:
    """Run the command."""
    target = new_file(args.output, args.force) if args.output else None
    scenario = read_scenario(args.scenario)
    if scenario.present is not None:
        raise refusal("[network]", "present", "links that stay, for garrison compare")
    try:
        found = _compared(args, scenario)
    except _core.InvalidInput as error:
        raise in_options(error, {"size": "--size"}) from None
    if target is not None:
        write_picture(target, found.plot())
    if args.json:
        print_json({"title": found.title, "attacked": found.attacked, "rows": found.rows})
        return OK
    _print(found, args.full)
    if args.output:
        print(f"written to {args.output}")
    return OK


def _compared(args: argparse.Namespace, scenario: Scenario) -> Comparison:
    """The scenario's filters first, then all others."""
    own = {label: filter for label, filter in scenario.filters if filter is not None}
    attacked = _agents(args.agents, scenario.names) if args.agents else scenario.hit
    if not attacked:
        raise refusal("compare", "a scenario without attacks", "agents that lie", "name them with --agents")
    found = compare(
        scenario.plant,
        scenario.network,
        attacked,
        steps=args.steps,
        start=args.start,
        trials=args.trials,
        size=args.size,
        title=scenario.title,
        progress=tell_work if sys.stderr.isatty() else None,
    )
    mine = compare(
        scenario.plant,
        scenario.network,
        attacked,
        filters={f"{label} (scenario)": filter for label, filter in own.items()},
        baselines=False,
        steps=args.steps,
        start=args.start,
        trials=args.trials,
        size=args.size,
    )
    found.rows[:0] = mine.rows
    return found


_LEGEND = (
    "error: of honest agents' estimates, from the attack's start on. delay: samples until somebody is accused rightly "
    "(median). false alarms: honest agents accused per trial, under all attacks, lies in messages too. bound share, "
    "inside: samples with a bound, errors within it. bytes: of all messages of a sample. us: microseconds per agent "
    "and sample. -: does not exist"
)


def _print(found: Comparison, full: bool) -> None:
    tail = ["bound share", "inside", "bytes", "us"]
    if full:
        rows = [[row["filter"], row["attack"], *(_cell(row[key]) for key in COLUMNS)] for row in found.rows]
        head = ["filter", "attack", "error 50 %", "95 %", "99 %", "delay", "false alarms", *tail, ""]
    else:
        keys = ("detection_delay", "false_alarms", "bound_share", "inside_bound", "bytes_per_sample", "microseconds")
        rows = [
            [row["filter"], _cell(row["none"]), *_worst(row, "measurements"), *_worst(row, "messages")]
            + [_cell(row[key]) for key in keys]
            + [_cell(row["status"])]
            for row in found.summary()
        ]
        head = ["filter", "error 95 %, no attack", "worst lie in measurements", "", "worst lie in messages", ""]
        head += ["delay", "false alarms", *tail, ""]
    console = console_for()
    print_table(found.title, head, rows, console)
    console.print(_LEGEND, markup=False)


def _worst(row: dict[str, Any], kind: str) -> list[str]:
    return [_cell(row[kind]), _cell(row[f"{kind}_by"])]


def _agents(text: str, names: list[str]) -> list[int]:
    found = []
    for word in (w.strip() for w in text.split(",")):
        if word in names:
            found.append(names.index(word))
        elif word.isdigit() and int(word) < len(names):
            found.append(int(word))
        else:
            raise refusal("--agents", repr(word), f"a number in 0..{len(names) - 1} or a name")
    return found


def _cell(value: Any) -> str:
    if value is None:
        return "-"
    if isinstance(value, str):
        return "" if value == "ok" else value if len(value) <= 48 else f"{value[:45]}..."
    return f"{value:.3g}"
