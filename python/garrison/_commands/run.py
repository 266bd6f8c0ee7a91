"""`garrison run`: simulate or replay a scenario."""

from __future__ import annotations

import argparse
import csv
import json
import re
import sys
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from garrison import _core
from garrison._commands.output import output_folder
from garrison._commands.setting import add_set, settings
from garrison._commands.terminal import OK, Commands, clean, console_for, print_json, print_table, print_warnings
from garrison.bound_kind import BoundKind
from garrison.jobs import Row, run_scenario, signal_size
from garrison.longform import state_columns
from garrison.report import table_rows
from garrison.report.table import error_note, warnings_of
from garrison.scenario import Scenario, read_scenario
from garrison.words import refusal

if TYPE_CHECKING:
    from rich.console import Console

#: numbers in estimates.csv; more are written as .npz
_MOST_NUMBERS = 2_000_000


def add(commands: Commands) -> None:
    """Declare the command."""
    command = commands.add_parser(
        "run",
        help="simulate or replay a scenario; with -o write summary.json, estimates, report.html",
        allow_abbrev=False,
    )
    command.add_argument("scenario", help="scenario file (TOML)")
    command.add_argument(
        "-o", "--output", help="folder to write to; must be new or empty (left out: the results are printed alone)"
    )
    add_set(command)
    command.add_argument("--force", action="store_true", help="replace the output of an earlier run")
    command.add_argument("--npz", action="store_true", help="write the whole main run (Run.load) instead of a CSV file")
    command.add_argument("--all-estimates", action="store_true", help="write the estimates of all filters, not of one")
    command.add_argument("--no-conditions", action="store_true", help="do not evaluate the filters' conditions first")
    command.add_argument("--json", action="store_true", help="print JSON")
    command.set_defaults(do=do)


def do(args: argparse.Namespace) -> int:
    """Run the command."""
    _require_output(args)
    given = settings(args.set)
    scenario = read_scenario(args.scenario, given)
    console = console_for(stderr=args.json)
    doubt: Exception | None = None
    where = "nothing was written; -o FOLDER keeps summary, estimates, pictures and a report"
    if args.output is None:
        rows = _run_with_progress(scenario, console, args)
        summary = _summary(scenario, rows, given)
    else:
        with output_folder(Path(args.output), args.force) as folder:
            rows = _run_with_progress(scenario, console, args)
            summary = _summary(scenario, rows, given)
            doubt = _write(folder, scenario, rows, summary, args)
            written = sorted(p.name for p in folder.iterdir())
        where = f"written to {args.output}: {', '.join(written)}"
    if args.json:
        print_json(summary)
    else:
        head, cells = table_rows(scenario, rows)
        print_table(scenario.title, head, cells, console)
        print(f"\n{error_note(scenario)}".rstrip())
    print_warnings(warnings_of(scenario, rows), stderr=args.json)
    print(where, file=sys.stderr if args.json else sys.stdout)
    if isinstance(doubt, _core.Error):
        print_warnings([f"no report and no picture: {doubt}"], stderr=args.json)
    elif doubt is not None:
        raise doubt
    return OK


def _require_output(args: argparse.Namespace) -> None:
    """Refuse options that say how to write, without where."""
    if args.output == "":
        raise refusal("-o", '""', "the folder to write to")
    for option in ("force", "npz", "all_estimates"):
        if args.output is None and getattr(args, option):
            raise refusal("-o", f"nothing, with --{option.replace('_', '-')}", "the folder to write to")


def _write(
    folder: Path, scenario: Scenario, rows: list[Row], summary: dict[str, Any], args: argparse.Namespace
) -> Exception | None:
    """Everything that a run leaves behind; what kept its pictures from being drawn."""
    (folder / "summary.json").write_text(json.dumps(clean(summary), indent=1), encoding="utf-8")
    for name, row in _estimate_names(rows if args.all_estimates else rows[:1]).items():
        _write_estimates(folder / name, scenario, row, args.npz)
    try:
        _write_pictures(folder, scenario, rows)
    except Exception as error:  # what is computed is kept whatever happens to its pictures
        return error
    return None


def _summary(scenario: Scenario, rows: list[Row], given: dict[str, Any]) -> dict[str, Any]:
    made = {"set": given} if given else {}
    return made | {
        "title": scenario.title,
        "version": _core.__version__,
        "scenario": scenario.path.name,
        "agents": scenario.model.agents,
        "states": scenario.model.states,
        "samples": scenario.steps,
        "errors": error_note(scenario),
        "notes": scenario.notes,
        "rows": [row.summary for row in rows],
    }


def _run_with_progress(scenario: Scenario, console: Console, args: argparse.Namespace) -> list[Row]:
    from rich.progress import BarColumn, Progress, TaskID, TextColumn, TimeRemainingColumn

    columns = (
        TextColumn("{task.description}", markup=False),
        BarColumn(),
        TextColumn("{task.percentage:>3.0f} %", markup=False),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as bar:
        tasks: dict[str, TaskID] = {}

        def progress(label: str, done: int, total: int) -> None:
            if label not in tasks:
                tasks[label] = bar.add_task(label, total=total)
            bar.update(tasks[label], completed=done)
            bar.update(designs, visible=False)

        designs = bar.add_task("", total=None, visible=False)

        def working(label: str, seconds: float) -> None:
            bar.update(designs, description=f"{label}, {seconds:.0f} s", visible=True)

        return run_scenario(scenario, progress, not args.no_conditions, working, whole=args.all_estimates)


def _estimate_names(rows: list[Row]) -> dict[str, Row]:
    """Name of the file of each row, without its ending: `estimates` for the main filter."""
    names = ["estimates"]
    for k, row in enumerate(rows[1:], start=2):
        label = re.sub(r"[^A-Za-z0-9]+", "_", row.label).strip("_").lower()
        names.append(f"estimates_{k}_{label}{'_attacked' if row.attacked else ''}")
    return dict(zip(names, rows, strict=True))


def _write_estimates(path: Path, scenario: Scenario, row: Row, npz: bool) -> None:
    """Estimates of one filter: one line per sample and agent (.csv), or the run itself (.npz)."""
    run = row.run
    if run is None or run.estimate is None:
        return
    if npz or run.estimate.size > _MOST_NUMBERS:
        run.save(path.with_name(f"{path.name}.npz"))
        return
    trials, times, agents, n = run.estimate.shape
    trial, time, agent = (axis.ravel() for axis in np.indices((trials, times, agents)))
    numbers = [run.estimate.reshape(-1, n)]
    named = "states" in run.model.__getstate__()
    head = ["trial", "time", "agent", *(state_columns(run) if named else (f"x{k}" for k in range(n)))]
    if run.bound is not None:
        numbers.append(run.bound.reshape(-1, 1))
        head.append("bound")
    kinds = run.bound_kind
    names = [scenario.names[a] for a in agent]
    first: list[Any] = [trial.tolist(), time.tolist(), names]
    if scenario.dates:  # sample 1 is the first record
        head.insert(2, "date")
        dates = ["", *(str(d) for d in scenario.dates)]
        offset = len(dates) - times
        first.insert(2, [dates[t + offset] for t in time])
    words = [] if kinds is None else [[BoundKind(int(k)).word] for k in kinds.ravel()]
    head += ["bound_kind"] if words else []
    with path.with_name(f"{path.name}.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(head)
        for k, (*keys, values) in enumerate(zip(*first, np.column_stack(numbers), strict=True)):
            writer.writerow([*keys, *(f"{v:.9g}" for v in values), *(words[k] if words else [])])


def _write_pictures(folder: Path, scenario: Scenario, rows: list[Row]) -> None:
    from garrison.figures import overview_figure
    from garrison.report.page import write_report

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of the drawing library, on numbers and labels that do not fit its axes
        write_report(folder / "report.html", scenario, rows)
        overview_figure(scenario, rows, signal_size(scenario)).savefig(folder / "overview.png", dpi=110)
