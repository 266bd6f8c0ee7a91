"""Conditions and bounds of a filter's theorems."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from garrison import _core, arguments, run_options
from garrison.arguments import number
from garrison.expected import expected_certificate
from garrison.notebook import of_check
from garrison.result import Result
from garrison.words import hinted, hinted_methods, refusal, require_order, shown


@hinted_methods
@dataclass(frozen=True, eq=False, repr=False)
class Check(Result):
    """What `check` found. A condition that fails is data, not an error.

    Attributes
    ----------
    conditions : list of dict
        name, value, needed, holds, meaning, required (False: it only sharpens the result).
    quantities : list of dict
        name, value (nan = does not exist), meaning.
    """

    conditions: list[dict[str, Any]]
    quantities: list[dict[str, Any]]

    @property
    def holds(self) -> bool:
        """All required conditions hold."""
        return not self.failed

    @property
    def failed(self) -> list[dict[str, Any]]:
        """The required conditions that do not hold."""
        return [c for c in self.conditions if c["required"] and not c["holds"]]

    def __getitem__(self, name: str) -> float:
        """Value of the condition or quantity `name`."""
        if not isinstance(name, str):
            raise refusal("Check[...]", shown(name), "the name of a condition or quantity")
        entries = [*self.conditions, *self.quantities]
        for entry in entries:
            if entry["name"] == name:
                return float(entry["value"])
        raise KeyError(f"{name!r}; there are {[e['name'] for e in entries]}")

    def _repr_html_(self) -> str:
        return of_check(self, [verdict(c) for c in self.conditions])

    def __str__(self) -> str:
        entries = [*self.conditions, *self.quantities]
        width = max((len(e["name"]) for e in entries), default=0)
        lines = [
            f"{verdict(c):18}  {c['name']:{width}}  {c['value']:<12.6g} needs {c['needed']}" for c in self.conditions
        ]
        lines += [f"{'':18}  {q['name']:{width}}  {q['value']:<12.6g} {q['meaning']}" for q in self.quantities]
        return "\n".join(lines)


def verdict(condition: dict[str, Any]) -> str:
    """Whether a condition is met, and whether that matters."""
    if condition["holds"]:
        return "met"
    return "NOT MET (required)" if condition["required"] else "not met (optional)"


@hinted
def check(
    model: _core.Model,
    network: _core.Network,
    filter: _core.Filter,
    *,
    seconds: float = math.inf,
    certificate: str = "none",
    failure: float = 1e-6,
    attacked: int | None = None,
    levels: tuple[float, float] | None = None,
    memory: bool = False,
    progress: Callable[[str, float], None] | None = None,
) -> Check:
    """Evaluate all conditions and bounds of the filter's theorems for this model and network.

    Parameters
    ----------
    model : Model
        The plant and its sensors.
    network : Network
        Who hears whom.
    filter : Filter
        One of garrison.filters, or a filter of your own.
    seconds : float
        > 0. After it searches end with a certified interval and say so; computations that have no partial result
        raise InvalidInput. Without it, searches end after about a second of work, with the same result on every
        machine. Ctrl-C ends both.
    certificate : {"none", "local", "flooded", "direct"}
        What to certify at run time, see `prepare`.
    failure : float
        Probability in [0, 1), per agent and sample, that a certified bound is wrong; 0 = never, with bounded
        noise.
    attacked : int, optional
        Most sources that lie, >= 0; default the filter's parameter of that name.
    levels : tuple of two floats, optional
        (z1, z2) instead of the covariances' own: what clean records exceed at the rate `failure`, whatever their law
        (`Fitted.levels`, `calibrate`). A bound is then wrong with at most five times that and a quarter.
    memory : bool
        Certify from all measurements so far, too, see `prepare`.
    progress : callable, optional
        progress(what, seconds) is called about once a second: what is computed, and for how long already.

    Returns
    -------
    Check
        conditions, quantities, and `holds`: every required condition is met.

    Raises
    ------
    InvalidInput
        Something does not fit; the message says which, and what was expected.
    """
    require_order("check", model, network, filter)
    tell = arguments.callback("progress", progress, "(what, seconds)")
    conditions, quantities = _core.check(model, network, filter, number("seconds", seconds), tell)
    if wanted := run_options.certificate(filter, certificate, failure, attacked, levels, memory):
        quantities += expected_certificate(_core.Design(model, network, filter, **wanted, progress=tell))
    return Check(conditions, quantities)
