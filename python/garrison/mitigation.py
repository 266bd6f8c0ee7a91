"""Detection and mitigation in one run: Algorithm 1 of the structural paper goes on through the switch of sensors."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from garrison import _core, filters
from garrison._core import structure
from garrison.arguments import entries, whole
from garrison.drivers import replay
from garrison.numeric import numbers
from garrison.record import Run
from garrison.result import Result
from garrison.words import count, hinted, hinted_methods, refusal

Array = NDArray[np.float64]


@dataclass(eq=False, repr=False)
class Switch(Result):
    """One sensor given up: at `time` (samples) `agent`'s alarm made it measure `after` instead (None: nothing)."""

    time: int
    agent: int
    kind: str
    before: int | None
    after: int | None


@hinted_methods
@dataclass(eq=False, repr=False)
class Mitigated(Result):
    """What came out of a replay in which agents with an alarm measure something else.

    Attributes
    ----------
    estimate : (time, agent, n) array
        Over all segments, time 0 first.
    error : (time, agent) array
        The same.
    switches : list of Switch
        Whose alarm made it measure something else, and when.
    segments : list of (first sample, measured states, run)
        Between switches; each is designed anew.
    """

    estimate: Array
    error: Array
    switches: list[Switch] = field(default_factory=list)
    segments: list[tuple[int, list[int | None], Run]] = field(default_factory=list)


def _model(A: Array, E: Array, R: Array, measured: Sequence[int | None]) -> _core.Model:
    n = len(A)
    C = [np.zeros((0, n)) if s is None else np.eye(n)[[s]] for s in measured]
    covariances = [np.zeros((0, 0)) if s is None else np.array([[R[i]]]) for i, s in enumerate(measured)]
    return _core.Model(A, C, process_covariance=E, measurement_covariance=covariances)


def _shaped(which: str, value: Any, *shapes: tuple[int, ...]) -> Array:
    """Numbers of one of these shapes; -1 is any length of at least 1."""
    found = numbers(which, value)
    for shape in shapes:
        if len(shape) == found.ndim and all(a == b or (b < 0 < a) for a, b in zip(found.shape, shape, strict=True)):
            return found
    words = " or ".join(str(s).replace("-1", "any") if s else "one number" for s in shapes)
    raise refusal(which, f"shape {found.shape}", words)


def _sensors(measured: Any, n: int, N: int) -> list[int | None]:
    """The state that each agent measures, None for a relay."""
    expected = f"{N} entries, one per agent: the state it measures, in 0..{n - 1}, or None"
    found = entries("measured", measured, expected)
    if len(found) != N:
        raise refusal("measured", f"{count(len(found), 'entry', 'entries')}", expected)
    return [None if s is None else whole(f"measured[{i}]", s, 0, n - 1) for i, s in enumerate(found)]


@hinted
def replay_mitigated(
    network: _core.Network,
    *,
    A: ArrayLike,
    process_covariance: ArrayLike,
    measurement_variance: ArrayLike,
    measured: Sequence[int | None],
    truth: ArrayLike,
    noise: ArrayLike,
    attack: ArrayLike,
    start: ArrayLike | None = None,
    choice: str = "exact",
    cost: ArrayLike | None = None,
    **params: Any,
) -> Mitigated:
    """Run the structural filter; whenever an agent raises an alarm, replace its sensor, redesign and go on.

    Parameters
    ----------
    network : Network
        Who hears whom.
    A : (n, n) array
        Of the plant.
    process_covariance : (n, n) array
        Of the plant's noise.
    measurement_variance : (N,) array or float
        Of the sensors' noise.
    measured : sequence of int or None
        State that each agent measures; None: a relay.
    truth : (samples + 1, n) array
        States from time 0.
    noise, attack : (samples, N) arrays
        Of the measurements; an attack sits on the first sensor of its agent and is left behind with it.
    start : (n,) array, optional
        Initial estimate, default 0.
    choice : {"exact", "class"}
        Any substitute that keeps the system observable, the cheapest by `cost`; or Algorithm 1 as published.
    cost : (N, n) array, optional
        Of letting an agent measure a state.
    **params
        Of the Structural filter, without weights, sharing and gain, which are designed for every segment.

    Returns
    -------
    Mitigated
        Estimates, errors, and what was replaced when.

    Raises
    ------
    DesignInfeasible
        No stabilising gain is left.
    InvalidInput
        Something does not fit.
    """
    if not isinstance(network, _core.Network):
        raise refusal("network", f"a {type(network).__name__}", "a garrison.Network")
    A_ = _shaped("A", A, (-1, -1))
    n, N = len(A_), network.agents
    E = _shaped("process_covariance", process_covariance, (n, n))
    R = np.broadcast_to(_shaped("measurement_variance", measurement_variance, (), (N,)), (N,))
    now = _sensors(measured, n, N)
    x = _shaped("truth", truth, (-1, n))
    v, tau = _shaped("noise", noise, (len(x) - 1, N)), _shaped("attack", attack, (len(x) - 1, N))
    system = structure.System(structure.Pattern.of(A_))
    filter = filters.Structural(**params)
    kinds = system.classes([[] if s is None else [s] for s in now])
    begin = np.zeros(n) if start is None else _shaped("start", start, (n,), (N, n))
    begin = np.broadcast_to(begin, (N, n))
    out = Mitigated(np.empty((len(x), *begin.shape)), np.empty((len(x), len(now))))
    out.estimate[0] = begin
    out.error[0] = np.linalg.norm(x[0] - begin, axis=1)
    original = [True] * len(now)
    t = 0
    while t < len(x) - 1:
        sensing = [i for i, s in enumerate(now) if s is not None]
        columns = [x[t + 1 :, now[i]] + v[t:, i] + tau[t:, i] * original[i] for i in sensing]
        y = np.column_stack(columns or [np.empty((len(x) - 1 - t, 0))])
        run = replay(
            _model(A_, E, R, now), network, filter, measurements=y, truth=x[t:], start=out.estimate[t], conditions=False
        )
        assert run.estimate is not None and run.error is not None
        alarmed = next(((k, sets) for _, k, sets in run.accusations if any(sets)), None)
        until = len(x) - 1 - t if alarmed is None else alarmed[0]
        out.estimate[t + 1 : t + until + 1] = run.estimate[0, 1 : until + 1]
        out.error[t + 1 : t + until + 1] = run.error[0, 1 : until + 1]
        out.segments.append((t, list(now), run))
        t += until
        if alarmed is None:
            break
        for agent in sorted({a for s in alarmed[1] for a in s}):
            new, log = system.mitigate(now, [agent], types=kinds, choice=choice, cost=cost)
            for who, kind, before, after in log:
                out.switches.append(Switch(t, who, kind, before, after))
                original[who] = False
            now = new
    return out
