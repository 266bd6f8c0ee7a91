"""Drivers: simulate a plant, replay a recording."""

from collections.abc import Callable, Iterable, Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from garrison import _core, arguments, doubts, refuted
from garrison.numeric import matched, numbers, output_names
from garrison.objects import described_attack, plain_data
from garrison.recipe import recipe
from garrison.record import Run
from garrison.sizes import require_memory
from garrison.varying import Inputs, VaryingModel, inputs_of, parted
from garrison.varying_network import VaryingNetwork, links_of
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
    certificate: str,
    failure: float,
    attacked: int | None,
    levels: tuple[float, float] | None,
) -> _core.Design:
    wanted = arguments.certificate(filter, certificate, failure, attacked, levels)
    if design is None:
        return _core.Design(model, network, filter, **wanted)
    if wanted:
        raise refusal("certificate", f"{certificate!r} with a design", "none", "garrison.prepare takes it")
    return design


def _run(
    data: dict[str, Any],
    model: _core.Model,
    network: _core.Network,
    filter: _core.Filter,
    design: _core.Design,
    attacks: list[_core.Attack],
    conditions: bool,
    known: dict[str, Any],
) -> Run:
    series = known["series"]
    run = Run(data | ({"inputs": known["inputs"]} if model.inputs else {}), model, network, filter, series)
    if conditions and not series:
        run.warnings[:0] = doubts.of_conditions(model, network, filter)
    if "A" in series or "C" in series:
        run.warnings.append("the plant changes in time: no theorem and no condition of a filter covers it")
    run.warnings += doubts.of_attacks(attacks, run.shape[1] - 1)
    run.warnings += doubts.of_alarms(filter, run.shape[1] - 1)
    run.warnings += doubts.of_losses(run.bound, run.verdict, run.counters)
    quiet = max((a.start for a in attacks), default=0)
    if "C" not in series:
        u = known["inputs"]
        run.warnings += refuted.of_bounds(
            model,
            filter,
            run.measurements,
            attacked=(design.certificate or {}).get("attacked"),
            inputs=u if len(u) else None,
            constant=not series and bool(not model.inputs or len(u)),
        )
    run.warnings += refuted.of_rate(filter, run.statistic, run.threshold)
    run.warnings += [] if "A" in series else doubts.of_divergence(model, run.estimate, run.error, quiet)
    return run


def _threads(filter: _core.Filter, attacks: list[_core.Attack], threads: int) -> int:
    """Python code runs in one thread: a filter or an attack of one's own need not be thread-safe."""
    found = arguments.whole("threads", threads, 0)
    return 1 if filter.own or any(attack.own for attack in attacks) else found


@hinted
def simulate(
    model: _core.Model | VaryingModel,
    network: _core.Network | VaryingNetwork,
    filter: _core.Filter,
    *,
    steps: int,
    inputs: Inputs = None,
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
    model : Model or VaryingModel
        The plant and its sensors.
    network : Network or VaryingNetwork
        Who hears whom.
    filter : Filter
        One of garrison.filters, or a filter of your own.
    steps : int
        Samples, >= 1.
    inputs : (steps, p) array, table or function of t, optional
        Known inputs of a model with B: row t is u(t), which leads from time t to t + 1. A pandas table with columns
        named as the model's inputs is matched by name. Estimates, errors and bounds are those of the state
        (docs/adr/0016); what lies in messages say is said of the state without the inputs' response.
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
    steps, trials = arguments.whole("steps", steps, 1), arguments.whole("trials", trials, 1)
    base, series = parted(model)
    ground, links = links_of(network, arguments.link(link), steps)
    require_order("simulate", base, ground, filter)
    known: dict[str, Any] = {"inputs": inputs_of(base, inputs, steps), "series": series}
    wanted = arguments.flag("conditions", conditions)
    attacks, kept = arguments.attacks(attack), arguments.choices("keep", keep, _KEEPABLE)
    require_room(base, filter, kept, trials, steps)
    design = _designed(base, ground, filter, design, certificate, failure, attacked, levels)
    data = _core.simulate(
        design,
        steps=steps,
        x0=np.zeros(0) if x0 is None else numbers("x0", x0).ravel(),
        start_error=arguments.moderate("start_error", start_error),
        noise=noise if isinstance(noise, str) else "auto",
        disturbances=np.zeros((0, 0)) if isinstance(noise, str) else arguments.table("noise", noise),
        trials=trials,
        first_trial=arguments.whole("first_trial", first_trial, 0, _MOST_TRIALS - trials),
        seed=arguments.whole("seed", seed, 0, 2**64 - 1),
        threads=_threads(filter, attacks, threads),
        start=None if start is None else arguments.table("start", start),
        attacks=attacks,
        link=links,
        keep=kept,
        **known,
        progress=arguments.callback("progress", progress),
    )
    run = _run(data, base, ground, filter, design, attacks, wanted, known)
    drawn = noise if isinstance(noise, str) else plain_data(numbers("noise", noise))
    own = {
        "driver": "simulate",
        "steps": steps,
        "x0": plain_data(x0),
        "start_error": float(start_error),
        "noise": drawn,
    }
    shared = _shared(trials, first_trial, seed, start, attacks, links, kept, design, wanted)
    return _made(run, own | shared)


def _made(run: Run, made: dict[str, Any]) -> Run:
    """The run with what made it, and the doubts that depend on that."""
    run.made = made
    run.warnings += refuted.of_certificates(run.bound_kind, made.get("failure", 0.0))
    return run


def _shared(
    trials: int,
    first_trial: int,
    seed: int,
    start: ArrayLike | None,
    attacks: list[_core.Attack],
    links: dict[str, Any],
    kept: list[str],
    design: _core.Design,
    conditions: bool,
) -> dict[str, Any]:
    """Arguments of both drivers as plain data, for `again`."""
    made = {"trials": trials, "first_trial": first_trial, "seed": int(seed), "start": plain_data(start), "link": links}
    made["conditions"] = conditions
    return made | {"keep": kept, "attack": [described_attack(a) for a in attacks]} | dict(design.certificate or {})


@hinted
def replay(
    model: _core.Model | VaryingModel,
    network: _core.Network | VaryingNetwork,
    filter: _core.Filter,
    *,
    measurements: ArrayLike,
    inputs: Inputs = None,
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
    model : Model or VaryingModel
        The plant and its sensors.
    network : Network or VaryingNetwork
        Who hears whom.
    filter : Filter
        One of garrison.filters, or a filter of your own.
    measurements : (samples, outputs) array
        nan or masked = missing; row r belongs to time r + 1. A pandas table with columns named as the network's
        agents (or the model's outputs) is matched by name. In families with a sample at the start (platoon) row r
        belongs to time r. A leading axis of trials is allowed, one log per trial; otherwise the one log serves
        all trials.
    inputs : (samples, p) array, table or function of t, optional
        Known inputs of a model with B, as in `simulate`: row t led from time t to t + 1.
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
    base, series = parted(model)
    plain = network.network if isinstance(network, VaryingNetwork) else network
    require_order("replay", base, plain, filter)
    names = output_names(base, plain)
    y = numbers("measurements", matched("measurements", measurements, names))
    trials = (len(y) if y.ndim == 3 else 1) if trials is None else arguments.whole("trials", trials, 1)
    wanted = arguments.flag("conditions", conditions)
    attacks, kept = arguments.attacks(attack), arguments.choices("keep", keep, _KEEPABLE)
    samples = y.shape[-2] if y.ndim >= 2 else 0
    ground, links = links_of(network, arguments.link(link), samples)
    known: dict[str, Any] = {"inputs": inputs_of(base, inputs, samples), "series": series}
    require_room(base, filter, kept, trials, samples)
    design = _designed(base, ground, filter, design, certificate, failure, attacked, levels)
    data = _core.replay(
        design,
        measurements=y,
        truth=None if truth is None else numbers("truth", truth),
        trials=trials,
        first_trial=arguments.whole("first_trial", first_trial, 0, _MOST_TRIALS - trials),
        seed=arguments.whole("seed", seed, 0, 2**64 - 1),
        threads=_threads(filter, attacks, threads),
        start=None if start is None else arguments.table("start", start),
        attacks=attacks,
        link=links,
        keep=kept,
        **known,
        progress=arguments.callback("progress", progress),
    )
    run = _run(data, base, ground, filter, design, attacks, wanted, known)
    run.warnings += doubts.of_silence(names, y.reshape(-1, base.outputs))
    shared = _shared(trials, first_trial, seed, start, attacks, links, kept, design, wanted)
    return _made(run, {"driver": "replay"} | shared)


@hinted
def again(run: Run) -> Run:
    """Run once more what a run keeps, also a loaded one.

    Parameters
    ----------
    run : Run
        Of simulate or replay. A replay needs the measurements that were kept; attacks on them are in there.

    Returns
    -------
    Run
        Equal to it, bit for bit.

    Raises
    ------
    InvalidInput
        The measurements are missing, or an attack was written in Python.
    """
    if not isinstance(run, Run):
        raise refusal("again", f"a {type(run).__name__}", "a garrison.Run")
    driver, objects, given = recipe(run)
    return simulate(*objects, **given) if driver == "simulate" else replay(*objects, **given)
