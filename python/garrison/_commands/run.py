"""`garrison run`: simulate or replay a scenario."""

import argparse
import json
import shutil
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.progress import BarColumn, Progress, TaskID, TextColumn, TimeRemainingColumn

from garrison import _core
from garrison._commands.terminal import OK, Commands, clean, console_for, print_json, print_table
from garrison.job import Row, run_scenario
from garrison.scenario import Scenario, read_scenario


def add(commands: Commands) -> None:
    command = commands.add_parser(
        "run", help="simulate or replay a scenario; write summary.json, estimates, report.html"
    )
    command.add_argument("scenario", help="scenario file (TOML)")
    command.add_argument("-o", "--output", required=True, help="folder to write to; must be new or empty")
    command.add_argument("--force", action="store_true", help="replace the output of an earlier run")
    command.add_argument("--npz", action="store_true", help="write all arrays as estimates.npz instead of a CSV file")
    command.add_argument("--json", action="store_true", help="print the result for machines")
    command.set_defaults(do=do)


def _output_folder(path: Path, force: bool) -> Path:
    if path.exists() and not path.is_dir():
        raise _core.IoError(f"{path}: got a file, expected a folder to write to")
    if path.exists() and any(path.iterdir()):
        if not force:
            raise _core.IoError(
                f"{path}: got a folder that is not empty; choose another one, or replace it with --force"
            )
        if not (path / "summary.json").is_file():
            raise _core.IoError(f"{path}: got a folder that no run of garrison has written, and will not replace it")
        shutil.rmtree(path)
    path.mkdir(parents=True, exist_ok=True)
    return path


def _bar(console: Console) -> Progress:
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        TextColumn("{task.percentage:>3.0f} %"),
        TimeRemainingColumn(),
    )
    return Progress(*columns, console=console, transient=True, disable=not console.is_terminal)


def _run_with_progress(scenario: Scenario, console: Console) -> list[Row]:
    with _bar(console) as bar:
        tasks: dict[str, TaskID] = {}

        def progress(label: str, done: int, total: int) -> None:
            task = tasks.setdefault(label, bar.add_task(label, total=total)) if label not in tasks else tasks[label]
            bar.update(task, completed=done)

        return run_scenario(scenario, progress)


def _write_estimates(folder: Path, scenario: Scenario, rows: list[Row], npz: bool) -> None:
    """Estimates of the main filter, attacked if there is an attack: one row per sample and agent, or .npz."""
    run = rows[0].run
    if run is None or run.estimate is None:
        return
    if npz or run.estimate.size > 2_000_000:
        run.save(folder / "estimates.npz")
        return
    trials, times, agents, n = run.estimate.shape
    index = np.indices((trials, times, agents)).reshape(3, -1).T
    columns = [index, run.estimate.reshape(-1, n)]
    head = ["trial", "time", "agent", *(f"x{k}" for k in range(n))]
    if run.bound is not None:
        columns.append(run.bound.reshape(-1, 1))
        head.append("bound")
    formats = ["%d"] * 3 + ["%.9g"] * (len(head) - 3)
    np.savetxt(
        folder / "estimates.csv",
        np.column_stack(columns),
        fmt=formats,
        delimiter=",",
        header=",".join(head),
        comments="",
    )


def do(args: argparse.Namespace) -> int:
    from garrison.job import signal_size
    from garrison.plots import overview_figure
    from garrison.report import table_rows, write_report

    console = console_for(stderr=args.json)
    scenario = read_scenario(args.scenario)
    folder = _output_folder(Path(args.output), args.force)
    rows = _run_with_progress(scenario, console)
    summary = {
        "title": scenario.title,
        "version": _core.__version__,
        "scenario": scenario.path.name,
        "agents": scenario.model.agents,
        "states": scenario.model.states,
        "samples": scenario.steps,
        "rows": [row.summary(scenario) for row in rows],
    }
    (folder / "summary.json").write_text(json.dumps(clean(summary), indent=1), encoding="utf-8")
    _write_estimates(folder, scenario, rows, args.npz)
    write_report(folder / "report.html", scenario, rows)
    overview_figure(scenario, rows, signal_size(scenario)).savefig(folder / "overview.png", dpi=110)
    if args.json:
        print_json(summary)
    else:
        head, cells = table_rows(scenario, rows)
        print_table(scenario.title, head, cells, console)
        console.print(
            f"\nwritten to {folder}: report.html (open it in a browser), overview.png, summary.json, estimates"
        )
    return OK
