"""Model, network and filter as plain data (for JSON), and back."""

from typing import Any

import numpy as np

from garrison import _core
from garrison.encoded import Kind, decoded, encoded
from garrison.numeric import numbers

Plain = dict[str, Any]
#: types of what is plain already; networks have millions of such entries
_PLAIN = {int, float, str, bool, type(None)}


def described(model: _core.Model, network: _core.Network, filter: _core.Filter) -> Plain:
    """The three objects by the arguments that make them."""
    return {"model": described_model(model), "network": _network(network), "filter": _filter(filter)}


def plain_lists(value: Any) -> Any:
    """Arrays and tuples, also inside lists, as nested lists; None stays."""
    if isinstance(value, (list, tuple)):
        return list(value) if _PLAIN.issuperset(map(type, value)) else [plain_lists(v) for v in value]
    if isinstance(value, dict):
        return {key: plain_lists(v) for key, v in value.items()}
    return value.tolist() if isinstance(value, (np.ndarray, np.generic)) else value


def plain_data(value: Any) -> Any:
    """Numbers of any kind as nested lists; None stays."""
    return None if value is None else plain_lists(numbers("value", value))


def described_attack(attack: _core.Attack) -> Plain:
    """The attack by what makes it; one of the user's own by its code alone."""
    if attack.own:
        return {"own": repr(attack)}
    return {key: plain_lists(value) for key, value in attack.__getstate__().items()}


def attack_of(plain: Plain) -> _core.Attack:
    """The attack that was described."""
    if "own" in plain:
        missing = f"an attack written in Python, {plain['own']}"
        raise _core.InvalidInput(f"attack: got {missing}, expected one of garrison.attacks; run it again by hand")
    made = _core.Attack.__new__(_core.Attack)
    schedule = [(start, agents) for start, agents in plain["schedule"]]
    made.__setstate__(plain | {"schedule": schedule})
    return made


def _arguments(thing: Any) -> Plain | None:
    """The arguments that make an equal object, where the core keeps them for pickles."""
    state = thing.__getstate__() if hasattr(thing, "__getstate__") else None
    return {key: plain_lists(value) for key, value in state.items()} if isinstance(state, dict) else None


def described_model(model: _core.Model) -> Plain:
    """The model by the arguments that make it."""
    if (arguments := _arguments(model)) is not None:
        return arguments
    bounds = np.asarray(model.measurement_bound)
    out: Plain = {"A": model.A, "C": model.C, "process_bound": model.process_bound}
    return {
        key: plain_lists(value) for key, value in (out | ({"measurement_bound": bounds} if bounds.size else {})).items()
    }


def model_of(plain: Plain) -> _core.Model:
    """The model that was described."""
    A = np.asarray(plain["A"], dtype=float)
    C = [np.asarray(c, dtype=float).reshape(-1, len(A)) for c in plain["C"]]
    rest = {key: value for key, value in plain.items() if key not in ("A", "C")}
    if "measurement_covariance" in rest:
        pairs = zip(rest["measurement_covariance"], C, strict=True)
        rest["measurement_covariance"] = [np.asarray(r, dtype=float).reshape(len(c), len(c)) for r, c in pairs]
    return _core.Model(A, C, **rest)


def _network(network: _core.Network) -> Plain:
    if (arguments := _arguments(network)) is not None:
        return arguments
    return {"agents": network.agents, "directed": network.directed, "edges": plain_lists(network.edges)}


def network_of(plain: Plain) -> _core.Network:
    """The network that was described."""
    rest = {key: value for key, value in plain.items() if key != "edges"}
    return _core.Network([(int(a), int(b)) for a, b in plain["edges"]], **rest)


def named(network: _core.Network, names: list[str] | None) -> _core.Network:
    """The same network with names of its agents, where the core keeps names."""
    if not names or not hasattr(network, "names"):
        return network
    plain = _network(network) | {"names": names}
    return network_of(plain)


def _filter(filter: _core.Filter) -> Plain:
    kind = type(filter)
    if not filter.own:
        return {"name": filter.name, "params": plain_lists(filter.params)}
    where = f"{filter.name}."
    params = {key: encoded(where + key, value, _KINDS) for key, value in filter.params.items()}
    return {"name": filter.name, "params": params, "class": f"{kind.__module__}.{kind.__qualname__}"}


def filter_of(plain: Plain) -> _core.Filter:
    """The filter that was described; one of the user's own needs its class defined, and nothing is imported for it."""
    if "class" not in plain:
        return _core.make_filter(plain["name"], plain["params"])
    pending: list[type[_core.Filter]] = _core.Filter.__subclasses__()
    while pending:
        kind = pending.pop()
        if f"{kind.__module__}.{kind.__qualname__}" == plain["class"]:
            made = kind.__new__(kind)
            made.__setstate__({key: decoded(value, _KINDS) for key, value in plain["params"].items()})
            return made
        pending += kind.__subclasses__()
    missing = f"the filter {plain['class']}, which is not defined here"
    raise _core.IoError(f"filter: got {missing}, expected its class; define or import it first")


#: objects of garrison that a filter of one's own may have as attributes
_KINDS = (
    Kind("model", _core.Model, described_model, model_of),
    Kind("network", _core.Network, _network, network_of),
    Kind("filter", _core.Filter, _filter, filter_of),
)
