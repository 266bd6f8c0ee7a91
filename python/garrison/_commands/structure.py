"""`garrison structure`: who is indispensable."""

import argparse

from garrison._commands.terminal import NO, OK, Commands, console_for, new_file, print_json, print_table


def add(commands: Commands) -> None:
    command = commands.add_parser(
        "structure", help="who is indispensable: classes, necessary sensors, substitutes; exit 1 if not observable"
    )
    command.add_argument("source", help="scenario file (TOML), or a CSV file with the matrix A")
    command.add_argument(
        "--measured", type=int, nargs="*", metavar="STATE", help="with a CSV file: the state of each sensor, from 0"
    )
    command.add_argument("-o", "--output", help="picture to write (.png, .svg, .pdf)")
    command.add_argument("--force", action="store_true", help="replace an existing picture")
    command.add_argument("--json", action="store_true", help="print the result for machines")
    command.set_defaults(do=do)


def do(args: argparse.Namespace) -> int:
    from garrison.sensors import anatomy_figure, read_anatomy, states_text, table_rows

    anatomy = read_anatomy(args.source, args.measured)
    report = anatomy.report()
    if args.output:
        target = new_file(args.output, args.force)
        anatomy_figure(anatomy).savefig(target, dpi=120)
    if args.json:
        print_json(report)
    else:
        console = console_for()
        contractions = "; ".join(states_text(c) for c in report["contractions"]) or "none"
        parents = "; ".join(states_text(c) for c in report["parent_components"][:20])
        facts = [
            ["states", str(report["states"])],
            ["structural rank", str(report["structural_rank"])],
            ["contractions (overlapping ones joined)", contractions],
            [f"parent components ({len(report['parent_components'])})", parents],
        ]
        if "observable" in report:
            unstable = len(report["unstable_modes_nobody_sees"])
            facts += [
                ["structurally observable", "yes" if report["observable"] else "no"],
                ["every state reaches a sensor", "yes" if report["output_connected"] else "no"],
                ["rank of [A; C] is full", "yes" if report["rank_condition"] else "no"],
                ["unstable modes that nobody sees", str(unstable)],
            ]
        print_table(anatomy.title, ["structure", ""], facts, console)
        if "agents" in report:
            console.print()
            head = ["agent", "measures", "class", "necessary", "substitutes", "could lie unseen"]
            print_table("", head, table_rows(report), console)
        if args.output:
            console.print(f"\nwritten to {args.output}")
    return OK if report.get("observable", True) else NO
