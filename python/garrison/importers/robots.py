"""A robot's recording as a scenario: every quantity of every topic is a sensor, and they test each other."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from garrison import _core
from garrison.importers.bundle import Bundle, Measurements, gate, model_file
from garrison.importers.limits import require_positive, require_probability
from garrison.importers.robot_files import Message, bag_messages, mcap_messages
from garrison.importers.robot_frames import Signal, in_one_frame
from garrison.importers.robot_signals import KINDS, read_topics
from garrison.words import count, refusal

Array = NDArray[np.float64]
SOURCE = (
    "a recording of a robot. Recordings are under their publisher's licence: name the source where you publish "
    "results. Nothing of them is part of garrison."
)
#: state of the plant -> its unit; each pair is a quantity and its rate
_PAIRS = (("x", "vx"), ("y", "vy"), ("heading", "rate"))
_UNITS = {"x": "m", "y": "m", "heading": "rad", "vx": "m/s", "vy": "m/s", "rate": "rad/s"}
_MOST_SAMPLES = 5_000_000


@dataclass(frozen=True)
class Assumptions:
    """period: s. window: s from the start in which frames are aligned. noise: quantity -> standard deviation.

    acceleration: m/s^2 and rad/s^2, standard deviation over a second. false_alarm: of a test, per sample.
    """

    period: float = 0.1
    window: float = 60.0
    acceleration: float = 1.0
    false_alarm: float = 1e-4
    noise: dict[str, float] = field(
        default_factory=lambda: {"x": 0.5, "y": 0.5, "heading": 0.1, "vx": 0.3, "vy": 0.3, "rate": 0.1}
    )

    def __post_init__(self) -> None:
        require_positive(period=self.period, align=self.window, acceleration=self.acceleration)
        require_positive(position_noise=min(self.noise["x"], self.noise["y"]), heading_noise=self.noise["heading"])
        require_positive(velocity_noise=min(self.noise["vx"], self.noise["vy"]), rate_noise=self.noise["rate"])
        require_probability("false-alarm", self.false_alarm)


def import_bag(paths: Sequence[Path], topics: Sequence[str] = (), assumed: Assumptions | None = None) -> Bundle:
    """The recording of a robot: ROS 1 bags or a ROS 2 bag (extra: robots).

    Parameters
    ----------
    paths : sequence of Path
        .bag files, or the folder of a ROS 2 bag.
    topics : sequence of str
        Those to use; none = all that are understood.
    assumed : Assumptions, optional
        Period (s), alignment (s), accelerations, false-alarm rate and noise by quantity.

    Returns
    -------
    Bundle
        What `write(folder)` writes: scenario.toml and the files beside it; facts and notes for people.

    Raises
    ------
    IoError
        A file cannot be read.
    InvalidInput
        There is nothing to use, or a library is missing.
    """
    alone = paths[0].suffix == ".mcap" and not (paths[0].parent / "metadata.yaml").exists()
    if alone and len(paths) == 1:
        return import_mcap(paths[0], topics, assumed)
    return _bundle(str(paths[0]), bag_messages(paths, set(KINDS)), topics, assumed or Assumptions())


def import_mcap(path: Path, topics: Sequence[str] = (), assumed: Assumptions | None = None) -> Bundle:
    """The recording of a robot: an MCAP file with ROS 2, ROS 1 or JSON messages (extra: robots).

    Parameters
    ----------
    path : Path
        Of the file.
    topics : sequence of str
        Those to use; none = all that are understood.
    assumed : Assumptions, optional
        Period (s), alignment (s), accelerations, false-alarm rate and noise by quantity.

    Returns
    -------
    Bundle
        What `write(folder)` writes: scenario.toml and the files beside it; facts and notes for people.

    Raises
    ------
    IoError
        A file cannot be read.
    InvalidInput
        There is nothing to use, or a library is missing.
    """
    return _bundle(str(path), mcap_messages(path, set(KINDS)), topics, assumed or Assumptions())


def _bundle(where: str, messages: Iterable[Message], topics: Sequence[str], assumed: Assumptions) -> Bundle:
    found = read_topics(messages, set(topics))
    used = [t for t in found if any(t.knows(q) for q in ("x", "latitude", "heading", "rate", "vx"))]
    if not used:
        raise refusal(where, "topics without any number", "positions, headings or turn rates")
    signals, frame = in_one_frame(used, assumed.window)
    sensors = [(s, q) for s in signals for q in _UNITS if q in s.series]
    states = _states(where, {q for _, q in sensors})
    sensors = [(s, q) for s, q in sensors if q in states]
    names = [f"{s.name.lstrip('/')} {q}" for s, q in sensors]
    times, values = _gridded(where, sensors, assumed.period)
    model = _model(states, sensors, names, assumed)
    tables = {
        "title": f"Robot: {', '.join(t.name for t in used)}",
        "model": {"file": "model.json"},
        "network": {"kind": "complete"},
        "data": {"file": "measurements.csv"},
        "filter": gate("gate, isolating", assumed.false_alarm, isolate=True),
        "run": {"start": [_first(values, sensors, state) for state in states]},
    }
    facts = [
        *((t.name, f"{t.kind}, {count(len(t.t), 'message')}") for t in used),
        ("frame", frame),
        ("states", ", ".join(f"{s} [{_UNITS[s]}]" for s in states)),
        ("samples", f"{len(times)}, every {assumed.period:g} s"),
    ]
    return Bundle(tables, SOURCE, Measurements(times, names, values), model, facts, _notes(signals, frame, assumed))


def _notes(signals: list[Signal], frame: str, assumed: Assumptions) -> list[str]:
    general = [
        f"positions and headings of all topics are brought into the frame of {frame} by the first "
        f"{assumed.window:g} s, which are taken as honest",
        "standard deviations are assumed; garrison calibrate finds the rate to ask for on a recording without attacks",
    ]
    return [*general, *(note for s in signals for note in s.notes)]


def _states(where: str, measured: set[str]) -> list[str]:
    """What can be estimated: a pair of a quantity and its rate needs a sensor of the quantity."""
    states = [name for pair in _PAIRS if pair[0] in measured for name in pair]
    if not states:
        raise refusal(
            where, f"only {', '.join(sorted(measured))}", "a position or a heading, which rates alone do not give"
        )
    return states


def _gridded(where: str, sensors: list[tuple[Signal, str]], period: float) -> tuple[list[str], Array]:
    """Seconds from the start and one column per sensor; of several readings in a period the last one counts."""
    first = min(s.t[0] for s, _ in sensors)
    rows = int(np.floor((max(s.t[-1] for s, _ in sensors) - first) / period + 1e-6)) + 1
    if rows > _MOST_SAMPLES or rows < 2:
        raise refusal(
            where, f"{count(rows, 'sample')} of {period:g} s", f"2..{_MOST_SAMPLES}", "choose another --period"
        )
    values = np.full((rows, len(sensors)), np.nan)
    for k, (signal, quantity) in enumerate(sensors):
        known = np.isfinite(signal.series[quantity])
        at = np.floor((signal.t[known] - first) / period + 1e-6).astype(int)
        values[at, k] = signal.series[quantity][known]
    return [f"{k * period:.9g}" for k in range(rows)], values


def _first(values: Array, sensors: list[tuple[Signal, str]], state: str) -> float:
    """The first reading of a state; 0 where no sensor has it."""
    columns = [k for k, (_, q) in enumerate(sensors) if q == state]
    rows = np.flatnonzero(np.isfinite(values[:, columns]).any(axis=1))
    return float(np.nanmean(values[rows[0], columns])) if len(rows) else 0.0


def _model(
    states: list[str], sensors: list[tuple[Signal, str]], names: list[str], assumed: Assumptions
) -> dict[str, object]:
    """Constant rates, driven by white accelerations."""
    n = len(states)
    A, Q = np.zeros((n, n)), np.zeros((n, n))
    for k in range(0, n, 2):
        A[k, k + 1] = 1.0
        Q[k + 1, k + 1] = assumed.acceleration**2
    C = [np.eye(n)[[states.index(q)]] for _, q in sensors]
    R = [np.array([[assumed.noise[q] ** 2]]) for _, q in sensors]
    plant = _core.Model.from_continuous(A, C, assumed.period, process_intensity=Q, measurement_covariance=R)
    return model_file(
        np.asarray(plant.A),
        C,
        process_covariance=np.asarray(plant.process_covariance),
        measurement_covariance=R,
        agents=names,
        states=states,
        outputs=names,
        units={s: _UNITS[s] for s in states} | {name: _UNITS[q] for name, (_, q) in zip(names, sensors, strict=True)},
    )
