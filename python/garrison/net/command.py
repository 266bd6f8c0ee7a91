"""The command `garrison-net`: a network of real daemons on this machine."""

import argparse
import sys
import tempfile
import time
from pathlib import Path

from garrison import _core
from garrison._commands.terminal import NO, OK, REFUSED, count_number, number, port_number
from garrison.net.accept import ROWS
from garrison.net.accept.daemons import ATTACK
from garrison.net.accept.load import Load
from garrison.net.accept.plans import band, carried_out
from garrison.net.outcome import write_summary
from garrison.net.plan import Plan, read_plan
from garrison.net.programs import is_there
from garrison.net.running import carry_out
from garrison.net.shown import show
from garrison.net.soak import WEATHER, Soak
from garrison.words import count, near, refusal

#: seconds of a row where all are measured
_SHORT = 30.0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="garrison-net",
        description="Networks of real daemons on this machine (127.0.0.1 only).",
        epilog="Exit codes: 0 everything held, 1 something did not, 2 input refused.",
        allow_abbrev=False,
    )
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    up = commands.add_parser("up", help="run a scenario as a network of daemons, and check it", allow_abbrev=False)
    up.add_argument("file", help="network.toml: a scenario, periods, what the network loses")
    up.add_argument("-o", "--out", help="folder for keys, logs and summary.json; default: a temporary one, removed")
    up.add_argument(
        "--page", type=port_number, metavar="PORT", help="serve a live page on this port of 127.0.0.1; 0 = any"
    )
    up.add_argument(
        "--attack",
        action="store_true",
        help="with somebody in between who has no key: replays, mutants and forgeries, each for a fifth of the "
        "datagrams, and a flood of 5000 a second",
    )
    up.add_argument("--kills", type=count_number, default=0, help="kill a daemon, and start it again, so many times")
    up.add_argument(
        "--liar", metavar="NAME", help="this agent's daemon lies to some neighbours, with its keys; see docs/node.md"
    )
    up.add_argument("--programs", help="folder of garrison-node, garrison-keygen and garrison-relay")
    soak = commands.add_parser(
        "soak", help="ten daemons for hours, with loss and power cuts: nothing grows", allow_abbrev=False
    )
    soak.add_argument("--seconds", type=number, default=600.0, help="how long, 30..86400 (default 600)")
    soak.add_argument("--programs", help="folder of the node's programs")
    accept = commands.add_parser(
        "accept", help="measure what a network of daemons has to meet, row by row", allow_abbrev=False
    )
    names = ", ".join(row.name for row in ROWS)
    accept.add_argument("row", nargs="*", help=f"some of {names}, in full length; default: all, 30 s each at most")
    accept.add_argument("--list", action="store_true", help="print the rows with their bars and full lengths, and end")
    accept.add_argument("--seconds", type=number, help="another length, for rows that have one")
    accept.add_argument("--programs", help="folder of the node's programs")
    return parser


def main(argv: list[str] | None = None) -> int:
    """Run the command line; returns the exit code."""
    try:
        args = _parser().parse_args(argv)
    except SystemExit as usage:
        return int(usage.code or 0)
    try:
        if args.command == "accept":
            return _accept(args)
        if args.command == "soak":
            return _soak(args)
        plan = read_plan(args.file)
        plan.relay |= ATTACK if args.attack else {}
        plan.state_every_s = 1.0 if args.kills else plan.state_every_s
        plan.liar = None if args.liar is None else _named(plan, args.liar)
        if args.out is not None:
            return _up(plan, _empty(Path(args.out)), args)
        with tempfile.TemporaryDirectory(prefix="garrison-net-") as folder:
            return _up(plan, Path(folder), args)
    except (_core.Error, OSError) as error:
        print(f"garrison-net: {' '.join(str(error).split())}", file=sys.stderr)
        return REFUSED
    except KeyboardInterrupt:
        return 130


def _soak(args: argparse.Namespace) -> int:
    if not 30 <= args.seconds <= 86400:
        raise refusal("--seconds", f"{args.seconds:g}", "a number in 30..86400")
    plan = band(10, 5, 50.0, args.seconds)
    plan.relay |= WEATHER
    plan.state_every_s = 1.0
    soak = Soak(plan, time.time() + args.seconds)
    outcome = carried_out(plan, args.programs, meanwhile=soak)
    outcome.broken += soak.broken()
    show(plan, outcome)
    print(f"soak: {soak.cuts} power cuts; the node that grew most grew by {soak.growth()} bytes")
    return NO if outcome.broken else OK


def _named(plan: Plan, name: str) -> int:
    names = plan.scenario.names
    if name not in names:
        raise refusal("--liar", repr(name), f"one of {', '.join(names)}", near(name, names))
    return names.index(name)


def _up(plan: Plan, folder: Path, args: argparse.Namespace) -> int:
    outcome = carry_out(plan, folder, programs=args.programs, page=args.page, kills=args.kills, say=_say)
    write_summary(outcome, folder / "summary.json")
    show(plan, outcome)
    return NO if outcome.broken else OK


def _accept(args: argparse.Namespace) -> int:
    if args.list:
        return _list()
    known = {row.name: row for row in ROWS}
    for name in args.row:
        if name not in known:
            raise refusal("accept", repr(name), f"one of {', '.join(known)}", near(name, known))
    if args.seconds is not None and not 2 <= args.seconds <= 3600:
        raise refusal("--seconds", f"{args.seconds:g}", "a number in 2..3600")
    missed = 0
    for row in [known[name] for name in args.row] or ROWS:
        if not args.row and not is_there(row.needs, args.programs):
            _say(f"left out  {row.name}: {row.needs} is not installed; it is a program of the tests")
            continue
        seconds = args.seconds or (row.seconds if args.row else min(row.seconds, _SHORT))
        load = Load()
        measured = row.run(seconds, args.programs)
        missed += not measured.met
        _say(f"{'met ' if measured.met else 'MISS'}  {row.name}: {row.bar}\n      {measured.text}")
        if words := load.words():
            _say(f"      {words}")
    _say("all met" if not missed else f"{count(missed, 'row')} missed")
    return NO if missed else OK


def _list() -> int:
    for row in ROWS:
        _say(f"{row.name:13} {f'{row.seconds:g} s' if row.seconds else '':>7}  {row.bar}")
    return OK


def _say(text: str) -> None:
    print(text, flush=True)


def _empty(path: Path) -> Path:
    path.mkdir(parents=True, exist_ok=True)
    if any(path.iterdir()):
        raise _core.IoError(f"{path}: got a folder that is not empty, expected a new or an empty one")
    return path
