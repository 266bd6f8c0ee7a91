"""Attacks on measurements and messages; every one works with every filter, in any combination.

`garrison list attacks` shows them with their parameters. Each is a function in CamelCase::

    garrison.attacks.Scale(agents=[3, 12], factor=3.0, start=100)
    garrison.attacks.Bias(schedule=[(100, [3]), (200, [5, 7])], value=10.0, stop=300, probability=0.5)

agents: ids that are attacked from sample `start` on, or schedule: (start, agents) phases in order of time;
stop: first sample that is not attacked any more; probability: chance that an agent is attacked at a sample.
The other parameters are those of the attack. Raises InvalidInput when something does not fit.
"""

from collections.abc import Callable, Iterable
from typing import Any

from garrison import _core
from garrison._core import Attack

Schedule = Iterable[tuple[int, Iterable[int]]]


def make(
    name: str,
    agents: Iterable[int] | None = None,
    *,
    start: int = 1,
    stop: int | None = None,
    schedule: Schedule | None = None,
    probability: float = 1.0,
    **params: Any,
) -> Attack:
    """Make the attack `name` (as in a scenario file); see the module's text for the arguments."""
    if (agents is None) == (schedule is None):
        got = "neither" if agents is None else "both"
        raise _core.InvalidInput(f"attack {name}: got {got} of agents and schedule, expected exactly one")
    phases = [(start, list(agents))] if agents is not None else [(t, list(a)) for t, a in schedule or ()]
    return _core.make_attack(name, phases, stop, probability, params)


def worst_covariance(
    filter: _core.Filter,
    model: _core.Model,
    network: _core.Network,
    agents: Iterable[int],
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
    if filter.name != "partial_sharing":
        raise _core.InvalidInput(f"filter: got {filter.name}, expected partial_sharing; (37) is about its gains")
    analysis = _core.partial_sharing.Analysis(filter, model, network)
    return _core.partial_sharing.worst_covariance(analysis, list(agents), energy, kind, start, stop)


def _camel(name: str) -> str:
    return "".join(part.capitalize() for part in name.split("_"))


_INFOS = {_camel(info["name"]): info for info in _core.attack_infos()}


def __getattr__(name: str) -> Callable[..., Attack]:
    if name not in _INFOS:
        near = _core.nearest_name(name, list(_INFOS))
        hint = f"; did you mean {near}?" if near else ""
        raise AttributeError(f"garrison.attacks has no {name}{hint} (it has {', '.join(_INFOS)})")
    info = _INFOS[name]

    def attack(agents: Iterable[int] | None = None, **arguments: Any) -> Attack:
        return make(info["name"], agents, **arguments)

    attack.__name__ = name
    params = "\n".join(f"{p['name']}: {p['doc']} [{p['unit']}]" for p in info["params"])
    attack.__doc__ = f"{info['doc']} ({info['target']} attack).\n\n{params}"
    return attack


def __dir__() -> list[str]:
    return ["make", "worst_covariance", *_INFOS]
