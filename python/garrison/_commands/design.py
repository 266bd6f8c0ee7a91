"""`garrison design`: parameters of a scenario's filter for a goal."""

import argparse
import math

from garrison._commands.output import new_file, write_picture
from garrison._commands.terminal import OK, Commands, console_for, number, print_json, print_table, whole_number
from garrison.designing import GOALS, design
from garrison.scenario import read_scenario
from garrison.words import refusal


def add(commands: Commands) -> None:
    """Declare the command."""
    command = commands.add_parser(
        "design",
        help="find rounds and threshold of the saturation filter for a goal on a scenario's plant",
        allow_abbrev=False,
    )
    command.add_argument("scenario", help="scenario file (TOML)")
    command.add_argument("--goal", choices=GOALS, default="error", help="smallest error, fewest bytes, most liars")
    command.add_argument(
        "--attacked", type=whole_number, help="liars to stand (default: the scenario's; not with --goal liars)"
    )
    command.add_argument("--initial-error", type=number, help="bound on the start's error (default: the scenario's)")
    command.add_argument("--error-at-most", type=number, help="with --goal bytes: the error to certify")
    command.add_argument("--most-rounds", type=whole_number, default=200, help="most rounds per sample (default 200)")
    command.add_argument("--plain", action="store_true", help="plain rounds, not Chebyshev-filtered ones")
    command.add_argument("-o", "--output", help="picture of the trade-off to write (.png, .svg, .pdf)")
    command.add_argument("--force", action="store_true", help="replace an existing picture")
    command.add_argument("--json", action="store_true", help="print JSON")
    command.set_defaults(do=do)


def do(args: argparse.Namespace) -> int:
    """Run the command."""
    target = new_file(args.output, args.force) if args.output else None
    scenario = read_scenario(args.scenario)
    scenario.require_constant("design")
    main = scenario.filters[0][1]
    own = main.params if main is not None else {}
    attacked = args.attacked if args.attacked is not None else own.get("attacked", len(scenario.hit))
    start = args.initial_error if args.initial_error is not None else own.get("initial_error")
    if start is None or math.isnan(start):
        raise refusal("--initial-error", "nothing, and no initial_error in [filter]", "a number > 0, unit of the state")
    found = design(
        scenario.model,
        scenario.network,
        attacked=None if args.goal == "liars" else attacked,
        initial_error=start,
        goal=args.goal,
        error_at_most=args.error_at_most,
        chebyshev=not args.plain,
        most_rounds=args.most_rounds,
    )
    if target is not None:
        write_picture(target, found.plot())
    if args.json:
        facts = {"goal": found.goal, "filter": found.filter.params, "attacked": found.attacked, "error": found.error}
        print_json(facts | {"fewest_rounds": found.fewest_rounds, "curve": [vars(c) for c in found.curve]})
        return OK
    rows = [[str(c.rounds), f"{c.threshold:.5g}", f"{c.error:.5g}", str(c.bytes_per_sample)] for c in found.curve]
    print(found)
    print()
    head = ["rounds", "best threshold", "certified error", "bytes per sample"]
    print_table(f"{scenario.title}: what rounds cost and give", head, rows, console_for())
    if args.output:
        print(f"written to {args.output}")
    return OK
