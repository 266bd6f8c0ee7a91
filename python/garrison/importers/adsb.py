"""The track of an aircraft as a scenario: its reported positions and its reported velocities test each other."""

import datetime as dt
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from garrison import _core
from garrison.importers.adsb_choice import Choice
from garrison.importers.adsb_doubts import contradictions, long_gap
from garrison.importers.adsb_files import Track, read_track
from garrison.importers.bundle import Bundle, Measurements, gate, model_file
from garrison.importers.earth import Plane
from garrison.importers.limits import require_positive, require_probability
from garrison.words import refusal

Array = NDArray[np.float64]
SOURCE = (
    "a track of ADS-B reports. Tracks are under the licence of the network that collected them (OpenSky Network, "
    "ADS-B Exchange, adsb.lol and others have terms of their own): name the source where you publish results. Nothing "
    "of them is part of garrison."
)
STATES = ["east", "east velocity", "north", "north velocity"]
OUTPUTS = ["position east", "position north", "velocity east", "velocity north"]
_UNITS = {"east": "m", "north": "m", "east velocity": "m/s", "north velocity": "m/s"} | {
    "position east": "m",
    "position north": "m",
    "velocity east": "m/s",
    "velocity north": "m/s",
}


@dataclass(frozen=True)
class Assumptions:
    """period: s. oldest: s, above which a position is missing. position, velocity: deviations of reports, m and m/s.

    manoeuvre: deviation of the acceleration over a second, m/s^2. false_alarm: of a test, per sample. The defaults are
    those at which recorded flights do not alarm where their reports agree (docs/how-to/import-aircraft.md).
    """

    period: float = 1.0
    oldest: float = 2.0
    position: float = 200.0
    velocity: float = 3.0
    manoeuvre: float = 10.0
    false_alarm: float = 1e-6

    def __post_init__(self) -> None:
        require_positive(period=self.period, oldest=self.oldest, manoeuvre=self.manoeuvre)
        require_positive(position_noise=self.position, velocity_noise=self.velocity)
        require_probability("false-alarm", self.false_alarm)


def import_adsb(path: Path, choice: Choice | None = None, assumed: Assumptions | None = None) -> Bundle:
    """The track of one aircraft.

    Parameters
    ----------
    path : Path
        Of a JSON or CSV file, also as .gz.
    choice : Choice, optional
        Which aircraft and which flight, where the file has several.
    assumed : Assumptions, optional
        Period (s), oldest position (s), noise (m, m/s, m/s^2) and false-alarm rate.

    Returns
    -------
    Bundle
        What `write(folder)` writes: scenario.toml and the files beside it; facts and notes for people.

    Raises
    ------
    IoError
        A file cannot be read.
    InvalidInput
        The file is no track, or has several aircraft or flights.
    """
    assumed = assumed or Assumptions()
    track = read_track(path, choice)
    times, values, fresh = _on_grid(track, assumed)
    first = int(np.argmax(np.isfinite(values).all(axis=1)))
    if not np.isfinite(values[first]).all():
        raise refusal(str(path), "no report with a fresh position and a velocity", "at least one")
    model = _model(assumed)
    start = values[first, [0, 2, 1, 3]]
    wrong = contradictions(values, assumed.period)
    contradict = ", which contradict each other" if wrong else ""
    tables = {
        "title": f"Aircraft {track.aircraft}, positions and velocities as reported{contradict}",
        "model": {"file": "model.json"},
        "network": {"kind": "complete"},
        "data": {"file": "measurements.csv"},
        "filter": gate("gate, isolating", assumed.false_alarm, isolate=True),
        "compare": [gate("gate, alarms only", assumed.false_alarm, isolate=False)],
        "run": {"start": [float(v) for v in start]},
    }
    values, times = values[first:], times[first:]
    usual = round(float(np.median(np.diff(track.t))), 3)
    facts = [
        ("aircraft", track.aircraft),
        ("time", f"{times[0]} to {times[-1]} UTC, every {assumed.period:g} s"),
        ("reports", f"{len(track.t)}, usually {usual:g} s apart"),
        ("samples", str(len(values))),
        ("fresh positions", f"{fresh[first:].mean():.0%}; older than {assumed.oldest:g} s: missing"),
        ("velocities", f"{np.isfinite(values[:, 2]).mean():.0%}"),
    ]
    notes = [
        "positions and velocities come from one receiver in the aircraft: an attacker of its satellite navigation "
        "moves both. An alarm says that they do not fit what was reported before, not where the aircraft is",
        *long_gap(fresh[first:], assumed.period),
        *wrong,
    ]
    return Bundle(tables, SOURCE, Measurements(times, OUTPUTS, values), model, facts, notes)


def _model(assumed: Assumptions) -> dict[str, object]:
    """Constant velocity, driven by white acceleration."""
    drift = np.array([[0.0, 1.0], [0.0, 0.0]])
    A, Q = np.zeros((4, 4)), np.zeros((4, 4))
    A[:2, :2] = A[2:, 2:] = drift
    Q[1, 1] = Q[3, 3] = assumed.manoeuvre**2
    C = [np.eye(4)[[k]] for k in (0, 2, 1, 3)]
    R = [np.array([[deviation**2]]) for deviation in (assumed.position, assumed.position, *2 * (assumed.velocity,))]
    plant = _core.Model.from_continuous(A, C, assumed.period, process_intensity=Q, measurement_covariance=R)
    return model_file(
        np.asarray(plant.A),
        C,
        process_covariance=np.asarray(plant.process_covariance),
        measurement_covariance=R,
        agents=OUTPUTS,
        states=STATES,
        outputs=OUTPUTS,
        units=_UNITS,
    )


def _on_grid(track: Track, assumed: Assumptions) -> tuple[list[str], Array, NDArray[np.bool_]]:
    """Times, (east, north, their velocities) per grid point, and where a position is fresh.

    Of several reports in one period the last one counts.
    """
    position_known, velocity_known = _fresh(track, assumed.oldest)
    first = np.floor(track.t[0] / assumed.period) * assumed.period
    at = np.floor((track.t - first) / assumed.period + 1e-6).astype(int)
    count = int(at[-1]) + 1
    if count > _MOST_FILLED * len(at):
        raise refusal(str(track.path), f"{count} periods with {len(at)} reports", "fewer gaps, or a longer --period")
    origin = int(np.argmax(position_known))
    plane = Plane(float(track.latitude[origin]), float(track.longitude[origin]))
    latitude, altitude = _held(track.latitude), np.nan_to_num(_held(track.altitude))
    moved = plane.position(track.latitude, track.longitude)
    velocity = plane.velocity(latitude, altitude, track.speed, track.track)
    # A report is from within its period: bring it to the grid's time along its own velocity.
    late = first + at * assumed.period - track.position_time
    late = np.where(np.isfinite(late), late, 0.0)
    values = np.full((count, 4), np.nan)
    lag = np.where(np.isfinite(velocity).all(axis=1), late, 0.0)[:, None] * np.nan_to_num(velocity)
    values[at[position_known], :2] = (moved + lag)[position_known]
    values[at[velocity_known], 2:] = velocity[velocity_known]
    stamps = [dt.datetime.fromtimestamp(first + k * assumed.period, dt.UTC) for k in range(count)]
    times = [f"{s:%Y-%m-%d %H:%M:%S}" + (f".{s.microsecond:06d}" if assumed.period % 1 else "") for s in stamps]
    return times, values, np.isfinite(values[:, 0])


#: grid points per report, above which the file is not a track but scattered reports
_MOST_FILLED = 200


def _fresh(track: Track, oldest: float) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Which positions and which velocities were received, and are not what was repeated from before."""
    position = np.isfinite(track.latitude) & np.isfinite(track.longitude)
    if np.isfinite(track.position_time).any():
        position &= np.abs(track.t - track.position_time) <= oldest  # nan: not known, not fresh
    else:
        position &= _changed(track.latitude) | _changed(track.longitude)
    velocity = np.isfinite(track.speed) & np.isfinite(track.track)
    changed = _changed(track.speed) | _changed(track.track)
    return position, velocity & _live(position, changed)


def _live(heard: NDArray[np.bool_], changed: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Where a repeated value is one of now: something is heard, and the value has changed since that began."""
    out = np.zeros(len(heard), dtype=bool)
    alive = False
    for k in range(len(heard)):
        alive = bool(changed[k] or (alive and heard[k]))
        out[k] = alive
    return out


def _changed(values: Array) -> NDArray[np.bool_]:
    return np.concatenate([[True], values[1:] != values[:-1]]) & np.isfinite(values)


def _held(values: Array) -> Array:
    """With the last known value where one is missing; the first known one at the beginning."""
    known = np.isfinite(values)
    if not known.any():
        return np.zeros(len(values))
    last = np.maximum.accumulate(np.where(known, np.arange(len(values)), -1))
    return np.asarray(values[np.where(last < 0, int(np.argmax(known)), last)])
