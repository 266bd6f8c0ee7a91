"""Model, network and filter as plain data (for JSON), and back."""

from typing import Any

import numpy as np

from garrison import _core

Plain = dict[str, Any]


def described(model: _core.Model, network: _core.Network, filter: _core.Filter) -> Plain:
    """The three objects by the arguments that make them."""
    return {"model": _model(model), "network": _network(network), "filter": _filter(filter)}


def _lists(value: Any) -> Any:
    """Arrays, also inside lists, as nested lists; None stays."""
    if isinstance(value, (list, tuple)):
        return [_lists(v) for v in value]
    return value.tolist() if isinstance(value, (np.ndarray, np.generic)) else value


def _string(model: _core.Model) -> Plain | None:
    """A model of vehicles, which has secured outputs that the constructor of Model cannot say."""
    A = np.asarray(model.A)
    if A.shape != (2, 2) or model.agents < 2 or model.outputs < 3 * model.agents:
        return None
    inputs = model.outputs > 4 * model.agents - 2
    given: Plain = {"vehicles": model.agents, "period": float(A[0, 1]), "inputs": inputs}
    try:
        same = _core.platoon.model(**given)
    except _core.Error:
        return None
    equal = np.array_equal(same.A, A) and all(np.array_equal(a, b) for a, b in zip(same.C, model.C, strict=True))
    return given if equal else None


def _model(model: _core.Model) -> Plain:
    if string := _string(model):
        return {"platoon": string}
    out: Plain = {"A": model.A, "C": model.C, "process_bound": model.process_bound}
    bounds = np.asarray(model.measurement_bound)
    out["measurement_bound"] = bounds if bounds.size else None
    for name in ("process_covariance", "measurement_covariance"):
        value = getattr(model, name, None)
        out[name] = (
            None if value is None or np.size(value[0] if isinstance(value, list) and value else value) == 0 else value
        )
    for name in ("state_names", "output_names"):
        if getattr(model, name, None):
            out[name] = list(getattr(model, name))
    return {key: _lists(value) for key, value in out.items() if value is not None}


def model_of(plain: Plain) -> _core.Model:
    """The model that was described."""
    if "platoon" in plain:
        return _core.platoon.model(**plain["platoon"])
    A = np.asarray(plain["A"], dtype=float)
    C = [np.asarray(c, dtype=float).reshape(-1, len(A)) for c in plain["C"]]
    rest = {key: value for key, value in plain.items() if key not in ("A", "C")}
    if "measurement_covariance" in rest:
        pairs = zip(rest["measurement_covariance"], C, strict=True)
        rest["measurement_covariance"] = [np.asarray(r, dtype=float).reshape(len(c), len(c)) for r, c in pairs]
    return _core.Model(A, C, **rest)


def _network(network: _core.Network) -> Plain:
    out: Plain = {"agents": network.agents, "directed": network.directed, "edges": [list(e) for e in network.edges]}
    names = getattr(network, "names", None)
    return out | ({"names": [str(n) for n in names]} if names else {})


def network_of(plain: Plain) -> _core.Network:
    """The network that was described."""
    rest = {key: value for key, value in plain.items() if key != "edges"}
    return _core.Network([(int(a), int(b)) for a, b in plain["edges"]], **rest)


def _filter(filter: _core.Filter) -> Plain:
    return {"name": filter.name, "params": filter.params}


def filter_of(plain: Plain) -> _core.Filter:
    """The filter that was described."""
    return _core.make_filter(plain["name"], plain["params"])
