"""The most liars for which each guarantee holds."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from garrison import _core
from garrison._core import saturation
from garrison.answers.removals import Removal
from garrison.answers.sensors import Sensors
from garrison.checks import check
from garrison.families import family_of
from garrison.filters import make_filter
from garrison.result import Result

Array = NDArray[np.float64]

#: rounds per sample beyond which the saturation filter is not called feasible
MOST_ROUNDS = 10_000
#: why nothing is known
LATE = "the time was up"
#: how far rounding moves a norm of 1 at most
_ROUNDING = 1e-9
#: our name -> name in the filter's check
_NAMES = {"a": "||A||", "gamma": "gamma", "lambda0": "lambda_0"}


@dataclass(frozen=True, eq=False, repr=False)
class Limit(Result):
    """A guarantee, with what it needs.

    holds: for any so many liars, for certain. fails: for some so many it does not; None: not known. why: what stands in
    the way of one more.
    """

    guarantee: str
    holds: int
    fails: int | None
    needs: str
    why: str

    @property
    def exact(self) -> bool:
        """The largest number is known."""
        return self.fails == self.holds + 1


def from_removal(guarantee: str, needs: str, removal: Removal, per_liar: int, names: list[str], can_lie: int) -> Limit:
    """A guarantee for s liars, of can_lie, that needs any per_liar * s sensors to be dispensable."""
    if removal.most == 0:
        return Limit(guarantee, 0, 0, needs, "not even all sensors together show the whole state")
    holds = min(max(removal.spare, 0) // per_liar, can_lie)
    if not removal.example:
        return Limit(guarantee, can_lie, None, needs, "") if removal.exact else Limit(guarantee, 0, None, needs, LATE)
    fails = -(-removal.most // per_liar)
    who = listed([names[k] for k in removal.example])
    why = f"without {who} part of the state is not seen"
    return Limit(guarantee, holds, fails, needs, why)


def listed(names: list[str], most: int = 8) -> str:
    """Names for people."""
    more = f" and {len(names) - most} more" if len(names) > most else ""
    return ", ".join(names[:most]) + more


@dataclass(frozen=True)
class SaturationFacts:
    """What the theorems of the saturation filter need, for s liars; rounds: the fewest that suffice, None:
    none do."""

    attacked: int
    setting: saturation.Setting
    norm_A: float
    lambda0: float
    rounds: int | None

    @property
    def holds(self) -> bool:
        """Some threshold and number of rounds satisfies condition (9)."""
        return self.rounds is not None


def saturation_facts(sensors: Sensors, added: Array, attacked: int, gamma: float, seconds: float) -> SaturationFacts:
    """Of the sensors and those `added` (k, n), each on an agent of its own, all rows scaled to length 1."""
    n = sensors.model.states
    silent = np.zeros((0, n))
    C = [silent] * sensors.model.agents
    sees = [k for k, row in enumerate(sensors.rows) if np.any(row)]
    if sees:
        for k, row in zip(sees, _unit(sensors.rows[sees]), strict=True):
            C[sensors.agent[k]] = row[None]
    C += [row[None] for row in _unit(added)] if len(added) else []
    # Any connected network of as many agents: what is asked of the check depends on plant and rows only.
    params = {"threshold": 1.0, "rounds": 1, "attacked": attacked}
    filter = make_filter("saturation", params)
    of_plant = check(_core.Model(sensors.model.A, C), _core.Network.star(len(C)), filter, seconds=seconds)
    a, lambda0 = of_plant[_NAMES["a"]], of_plant[_NAMES["lambda0"]]
    if abs(a - 1.0) < _ROUNDING:  # a norm of 1 that rounding has put below contracts nothing
        a = 1.0
    setting = saturation.Setting(agents=len(C), a=a, lambda0=lambda0, contraction=0.0, attacked=attacked)
    rounds = saturation.minimal_rounds(setting, gamma) if gamma < 1 else None
    few = rounds if rounds and rounds <= MOST_ROUNDS else None
    return SaturationFacts(attacked, setting, a, lambda0, few)


def _unit(rows: Array) -> Array:
    return np.asarray(saturation.normalise_rows(rows, np.zeros(len(rows)))["C"])


def network_contraction(net: _core.Network) -> float:
    """gamma of one round on a network; 1 where it is directed or in parts."""
    if net.agents == 1:
        return 0.0
    if net.directed or not net.connected:
        return 1.0
    plain = _core.Model([[1.0]], [[[1.0]]] * net.agents)
    found = check(plain, net, make_filter("saturation", {"threshold": 1.0, "rounds": 1, "attacked": 0}))
    return found[_NAMES["gamma"]]


def of_filter(model: _core.Model, network: _core.Network, filter: _core.Filter, budget: Any) -> Limit | None:
    """The largest `attacked` with which the filter, otherwise as it is, meets all its required conditions.

    None where nothing that it requires depends on `attacked`: then it promises nothing about liars.
    """
    if "attacked" not in filter.params:
        return None
    needs = "all required conditions of `garrison check`, with the parameters given"
    least, last = family_of(filter).least_attacked, -1
    unmet: dict[int, str] = {}  # attacked -> what is not met with so many
    # More liars may be easier: a threshold that is too small for few is right for more, and "at most five" covers none.
    for attacked in range(least, model.agents + 1):
        if budget.over:
            return Limit(_titled(filter), max(last, 0), None, needs, LATE)
        try:
            found = check(model, network, make_filter(filter.name, filter.params | {"attacked": attacked}))
        except _core.InvalidInput as refused:
            unmet[attacked] = str(refused)
            break
        if found.holds:
            last = attacked
        else:
            unmet[attacked] = "; ".join(c["name"] for c in found.failed)
    if not unmet:
        return None
    if last == model.agents:
        return Limit(_titled(filter), last, None, needs, "")
    why = unmet[max(last + 1, least)]
    return Limit(_titled(filter), max(last, 0), last + 1 if last >= 0 else 0, needs, f"not met: {why}")


def _titled(filter: _core.Filter) -> str:
    return f"the filter {filter.name} as given keeps its theorem"
