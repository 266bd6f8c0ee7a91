"""`garrison replay`: do again what the logs of nodes say."""

import argparse
from pathlib import Path

from garrison import _core
from garrison._commands.terminal import NO, OK, Commands, console_for, print_json, print_table
from garrison.files import contents


def add(commands: Commands) -> None:
    """Declare the command."""
    command = commands.add_parser(
        "replay",
        help="do again what the logs of nodes say, and compare every bit; exit 1 on a miss",
        allow_abbrev=False,
    )
    command.add_argument("log", nargs="+", help="an .mcap file that garrison-node wrote")
    command.add_argument("--json", action="store_true", help="print JSON")
    command.set_defaults(do=do)


def do(args: argparse.Namespace) -> int:
    """Run the command."""
    found = [{"log": name, **_replayed(Path(name))} for name in args.log]
    if args.json:
        print_json(found)
    else:
        head = ["log", "agent", "filter", "calls", "samples", "estimates", "differ", "the node"]
        rows = [
            [
                str(one["log"]),
                str(one["agent"]),
                str(one["family"]),
                str(one["calls"]),
                f"{one['first']}..{one['last']}",
                str(one["estimates"]),
                str(one["differ"]),
                "was stopped" if one["ended"] else "was killed, runs, or had no room",
            ]
            for one in found
        ]
        print_table("", head, rows, console_for())
    return NO if any(one["differ"] for one in found) else OK


def _replayed(path: Path) -> dict[str, object]:
    try:
        return dict(_core.replay_log(contents(path)))
    except _core.InvalidInput as error:
        raise _core.InvalidInput(f"{path}: {error}") from None
