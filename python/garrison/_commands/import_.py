"""`garrison import`: recordings and cases of others as a scenario."""

import argparse
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from garrison._commands.output import output_folder
from garrison._commands.terminal import OK, Commands, console_for, number, print_json, print_table, whole_number
from garrison.importers.bundle import Bundle

if TYPE_CHECKING:
    from garrison.importers.robots import Assumptions

Parsers = argparse._SubParsersAction


def add(commands: Commands) -> None:
    """Declare the command and one below it per kind of file."""
    command = commands.add_parser(
        "import",
        help="turn recordings or cases of others into a scenario: OpenACC, ADS-B, pandapower, bags, MCAP, CSV",
        allow_abbrev=False,
    )
    kinds = command.add_subparsers(dest="kind", required=True, metavar="KIND")
    for declare in (_openacc, _adsb, _pandapower, _rosbag, _mcap, _csv):
        own = declare(kinds)
        own.add_argument("-o", "--output", required=True, help="folder to write to; must be new or empty")
        own.add_argument("--force", action="store_true", help="replace the output of an earlier import")
        own.add_argument("--json", action="store_true", help="print JSON")
        own.set_defaults(do=do)


def do(args: argparse.Namespace) -> int:
    """Run the command."""
    make: Callable[[argparse.Namespace], Bundle] = args.make
    bundle = make(args)
    with output_folder(Path(args.output), args.force) as folder:
        bundle.write(folder)
    scenario = Path(args.output) / "scenario.toml"
    if args.json:
        print_json({"scenario": str(scenario), "facts": dict(bundle.facts), "notes": bundle.notes})
        return OK
    title = str(bundle.tables["title"])
    print_table(title, ["", ""], [list(fact) for fact in bundle.facts], console_for())
    print()
    for note in bundle.notes:
        print(f"note: {note}")
    print(f"source: {bundle.source}")
    print(
        f"written to {args.output}. Next:\n  garrison check {scenario}\n  garrison run {scenario} -o {args.output}/run"
    )
    return OK


def _openacc(kinds: "Parsers[argparse.ArgumentParser]") -> argparse.ArgumentParser:
    own = kinds.add_parser(
        "openacc", help="read cars in a row: an OpenACC file, or one file per follower", allow_abbrev=False
    )
    own.add_argument("files", nargs="+", type=Path, help="CSV files of one recording")
    own.add_argument("--attacked", type=whole_number, default=1, help="most odometers that may be wrong (1)")
    own.add_argument(
        "--measurement-noise",
        type=number,
        help="bound on the noise of odometers and gaps, m (default: 2, or what admits all but --attacked)",
    )
    own.add_argument(
        "--process-noise", type=number, default=0.06, help="bound on the process noise of a sample, m and m/s (0.06)"
    )
    own.add_argument(
        "--initial-error",
        type=number,
        help="bound on the error of the first estimate, m (10 times the measurement noise)",
    )
    own.add_argument("--from", dest="start", type=number, metavar="SECONDS", help="first time that is used")
    own.add_argument("--to", dest="end", type=number, metavar="SECONDS", help="last time that is used")
    own.set_defaults(make=_make_openacc)
    return own


def _make_openacc(args: argparse.Namespace) -> Bundle:
    from garrison.importers.openacc import Noise, import_openacc

    noise = Noise(args.process_noise, args.measurement_noise, args.initial_error, args.attacked)
    return import_openacc(args.files, noise, (args.start, args.end))


def _adsb(kinds: "Parsers[argparse.ArgumentParser]") -> argparse.ArgumentParser:
    own = kinds.add_parser(
        "adsb",
        help="read the track of an aircraft: state vectors, or a trace of readsb or ADS-B Exchange",
        allow_abbrev=False,
    )
    own.add_argument("file", type=Path, help="JSON or CSV file, also as .gz")
    own.add_argument("--aircraft", metavar="ADDRESS", help="ICAO address, where the file has several aircraft")
    own.add_argument("--from", dest="start", metavar="TIME", help="first time that is used, UTC")
    own.add_argument("--to", dest="end", metavar="TIME", help="last time that is used, UTC")
    own.add_argument("--period", type=number, default=1.0, help="sampling period, s (1)")
    own.add_argument("--oldest", type=number, default=2.0, help="age of a position above which it is missing, s (2)")
    own.add_argument("--position-noise", type=number, default=200.0, help="standard deviation of positions, m (200)")
    own.add_argument("--velocity-noise", type=number, default=3.0, help="standard deviation of velocities, m/s (3)")
    own.add_argument("--manoeuvre", type=number, default=10.0, help="standard deviation of accelerations, m/s^2 (10)")
    own.add_argument("--false-alarm", type=number, default=1e-6, help="false-alarm rate of a test, per sample (1e-6)")
    own.set_defaults(make=_make_adsb)
    return own


def _make_adsb(args: argparse.Namespace) -> Bundle:
    from garrison.importers.adsb import Assumptions, import_adsb
    from garrison.importers.adsb_choice import Choice
    from garrison.scenario.section import moment

    start = moment("--from", args.start) if args.start is not None else None
    end = moment("--to", args.end, last=True) if args.end is not None else None
    noise = args.position_noise, args.velocity_noise, args.manoeuvre
    assumed = Assumptions(args.period, args.oldest, *noise, args.false_alarm)
    return import_adsb(args.file, Choice(args.aircraft, start, end), assumed)


def _rosbag(kinds: "Parsers[argparse.ArgumentParser]") -> argparse.ArgumentParser:
    own = kinds.add_parser(
        "rosbag", help="read a robot: ROS 1 bags, or a ROS 2 bag (needs rosbags)", allow_abbrev=False
    )
    own.add_argument("files", nargs="+", type=Path, help=".bag files, or the folder of a ROS 2 bag")
    _robot(own)
    own.set_defaults(make=_make_rosbag)
    return own


def _mcap(kinds: "Parsers[argparse.ArgumentParser]") -> argparse.ArgumentParser:
    own = kinds.add_parser(
        "mcap", help="read a robot: an MCAP file (needs mcap, and rosbags for ROS)", allow_abbrev=False
    )
    own.add_argument("file", type=Path, help="MCAP file")
    _robot(own)
    own.set_defaults(make=_make_mcap)
    return own


def _robot(own: argparse.ArgumentParser) -> None:
    own.add_argument("--topic", action="append", default=[], help="use this topic; may be repeated (default: all)")
    own.add_argument("--period", type=number, default=0.1, help="sampling period, s (0.1)")
    own.add_argument(
        "--align", type=number, default=60.0, help="seconds at the start that are used to align the frames (60)"
    )
    own.add_argument("--position-noise", type=number, default=0.5, help="standard deviation of positions, m (0.5)")
    own.add_argument("--heading-noise", type=number, default=0.1, help="standard deviation of headings, rad (0.1)")
    own.add_argument("--velocity-noise", type=number, default=0.3, help="standard deviation of velocities, m/s (0.3)")
    own.add_argument("--rate-noise", type=number, default=0.1, help="standard deviation of turn rates, rad/s (0.1)")
    own.add_argument(
        "--acceleration", type=number, default=1.0, help="standard deviation of accelerations, m/s^2 and rad/s^2 (1)"
    )
    own.add_argument("--false-alarm", type=number, default=1e-4, help="false-alarm rate of a test, per sample (1e-4)")


def _make_rosbag(args: argparse.Namespace) -> Bundle:
    from garrison.importers.robots import import_bag

    return import_bag(args.files, args.topic, _robot_assumptions(args))


def _make_mcap(args: argparse.Namespace) -> Bundle:
    from garrison.importers.robots import import_mcap

    return import_mcap(args.file, args.topic, _robot_assumptions(args))


def _robot_assumptions(args: argparse.Namespace) -> "Assumptions":
    from garrison.importers.robots import Assumptions

    noise = {q: args.position_noise for q in ("x", "y")} | {q: args.velocity_noise for q in ("vx", "vy")}
    noise |= {"heading": args.heading_noise, "rate": args.rate_noise}
    return Assumptions(args.period, args.align, args.acceleration, args.false_alarm, noise)


def _pandapower(kinds: "Parsers[argparse.ArgumentParser]") -> argparse.ArgumentParser:
    own = kinds.add_parser("pandapower", help="read a power grid: a file or a case of pandapower", allow_abbrev=False)
    own.add_argument("case", metavar="CASE", help="JSON file of pandapower, or a case that it ships, as case118")
    chosen = own.add_mutually_exclusive_group()
    chosen.add_argument(
        "--units", type=whole_number, metavar="COUNT", help="phasor units, at the buses with most lines"
    )
    chosen.add_argument("--at", nargs="+", metavar="BUS", help="buses with a phasor unit; default all")
    own.add_argument("--steps", type=whole_number, help="samples to simulate (50; 10 above 200 buses)")
    own.add_argument(
        "--angle-noise", type=number, default=0.002, help="standard deviation of measured angles, rad (0.002)"
    )
    own.add_argument(
        "--flow-noise", type=number, default=0.02, help="standard deviation of measured flows, per unit (0.02)"
    )
    own.add_argument("--wander", type=number, default=0.001, help="how far an angle moves per sample, rad (0.001)")
    own.add_argument(
        "--areas",
        type=whole_number,
        metavar="COUNT",
        help="divide the buses among so many agents (8 for 41 to 200 buses with more than 40 units, else one per unit)",
    )
    own.set_defaults(make=_make_pandapower)
    return own


def _make_pandapower(args: argparse.Namespace) -> Bundle:
    from garrison.importers.grids import Assumptions, import_pandapower

    assumed = Assumptions(args.angle_noise, args.flow_noise, args.wander, args.steps, args.areas)
    return import_pandapower(args.case, args.at if args.at else args.units, assumed)


def _csv(kinds: "Parsers[argparse.ArgumentParser]") -> argparse.ArgumentParser:
    own = kinds.add_parser("csv", help="read records: a column of times and a column per sensor", allow_abbrev=False)
    own.add_argument("file", type=Path, help="CSV file, with any separator")
    own.add_argument("--to", metavar="TIME", help="end of the clean part that the model is fitted to (the first half)")
    own.add_argument("--factors", type=whole_number, default=1, help="states of the model (1)")
    own.add_argument(
        "--harmonics",
        type=whole_number,
        help="harmonics of the yearly season (2 from two years on, else 0)",
    )
    own.add_argument(
        "--standardise",
        action=argparse.BooleanOptionalAction,
        help="take every column in units of its own spread; --no-standardise: all columns have one unit (default: "
        "standardise where the header names different units)",
    )
    own.add_argument("--stations", type=Path, help="CSV file with code, latitude and longitude of the sensors")
    own.add_argument("--radius", type=number, metavar="KM", help="sensors at most so far apart are neighbours")
    own.add_argument("--false-alarm", type=number, default=1e-4, help="false-alarm rate of a test, per sample (1e-4)")
    own.set_defaults(make=_make_csv)
    return own


def _make_csv(args: argparse.Namespace) -> Bundle:
    from garrison.importers.records import Choice, import_csv
    from garrison.scenario.section import moment

    end = moment("--to", args.to, last=True) if args.to is not None else None
    rest = args.factors, args.harmonics, args.stations, args.radius, args.false_alarm, args.standardise
    return import_csv(args.file, Choice(end, *rest))
