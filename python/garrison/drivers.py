"""Drivers: simulate a plant, replay a recording, and the central Kalman filter everybody is compared with."""

import operator
from collections.abc import Callable, Iterable, Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from garrison import _core, doubts
from garrison.numeric import matched, numbers
from garrison.record import Run
from garrison.sizes import require_memory
from garrison.words import count, hinted, only, refusal, require_order, shown

Array = NDArray[np.float64]
Progress = Callable[[int, int], None]
Attacks = _core.Attack | Iterable[_core.Attack]

KEEP = ("estimate", "report", "measurements")


def _start(start: Any, states: int) -> Array | None:
    if start is None:
        return None
    rows = np.atleast_1d(numbers("start", start))
    return rows.reshape(1, -1) if rows.ndim == 1 else rows


def _whole(which: str, value: Any, least: int, most: int = 2**31 - 1) -> int:
    try:
        found = operator.index(value)
    except TypeError:
        found = least - 1
    if isinstance(value, bool) or not least <= found <= most:
        words = f"a whole number >= {least}" if most >= 2**31 - 1 else f"a whole number in {least}..{most}"
        raise refusal(which, shown(value), words)
    return found


def _attacks(attack: Attacks) -> list[_core.Attack]:
    found = [attack] if isinstance(attack, _core.Attack) else list(attack)
    for one in found:
        if not isinstance(one, _core.Attack):
            raise refusal("attack", shown(one), "an attack of garrison.attacks, or a list of them")
    return found


def _link(link: Mapping[str, float] | None) -> dict[str, float]:
    found = dict(link or {})
    only("link", found, ["drop", "delay", "delay_rounds"])
    for key, value in found.items():
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            raise refusal(
                f"link.{key}", shown(value), "a whole number" if key == "delay_rounds" else "a number in 0..1"
            )
    if "delay_rounds" in found:
        found["delay_rounds"] = _whole("link.delay_rounds", found["delay_rounds"], 0)
    return found


def require_room(model: _core.Model, filter: _core.Filter, keep: Iterable[str], trials: int, steps: int) -> None:
    """Refuse a run whose arrays would not fit into the memory limit, before anything is computed."""
    n, N = model.states, model.agents
    row = {
        "estimate": N * n,
        "report": 5 * N,
        "measurements": model.outputs,
        "signals": len(filter.signal_names) * N,
    }
    doubles = trials * (steps + 1.0) * (n + sum(row.get(name, 0) for name in keep))
    require_memory("steps, trials", f"{count(steps, 'sample')} in {count(trials, 'trial')}", doubles)


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
    quiet = max((a.start for a in attacks), default=0)
    run.warnings += doubts.of_divergence(model, run.estimate, run.error, quiet)
    return run


@hinted
def simulate(
    model: _core.Model,
    network: _core.Network,
    filter: _core.Filter,
    *,
    steps: int,
    attack: Attacks = (),
    trials: int = 1,
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
) -> Run:
    """Simulate the plant, attack it, filter it.

    steps: samples >= 1. attack: one or more, applied in order. x0: (n,) true initial state, default 0. start: (n,)
    common initial estimate, or (N, n) one per agent, default 0; start_error moves it by a random vector of at most
    that length per trial. noise: "uniform" within the model's bounds, "extreme" at them, "normal", "none", "auto";
    families whose agents drive plants of their own have laws of their own, x0 (N, n), default: where they should be,
    and take recorded disturbances, one row per time 0..steps, in place of a law (garrison.platoon).
    link: drop and delay (probabilities), delay_rounds. keep: of "estimate", "report", "signals", "measurements",
    "details" (lists such as sets). threads: 0 = all cores; the result does not depend on it.
    progress(done, total) is called at most once per percent. conditions: evaluate the filter's conditions first, and
    put the required ones that are not met into the run's `warnings`.
    Deterministic: equal arguments give bit-identical results. Raises InvalidInput when something does not fit.
    """
    require_order("simulate", model, network, filter)
    steps, trials = _whole("steps", steps, 1), _whole("trials", trials, 1)
    attacks, kept = _attacks(attack), list(keep)
    require_room(model, filter, kept, trials, steps)
    data = _core.simulate(
        model,
        network,
        filter,
        steps=steps,
        x0=np.zeros(0) if x0 is None else numbers("x0", x0).ravel(),
        start_error=float(numbers("start_error", start_error)),
        noise=noise if isinstance(noise, str) else "auto",
        disturbances=np.zeros((0, 0)) if isinstance(noise, str) else np.atleast_2d(numbers("noise", noise)),
        trials=trials,
        seed=_whole("seed", seed, 0, 2**64 - 1),
        threads=_whole("threads", threads, 0),
        start=_start(start, model.states),
        attacks=attacks,
        link=_link(link),
        keep=kept,
        progress=progress,
    )
    return _run(data, model, network, filter, attacks, conditions)


def output_names(model: _core.Model, network: _core.Network) -> list[str] | None:
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
    seed: int = 0,
    link: Mapping[str, float] | None = None,
    keep: Iterable[str] = KEEP,
    threads: int = 0,
    progress: Progress | None = None,
    conditions: bool = True,
) -> Run:
    """Feed recorded measurements, (samples, outputs), nan or masked = missing; row r belongs to time r + 1.

    A pandas table with columns named as the network's agents (or the model's outputs) is matched by name.
    In families with a sample at the start (platoon) row r belongs to time r, and truth is (samples, N, n).
    truth: (samples + 1, n), from time 0, or None. Both may have a leading axis of trials, one log per trial;
    otherwise the one log serves all `trials` (default 1). Attacks come on top of the log. The rest as in simulate.
    """
    require_order("replay", model, network, filter)
    y = numbers("measurements", matched("measurements", measurements, output_names(model, network)))
    trials = (len(y) if y.ndim == 3 else 1) if trials is None else _whole("trials", trials, 1)
    attacks, kept = _attacks(attack), list(keep)
    require_room(model, filter, kept, trials, y.shape[-2] if y.ndim >= 2 else 0)
    data = _core.replay(
        model,
        network,
        filter,
        measurements=y,
        truth=None if truth is None else numbers("truth", truth),
        trials=trials,
        seed=_whole("seed", seed, 0, 2**64 - 1),
        threads=_whole("threads", threads, 0),
        start=_start(start, model.states),
        attacks=attacks,
        link=_link(link),
        keep=kept,
        progress=progress,
    )
    return _run(data, model, network, filter, attacks, conditions)


@hinted
def central_kalman(
    model: _core.Model,
    measurements: ArrayLike,
    *,
    start: ArrayLike | None = None,
    start_variance: float = 1.0,
) -> Array:
    """Estimates (samples + 1, n) of a central Kalman filter that sees all measurements (samples, outputs).

    The unprotected ideal that distributed filters are compared with. Needs the model's covariances; nan or masked =
    missing.
    """
    x0 = np.zeros(model.states) if start is None else numbers("start", start)
    y = numbers("measurements", measurements)
    if y.ndim != 2 or x0.shape != (model.states,):
        got = f"measurements {y.shape} and start {x0.shape}"
        raise refusal("central_kalman", got, f"(samples, {model.outputs}) and ({model.states},)")
    return _core.central_kalman(model, y, x0, start_variance)
