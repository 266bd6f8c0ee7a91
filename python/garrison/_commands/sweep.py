"""`garrison sweep`: a scenario over a grid of values and many trials."""

import argparse
import shlex
import sys
from pathlib import Path
from typing import Any

from garrison import _core
from garrison._commands.output import write_picture
from garrison._commands.terminal import (
    INTERRUPTED,
    NO,
    OK,
    REFUSED,
    Commands,
    console_for,
    in_options,
    print_json,
    print_table,
    whole_number,
)
from garrison.scenario import read_document
from garrison.sweeps import Sweep, parsed, points_of, sweep
from garrison.sweeps.grid import read_points
from garrison.sweeps.pool import cluster
from garrison.sweeps.run import timed
from garrison.words import count, refusal

_MOST_ROWS = 60
#: bytes of a row of trials.csv, about
_ROW = 300


def add(commands: Commands) -> None:
    """Declare the command."""
    command = commands.add_parser(
        "sweep",
        help="run a scenario over a grid of values, with many trials; write tables and pictures; exit 1 if a point is "
        "refused or lost",
        allow_abbrev=False,
    )
    command.add_argument("scenario", help="scenario file (TOML)")
    command.add_argument(
        "--set",
        action="append",
        default=[],
        metavar="KEY=VALUES",
        help="values of a key: 1,5,25, or a:b:n (n values from a to b, evenly), or log:a:b:n (by equal factors); may "
        "be repeated for other keys",
    )
    command.add_argument("--points", metavar="FILE", help="CSV file with a row per point, in place of --set")
    command.add_argument("--trials", type=whole_number, default=1, help="trials of every point (default 1)")
    command.add_argument("-o", "--output", required=True, help="folder to write to; a part of the same sweep is kept")
    command.add_argument("--workers", type=whole_number, default=1, help="processes on this machine (default 1)")
    command.add_argument(
        "--scheduler", metavar="ADDRESS", help="address of a running Dask scheduler, e.g. tcp://host:8786"
    )
    command.add_argument("--scheduler-file", metavar="FILE", help="file that a running Dask scheduler wrote")
    command.add_argument(
        "--block", type=whole_number, help="trials of a task (default: so many that one lasts some seconds)"
    )
    command.add_argument("--independent", action="store_true", help="other noise at every point; default: the same")
    command.add_argument("--dry-run", action="store_true", help="print points, trials, seconds and bytes; run nothing")
    command.add_argument("--json", action="store_true", help="print the table of points as JSON")
    command.set_defaults(do=do)


def do(args: argparse.Namespace) -> int:
    """Run the command."""
    if args.points and args.set:
        raise refusal("--points", "both --points and --set", "one of them")
    pairs = [parsed(text) for text in args.set]
    twice = [key for k, (key, _) in enumerate(pairs) if key in [other for other, _ in pairs[:k]]]
    if twice:
        raise refusal("--set", f"{twice[0]} twice", "every key once")
    points = read_points(args.points) if args.points else points_of(dict(pairs))
    if args.dry_run:
        return _dry(args, points)
    try:
        found = sweep(
            args.scenario,
            points=points,
            trials=args.trials,
            out=args.output,
            workers=args.workers,
            client=cluster(args.scheduler, args.scheduler_file),
            block=args.block,
            independent=args.independent,
            progress=_tell if sys.stderr.isatty() else None,
        )
    except _core.InvalidInput as error:
        raise in_options(error, {"out": "-o"}) from None
    except KeyboardInterrupt:
        again = shlex.join(["garrison", *sys.argv[1:]])
        print(f"\ngarrison: interrupted; what is done is kept, go on with: {again}", file=sys.stderr)
        return INTERRUPTED
    pictures = _pictures(found)
    _print(found, args, pictures)
    if found.trials and all(str(row["status"]).startswith("refused") for row in found.trials):
        return REFUSED
    return NO if found.refused or found.lost else OK


def _tell(done: int, total: int) -> None:
    end = "\n" if done >= total else ""
    print(f"\r\033[K{done} of {count(total, 'task')}", end=end, file=sys.stderr, flush=True)


def _dry(args: argparse.Namespace, points: list[dict[str, Any]]) -> int:
    path = Path(args.scenario).absolute()
    document = read_document(path)
    per_trial = timed(path, points, [f"dry{k}" for k in range(len(points))])
    attacked = 2 if document.get("attack") else 1
    rows = len(points) * args.trials * attacked * (1 + len(document.get("compare", [])))
    facts = {
        "points": len(points),
        "trials": len(points) * args.trials,
        "seconds": round(per_trial * len(points) * args.trials / max(args.workers, 1), 1),
        "bytes": rows * _ROW,
    }
    if args.json:
        print_json(facts)
    else:
        words = "about {seconds} s on {workers}, tables of about {bytes} bytes".format(
            seconds=facts["seconds"], workers=count(max(args.workers, 1), "worker"), bytes=facts["bytes"]
        )
        print(f"{count(len(points), 'point')}, {count(facts['trials'], 'trial')} in all: {words}")
    return OK


def _pictures(found: Sweep) -> list[str]:
    if len(found.keys) not in (1, 2) or all(row["status"] != "ok" for row in found.trials):
        return []
    write_picture(found.folder / "sweep.png", found.plot())
    return ["sweep.png"]


def _print(found: Sweep, args: argparse.Namespace, pictures: list[str]) -> None:
    if args.json:
        print_json({"points": found.points, "refused": found.refused, "lost": found.lost})
    else:
        keys = [
            "filter",
            "attacked",
            "trials",
            "mean_error_median",
            "mean_error_q95",
            "worst_error_q95",
            "inside_bound",
        ]
        head = [*found.keys, *(key.replace("_", " ") for key in keys)]
        rows = [[_cell(row.get(key, "")) for key in (*found.keys, *keys)] for row in found.points]
        print_table(found.title, head, rows[:_MOST_ROWS], console_for())
        if len(rows) > _MOST_ROWS:
            print(f"... and {len(rows) - _MOST_ROWS} more in points.csv")
    for line in (*found.refused, *found.lost):
        print(f"warning: {line}", file=sys.stderr)
    files = ", ".join(["trials.csv", "points.csv", *pictures])
    print(f"written to {args.output}: {files}", file=sys.stderr if args.json else sys.stdout)


def _cell(value: Any) -> str:
    if isinstance(value, str) and value in ("True", "False"):
        return "yes" if value == "True" else "no"
    return f"{value:.4g}" if isinstance(value, float) else str(value)
