"""Networks whose links come and go, which is the same as losing every message of an absent one."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from garrison import _core, notebook
from garrison.arguments import entries, whole
from garrison.numeric import numbers
from garrison.words import Hinting, count, hinted, hinted_methods, refusal, shown


@hinted_methods
class VaryingNetwork(metaclass=Hinting):
    """A network whose links come and go: at every sample a message arrives over those that are present.

    Filters are designed for the network of all links that ever exist; one that is absent is a lost message (bounds and
    certificates treat it so). Taken by `simulate` and `replay`. Immutable; compares by value, copies and pickles.

    Parameters
    ----------
    network : Network, list of Networks, or function
        Of all links, with `present`; or the network of every sample, the first of sample 1, all with the same agents. A
        function is called with t = 1..steps and returns that of sample t.
    present : (T, links) array of bool or function, optional
        Whether each of `network.edges` is there at samples 1..T; of an undirected network, both ways. A function
        returns the row of sample t.
    steps : int, optional
        T, where a function is given.

    Raises
    ------
    InvalidInput
        Sizes do not fit.
    """

    @hinted
    def __init__(
        self,
        network: _core.Network | Iterable[_core.Network] | Callable[[int], _core.Network],
        present: ArrayLike | Callable[[int], ArrayLike] | None = None,
        *,
        steps: int | None = None,
    ) -> None:
        T = None if steps is None else whole("steps", steps, 1)
        if callable(network):
            network = _of_every_sample("network", network, T)
        if callable(present):
            present = [numbers("present", row, flags=True) for row in _of_every_sample("present", present, T)]
        if isinstance(network, _core.Network):
            if present is None:
                raise refusal("VaryingNetwork.present", "none", f"(steps, {len(network.edges)}) of True or False")
            self._network, self._present = network, _presence(network, present)
        else:
            listed = entries("VaryingNetwork.network", network, "a Network with `present`, or a list of Networks")
            self._network, self._present = _united(listed)
        if T is not None and len(self._present) != T:
            raise refusal("VaryingNetwork", count(len(self._present), "sample"), f"{T}, as `steps` says")
        self._present.flags.writeable = False

    @property
    def network(self) -> _core.Network:
        """Of all links that ever exist."""
        return self._network

    @property
    def present(self) -> NDArray[np.bool_]:
        """(T, links): whether each of `network.edges` is there at samples 1..T."""
        return self._present

    @property
    def steps(self) -> int:
        """How many samples it is given for."""
        return len(self._present)

    @property
    def cuts(self) -> list[tuple[int, int, int, int]]:
        """(sender, receiver, start, stop) of every absence, as `link` takes them."""
        found: list[tuple[int, int, int, int]] = []
        for k, (sender, receiver) in enumerate(self._network.edges):
            change = np.diff(np.concatenate([[0], ~self._present[:, k], [0]]).astype(int))
            for start, stop in zip(np.flatnonzero(change == 1) + 1, np.flatnonzero(change == -1) + 1, strict=True):
                found.append((int(sender), int(receiver), int(start), int(stop)))
                if not self._network.directed:
                    found.append((int(receiver), int(sender), int(start), int(stop)))
        return found

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, VaryingNetwork):
            return NotImplemented
        return self._network == other._network and np.array_equal(self._present, other._present)

    def __hash__(self) -> int:
        return hash((self._network, self._present.tobytes()))

    def __reduce__(self) -> Any:
        return VaryingNetwork, (self._network, np.array(self._present))

    def __deepcopy__(self, memo: Any) -> VaryingNetwork:
        return self

    def __repr__(self) -> str:
        return f"garrison.VaryingNetwork({self._network!r}, {self._present.tolist()!r})"

    def __str__(self) -> str:
        return f"{self._network} over {self.steps} samples"

    def _repr_html_(self) -> str:
        share = float(self._present.mean()) if self._present.size else 1.0
        return notebook.of_network(self._network, f"over {self.steps} samples, a link is there in {share:.0%}")


def _of_every_sample(name: str, function: Callable[[int], Any], steps: int | None) -> list[Any]:
    """What a function of t gives at samples 1..steps. Its own errors stay its own, but for one that says it is none."""
    if steps is None:
        raise refusal(f"VaryingNetwork.{name}", "a function and no steps", "steps, how many times it is asked for")
    try:
        return [function(t) for t in range(1, steps + 1)]
    except TypeError as error:
        advice = "a function of t, a whole number"
        raise refusal(f"VaryingNetwork.{name}", f"a TypeError ({error})", advice) from error


def _presence(network: _core.Network, present: ArrayLike) -> NDArray[np.bool_]:
    found = numbers("present", present, flags=True)
    links = len(network.edges)
    if found.ndim != 2 or found.shape[1] != links or len(found) == 0:
        raise refusal("present", f"{found.shape}", f"(steps, {links}), a column for each of network.edges")
    if not np.isin(found, (0.0, 1.0)).all():
        raise refusal("present", "another number", "True or False, 1 or 0")
    return found.astype(bool)


def _united(networks: list[Any]) -> tuple[_core.Network, NDArray[np.bool_]]:
    for k, one in enumerate(networks):
        if not isinstance(one, _core.Network):
            raise refusal(f"VaryingNetwork.network[{k}]", shown(one), "a garrison.Network")
        first = networks[0]
        if (one.agents, one.directed, list(one.names)) != (first.agents, first.directed, list(first.names)):
            raise refusal(f"VaryingNetwork.network[{k}]", str(one), f"the agents and direction of the first, {first}")
    if not networks:
        raise refusal("VaryingNetwork.network", "an empty list", "one network per sample")
    edges = [{(int(a), int(b)) for a, b in one.edges} for one in networks]
    union = sorted(set().union(*edges))
    network = _core.Network(union, agents=first.agents, directed=first.directed, names=list(first.names) or None)
    columns = [(int(a), int(b)) for a, b in network.edges]
    return network, np.array([[edge in there for edge in columns] for there in edges], dtype=bool).reshape(
        len(networks), len(columns)
    )


def links_of(network: Any, link: dict[str, Any], steps: int) -> tuple[Any, dict[str, Any]]:
    """The network of all links, and the faults of the links with the absences among them."""
    if not isinstance(network, VaryingNetwork):
        return network, link
    if network.steps < steps:
        raise refusal(
            "network", f"a network over {count(network.steps, 'sample')}", f"at least {steps}, one per sample"
        )
    return network.network, link | {"cuts": [*link.get("cuts", []), *network.cuts]}


__all__ = ["VaryingNetwork", "links_of"]
