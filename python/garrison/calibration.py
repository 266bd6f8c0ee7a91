"""Levels from clean records: what was asked for on paper, and what has to be asked for to get it on real data."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from garrison import _core, arguments
from garrison.clean import clean_levels, clean_residuals
from garrison.drivers import replay
from garrison.numeric import numbers
from garrison.objects import described_model, model_of
from garrison.record import Run
from garrison.result import Result
from garrison.varying import Inputs, inputs_of
from garrison.words import count, hinted, hinted_methods, refusal, require_order

Array = NDArray[np.float64]

#: parameter of a filter that sets the rate of its false alarms
_RATE = "false_alarm"
#: smallest nominal rate that is tried, and the relative accuracy of the one that is found
_LEAST, _ACCURACY = 1e-300, 5e-3
#: parts of the records in which rates are looked at apart, and deviations between these that are allowed for where
#: the rate cannot be judged: on the Irish wind as many later rates are then too high as too low
_PARTS, _MARGIN = 5, 0.5
#: alarms on the records, counted as so many independent ones, from which on the rate of later ones is within a factor
#: of two with 95 %: both are then known to a quarter. Blocks of the records whose counts say how they cluster
_ENOUGH, _BLOCKS = 16.0, 20


@hinted_methods
@dataclass(frozen=True, eq=False, repr=False)
class Calibration(Result):
    """A filter whose false alarms on clean records are as frequent as asked.

    All of it holds for records like the ones it was made from: a season, an instrument or a climate that they do not
    contain voids it.

    Attributes
    ----------
    filter : Filter
        The same with the nominal rate `nominal` in place of `asked`.
    asked, nominal : float
        Rates of false alarms, in (0, 1).
    before, got : float
        Share of alarms among the tests with the filter as it was given, and now.
    by_part : tuple of float
        The share now in each fifth of the records: what a later record may differ by.
    tests : int
        Of all sensors together, over which the rates are taken.
    doubt : str
        Why so rare an alarm could not be judged on these records: too few alarms that do not come together (storms,
        overlapping windows); the rate on others may then be another one altogether. "" where it could be judged.
    thresholds : (N, 3) array
        Of every sensor's statistic the level that it exceeds at the rate asked for, and an interval that holds the true
        one with 95 % if the tests are independent (tests over overlapping windows are not: take it as optimistic); nan
        where there are too few tests.
    model : Model
        With noise bounds that hold on these records too.
    exceeds : float
        The next record breaks one of them with this chance at most, if it is like these.
    levels : tuple of float or None
        (z1, z2) of the certificates for `attacked` sensors and the rate asked for; None where they do not exist
        (several states, or too few records).
    """

    filter: _core.Filter
    asked: float
    nominal: float
    before: float
    got: float
    by_part: tuple[float, ...]
    tests: int
    doubt: str
    thresholds: Array
    model: _core.Model
    exceeds: float
    levels: tuple[float, float] | None

    @property
    def judged(self) -> bool:
        """Without a doubt: the rate on other records like these is within a factor of two with 95 %."""
        return not self.doubt


@hinted
def calibrate(
    model: _core.Model,
    network: _core.Network,
    filter: _core.Filter,
    *,
    measurements: ArrayLike,
    inputs: Inputs = None,
    attacked: int = 1,
    progress: Callable[[str, float], None] | None = None,
) -> Calibration:
    """Set a filter's nominal false-alarm rate so that the rate asked for is what clean records give.

    The nominal rate is the one at which the share of alarms on these records is the one asked for; where too few alarms
    are left to judge it, less half a deviation between fifths of the records beyond chance. What the records do
    not contain they say nothing of: levels that drift from year to year show in records of several years alone, and so
    does a model that was fitted to too few (on the Irish wind, of which 4 years or more were fitted, calibrated on and
    tested in any order, 3 of 234 rates were off by more than a factor of two; of 3 years 38 of 456, of 2 years 127 of
    909).

    Parameters
    ----------
    model : Model
        The plant and its sensors.
    network : Network
        Who hears whom.
    filter : Filter
        With a parameter false_alarm.
    measurements : (samples, outputs) array
        Of records without attacks that the model was NOT fitted to, nan = missing.
    inputs : (samples, p) array, table or function of t, optional
        Known inputs of a model with B, as for `replay`: the row of a sample led to it.
    attacked : int
        Most sensors attacked, for the certificates' levels.
    progress : callable, optional
        progress(what, seconds) is called before every one of the 10 to 40 replays of the records: at which nominal
        rate, and for how long all of it lasts already.

    Returns
    -------
    Calibration
        What to set, and what was got before and after.

    Raises
    ------
    InvalidInput
        The filter has no false_alarm, there are fewer than 1/false_alarm tests, or something does not fit.
    """
    require_order("calibrate", model, network, filter)
    y = numbers("measurements", measurements)
    if y.ndim != 2:
        raise refusal("measurements", f"shape {y.shape}", "(samples, outputs)")
    known = inputs_of(model, inputs, len(y)) if model.inputs or inputs is not None else None
    attacked = arguments.whole("attacked", attacked, 0, model.agents - 1)
    asked = filter.params.get(_RATE)
    if not isinstance(asked, float):
        raise refusal("filter", filter.name, "a filter with a false-alarm rate", "its parameter is called false_alarm")

    tell, began = arguments.callback("progress", progress, "(what, seconds)"), time.monotonic()

    def run_at(rate: float) -> Run:
        if tell is not None:
            tell(f"replaying {filter.name} with {_RATE} = {rate:.3g}", time.monotonic() - began)
        again = _core.make_filter(filter.name, filter.params | {_RATE: rate})
        return replay(model, network, again, measurements=y, inputs=known, keep=("report",), conditions=False)

    def matching(margin: float) -> float:
        return _matching(lambda rate: _allowed(_ratios(run_at(rate)), asked, margin) / asked, asked)

    before = _ratios(run_at(asked))
    tests = int(np.isfinite(before).sum())
    if tests < 1.0 / asked:
        raise refusal(
            "measurements", count(tests, "test"), f"at least {1.0 / asked:.0f}", "calibrate on more clean records"
        )
    nominal = matching(0.0)
    last = run_at(nominal)
    if _doubt(_ratios(last)):
        nominal = matching(_MARGIN)
        last = run_at(nominal)
    after = _ratios(last)
    assert last.statistic is not None
    thresholds = np.array(
        [_core.certificate.empirical_quantile(s, asked) for s in np.reshape(last.statistic, (-1, model.agents)).T]
    )
    inflated, exceeds = _inflated(model, y, known)
    return Calibration(
        _core.make_filter(filter.name, filter.params | {_RATE: nominal}),
        asked,
        nominal,
        _share(before),
        _share(after),
        tuple(_share(part) for part in np.array_split(after, _PARTS)),
        tests,
        _doubt(after),
        thresholds,
        inflated,
        exceeds,
        clean_levels(model, y, attacked, asked),
    )


def _ratios(run: Run) -> Array:
    """Statistic / threshold of every sample and sensor; nan = not tested."""
    assert run.statistic is not None
    assert run.threshold is not None
    found: Array = (run.statistic / run.threshold)[0]
    return found


def _share(ratios: Array) -> float:
    """Of the tests that are an alarm; nan without tests."""
    tests = np.isfinite(ratios).sum()
    return float((ratios > 1.0).sum() / tests) if tests else float("nan")


def _independent(ratios: Array) -> float:
    """Alarms, counted as so many independent ones: alarms that come in clusters vary more from block to block."""
    blocks = np.array_split(ratios, _BLOCKS)
    alarms = np.array([(block > 1.0).sum() for block in blocks], dtype=float)
    tests = np.array([np.isfinite(block).sum() for block in blocks], dtype=float)
    if not alarms.any():
        return 0.0
    expected = tests * alarms.sum() / tests.sum()
    clusters = float(np.sum((alarms - expected) ** 2) / (_BLOCKS - 1) / expected.mean())
    return float(alarms.sum()) / max(1.0, clusters)


def _doubt(ratios: Array) -> str:
    """Why so rare an alarm cannot be judged; "" where it can."""
    alarms, independent = int((ratios > 1.0).sum()), _independent(ratios)
    if independent >= _ENOUGH:
        return ""
    clusters = ""
    if alarms >= _ENOUGH:
        clusters = f", which come together like {independent:.2g} (overlapping windows, storms)"
    return f"{count(alarms, 'alarm')} on these records{clusters}, and {_ENOUGH:g} independent ones are needed"


def _allowed(ratios: Array, asked: float, margin: float) -> float:
    """The share of alarms, and what parts of the records differ by beyond chance on top, so many deviations of it."""
    shares = np.array([_share(part) for part in np.array_split(ratios, _PARTS)])
    shares = shares[np.isfinite(shares)]
    if len(shares) < 2:
        return _share(ratios)
    chance = asked * len(shares) / np.isfinite(ratios).sum()
    return _share(ratios) + margin * float(np.sqrt(max(0.0, np.var(shares, ddof=1) - chance)))


def _matching(over: Callable[[float], float], asked: float) -> float:
    """The rate at which over(rate), which grows with it, is 1: bisection of its logarithm."""
    low, high = np.log(asked), np.log(asked)
    while over(float(np.exp(low))) > 1.0:
        low = 2.0 * low
        if low < np.log(_LEAST):
            raise refusal(
                "measurements",
                f"more alarms than {asked:g} at every nominal rate",
                "clean records",
                "is a sensor attacked or broken in them?",
            )
    while over(float(np.exp(high))) < 1.0 and high < np.log(0.5):
        high = 0.5 * high
    while high - low > _ACCURACY * abs(low):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if over(float(np.exp(middle))) > 1.0 else (middle, high)
    return float(np.exp(low))


def _inflated(model: _core.Model, y: Array, inputs: Array | None) -> tuple[_core.Model, float]:
    """The model with bounds that these records keep too, and the chance that the next one breaks one of them."""
    v, w = clean_residuals(model, y, inputs)
    v = v[np.isfinite(v).all(axis=1)]
    w = w[np.isfinite(w).all(axis=1)]
    plain = described_model(model)
    bounds = np.asarray(model.measurement_bound)
    if len(v) == 0 or len(w) == 0 or bounds.size == 0 or not np.isfinite(model.process_bound):
        return model, float("nan")
    owner = np.repeat(np.arange(model.agents), [len(c) for c in model.C])
    seen = np.array([np.abs(v[:, owner == i]).max(initial=0.0) for i in range(model.agents)])
    plain["measurement_bound"] = np.maximum(bounds, seen).tolist()
    plain["process_bound"] = max(model.process_bound, float(np.linalg.norm(w, axis=1).max()))
    return model_of(plain), (model.agents + 1.0) / (len(v) + 1.0)
