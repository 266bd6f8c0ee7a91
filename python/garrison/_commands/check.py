"""`garrison check`: conditions and bounds of a scenario."""

import argparse

from garrison._commands.setting import add_set, settings
from garrison._commands.terminal import NO, OK, Commands, console_for, print_json, print_table, print_warnings, working
from garrison.checks import verdict
from garrison.jobs import checked, rehearse
from garrison.scenario import read_scenario


def add(commands: Commands) -> None:
    """Declare the command."""
    command = commands.add_parser(
        "check",
        help="validate a scenario, print conditions and bounds of its filter; exit 1 if a required one is not met",
        allow_abbrev=False,
    )
    command.add_argument("scenario", help="scenario file (TOML)")
    add_set(command)
    command.add_argument("--json", action="store_true", help="print JSON")
    command.set_defaults(do=do)


def do(args: argparse.Namespace) -> int:
    """Run the command."""
    scenario = read_scenario(args.scenario, settings(args.set))
    label, filter = scenario.filters[0]
    assert filter is not None  # the main filter is never the central one
    with working(f"checking the conditions of {label}"):
        found, doubts = checked(scenario, filter)
        rehearse(scenario)
    code = OK if found.holds else NO
    if args.json:
        facts = {"conditions": found.conditions, "quantities": found.quantities, "notes": scenario.notes + doubts}
        print_json({"filter": label, "holds": found.holds, **facts})
        return code
    console = console_for()
    rows = [[verdict(c), c["name"], f"{c['value']:.6g}", c["needed"], c["meaning"]] for c in found.conditions]
    print_table(f"{scenario.title}: {label}", ["", "condition", "value", "needed", "meaning"], rows, console)
    console.print()
    quantities = [[q["name"], f"{q['value']:.6g}", q["meaning"]] for q in found.quantities]
    print_table("", ["quantity", "value", "meaning"], quantities, console)
    print_warnings(scenario.notes + doubts)
    return code
