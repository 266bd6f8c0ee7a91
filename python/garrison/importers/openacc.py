"""Vehicles in a string, recorded on the road: OpenACC files as a scenario of the platoon filter.

Every car has an odometer (its recorded speed, integrated from the first gap on) as its absolute sensor; the recorded
gaps to the car ahead are the relative ones; the input is the recorded acceleration, or the difference of speeds.
"""

from collections.abc import Sequence
from dataclasses import dataclass
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
#: sensor noise of both sides of a comparison, and of the gap between them
_FAR = 3.0


@dataclass(frozen=True)
class Noise:
    """What the filter is told: lengths of noise vectors (m, m/s) and of the first error; attacked sensors."""

    process: float = 0.06
    measurement: float = 2.0
    initial: float = 20.0
    attacked: int = 1

    def __post_init__(self) -> None:
        require_positive(process_noise=self.process, measurement_noise=self.measurement, initial_error=self.initial)


def import_openacc(
    paths: Sequence[Path], noise: Noise | None = None, between: tuple[float | None, float | None] = (None, None)
) -> Bundle:
    """One recording of a string of cars: a file with all of them, or one file per follower.

    between: first and last time that is used, s. Raises IoError or InvalidInput where a file is none, or has less than
    three cars in a row.
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
        raise refusal("--attacked", str(noise.attacked), f"1..{reach}, half of the {cars} cars without the car itself")
    odometer = _odometers(convoy)
    tables = {
        "title": f"{cars} recorded cars: {', '.join(convoy.names)}",
        "model": {"vehicles": cars, "period": convoy.period, "inputs": True, "names": convoy.names},
        "network": {"kind": "band", "range": reach},
        "data": {"file": "measurements.csv"},
        "filter": _filter(noise),
        "run": {"start": [[float(odometer[0, k]), float(convoy.speed[0, k])] for k in range(cars)]},
    }
    facts, notes = _facts(convoy, odometer, noise)
    return Bundle(tables, SOURCE, _measurements(convoy, odometer), facts=facts, notes=[*convoy.notes, *notes])


def _filter(noise: Noise) -> dict[str, object]:
    return {
        "name": "platoon",
        "label": "platoon",
        "attacked": noise.attacked,
        "process_noise": noise.process,
        "measurement_noise": noise.measurement,
        "initial_error": noise.initial,
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


def _facts(convoy: Convoy, odometer: Array, noise: Noise) -> tuple[list[tuple[str, str]], list[str]]:
    """Facts for people, and a note where more odometers drift than may be wrong."""
    drift = _drifts(convoy, odometer)
    most = np.abs(drift).max(axis=0)
    facts = [
        ("cars", f"{len(convoy.names)}, first to last: {', '.join(convoy.names)}"),
        ("samples", f"{len(odometer)}, every {convoy.period:g} s"),
        *(
            (f"odometer of {name}", f"{drift[-1, k]:+.1f} m off at the end, {most[k]:.1f} m at most, by the gaps")
            for k, name in enumerate(convoy.names)
        ),
    ]
    wrong = int((most > _FAR * noise.measurement).sum())
    if wrong <= noise.attacked:
        return facts, []
    bound = float(np.sort(most)[-1 - noise.attacked]) / _FAR
    return facts, [
        f"{wrong} odometers drift by more than {_FAR:g} times --measurement-noise ({noise.measurement:g} m), and "
        f"--attacked says {noise.attacked}: the data may contradict what the filter assumes; --measurement-noise "
        f"{np.ceil(10 * bound) / 10:g} admits all but {noise.attacked}, --from and --to take a shorter stretch"
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
