"""`garrison calibrate`: the nominal rates at which the filters of a scenario alarm as rarely as asked."""

import argparse
from typing import Any

from garrison._commands.terminal import OK, Commands, console_for, print_json, print_table, print_warnings, working
from garrison.calibration import Calibration, calibrate
from garrison.scenario import Scenario, read_scenario
from garrison.words import refusal


def add(commands: Commands) -> None:
    """Declare the command."""
    command = commands.add_parser(
        "calibrate",
        help="find the nominal false-alarm rates that give the rates asked for on a scenario's clean records",
        allow_abbrev=False,
    )
    command.add_argument(
        "scenario", help="scenario file (TOML) with [data]: records without attacks, not those of the fit"
    )
    command.add_argument("--json", action="store_true", help="print JSON")
    command.set_defaults(do=do)


def do(args: argparse.Namespace) -> int:
    """Run the command."""
    scenario = read_scenario(args.scenario)
    scenario.require_constant("calibrate")
    found = _all(scenario)
    if args.json:
        print_json({"filters": [_plain(label, scenario, one) for label, one in found]})
        return OK
    console = console_for()
    rows = [
        [label, f"{c.asked:.3g}", f"{c.before:.3g}", f"{c.nominal:.3g}", _now(c), str(c.tests)] for label, c in found
    ]
    head = ["filter", "asked", "got before", "false_alarm to set", "got now (by fifths of the records)", "tests"]
    print_table(f"{scenario.title}: false alarms on the records, taken as clean", head, rows, console)
    for label, c in found:
        levels = [[name, *(f"{v:.4g}" for v in row)] for name, row in zip(scenario.names, c.thresholds, strict=True)]
        print_table(f"{label}: levels of the statistic", ["agent", "level", "95 % from", "to"], levels, console)
    print_warnings([*scenario.notes, *(_unjudged(label, c) for label, c in found if not c.judged)])
    return OK


def _now(c: Calibration) -> str:
    parts = [v for v in c.by_part if v == v]  # nan: nothing was tested there
    about = f"{c.got:.3g} ({min(parts):.2g} to {max(parts):.2g})" if parts else f"{c.got:.3g}"
    return about if c.judged else f"{about}, not judged"


def _unjudged(label: str, c: Calibration) -> str:
    return (
        f"{label}: not judged: {c.doubt}; on other records the rate may be another one, by a factor of 10 and more: "
        "calibrate on longer records, or ask for more frequent alarms or a shorter window"
    )


def _all(scenario: Scenario) -> list[tuple[str, Calibration]]:
    if scenario.measurements is None:
        raise refusal("data", "no table [data]", "records without attacks", "calibration needs recorded measurements")
    chosen = [(label, f) for label, f in scenario.filters if f is not None and "false_alarm" in f.params]
    if not chosen:
        raise refusal("filter", "no filter with a false-alarm rate", "one with a parameter false_alarm")
    found = []
    for label, f in chosen:
        with working(f"calibrating {label}"):
            y, u = scenario.measurements, scenario.inputs
            found.append((label, calibrate(scenario.model, scenario.network, f, measurements=y, inputs=u)))
    return found


def _plain(label: str, scenario: Scenario, c: Calibration) -> dict[str, Any]:
    levels = {name: row.tolist() for name, row in zip(scenario.names, c.thresholds, strict=True)}
    return {
        "filter": label,
        "asked": c.asked,
        "before": c.before,
        "false_alarm": c.nominal,
        "got": c.got,
        "by_part": list(c.by_part),
        "judged": c.judged,
        "doubt": c.doubt,
        "tests": c.tests,
        "levels": levels,
        "process_bound": c.model.process_bound,
        "measurement_bound": c.model.measurement_bound.tolist(),
        "exceeds": c.exceeds,
        "certificate_levels": c.levels,
    }
