"""Attacks on measurements and messages; every one works with every filter, in any combination.

`garrison list attacks` shows them with their parameters. Each is a function in CamelCase::

    garrison.attacks.Scale(agents=[3, 12], factor=3.0, start=100)
    garrison.attacks.Bias(schedule=[(100, [3]), (200, [5, 7])], value=10.0, stop=300, probability=0.5)

agents: ids that are attacked from sample `start` on, or schedule: (start, agents) phases in order of time;
stop: first sample that is not attacked any more; probability: chance that an agent is attacked at a sample.
The other parameters are those of the attack. Raises InvalidInput when something does not fit.
"""

from collections.abc import Callable, Iterable
from typing import Any, NoReturn

from garrison import _core
from garrison._core import Attack
from garrison._core.attacks import *  # noqa: F403  (what the core registers)
from garrison.arguments import entries, require_arguments
from garrison.words import hinted, refusal, refuse_attribute, require_order, shown

#: the name of every attack's function
ATTACKS = tuple(name for name in vars(_core.attacks) if not name.startswith("_"))

__all__ = ["ATTACKS", "Attack", "custom", "custom_message", "make", "worst_covariance", *ATTACKS]


@hinted
def make(name: str, agents: Iterable[int] | int | None = None, **arguments: Any) -> Attack:
    """Make the attack `name`, as in a scenario file.

    Parameters
    ----------
    name : str
        As in `garrison list attacks`, such as "bias".
    agents : int or sequence of int, optional
        Ids that are attacked from `start` on; or give `schedule`.
    **arguments
        start, stop, schedule, probability, and the parameters of the attack.

    Returns
    -------
    Attack

    Raises
    ------
    InvalidInput
        An unknown name or parameter, or a value out of range.
    """
    names = [info["name"] for info in _core.attack_infos()]
    if not isinstance(name, str) or name not in names:
        return _core.make_attack(name, [(1, [0])])  # refuses, with the nearest name
    attack: Attack = getattr(_core.attacks, ATTACKS[names.index(name)])(agents, **arguments)
    return attack


def _custom(
    name: str,
    function: Callable[..., Any],
    takes: tuple[str, ...],
    agents: Iterable[int] | int | None,
    start: int | None,
    stop: int | None,
    schedule: Iterable[tuple[int, Iterable[int]]] | None,
    probability: float,
) -> Attack:
    if not callable(function):
        raise refusal(name, shown(function), "a function")
    require_arguments(name, function, takes)
    if (agents is None) == (schedule is None):
        got = "neither agents nor schedule" if agents is None else "both agents and schedule"
        raise refusal(name, got, "exactly one of them")
    if schedule is None:
        phases = [(1 if start is None else start, _several("agents", agents))]
    elif start is not None:
        raise refusal(name, "start and schedule", "one of them", "every phase of a schedule has its start")
    else:
        phases = _phases(schedule)
    return _core.custom_attack(name, function, phases, stop, probability)


def _several(which: str, given: Any, expected: str = "a list of agents") -> list[Any]:
    """The entries of a list; one alone is a list of one. The core looks at each."""
    one = not isinstance(given, (str, bytes, Iterable)) or getattr(given, "ndim", 1) == 0
    return entries(which, [given] if one else given, expected)


def _phases(schedule: Any) -> list[tuple[Any, list[Any]]]:
    """(start, agents) of every phase."""
    found, what = [], "a pair (start, agents)"
    for k, phase in enumerate(_several("schedule", schedule, "a list of pairs (start, agents)")):
        pair = _several(f"schedule[{k}]", phase, what)
        if len(pair) != 2:
            raise refusal(f"schedule[{k}]", shown(phase), what)
        found.append((pair[0], _several(f"schedule[{k}][1]", pair[1])))
    return found


@hinted
def custom(
    function: Callable[..., Any],
    agents: Iterable[int] | int | None = None,
    *,
    start: int | None = None,
    stop: int | None = None,
    schedule: Iterable[tuple[int, Iterable[int]]] | None = None,
    probability: float = 1.0,
) -> Attack:
    """An attack on measurements by a function of your own.

    Runs are single-threaded with it. What the function raises comes back with its traceback and a note that names the
    agent and the sample.

    Parameters
    ----------
    function : callable
        function(t, agent, y, rng) -> what the sensor says instead. y: (outputs,) of this agent that can be attacked,
        nan = missing; return as many numbers (nan and inf are allowed). rng: a numpy.random.Generator that depends on
        seed, trial, t and agent only. An object with __call__ is copied for every trial, so it may remember.
    agents : int or sequence of int, optional
        Ids that are attacked from `start` on; or give `schedule`.
    start : int, optional
        First sample that is attacked; below 1 is as 1; default 1.
    stop : int, optional
        First sample that is not attacked any more; default: never.
    schedule : sequence of (start, agents), optional
        Phases in order of time, instead of agents and start.
    probability : float
        Chance that an agent is attacked at a sample, 0..1.

    Returns
    -------
    Attack

    Raises
    ------
    InvalidInput
        No function with these arguments, a number out of range, or both or neither of agents and schedule.
    """
    return _custom("custom", function, ("t", "agent", "y", "rng"), agents, start, stop, schedule, probability)


@hinted
def custom_message(
    function: Callable[..., Any],
    agents: Iterable[int] | int | None = None,
    *,
    start: int | None = None,
    stop: int | None = None,
    schedule: Iterable[tuple[int, Iterable[int]]] | None = None,
    probability: float = 1.0,
) -> Attack:
    """Lies in messages by a function of your own.

    Runs are single-threaded with it. What the function raises comes back with its traceback and a note that names the
    agent and the sample.

    Parameters
    ----------
    function : callable
        function(t, round, sender, receiver, message, rng) -> message, called once per neighbour and round; it must not
        remember anything. message: dict of the fields that are sent (arrays, numbers, flags, lists of agents; where a
        certificate is asked for also what is said for it, such as certificate.measurements); return the fields that
        change, or None to send nothing to this receiver. rng: a numpy.random.Generator that depends on seed, trial, t,
        round, sender and receiver only.
    agents : int or sequence of int, optional
        Ids that are attacked from `start` on; or give `schedule`.
    start : int, optional
        First sample that is attacked; below 1 is as 1; default 1.
    stop : int, optional
        First sample that is not attacked any more; default: never.
    schedule : sequence of (start, agents), optional
        Phases in order of time, instead of agents and start.
    probability : float
        Chance that an agent is attacked at a sample, 0..1.

    Returns
    -------
    Attack

    Raises
    ------
    InvalidInput
        No function with these arguments, a number out of range, or both or neither of agents and schedule.
    """
    takes = ("t", "round", "sender", "receiver", "message", "rng")
    return _custom("custom_message", function, takes, agents, start, stop, schedule, probability)


@hinted
def worst_covariance(
    model: _core.Model,
    network: _core.Network,
    filter: _core.Filter,
    agents: Iterable[int] | int,
    *,
    energy: float,
    kind: str = "steady",
    start: int = 1,
    stop: int | None = None,
) -> _core.partial_sharing.WorstAttack:
    """The coordinated Gaussian attack that hurts a PartialSharing filter most.

    Parameters
    ----------
    model : Model
        With process_covariance and measurement_covariance.
    network : Network
        Of the same agents.
    filter : Filter
        A garrison.filters.PartialSharing.
    agents : int or sequence of int
        Attacked agents, at least one.
    energy : float
        Largest trace of the covariance of what they add, >= 0 [state^2].
    kind : str
        "steady" maximises the network's MSE over a cycle of the periodic steady state; "one_step" the next step alone,
        (37) of the paper.
    start : int
        First sample that is attacked; below 1 is as 1.
    stop : int, optional
        First sample that is not attacked any more; default: never.

    Returns
    -------
    WorstAttack
        An Attack that also has covariance, form, direction and gain.

    Raises
    ------
    InvalidInput
        Another filter, a bad agent or energy, or an unstable filter.
    """
    require_order("worst_covariance", model, network, filter)
    if filter.name != "partial_sharing":
        raise refusal("filter", filter.name, "partial_sharing", "(37) is about its gains")
    analysis = _core.partial_sharing.Analysis(model, network, filter)
    return _core.partial_sharing.worst_covariance(
        analysis,
        agents,  # type: ignore[arg-type]
        energy,
        kind,
        start,
        stop,
    )


def __getattr__(name: str) -> NoReturn:
    refuse_attribute(__name__, name, __all__)
