"""The command `garrison`.

Exit codes: 0 fine, 1 the answer is no (a condition fails, a case misses), 2 bad input or usage, 130 interrupted.
"""

import argparse
import json
import math
import shutil
import sys
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console
from rich.progress import BarColumn, Progress, TaskID, TextColumn, TimeRemainingColumn
from rich.table import Table

from garrison import _core
from garrison.checks import check, verdict
from garrison.fitting import fit, read_records
from garrison.job import Row, run_scenario
from garrison.scenario import Scenario, read_scenario
from garrison.verify import FileResult, verify

OK, NO, BAD = 0, 1, 2
_WIDTH = 140  # of tables that do not go to a terminal


def _console(stderr: bool = False) -> Console:
    stream = sys.stderr if stderr else sys.stdout
    return Console(stderr=stderr, width=None if stream.isatty() else _WIDTH)


def _clean(value: Any) -> Any:
    """Numbers that JSON does not have become null."""
    if isinstance(value, dict):
        return {str(k): _clean(v) for k, v in value.items()}
    if isinstance(value, (list, tuple)):
        return [_clean(v) for v in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value


def _json(value: Any) -> None:
    print(json.dumps(_clean(value), indent=1))


def _table(title: str, head: list[str], rows: list[list[str]], console: Console) -> None:
    table = Table(title=title, title_justify="left", show_edge=False, pad_edge=False)
    for name in head:
        table.add_column(name, overflow="fold")
    for row in rows:
        table.add_row(*row)
    console.print(table)


# --- run ---------------------------------------------------------------------------------------------------------


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


def _cmd_run(args: argparse.Namespace) -> int:
    from garrison.job import signal_size
    from garrison.plots import overview_figure
    from garrison.report import table_rows, write_report

    console = _console(stderr=args.json)
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
    (folder / "summary.json").write_text(json.dumps(_clean(summary), indent=1), encoding="utf-8")
    _write_estimates(folder, scenario, rows, args.npz)
    write_report(folder / "report.html", scenario, rows)
    overview_figure(scenario, rows, signal_size(scenario)).savefig(folder / "overview.png", dpi=110)
    if args.json:
        _json(summary)
    else:
        head, cells = table_rows(scenario, rows)
        _table(scenario.title, head, cells, console)
        console.print(
            f"\nwritten to {folder}: report.html (open it in a browser), overview.png, summary.json, estimates"
        )
    return OK


# --- check -------------------------------------------------------------------------------------------------------


def _cmd_check(args: argparse.Namespace) -> int:
    scenario = read_scenario(args.scenario)
    label, filter = scenario.filters[0]
    assert filter is not None  # the main filter is never the central one
    found = check(filter, scenario.model, scenario.network)
    if args.json:
        _json(
            {
                "filter": label,
                "holds": found.holds,
                "conditions": found.conditions,
                "quantities": found.quantities,
            }
        )
        return OK if found.holds else NO
    console = _console()
    rows = [[verdict(c), c["name"], f"{c['value']:.6g}", c["needed"], c["meaning"]] for c in found.conditions]
    _table(f"{scenario.title}: {label}", ["", "condition", "value", "needed", "meaning"], rows, console)
    console.print()
    _table(
        "",
        ["quantity", "value", "meaning"],
        [[q["name"], f"{q['value']:.6g}", q["meaning"]] for q in found.quantities],
        console,
    )
    return OK if found.holds else NO


# --- list --------------------------------------------------------------------------------------------------------


def _range(p: dict[str, Any]) -> str:
    if p["choices"]:
        return " | ".join(p["choices"])
    low = f"{'>' if p['open'] else '>='} {p['least']:g}" if math.isfinite(p["least"]) else ""
    high = f"<= {p['most']:g}" if math.isfinite(p["most"]) else ""
    return ", ".join(x for x in (low, high) if x)


def _default(p: dict[str, Any]) -> str:
    value = p["default"]
    if p["required"]:
        return "required"
    return "-" if isinstance(value, float) and math.isnan(value) else str(value)


def _param_rows(params: list[dict[str, Any]]) -> list[list[str]]:
    return [[p["name"], p["symbol"], p["unit"], _range(p), _default(p), p["doc"]] for p in params]


def _cmd_list(args: argparse.Namespace) -> int:
    kinds = {"filters": _core.filter_infos(), "attacks": _core.attack_infos()}
    wanted = {args.what: kinds[args.what]} if args.what else kinds
    if args.json:
        _json(wanted)
        return OK
    console = _console()
    head = ["parameter", "symbol", "unit", "range", "default", "meaning"]
    for kind, infos in wanted.items():
        for info in infos:
            about = info.get("title") or f"{info['doc']} ({info['target']} attack)"
            console.print(f"\n[bold]{info['name']}[/bold]  {about}  [dim]{kind}[/dim]")
            if info["params"]:
                _table("", head, _param_rows(info["params"]), console)
    return OK


# --- verify ------------------------------------------------------------------------------------------------------


def _worst(result: FileResult) -> str:
    worst = max((f for f in result.fields if math.isfinite(f.deviation)), key=lambda f: f.deviation, default=None)
    return "-" if worst is None else f"{worst.deviation:.1e}  {worst.name}"


def _cmd_verify(args: argparse.Namespace) -> int:
    results = verify(args.folder, args.family)
    fields = sum(len(r.fields) for r in results)
    misses = sum(r.misses for r in results)
    if args.json:
        _json(
            {
                "files": [
                    {
                        "file": r.file,
                        "family": r.family,
                        "misses": r.misses,
                        "fields": [vars(f) for f in r.fields],
                    }
                    for r in results
                ],
                "fields": fields,
                "misses": misses,
            }
        )
    else:
        console = _console()
        rows = [[r.file, r.family, str(len(r.fields)), _worst(r), str(r.misses)] for r in results]
        _table("", ["file", "family", "fields", "worst deviation", "misses"], rows, console)
        for r in results:
            for f in r.fields:
                if not f.ok or args.fields:
                    console.print(
                        f"{'ok  ' if f.ok else 'MISS'} {r.file} {f.name}: {f.deviation:.2e} {f.note}",
                        markup=False,
                    )
    if not results:
        print(f"verify: no case files in {args.folder}", file=sys.stderr)
        return NO
    print(
        f"verify: {len(results)} files, {fields} fields, {misses} missed",
        file=sys.stderr if args.json else sys.stdout,
    )
    return OK if misses == 0 else NO


# --- fit ---------------------------------------------------------------------------------------------------------


def _cmd_fit(args: argparse.Namespace) -> int:
    import datetime as dt

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
        target = Path(args.output)
        if target.exists() and not args.force:
            raise _core.IoError(f"{target}: exists already; choose another name, or replace it with --force")
        target.write_text(text + "\n", encoding="utf-8")
    if args.json or not args.output:
        print(text)
        return OK
    i = found.identified
    console = _console()
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
    _table("", head, rows, console)
    console.print(f"written to {args.output}")
    return OK


# --- structure ---------------------------------------------------------------------------------------------------


def _cmd_structure(args: argparse.Namespace) -> int:
    from garrison.sensors import anatomy_figure, read_anatomy, states_text, table_rows

    anatomy = read_anatomy(args.source, args.measured)
    report = anatomy.report()
    if args.output:
        target = Path(args.output)
        if target.exists() and not args.force:
            raise _core.IoError(f"{target}: exists already; choose another name, or replace it with --force")
        anatomy_figure(anatomy).savefig(target, dpi=120)
    if args.json:
        _json(report)
    else:
        console = _console()
        contractions = "; ".join(states_text(c) for c in report["contractions"]) or "none"
        parents = "; ".join(states_text(c) for c in report["parent_components"][:20])
        facts = [
            ["states", str(report["states"])],
            ["structural rank", str(report["structural_rank"])],
            ["contractions (overlapping ones joined)", contractions],
            [f"parent components ({len(report['parent_components'])})", parents],
        ]
        if "observable" in report:
            unstable = len(report["unstable_modes_nobody_sees"])
            facts += [
                ["structurally observable", "yes" if report["observable"] else "no"],
                ["every state reaches a sensor", "yes" if report["output_connected"] else "no"],
                ["rank of [A; C] is full", "yes" if report["rank_condition"] else "no"],
                ["unstable modes that nobody sees", str(unstable)],
            ]
        _table(anatomy.title, ["structure", ""], facts, console)
        if "agents" in report:
            console.print()
            head = ["agent", "measures", "class", "necessary", "substitutes", "could lie unseen"]
            _table("", head, table_rows(report), console)
        if args.output:
            console.print(f"\nwritten to {args.output}")
    return OK if report.get("observable", True) else NO


# --- main --------------------------------------------------------------------------------------------------------


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="garrison",
        description="A network that keeps its estimate while some of its own sensors lie.",
        epilog="Exit codes: 0 fine, 1 the answer is no (condition fails, case misses), 2 bad input, 130 interrupted.",
    )
    parser.add_argument("--version", action="version", version=f"garrison {_core.__version__}")
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")

    run = commands.add_parser("run", help="simulate or replay a scenario; write summary.json, estimates, report.html")
    run.add_argument("scenario", help="scenario file (TOML)")
    run.add_argument("-o", "--output", required=True, help="folder to write to; must be new or empty")
    run.add_argument("--force", action="store_true", help="replace the output of an earlier run")
    run.add_argument("--npz", action="store_true", help="write all arrays as estimates.npz instead of a CSV file")
    run.set_defaults(do=_cmd_run)

    check_ = commands.add_parser(
        "check", help="validate a scenario, print conditions and bounds; exit 1 if a condition fails"
    )
    check_.add_argument("scenario", help="scenario file (TOML)")
    check_.set_defaults(do=_cmd_check)

    list_ = commands.add_parser("list", help="what exists, with parameters, units, ranges, defaults")
    list_.add_argument("what", nargs="?", choices=["filters", "attacks"])
    list_.set_defaults(do=_cmd_list)

    verify_ = commands.add_parser("verify", help="replay reference cases; exit 1 on any miss")
    verify_.add_argument("folder", help="folder with case files (*.json), subfolders included")
    verify_.add_argument("--family", help="only the cases of this family, e.g. saturation")
    verify_.add_argument("--fields", action="store_true", help="print every field, not only the misses")
    verify_.set_defaults(do=_cmd_verify)

    fit_ = commands.add_parser("fit", help="identify a model from clean daily records (CSV: date,STATION,...)")
    fit_.add_argument("records", help="CSV file")
    fit_.add_argument("--from", dest="start", help="first day, YYYY-MM-DD")
    fit_.add_argument("--to", dest="end", help="last day, YYYY-MM-DD")
    fit_.add_argument("--factors", type=int, default=2, help="common factors that become the state (default 2)")
    fit_.add_argument("--harmonics", type=int, default=2, help="of the seasonal cycle (default 2)")
    fit_.add_argument("--period", type=float, default=365.25, help="of the cycle, in samples (default 365.25)")
    fit_.add_argument("--root", action="store_true", help="work on the square root of the records")
    fit_.add_argument("--factor", type=float, default=1.0, help="unit conversion (default 1)")
    fit_.add_argument("-o", "--output", help="model file to write (JSON); default: standard output")
    fit_.add_argument("--force", action="store_true", help="replace an existing model file")
    fit_.set_defaults(do=_cmd_fit)

    structure_ = commands.add_parser(
        "structure", help="who is indispensable: classes, necessary sensors, substitutes; exit 1 if not observable"
    )
    structure_.add_argument("source", help="scenario file (TOML), or a CSV file with the matrix A")
    structure_.add_argument(
        "--measured", type=int, nargs="*", metavar="STATE", help="with a CSV file: the state of each sensor, from 0"
    )
    structure_.add_argument("-o", "--output", help="picture to write (.png, .svg, .pdf)")
    structure_.add_argument("--force", action="store_true", help="replace an existing picture")
    structure_.set_defaults(do=_cmd_structure)
    for command in (run, check_, list_, verify_, fit_, structure_):
        command.add_argument("--json", action="store_true", help="print the result for machines")
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
