"""`garrison structure`: which sensors are necessary, and what could replace them."""

import argparse

from garrison._commands.output import new_file, write_picture
from garrison._commands.terminal import NO, OK, Commands, console_for, print_json, print_table, whole_number
from garrison.anatomy import read_anatomy, states_text, table_rows


def add(commands: Commands) -> None:
    """Declare the command."""
    command = commands.add_parser(
        "structure",
        help="structural analysis: which sensors are necessary and what could replace them; exit 1 if not observable",
        allow_abbrev=False,
    )
    command.add_argument("source", help="scenario file (TOML), or a CSV file with the matrix A")
    command.add_argument(
        "--measured",
        type=whole_number,
        nargs="*",
        metavar="STATE",
        help="with a CSV file: the state of each sensor, from 0",
    )
    command.add_argument("-o", "--output", help="picture to write (.png, .svg, .pdf)")
    command.add_argument("--force", action="store_true", help="replace an existing picture")
    command.add_argument("--json", action="store_true", help="print JSON")
    command.set_defaults(do=do)


def do(args: argparse.Namespace) -> int:
    """Run the command."""
    anatomy = read_anatomy(args.source, args.measured)
    report = anatomy.report()
    if args.output:
        from garrison.figures import anatomy_figure

        write_picture(new_file(args.output, args.force), anatomy_figure(anatomy))
    if args.json:
        print_json(report)
    else:
        console = console_for()
        contractions = "; ".join(states_text(c) for c in report["contractions"]) or "none"
        parents = "; ".join(states_text(c) for c in report["parent_components"][:20])
        facts = [
            ["states", str(report["states"])],
            ["structural rank", str(report["structural_rank"])],
            ["groups to be measured, one state of each at least: contractions", contractions],
            [f"and likewise: parent components ({len(report['parent_components'])})", parents],
        ]
        if "observable" in report:
            unstable = len(report["unstable_modes_nobody_sees"])
            facts += [
                ["structurally observable", "yes" if report["observable"] else "no"],
                ["every state reaches a sensor", "yes" if report["output_connected"] else "no"],
                ["rank of [A; C] is full", "yes" if report["rank_condition"] else "no"],
                ["unstable modes that no sensor observes", str(unstable)],
            ]
        print_table(anatomy.title, ["structure", ""], facts, console)
        if "agents" in report:
            console.print()
            head = ["agent", "measures", "class", "necessary", "substitutes", "could drift without limit, unseen"]
            print_table("", head, table_rows(report), console)
        if args.output:
            console.print(f"\nwritten to {args.output}")
    return OK if report.get("observable", True) else NO
