"""`garrison check`: conditions and bounds of a scenario."""

import argparse

from garrison._commands.terminal import NO, OK, Commands, console_for, print_json, print_table
from garrison.checks import check, verdict
from garrison.scenario import read_scenario


def add(commands: Commands) -> None:
    command = commands.add_parser(
        "check", help="validate a scenario, print conditions and bounds; exit 1 if a condition fails"
    )
    command.add_argument("scenario", help="scenario file (TOML)")
    command.add_argument("--json", action="store_true", help="print the result for machines")
    command.set_defaults(do=do)


def do(args: argparse.Namespace) -> int:
    scenario = read_scenario(args.scenario)
    label, filter = scenario.filters[0]
    assert filter is not None  # the main filter is never the central one
    found = check(filter, scenario.model, scenario.network)
    if args.json:
        print_json(
            {
                "filter": label,
                "holds": found.holds,
                "conditions": found.conditions,
                "quantities": found.quantities,
            }
        )
        return OK if found.holds else NO
    console = console_for()
    rows = [[verdict(c), c["name"], f"{c['value']:.6g}", c["needed"], c["meaning"]] for c in found.conditions]
    print_table(f"{scenario.title}: {label}", ["", "condition", "value", "needed", "meaning"], rows, console)
    console.print()
    print_table(
        "",
        ["quantity", "value", "meaning"],
        [[q["name"], f"{q['value']:.6g}", q["meaning"]] for q in found.quantities],
        console,
    )
    return OK if found.holds else NO
