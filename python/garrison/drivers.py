"""Drivers: simulate a plant, replay a recording, and the central Kalman filter everybody is compared with."""

from collections.abc import Callable, Iterable, Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from garrison import _core, arguments, doubts, refuted
from garrison.numeric import matched, numbers
from garrison.record import Run
from garrison.sizes import require_memory
from garrison.words import count, hinted, refusal, require_order

Array = NDArray[np.float64]
Progress = Callable[[int, int], None]
Attacks = _core.Attack | Iterable[_core.Attack]

#: what a run keeps when nothing else is asked for, and everything that it can keep
KEEP = ("estimate", "report", "measurements")
_KEEPABLE = (*KEEP, "signals", "details")
#: trials have numbers below this one
_MOST_TRIALS = 2**24


def require_room(model: _core.Model, filter: _core.Filter, keep: Iterable[str], trials: int, steps: int) -> None:
    """Refuse a run whose arrays would not fit into the memory limit, before anything is computed."""
    n, N = model.states, model.agents
    row = {
        "estimate": N * n,
        "report": 6 * N,
        "measurements": model.outputs,
        "signals": len(filter.signal_names) * N,
    }
    doubles = trials * (steps + 1.0) * (n + sum(row.get(name, 0) for name in keep))
    require_memory("steps, trials", f"{count(steps, 'sample')} in {count(trials, 'trial')}", doubles)


def _designed(
    model: _core.Model,
    network: _core.Network,
    filter: _core.Filter,
    design: _core.Design | None,
    certificate: dict[str, Any],
) -> _core.Design:
    if design is None:
        return _core.Design(model, network, filter, **certificate)
    if certificate:
        raise refusal(
            "certificate", f"{certificate['certificate']!r} with a design", "none", "garrison.prepare takes it"
        )
    return design


def _run(
    data: dict[str, Any],
    model: _core.Model,
    network: _core.Network,
    filter: _core.Filter,
    attacks: list[_core.Attack],
    conditions: bool,
) -> Run:
    run = Run(data, model, network, filter)
    if conditions:
        run.warnings[:0] = doubts.of_conditions(model, network, filter)
    run.warnings += doubts.of_attacks(attacks, run.shape[1] - 1)
    quiet = max((a.start for a in attacks), default=0)
    run.warnings += refuted.of_bounds(model, filter, run.measurements)
    run.warnings += refuted.of_rate(filter, run.statistic, run.threshold)
    run.warnings += doubts.of_divergence(model, run.estimate, run.error, quiet)
    return run


def _threads(filter: _core.Filter, attacks: list[_core.Attack], threads: int) -> int:
    """Python code runs in one thread: a filter or an attack of one's own need not be thread-safe."""
    found = arguments.whole("threads", threads, 0)
    return 1 if filter.own or any(attack.own for attack in attacks) else found


@hinted
def simulate(
    model: _core.Model,
    network: _core.Network,
    filter: _core.Filter,
    *,
    steps: int,
    attack: Attacks = (),
    trials: int = 1,
    first_trial: int = 0,
    seed: int = 0,
    x0: ArrayLike | None = None,
    start: ArrayLike | None = None,
    start_error: float = 0.0,
    noise: str | ArrayLike = "auto",
    link: Mapping[str, float] | None = None,
    keep: Iterable[str] = KEEP,
    threads: int = 0,
    progress: Progress | None = None,
    conditions: bool = True,
    certificate: str = "none",
    failure: float = 1e-6,
    attacked: int | None = None,
    levels: tuple[float, float] | None = None,
    design: _core.Design | None = None,
) -> Run:
    """Simulate the plant, attack it, filter it.

    Parameters
    ----------
    model : Model
        The plant and its sensors.
    network : Network
        Who hears whom.
    filter : Filter
        One of garrison.filters, or a filter of your own.
    steps : int
        Samples, >= 1.
    attack : Attack or sequence of them
        Applied in order.
    trials : int
        Independent repetitions, >= 1.
    first_trial : int
        Trial k of this run has the bits of trial first_trial + k of a run from 0, so that a run can be had in
        parts; first_trial + trials <= 2^24.
    x0 : (n,) array, optional
        True initial state, default 0; (N, n) in families whose agents drive plants of their own, default: where
        they should be.
    start : (n,) or (N, n) array, optional
        Initial estimate, common or one per agent, default 0.
    start_error : float
        Moves `start` by a random vector of at most that length per trial, >= 0.
    noise : {"auto", "uniform", "extreme", "normal", "none"} or array
        "uniform" within the model's bounds, "extreme" at them. Families whose agents drive plants of their own
        have laws of their own, and take recorded disturbances, one row per time 0..steps, in place of a law
        (garrison.platoon).
    seed : int
        Of noise, attacks and links, >= 0. Equal arguments give bit-identical results.
    link : dict, optional
        drop and delay (probabilities; a late message is lost to its receiver, whatever delay_rounds says); cuts:
        a list of (sender, receiver, start, stop), None for all agents or no end; lost: recorded losses, a list of
        (sample, round, sender, receiver).
    keep : iterable of str
        Of "estimate", "report", "signals", "measurements", "details" (lists such as sets).
    threads : int
        0 = all cores it may use; the result does not depend on it. Filters and attacks of your own
        (garrison.Filter, garrison.attacks.custom) always run in one.
    progress : callable, optional
        progress(done, total) is called at most once per percent.
    conditions : bool
        Evaluate the filter's conditions first, and put the required ones that are not met into the run's
        `warnings`.
    certificate : {"none", "local", "flooded", "direct"}
        What to certify at run time, see `prepare`.
    failure : float
        Probability in [0, 1), per agent and sample, that a certified bound is wrong; 0 = never, with bounded
        noise.
    attacked : int, optional
        Most sources that lie, >= 0; default the filter's parameter of that name.
    levels : tuple of two floats, optional
        (z1, z2) instead of the covariances' own: what clean records exceed at the rate `failure`, whatever their law
        (`Fitted.levels`, `calibrate`). A bound is then wrong with at most five times that and a quarter.
    design : Design, optional
        Made before of these very three (`prepare` does that).

    Returns
    -------
    Run
        Arrays (trial, time, agent, ..), time 0..steps.

    Raises
    ------
    InvalidInput
        Something does not fit; the message says which, and what was expected.
    """
    require_order("simulate", model, network, filter)
    steps, trials = arguments.whole("steps", steps, 1), arguments.whole("trials", trials, 1)
    wanted = arguments.flag("conditions", conditions)
    attacks, kept = arguments.attacks(attack), arguments.choices("keep", keep, _KEEPABLE)
    require_room(model, filter, kept, trials, steps)
    data = _core.simulate(
        _designed(
            model, network, filter, design, arguments.certificate(filter, certificate, failure, attacked, levels)
        ),
        steps=steps,
        x0=np.zeros(0) if x0 is None else numbers("x0", x0).ravel(),
        start_error=arguments.number("start_error", start_error),
        noise=noise if isinstance(noise, str) else "auto",
        disturbances=np.zeros((0, 0)) if isinstance(noise, str) else arguments.table("noise", noise),
        trials=trials,
        first_trial=arguments.whole("first_trial", first_trial, 0, _MOST_TRIALS - trials),
        seed=arguments.whole("seed", seed, 0, 2**64 - 1),
        threads=_threads(filter, attacks, threads),
        start=None if start is None else arguments.table("start", start),
        attacks=attacks,
        link=arguments.link(link),
        keep=kept,
        progress=arguments.callback("progress", progress),
    )
    return _run(data, model, network, filter, attacks, wanted)


def output_names(model: _core.Model, network: _core.Network | None = None) -> list[str] | None:
    """Names of the columns of measurements: the outputs', or the agents' where each has one output; else None."""
    if names := getattr(model, "output_names", None):
        return [str(n) for n in names]
    names = getattr(network, "names", None)
    return [str(n) for n in names] if names and model.outputs == model.agents else None


@hinted
def replay(
    model: _core.Model,
    network: _core.Network,
    filter: _core.Filter,
    *,
    measurements: ArrayLike,
    truth: ArrayLike | None = None,
    start: ArrayLike | None = None,
    attack: Attacks = (),
    trials: int | None = None,
    first_trial: int = 0,
    seed: int = 0,
    link: Mapping[str, float] | None = None,
    keep: Iterable[str] = KEEP,
    threads: int = 0,
    progress: Progress | None = None,
    conditions: bool = True,
    certificate: str = "none",
    failure: float = 1e-6,
    attacked: int | None = None,
    levels: tuple[float, float] | None = None,
    design: _core.Design | None = None,
) -> Run:
    """Feed recorded measurements to a filter.

    Parameters
    ----------
    model : Model
        The plant and its sensors.
    network : Network
        Who hears whom.
    filter : Filter
        One of garrison.filters, or a filter of your own.
    measurements : (samples, outputs) array
        nan or masked = missing; row r belongs to time r + 1. A pandas table with columns named as the network's
        agents (or the model's outputs) is matched by name. In families with a sample at the start (platoon) row r
        belongs to time r. A leading axis of trials is allowed, one log per trial; otherwise the one log serves
        all trials.
    truth : (samples + 1, n) array, optional
        From time 0; (samples, N, n) in families with a sample at the start. May have a leading axis of trials.
    start : (n,) or (N, n) array, optional
        Initial estimate, common or one per agent, default 0.
    attack : Attack or sequence of them
        On top of the log, in order.
    trials : int, optional
        Repetitions, default one per log.
    first_trial : int
        As in `simulate`.
    seed : int
        Of noise, attacks and links, >= 0. Equal arguments give bit-identical results.
    link : dict, optional
        drop and delay (probabilities; a late message is lost to its receiver, whatever delay_rounds says); cuts:
        a list of (sender, receiver, start, stop), None for all agents or no end; lost: recorded losses, a list of
        (sample, round, sender, receiver).
    keep : iterable of str
        Of "estimate", "report", "signals", "measurements", "details" (lists such as sets).
    threads : int
        0 = all cores it may use; the result does not depend on it. Filters and attacks of your own
        (garrison.Filter, garrison.attacks.custom) always run in one.
    progress : callable, optional
        progress(done, total) is called at most once per percent.
    conditions : bool
        Evaluate the filter's conditions first, and put the required ones that are not met into the run's
        `warnings`.
    certificate : {"none", "local", "flooded", "direct"}
        What to certify at run time, see `prepare`.
    failure : float
        Probability in [0, 1), per agent and sample, that a certified bound is wrong; 0 = never, with bounded
        noise.
    attacked : int, optional
        Most sources that lie, >= 0; default the filter's parameter of that name.
    levels : tuple of two floats, optional
        (z1, z2) instead of the covariances' own: what clean records exceed at the rate `failure`, whatever their law
        (`Fitted.levels`, `calibrate`). A bound is then wrong with at most five times that and a quarter.
    design : Design, optional
        Made before of these very three (`prepare` does that).

    Returns
    -------
    Run
        Arrays (trial, time, agent, ..).

    Raises
    ------
    InvalidInput
        Something does not fit; the message says which, and what was expected.
    """
    require_order("replay", model, network, filter)
    y = numbers("measurements", matched("measurements", measurements, output_names(model, network)))
    trials = (len(y) if y.ndim == 3 else 1) if trials is None else arguments.whole("trials", trials, 1)
    wanted = arguments.flag("conditions", conditions)
    attacks, kept = arguments.attacks(attack), arguments.choices("keep", keep, _KEEPABLE)
    require_room(model, filter, kept, trials, y.shape[-2] if y.ndim >= 2 else 0)
    data = _core.replay(
        _designed(
            model, network, filter, design, arguments.certificate(filter, certificate, failure, attacked, levels)
        ),
        measurements=y,
        truth=None if truth is None else numbers("truth", truth),
        trials=trials,
        first_trial=arguments.whole("first_trial", first_trial, 0, _MOST_TRIALS - trials),
        seed=arguments.whole("seed", seed, 0, 2**64 - 1),
        threads=_threads(filter, attacks, threads),
        start=None if start is None else arguments.table("start", start),
        attacks=attacks,
        link=arguments.link(link),
        keep=kept,
        progress=arguments.callback("progress", progress),
    )
    return _run(data, model, network, filter, attacks, wanted)


@hinted
def central_kalman(
    model: _core.Model,
    measurements: ArrayLike,
    *,
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
    model : Model
        With covariances.
    measurements : (samples, outputs) array
        nan or masked = missing. A pandas table with columns named as the model's outputs is matched by name.
    start : (n,) array, optional
        Initial estimate, default 0.
    start_variance : float
        Variance of every entry of `start`, >= 0.
    gate : float, optional
        Probability, 0..1, at which an honest output is left out by a chi-square test of its own innovation.
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
    if not isinstance(model, _core.Model):
        raise refusal("central_kalman: model", f"a {type(model).__name__}", "a garrison.Model")
    x0 = np.zeros(model.states) if start is None else numbers("start", start)
    y = numbers("measurements", matched("measurements", measurements, output_names(model)))
    if y.ndim != 2 or x0.shape != (model.states,):
        got = f"measurements {y.shape} and start {x0.shape}"
        raise refusal("central_kalman", got, f"(samples, {model.outputs}) and ({model.states},)")
    screen = {
        "gate": 0.0 if gate is None else arguments.number("gate", gate),
        "huber": np.inf if huber is None else arguments.number("huber", huber),
    }
    return _core.central_kalman(model, y, x0, arguments.number("start_variance", start_variance), **screen)
