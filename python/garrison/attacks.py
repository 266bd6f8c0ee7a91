"""Attacks on measurements and messages; every one works with every filter, in any combination.

`garrison list attacks` shows them with their parameters. Each is a function in CamelCase::

    garrison.attacks.Scale(agents=[3, 12], factor=3.0, start=100)
    garrison.attacks.Bias(schedule=[(100, [3]), (200, [5, 7])], value=10.0, stop=300, probability=0.5)

agents: ids (or one id) that are attacked from sample `start` on, or schedule: (start, agents) phases in order of time;
stop: first sample that is not attacked any more; probability: chance that an agent is attacked at a sample.
The other parameters are those of the attack. Raises InvalidInput when something does not fit.
"""

from collections.abc import Callable, Iterable
from typing import Any

from garrison import _core
from garrison._core import Attack
from garrison.arguments import number, whole
from garrison.parameters import cleaned
from garrison.words import near, refusal, require_order, shown

Agents = int | Iterable[int]
Schedule = Iterable[tuple[int, Agents]]


def _ids(where: str, agents: Any) -> list[int]:
    many = isinstance(agents, Iterable) and not isinstance(agents, str) and getattr(agents, "ndim", 1) > 0
    try:
        return [whole(where, a, 0) for a in (agents if many else [agents])]
    except _core.InvalidInput:
        raise refusal(where, shown(agents), "the number of an agent, or a list of such numbers") from None


def _sample(where: str, value: Any) -> int:
    return whole(where, value, -(2**62), 2**62)


def _phases(where: str, start: int, agents: Agents | None, schedule: Schedule | None) -> list[tuple[int, list[int]]]:
    if (agents is None) == (schedule is None):
        got = "neither" if agents is None else "both"
        raise refusal(where, f"{got} of agents and schedule", "exactly one")
    if schedule is None:
        assert agents is not None
        return [(_sample(f"{where}.start", start), _ids(f"{where}.agents", agents))]
    try:
        pairs = [(t, a) for t, a in schedule]
    except (TypeError, ValueError):
        raise refusal(f"{where}.schedule", shown(schedule), "pairs of a start and a list of agents") from None
    return [(_sample(f"{where}.schedule", t), _ids(f"{where}.schedule", a)) for t, a in pairs]


def make(
    name: str,
    agents: Agents | None = None,
    *,
    start: int = 1,
    stop: int | None = None,
    schedule: Schedule | None = None,
    probability: float = 1.0,
    **params: Any,
) -> Attack:
    """Make the attack `name` (as in a scenario file); see the module's text for the arguments."""
    info = _BY_NAME.get(name)
    if info is None:
        raise refusal("attack", repr(name), f"one of {', '.join(_BY_NAME)}", near(str(name), _BY_NAME))
    where = f"attack {name}"
    phases = _phases(where, start, agents, schedule)
    end = None if stop is None else _sample(f"{where}.stop", stop)
    chance = number(f"{where}.probability", probability)
    return _core.make_attack(name, phases, end, chance, cleaned(where, info["params"], params))


def worst_covariance(
    model: _core.Model,
    network: _core.Network,
    filter: _core.Filter,
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
    require_order("worst_covariance", model, network, filter)
    if filter.name != "partial_sharing":
        raise refusal("filter", filter.name, "partial_sharing", "(37) is about its gains")
    analysis = _core.partial_sharing.Analysis(filter, model, network)
    return _core.partial_sharing.worst_covariance(analysis, list(agents), energy, kind, start, stop)


def _camel(name: str) -> str:
    return "".join(part.capitalize() for part in name.split("_"))


_BY_NAME = {info["name"]: info for info in _core.attack_infos()}
_INFOS = {_camel(name): info for name, info in _BY_NAME.items()}


def _signature(info: dict[str, Any]) -> Any:
    """Arguments of an attack's function: those of all attacks, then its own with their defaults."""
    import inspect  # costs as much as the rest of this module

    own = [
        inspect.Parameter(
            p["name"],
            inspect.Parameter.KEYWORD_ONLY,
            default=inspect.Parameter.empty if p["required"] else p["default"],
        )
        for p in info["params"]
    ]
    common = [p for p in inspect.signature(make).parameters.values() if p.name not in ("name", "params")]
    return inspect.Signature([*common, *own], return_annotation=Attack)


def __getattr__(name: str) -> Callable[..., Attack]:
    if name not in _INFOS:
        hint = near(name, _INFOS)
        raise AttributeError(
            f"garrison.attacks has no {name}{f'; {hint}' if hint else ''} (it has {', '.join(_INFOS)})"
        )
    info = _INFOS[name]

    def attack(agents: Agents | None = None, **arguments: Any) -> Attack:
        return make(info["name"], agents, **arguments)

    attack.__name__ = attack.__qualname__ = name
    attack.__signature__ = _signature(info)  # type: ignore[attr-defined]
    params = "\n".join(f"{p['name']}: {p['doc']} [{p['unit']}]" for p in info["params"])
    attack.__doc__ = f"{info['doc']} ({info['target']} attack).\n\n{params}"
    return attack


def __dir__() -> list[str]:
    return ["make", "worst_covariance", *_INFOS]
