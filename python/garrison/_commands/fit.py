"""`garrison fit`: identify a model from records."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING, Any

import numpy as np

from garrison._commands.output import new_file
from garrison._commands.terminal import OK, Commands, console_for, number, print_table, print_warnings, whole_number
from garrison.fitting import FAILURE, Fit
from garrison.fitting_full import FullFit
from garrison.identifying import fit
from garrison.paths import whole_file
from garrison.scenario.section import moment
from garrison.tables import read_records
from garrison.words import count, refusal, shown

if TYPE_CHECKING:
    from rich.console import Console


def add(commands: Commands) -> None:
    """Declare the command."""
    command = commands.add_parser(
        "fit", help="identify a model from clean regular records (CSV: date,STATION,...)", allow_abbrev=False
    )
    command.add_argument("records", help="CSV file")
    command.add_argument(
        "--from", dest="start", help="first record: YYYY-MM-DD, with a time, a month, a year, or seconds"
    )
    command.add_argument("--to", dest="end", help="last record, included")
    command.add_argument(
        "--states",
        choices=("factors", "all"),
        default="factors",
        help="factors: what all stations have in common (default); all: every station, with samples of its past",
    )
    command.add_argument("--factors", type=whole_number, help="number of common factors (default 2)")
    command.add_argument(
        "--order", type=whole_number, help="with --states all: samples of the past (default: the likeliest, up to 4)"
    )
    command.add_argument(
        "--input",
        action="append",
        dest="inputs",
        metavar="COLUMN",
        help="with --states all: a column of the records that is a known input; may be repeated",
    )
    command.add_argument(
        "--harmonics", type=whole_number, default=2, help="number of harmonics of the seasonal cycle (default 2)"
    )
    command.add_argument("--period", type=number, help="length of the cycle in samples (default: a year)")
    command.add_argument("--root", action="store_true", help="work on the square root of the records")
    command.add_argument(
        "--scale",
        type=number,
        default=1.0,
        help="multiply the records by this number, to convert units (default 1); in scenarios and gr.fit: factor",
    )
    command.add_argument(
        "--standardise",
        action=argparse.BooleanOptionalAction,
        help="take every column in units of its own spread; --no-standardise: all columns have one unit (default: "
        "standardise where the header names different units)",
    )
    command.add_argument(
        "--attacked",
        type=whole_number,
        help="also store levels for certificates with so many stations attacked, and wider bounds",
    )
    command.add_argument(
        "--failure", type=number, help="rate at which clean records exceed these levels (default 1e-3)"
    )
    command.add_argument("-o", "--output", help="model file to write (JSON); default: standard output")
    command.add_argument("--force", action="store_true", help="replace an existing model file")
    command.add_argument("--json", action="store_true", help="print JSON")
    command.set_defaults(do=do)


def do(args: argparse.Namespace) -> int:
    """Run the command."""
    _require_options(args)
    start = moment("--from", args.start) if args.start is not None else None
    end = moment("--to", args.end, last=True) if args.end is not None else None
    records = read_records(args.records).between(start, end)
    print_warnings(records.notes, stderr=True)  # first: what is wrong with records may end the fit
    found = fit(records, **_options(args))
    if args.attacked is not None and found.levels(args.attacked, args.failure or FAILURE) is None:
        print_warnings([f"no levels for certificates: {_without_levels(found, args)}"], stderr=True)
    text = found.to_json(args.attacked, args.failure or FAILURE)
    if args.output:
        with whole_file(new_file(args.output, args.force)) as temporary:
            temporary.write_text(text + "\n", encoding="utf-8")
    if args.json or not args.output:
        print(text)
        return OK
    console = console_for()
    console.print(
        f"{len(records.dates)} records, {records.dates[0]} to {records.dates[-1]}, "
        f"{count(len(found.records.stations), 'station')}"
    )
    if isinstance(found, FullFit):
        _show_full(found, console)
    else:
        _show_factors(found, console)
    console.print(str(found.whiteness()))
    console.print(f"written to {args.output}")
    return OK


def _without_levels(found: Fit, args: argparse.Namespace) -> str:
    """Why there are no levels."""
    if found.model.states > 1:
        return f"the model has {found.model.states} states, and they exist for --factors 1 alone"
    complete = int(np.isfinite(found.measurements(found.records)).all(axis=1).sum())
    rate = args.failure or FAILURE
    return f"{count(complete, 'complete record')}, and a rate of {rate:g} takes {2 / rate - 1:.0f}: raise --failure"


def _options(args: argparse.Namespace) -> dict[str, Any]:
    """What was given, by the names of `garrison.fit`."""
    given = {
        "states": args.states,
        "factors": args.factors,
        "order": args.order,
        "inputs": args.inputs,
        "period": args.period,
        "standardise": args.standardise,
    }
    options = {key: value for key, value in given.items() if value is not None}
    return {**options, "harmonics": args.harmonics, "root": args.root, "factor": args.scale}


def _show_factors(found: Fit, console: Console) -> None:
    i = found.identified
    if i.options.standardise:
        console.print("every column is taken in units of its own spread")
    console.print(f"factors carry {', '.join(f'{s:.1%}' for s in i.share)} of the variance around the season")
    console.print(f"A = {np.asarray(i.A).round(4).tolist()}, ||w|| <= {i.process_bound:.4g}")
    rows = [
        [name, *(f"{v:.3f}" for v in row), f"{bound:.3f}", f"{variance**0.5:.3f}"]
        for name, row, bound, variance in zip(
            found.records.stations, np.asarray(i.C), i.measurement_bound, i.measurement_variance, strict=True
        )
    ]
    head = ["station", *(f"C{k}" for k in range(found.model.states)), "|v| <=", "std of v"]
    print_table("", head, rows, console)


def _show_full(found: FullFit, console: Console) -> None:
    """Per station: the spread around the season, and what the model leaves of it one sample ahead."""
    order = found.autoregression.order
    past = "1 sample" if order == 1 else f"{order} samples"
    console.print(f"a vector autoregression with {past} of the past; ||w|| <= {found.identified.process_bound:.4g}")
    spread = np.nanstd(found.measurements(found.records), axis=0)
    left = np.nanstd(np.asarray(found.autoregression.residuals), axis=0)
    stations = found.records.stations
    rows = [[name, f"{a:.3f}", f"{b:.3f}"] for name, a, b in zip(stations, spread, left, strict=True)]
    print_table("", ["station", "std", "residual std"], rows, console)


def _require_options(args: argparse.Namespace) -> None:
    """Refuse what the records need not be read for, by the names of the command line."""
    if not 0.0 < args.scale < np.inf:
        raise refusal("--scale", f"{args.scale:g}", "a finite number > 0", "it multiplies all records")
    if args.states == "all" and args.factors is not None:
        raise refusal("--factors", f"{args.factors} beside --states all", "one of them", "there are no factors then")
    if args.states == "all" and args.standardise is not None:
        raise refusal("--standardise", "--states all beside it", "one of them", "units of stations do not matter then")
    for option, value in (("--order", args.order), ("--input", args.inputs)):
        if args.states == "factors" and value is not None:
            raise refusal(option, shown(value), "--states all beside it")
    if args.states == "all" and args.attacked is not None:
        raise refusal("--attacked", f"{args.attacked} beside --states all", "--factors 1", "levels exist for one state")
    if args.failure is None:
        return
    if args.attacked is None:
        raise refusal("--failure", f"{args.failure:g} without --attacked", "both", "it is a rate of the levels")
    if not 0.0 < args.failure < 1.0:
        raise refusal("--failure", f"{args.failure:g}", "a rate in (0, 1)")
