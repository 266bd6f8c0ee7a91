"""Vehicles in a string, recorded on the road: OpenACC files as a scenario of the platoon filter.

Every car has an odometer (its recorded speed, integrated from the first gap on) as its absolute sensor; the recorded
gaps to the car ahead are the relative ones; the input is the recorded acceleration, or the difference of speeds.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from garrison.importers.bundle import Bundle, Measurements
from garrison.importers.limits import require_positive
from garrison.importers.openacc_files import Convoy, read_convoy
from garrison.words import count, refusal

Array = NDArray[np.float64]
SOURCE = (
    "recorded vehicles in the form of the OpenACC database (Joint Research Centre of the European Commission). Its "
    "files are under their publisher's licence (CC BY 4.0 at the time of writing): name the source where you publish "
    "results. Nothing of them is part of garrison."
)
_LEAST_CARS = 3
#: m, less than which no odometer is trusted to
_LEAST = 2.0
#: times the measurement noise: an error of the first estimate, from which the bounds still contract
_WIDE = 10.0


@dataclass(frozen=True)
class Noise:
    """What the filter assumes: lengths of noise vectors (m, m/s) and of the first error; attacked sensors.

    measurement None: 2 m, or what admits all odometers but `attacked`, as far as the gaps tell.
    """

    process: float = 0.06
    measurement: float | None = None
    initial: float | None = None
    attacked: int = 1

    def __post_init__(self) -> None:
        given = {"measurement_noise": self.measurement, "initial_error": self.initial}
        require_positive(process_noise=self.process, **{k: v for k, v in given.items() if v is not None})


def import_openacc(
    paths: Sequence[Path], noise: Noise | None = None, between: tuple[float | None, float | None] = (None, None)
) -> Bundle:
    """One recording of a string of cars.

    Parameters
    ----------
    paths : sequence of Path
        A file with all of them, or one file per follower.
    noise : Noise, optional
        Bounds on noise and start (m, m/s), and how many odometers may be wrong.
    between : (float or None, float or None)
        First and last time that is used, s.

    Returns
    -------
    Bundle
        What `write(folder)` writes: scenario.toml and the files beside it; facts and notes for people.

    Raises
    ------
    IoError
        A file cannot be read.
    InvalidInput
        A file is no recording, or has less than three cars in a row.
    """
    noise = noise or Noise()
    convoy = read_convoy(paths).between(*between)
    cars = len(convoy.names)
    if cars < _LEAST_CARS:
        got = f"{count(cars, 'car')} in a row with speeds and gaps ({', '.join(convoy.names)})"
        raise refusal(
            convoy.where, got, f"at least {_LEAST_CARS}", "a string of fewer cannot tell whose sensor is wrong"
        )
    reach = (cars - 1) // 2
    if not 1 <= noise.attacked <= reach:
        raise refusal(
            "--attacked",
            str(noise.attacked),
            f"1..{reach}: at most half of the other cars, of which there are {cars - 1}",
        )
    odometer = _odometers(convoy)
    drift = _drifts(convoy, odometer)
    needed = _needed(drift)
    admitting, wrong = _admitting(needed, noise.attacked)
    assumed = max(_LEAST, admitting) if noise.measurement is None else noise.measurement
    tables = {
        "title": f"{cars} recorded cars: {', '.join(convoy.names)}",
        "model": {"vehicles": cars, "period": convoy.period, "inputs": True, "names": convoy.names},
        "network": {"kind": "band", "range": reach},
        "data": {"file": "measurements.csv"},
        "filter": _filter(noise, assumed),
        "run": {"start": [[float(odometer[0, k]), float(convoy.speed[0, k])] for k in range(cars)]},
    }
    facts = _facts(convoy, drift, assumed, wrong if needed.max() > assumed else ())
    notes = [*convoy.notes, *_doubt(assumed, admitting, noise.attacked)]
    return Bundle(tables, SOURCE, _measurements(convoy, odometer), facts=facts, notes=notes)


def _filter(noise: Noise, measurement: float) -> dict[str, object]:
    return {
        "name": "platoon",
        "label": "platoon",
        "attacked": noise.attacked,
        "process_noise": noise.process,
        "measurement_noise": measurement,
        "initial_error": noise.initial or _WIDE * measurement,
        "bound": "tight",
        "count": "cover",
        "pairs": True,
        "neighbours": True,
        "median": True,
    }


def _odometers(convoy: Convoy) -> Array:
    """Positions (rows, cars) along the road: the first gaps, then the integral of every car's own speed."""
    first = -np.concatenate([[0.0], np.cumsum(convoy.gap[0])])
    way = np.cumsum(0.5 * (convoy.speed[1:] + convoy.speed[:-1]) * convoy.period, axis=0)
    return first + np.vstack([np.zeros((1, len(first))), way])


def _drifts(convoy: Convoy, odometer: Array) -> Array:
    """How far (rows, cars) each odometer is from where the gaps put its car, seen from the median of all cars."""
    apart = np.cumsum(-np.diff(odometer, axis=1) - convoy.gap, axis=1)
    apart = np.hstack([np.zeros((len(apart), 1)), -apart])
    return apart - np.median(apart, axis=1, keepdims=True)


def _needed(drift: Array) -> Array:
    """Measurement noise (m) that explains each pair of cars: of two odometers, and of the gaps between them."""
    cars = drift.shape[1]
    out = np.zeros((cars, cars))
    for i, k in combinations(range(cars), 2):
        out[i, k] = out[k, i] = np.abs(drift[:, i] - drift[:, k]).max() / (2 + k - i)
    return out


def _admitting(needed: Array, attacked: int) -> tuple[float, tuple[int, ...]]:
    """The least measurement noise (m, rounded up to 0.1) by which all cars but `attacked` are right, and these."""

    def rest(wrong: tuple[int, ...]) -> float:
        kept = [k for k in range(len(needed)) if k not in wrong]
        return float(needed[np.ix_(kept, kept)].max())

    wrong = min(combinations(range(len(needed)), attacked), key=rest)
    return float(np.ceil(10.0 * rest(wrong)) / 10.0), wrong


def _facts(convoy: Convoy, drift: Array, assumed: float, wrong: tuple[int, ...]) -> list[tuple[str, str]]:
    """For people: who drives, and how far the odometers are from where the gaps put their cars."""
    most = np.abs(drift).max(axis=0)
    but = f" but {', '.join(convoy.names[k] for k in wrong)}" if wrong else ""
    return [
        ("cars", f"{len(convoy.names)}, first to last: {', '.join(convoy.names)}"),
        ("samples", f"{len(drift)}, every {convoy.period:g} s"),
        *(
            (f"odometer of {name}", f"{drift[-1, k]:+.1f} m off at the end, {most[k]:.1f} m at most, by the gaps")
            for k, name in enumerate(convoy.names)
        ),
        ("measurement noise", f"{assumed:g} m, of odometers and gaps; explains all cars{but}"),
    ]


def _doubt(assumed: float, admitting: float, attacked: int) -> list[str]:
    """A note where more odometers drift than may be wrong."""
    if admitting <= assumed:
        return []
    return [
        f"more than {attacked} odometers drift by more than --measurement-noise {assumed:g} and the gaps explain: the "
        f"data may contradict what the filter assumes; {admitting:g} m explain all but {attacked} (--attacked), --from "
        "and --to take a shorter stretch"
    ]


def _measurements(convoy: Convoy, odometer: Array) -> Measurements:
    """Per car: own position and velocity; relative to the car ahead (not of the first); acceleration."""
    columns: list[str] = []
    parts: list[Array] = []
    for k, name in enumerate(convoy.names):
        columns += [f"{name} position [m]", f"{name} velocity [m/s]"]
        parts += [odometer[:, k], convoy.speed[:, k]]
        if k > 0:
            columns += [f"{name} relative position [m]", f"{name} relative velocity [m/s]"]
            parts += [-convoy.gap[:, k - 1], convoy.speed[:, k] - convoy.speed[:, k - 1]]
        columns.append(f"{name} acceleration [m/s^2]")
        parts.append(convoy.acceleration[:, k])
    times = [f"{round(convoy.start + k * convoy.period, 6):.12g}" for k in range(len(odometer))]
    return Measurements(times, columns, np.column_stack(parts))
