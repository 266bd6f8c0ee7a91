"""Attacks on measurements and messages; every one works with every filter, in any combination.

`garrison list attacks` shows them with their parameters. Each is a function in CamelCase::

    garrison.attacks.Scale(agents=[3, 12], factor=3.0, start=100)
    garrison.attacks.Bias(schedule=[(100, [3]), (200, [5, 7])], value=10.0, stop=300, probability=0.5)

agents: ids that are attacked from sample `start` on, or schedule: (start, agents) phases in order of time;
stop: first sample that is not attacked any more; probability: chance that an agent is attacked at a sample.
The other parameters are those of the attack. Raises InvalidInput when something does not fit.
"""

from collections.abc import Iterable
from typing import Any, NoReturn

from garrison import _core
from garrison._core import Attack
from garrison._core.attacks import *  # noqa: F403  (what the core registers)
from garrison.words import hinted, refusal, refuse_attribute, require_order

#: the name of every attack's function
ATTACKS = tuple(name for name in vars(_core.attacks) if not name.startswith("_"))

__all__ = ["ATTACKS", "Attack", "make", "worst_covariance", *ATTACKS]


@hinted
def make(name: str, agents: Iterable[int] | int | None = None, **arguments: Any) -> Attack:
    """Make the attack `name` (as in a scenario file); see the module's text for the arguments."""
    names = [info["name"] for info in _core.attack_infos()]
    if not isinstance(name, str) or name not in names:
        return _core.make_attack(name, [(1, [0])])  # refuses, with the nearest name
    attack: Attack = getattr(_core.attacks, ATTACKS[names.index(name)])(agents, **arguments)
    return attack


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
    """The coordinated Gaussian attack of `agents` that hurts a PartialSharing filter most, trace(covariance) <= energy.

    kind: "steady" maximises the network's MSE over a cycle of the periodic steady state; "one_step" the next step
    alone, (37) of the paper. Attacks from sample `start` on, until `stop` (excluded). The result also has covariance,
    form, direction and gain. Raises InvalidInput for another filter, a bad agent or energy, or an unstable filter.
    """
    require_order("worst_covariance", model, network, filter)
    if filter.name != "partial_sharing":
        raise refusal("filter", filter.name, "partial_sharing", "(37) is about its gains")
    analysis = _core.partial_sharing.Analysis(filter, model, network)
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
