"""The command `garrison`.

Exit codes: 0 fine, 1 the answer is no (a condition fails, a case misses), 2 bad input or usage, 130 interrupted.
"""

import argparse
import sys

from garrison import _core
from garrison._commands import check, fit, run, structure, verify
from garrison._commands import list as list_
from garrison._commands.terminal import BAD

COMMANDS = (run, check, list_, verify, fit, structure)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="garrison",
        description="A network that keeps its estimate while some of its own sensors lie.",
        epilog="Exit codes: 0 fine, 1 the answer is no (condition fails, case misses), 2 bad input, 130 interrupted.",
    )
    parser.add_argument("--version", action="version", version=f"garrison {_core.__version__}")
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for command in COMMANDS:
        command.add(commands)
    return parser


def main(argv: list[str] | None = None) -> int:
    """Run the command line; returns the exit code."""
    args = _parser().parse_args(argv)
    try:
        return int(args.do(args))
    except (_core.Error, OSError) as error:
        print(f"garrison: {error}", file=sys.stderr)
        return BAD
    except KeyboardInterrupt:
        print("garrison: interrupted", file=sys.stderr)
        return 130


if __name__ == "__main__":
    sys.exit(main())
