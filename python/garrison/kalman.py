"""Kalman filters that see measurements as they come: the baselines that everybody is compared with. No bounds."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from garrison import _core, arguments
from garrison.numeric import matched, numbers, output_names
from garrison.varying import Inputs, VaryingModel, at_time, inputs_of, parted
from garrison.words import hinted, refusal, require_plant

Array = NDArray[np.float64]


def _screen(gate: float | None, huber: float | None) -> dict[str, Any]:
    return {
        "gate": 0.0 if gate is None else arguments.number("gate", gate),
        "huber": np.inf if huber is None else arguments.number("huber", huber),
    }


@hinted
def central_kalman(
    model: _core.Model | VaryingModel,
    measurements: ArrayLike,
    *,
    inputs: Inputs = None,
    start: ArrayLike | None = None,
    start_variance: float = 1.0,
    gate: float | None = None,
    huber: float | None = None,
) -> Array:
    """Estimates of a central Kalman filter that sees all measurements.

    Unprotected it is the ideal that distributed filters are compared with; `gate` and `huber` are the protections
    in use today. At most one of them; neither has a bound.

    Parameters
    ----------
    model : Model or VaryingModel
        With covariances.
    measurements : (samples, outputs) array
        nan or masked = missing. A pandas table with columns named as the model's outputs is matched by name.
    inputs : (samples, p) array, table or function of t, optional
        Known inputs of a model with B, as in `simulate`.
    start : (n,) array, optional
        Initial estimate, default 0.
    start_variance : float
        Variance of every entry of `start`, >= 0.
    gate : float, optional
        Probability, in (0, 1), or 0 for none, at which an honest output is left out by a chi-square test of its own
        innovation.
    huber : float, optional
        Deviations, > 0 (1.345 is usual), from which on a larger residual pulls no harder (M-estimation by iterated
        weights, Durovic and Kovacevic 1999).

    Returns
    -------
    (samples + 1, n) array
        Estimates from time 0.

    Raises
    ------
    InvalidInput
        Something does not fit; the message says which, and what was expected.
    """
    plain, series = parted(model)
    if not isinstance(plain, _core.Model):
        raise refusal("central_kalman: model", f"a {type(model).__name__}", "a garrison.Model")
    x0 = np.zeros(plain.states) if start is None else numbers("start", start)
    y = numbers("measurements", matched("measurements", measurements, output_names(plain)))
    if y.ndim != 2 or x0.shape != (plain.states,):
        got = f"measurements {y.shape} and start {x0.shape}"
        raise refusal("central_kalman", got, f"(samples, {plain.outputs}) and ({plain.states},)")
    known: dict[str, Any] = {"inputs": inputs_of(plain, inputs, len(y)), "series": series}
    variance = arguments.number("start_variance", start_variance)
    return _core.central_kalman(plain, y, x0, variance, **_screen(gate, huber), **known)


@hinted
def local_kalman(
    model: _core.Model | VaryingModel,
    network: _core.Network,
    measurements: ArrayLike,
    *,
    inputs: Inputs = None,
    start: ArrayLike | None = None,
    start_variance: float = 1.0,
    gate: float | None = None,
    huber: float | None = None,
) -> Array:
    """Estimates of a Kalman filter per agent, of its own measurements and those of the neighbours that it hears.

    What people use today where there is no centre: agents exchange measurements once, and nothing else. With `gate`
    or `huber` as in `central_kalman`; no bound.

    Parameters
    ----------
    model : Model or VaryingModel
        With covariances.
    network : Network
        Who hears whom.
    measurements : (samples, outputs) array
        As in `central_kalman`; of a run, `run.measurements[trial]`.
    inputs : (samples, p) array, table or function of t, optional
        Known inputs of a model with B, as in `simulate`.
    start : (n,) or (N, n) array, optional
        Initial estimate, common or one per agent, default 0.
    start_variance : float
        Variance of every entry of `start`, >= 0.
    gate, huber : float, optional
        As in `central_kalman`; at most one of them.

    Returns
    -------
    (samples + 1, N, n) array
        Estimates from time 0.

    Raises
    ------
    InvalidInput
        Something does not fit; the message says which, and what was expected.
    """
    plain, series = parted(model)
    require_plant("local_kalman", plain, network)
    shape = (plain.agents, plain.states)
    x0 = np.zeros(shape) if start is None else numbers("start", start)
    y = numbers("measurements", matched("measurements", measurements, output_names(plain, network)))
    if y.ndim != 2 or x0.shape not in (shape, shape[1:]):
        got = f"measurements {y.shape} and start {x0.shape}"
        raise refusal("local_kalman", got, f"(samples, {plain.outputs}) and ({plain.states},) or {shape}")
    known: dict[str, Any] = {"inputs": inputs_of(plain, inputs, len(y)), "series": series}
    variance = arguments.number("start_variance", start_variance)
    starts = np.ascontiguousarray(np.broadcast_to(x0, shape))
    found = _core.local_kalman(plain, network, y, starts, variance, **_screen(gate, huber), **known)
    return np.stack(found, axis=1)


@hinted
def extended_kalman(
    f: Callable[..., ArrayLike],
    h: Callable[..., ArrayLike],
    measurements: ArrayLike,
    *,
    process_covariance: ArrayLike | float,
    measurement_variance: ArrayLike | float,
    start: ArrayLike,
    start_covariance: ArrayLike | float = 1.0,
    inputs: Inputs = None,
    f_jacobian: Callable[..., ArrayLike] | None = None,
    h_jacobian: Callable[..., ArrayLike] | None = None,
    gate: float | None = None,
    huber: float | None = None,
) -> Array:
    """Estimates of an extended Kalman filter: a nonlinear plant by functions, all measurements in one place.

    x(t+1) = f(x(t), u(t), t) + w(t), y(t) = h(x(t), t) + v(t), linearised about the estimate. A baseline: no bound.

    Parameters
    ----------
    f : function (x, u, t) -> (n,)
        The plant; u is empty without inputs.
    h : function (x, t) -> (m,)
        What is measured.
    measurements : (samples, m) array
        nan or masked = missing; row r belongs to time r + 1.
    process_covariance : (n, n) or (samples, n, n) array, or float
        Of w, constant or of every step; a number is times the identity.
    measurement_variance : (m,) or (samples, m) array, or float
        Of v, >= 0, constant or of every sample; outputs are independent.
    start : (n,) array
        Initial estimate.
    start_covariance : (n, n) array or float
        Of its error; a number is times the identity.
    inputs : (samples, p) array or function of t, optional
        Row t is u(t), which leads from time t to t + 1.
    f_jacobian : function (x, u, t) -> (n, n), optional
        Derivative of f in x; default by central differences.
    h_jacobian : function (x, t) -> (m, n), optional
        Derivative of h in x; default by central differences.
    gate, huber : float, optional
        As in `central_kalman`; at most one of them.

    Returns
    -------
    (samples + 1, n) array
        Estimates from time 0.

    Raises
    ------
    InvalidInput
        Something does not fit, or a function returns what is not finite; what it raises itself passes.
    """
    for name, given in {"f": f, "h": h}.items():
        if not callable(given):
            raise refusal(f"extended_kalman.{name}", str(given), "a function")
    jacobians: dict[str, Any] = {"f_jacobian": f_jacobian, "h_jacobian": h_jacobian}
    for name, derivative in jacobians.items():
        if derivative is not None and not callable(derivative):
            raise refusal(f"extended_kalman.{name}", str(derivative), "a function, or None for central differences")
    x0, y = numbers("start", start).ravel(), numbers("measurements", measurements)
    if y.ndim != 2:
        raise refusal("extended_kalman.measurements", f"{y.shape}", "(samples, m)")
    return _core.extended_kalman(
        f,
        h,
        y,
        x0,
        _square("start_covariance", start_covariance, len(x0)),
        {"process_covariance": _over_time(_square("process_covariance", process_covariance, len(x0)))},
        _variances(measurement_variance, y.shape[1]),
        _rows(inputs, len(y)),
        **jacobians,
        **_screen(gate, huber),
    )


def _square(which: str, given: Any, n: int) -> Array:
    found = numbers(which, given)
    return found * np.eye(n) if found.ndim == 0 else np.atleast_2d(found)


def _over_time(covariance: Array) -> Array:
    return covariance[None] if covariance.ndim == 2 else covariance


def _variances(given: Any, outputs: int) -> Array:
    """A row of variances, or one per sample."""
    found = numbers("measurement_variance", given)
    if found.ndim > 2:
        raise refusal("measurement_variance", f"{found.shape}", f"({outputs},) or (samples, {outputs})")
    return np.full((1, outputs), float(found)) if found.ndim == 0 else np.atleast_2d(found)


def _rows(inputs: Any, samples: int) -> Array:
    """One row of inputs per step; none: rows without numbers."""
    if inputs is None:
        return np.zeros((samples, 0))
    given = [at_time("inputs", inputs, t).ravel() for t in range(samples)] if callable(inputs) else inputs
    found = numbers("inputs", given)
    return found[:, None] if found.ndim == 1 else found
