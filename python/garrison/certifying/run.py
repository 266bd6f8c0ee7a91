"""gr.certify."""

from __future__ import annotations

from collections.abc import Callable
from math import comb
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from garrison import _core, arguments
from garrison.certifying.certified import Certified
from garrison.certifying.contradiction import of_apart, of_dependence
from garrison.certifying.methods import Record, by_bank, by_window, rule, steady, steady_window
from garrison.certifying.plant import Plant
from garrison.numeric import matched, numbers, output_names
from garrison.varying import Inputs, inputs_of
from garrison.words import count, hinted, refusal, shown

Array = NDArray[np.float64]

#: filters of a bank up to which "auto" takes one
_MOST_MEMBERS = 3000
#: standard deviations of a measurement that a state may be away: rounding is then a hundredth of one
_MOST_DEVIATIONS = 1e13
_LONGEST_WINDOW = 1000
METHODS = ("auto", "bank", "window")


@hinted
def certify(
    model: _core.Model,
    measurements: ArrayLike,
    *,
    attacked: int,
    failure: float = 1e-6,
    method: str = "auto",
    window: int = 20,
    moving: bool = False,
    start: ArrayLike | None = None,
    start_covariance: ArrayLike | None = None,
    inputs: Inputs = None,
    progress: Callable[[int, int], None] | None = None,
) -> Certified:
    """Certify the state from measurements alone: a region that holds whatever at most `attacked` sources say.

    Who can falsify a measurement is its source (`sources` of the model; every agent is one where none are given):
    redundancy of sources counts, not of numbers. A bank of filters stays bounded exactly where the plant is detectable
    without any 2 * attacked sources. Definitions and proofs: docs/certificates.md, sections 8 and 9.

    Parameters
    ----------
    model : Model
        With process_covariance and measurement_covariance of white Gaussian noise: noise that remembers its past
        voids the certificate. `Certified.warnings` tell where the measurements show it.
    measurements : (samples, outputs) array
        nan or masked = missing. A pandas table with columns named as the model's outputs is matched by name.
    attacked : int
        Most sources that lie, >= 0: always the same ones, or (moving) other ones at every sample.
    failure : float
        Probability that the region of a sample is wrong, in (0, 1).
    method : str
        "bank", "window", or "auto": a bank where the liars do not change and it has at most 3000 filters.
    window : int
        Samples of a window, 1..1000; also of the window that a bank starts from, where `start` is not given.
    moving : bool
        The liars may change from sample to sample.
    start, start_covariance : (n,) and (n, n) array, optional
        For a bank: mean and covariance of the state at the first sample, before its measurements.
    inputs : (samples, p) array, table or function of t, optional
        Known inputs of a model with B: row k moved the plant to the sample of row k of the measurements.
    progress : callable, optional
        progress(done, total) is called after every sample.

    Returns
    -------
    Certified
        Prints in words.

    Raises
    ------
    InvalidInput
        Something does not fit; the message says which, and what was expected.
    """
    if not isinstance(model, _core.Model):
        raise refusal("model", shown(model), "a garrison.Model")
    plant = Plant(model)
    y = numbers("measurements", matched("measurements", measurements, output_names(model)))
    if y.ndim != 2 or y.shape[1] != len(plant.rows):
        raise refusal("measurements", f"shape {y.shape}", f"(samples, {len(plant.rows)}), a column per output")
    if np.isinf(y).any():
        raise refusal("measurements", "an infinite number", "finite numbers, nan = missing")
    s = arguments.whole("attacked", attacked, 0, len(plant.names))
    failure = arguments.probability("failure", failure)
    moving = arguments.flag("moving", moving)
    length = arguments.whole("window", window, 1, _LONGEST_WINDOW)
    chosen = _method(method, moving, comb(len(plant.names), s))
    first = _start(model.states, start, start_covariance, chosen)
    tell = arguments.callback("progress", progress)
    told = (lambda done: tell(done, len(y))) if tell else (lambda _: None)
    moved = _moved(model, inputs_of(model, inputs, len(y)), len(y))
    white = plant.whitened(y)
    if chosen == "bank":
        record = by_bank(plant, white, moved, s, failure, length, first, _MOST_MEMBERS, told)
        for_ever = steady(plant, s, failure, len(y))
    else:
        record = by_window(plant, white, moved, s, failure, length, moving, _MOST_MEMBERS, told)
        for_ever = None if moving else steady_window(plant, s, failure, length)
    lost = _forget_beyond_doubles(record, plant)
    return Certified(
        center=record.center,
        box=record.box,
        radius=record.radius,
        proved=[[plant.names[k] for k in some] for some in record.proved],
        sources=plant.names,
        attacked=s,
        failure=failure,
        method=chosen,
        rule="B" if chosen == "bank" else rule(plant, s, moving, length)[0],
        window=length,
        steady=for_ever,
        warnings=lost + _warnings(record, plant, model, failure),
    )


def _forget_beyond_doubles(record: Record, plant: Plant) -> list[str]:
    """No region and no proof from the sample on at which the state is so far away that rounding counts beside noise."""
    with np.errstate(invalid="ignore", over="ignore"):
        far = np.abs(record.center @ plant.rows.T).max(axis=1) > _MOST_DEVIATIONS
    if not far.any():
        return []
    first = int(np.argmax(far))
    record.center[first:], record.box[first:], record.radius[first:] = np.nan, np.inf, np.inf
    record.proved[first:] = [[] for _ in record.proved[first:]]
    return [
        f"no region and no proof from sample {first} on: the state has gone {_MOST_DEVIATIONS:g} standard deviations "
        "of the measurements away, where numbers of 16 digits do not hold the noise any more"
    ]


def _warnings(record: Record, plant: Plant, model: _core.Model, failure: float) -> list[str]:
    """What the measurements say against the model."""
    lines = []
    if record.apart:
        first, state = record.apart[0]
        where = list(model.state_names)[state]
        lines += of_apart(len(record.apart), len(record.radius), first, where, failure)
    evidence, source, correlation, pairs = record.dependence
    return lines + of_dependence(evidence, 1, f"source {plant.names[source]}", correlation, pairs)


def _moved(model: _core.Model, inputs: Array, samples: int) -> Array:
    """What the known inputs add to the state of every sample: B u."""
    if not inputs.size:
        return np.zeros((samples, model.states))
    if len(inputs) != samples:
        raise refusal("inputs", count(len(inputs), "row"), f"{samples}, one per row of the measurements")
    return np.asarray(inputs @ np.asarray(model.B).T, dtype=float)


def _method(method: Any, moving: bool, members: int) -> str:
    (chosen,) = arguments.choices("method", arguments.text("method", method), METHODS)
    if chosen == "auto":
        return "window" if moving or members > _MOST_MEMBERS else "bank"
    if chosen == "bank" and moving:
        raise refusal("method", "'bank' with moving = True", "'window'", "a bank needs liars that never change")
    if chosen == "bank" and members > _MOST_MEMBERS:
        raise refusal("method", f"a bank of {members} filters", f"at most {_MOST_MEMBERS}", "use method = 'window'")
    return chosen


def _start(n: int, mean: ArrayLike | None, covariance: ArrayLike | None, method: str) -> tuple[Array, Array] | None:
    if mean is None and covariance is None:
        return None
    if mean is None or covariance is None:
        raise refusal("start, start_covariance", "one of them", "both or none")
    if method == "window":
        raise refusal("start", "a start for windows", "none", "a window knows nothing but its own samples")
    x0, P0 = numbers("start", mean), numbers("start_covariance", covariance)
    if x0.shape != (n,) or P0.shape != (n, n):
        raise refusal("start, start_covariance", f"shapes {x0.shape} and {P0.shape}", f"{(n,)} and {(n, n)}")
    return x0, P0
