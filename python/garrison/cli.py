"""The command `garrison`.

Exit codes: 0 fine, 1 a check failed (a condition is not met, a case misses), 2 input or usage refused, 70 a bug,
130 interrupted.
"""

import argparse
import errno
import os
import sys
import traceback
from pathlib import Path

from garrison import _core
from garrison._commands import (
    analyze,
    calibrate,
    check,
    compare,
    design,
    design_file,
    fit,
    import_,
    init,
    replay,
    run,
    structure,
    sweep,
    verify,
)
from garrison._commands import list as list_
from garrison._commands.parser import Parser
from garrison._commands.terminal import BUG, INTERRUPTED, OK, REFUSED

COMMANDS = (
    init,
    run,
    sweep,
    compare,
    check,
    analyze,
    design,
    list_,
    verify,
    fit,
    import_,
    calibrate,
    structure,
    design_file,
    replay,
)
#: environment variable that shows where a bug was met
_DEBUG = "GARRISON_DEBUG"


def _parser() -> argparse.ArgumentParser:
    parser = Parser(
        prog="garrison",
        description="A network that keeps its estimate while some of its own sensors lie.",
        epilog="Exit codes: 0 fine, 1 a check failed, 2 input refused, 70 a bug in garrison, 130 interrupted. "
        "Environment: GARRISON_MEMORY_GB, the most memory of a run (default 8); GARRISON_DEBUG=1 shows where a bug is.",
        allow_abbrev=False,
    )
    parser.add_argument("--version", action="version", version=f"garrison {_core.__version__}")
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for command in COMMANDS:
        command.add(commands)
    return parser


def main(argv: list[str] | None = None) -> int:
    """Run the command line; returns the exit code."""
    if hasattr(sys.stdout, "reconfigure"):
        sys.stdout.reconfigure(errors="replace")  # names of users on terminals that cannot show them
    try:
        args = _parser().parse_args(argv)
    except SystemExit as usage:
        return int(usage.code or 0)
    try:
        return int(args.do(args))
    except BrokenPipeError:  # the reader of our output has seen enough
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return OK
    except (_core.Error, OSError) as error:
        return _say(_one_line(error), REFUSED)
    except MemoryError:
        return _say("got a task that does not fit into this machine's memory, expected a smaller one", REFUSED)
    except KeyboardInterrupt:
        return _say("interrupted", INTERRUPTED)
    except Exception as error:
        if os.environ.get(_DEBUG):
            traceback.print_exc()
        place = traceback.extract_tb(error.__traceback__)[-1]
        what = f"{type(error).__name__}: {_one_line(error)} ({Path(place.filename).name}:{place.lineno})"
        return _say(f"this is a bug, please report it with the command and its input: {what}", BUG)


def _one_line(error: BaseException) -> str:
    if isinstance(error, OSError) and error.errno in (errno.ENOSPC, errno.EDQUOT):
        where = error.filename or "the output"
        return f"{where}: got a disk that is full, expected room for it; free some, or name another place with -o"
    if type(error).__module__ == "builtins" and isinstance(error, OSError) and error.filename is not None:
        return f"{error.filename}: got {error.strerror}, expected a file or folder that can be used"
    return " ".join(str(error).split())


def _say(text: str, code: int) -> int:
    print(f"garrison: {text}", file=sys.stderr)
    return code


if __name__ == "__main__":
    sys.exit(main())
