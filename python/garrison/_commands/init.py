"""`garrison init`: a scenario to start from."""

import argparse

from garrison._commands.output import new_file
from garrison._commands.template import TEMPLATE
from garrison._commands.terminal import OK, Commands
from garrison.paths import whole_file


def add(commands: Commands) -> None:
    """Declare the command."""
    command = commands.add_parser("init", help="write a scenario with comments, to start from", allow_abbrev=False)
    command.add_argument("scenario", nargs="?", default="scenario.toml", help="file to write (default scenario.toml)")
    command.add_argument("--force", action="store_true", help="replace the file if there is one")
    command.set_defaults(do=do)


def do(args: argparse.Namespace) -> int:
    """Run the command."""
    path = new_file(args.scenario, args.force)
    with whole_file(path) as temporary:
        temporary.write_text(TEMPLATE.replace("FILE", path.name), encoding="utf-8")
    print(f"written: {path}; next: garrison run {path} -o out")
    return OK
