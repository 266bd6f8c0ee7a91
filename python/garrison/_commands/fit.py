"""`garrison fit`: identify a model from records."""

import argparse
import datetime as dt

import numpy as np

from garrison import _core
from garrison._commands.terminal import OK, Commands, console_for, new_file, print_table
from garrison.fitting import fit, read_records


def add(commands: Commands) -> None:
    command = commands.add_parser("fit", help="identify a model from clean daily records (CSV: date,STATION,...)")
    command.add_argument("records", help="CSV file")
    command.add_argument("--from", dest="start", help="first day, YYYY-MM-DD")
    command.add_argument("--to", dest="end", help="last day, YYYY-MM-DD")
    command.add_argument("--factors", type=int, default=2, help="common factors that become the state (default 2)")
    command.add_argument("--harmonics", type=int, default=2, help="of the seasonal cycle (default 2)")
    command.add_argument("--period", type=float, default=365.25, help="of the cycle, in samples (default 365.25)")
    command.add_argument("--root", action="store_true", help="work on the square root of the records")
    command.add_argument("--factor", type=float, default=1.0, help="unit conversion (default 1)")
    command.add_argument("-o", "--output", help="model file to write (JSON); default: standard output")
    command.add_argument("--force", action="store_true", help="replace an existing model file")
    command.add_argument("--json", action="store_true", help="print the result for machines")
    command.set_defaults(do=do)


def do(args: argparse.Namespace) -> int:
    def day(text: str | None) -> dt.date | None:
        try:
            return dt.date.fromisoformat(text) if text else None
        except ValueError:
            raise _core.InvalidInput(f"got the date {text!r}, expected YYYY-MM-DD") from None

    records = read_records(args.records).between(day(args.start), day(args.end))
    found = fit(
        records,
        factors=args.factors,
        harmonics=args.harmonics,
        period=args.period,
        root=args.root,
        factor=args.factor,
    )
    text = found.to_json()
    if args.output:
        target = new_file(args.output, args.force)
        target.write_text(text + "\n", encoding="utf-8")
    if args.json or not args.output:
        print(text)
        return OK
    i = found.identified
    console = console_for()
    console.print(
        f"{len(records.dates)} records, {records.dates[0]} to {records.dates[-1]}, {len(records.stations)} stations"
    )
    console.print(f"factors carry {', '.join(f'{s:.1%}' for s in i.share)} of the variance around the season")
    console.print(f"A = {np.asarray(i.A).round(4).tolist()}, ||w|| <= {i.process_bound:.4g}")
    rows = [
        [name, *(f"{v:.3f}" for v in row), f"{bound:.3f}", f"{variance**0.5:.3f}"]
        for name, row, bound, variance in zip(
            records.stations, np.asarray(i.C), i.measurement_bound, i.measurement_variance, strict=True
        )
    ]
    head = ["station", *(f"C{k}" for k in range(found.model.states)), "|v| <=", "std of v"]
    print_table("", head, rows, console)
    console.print(f"written to {args.output}")
    return OK
