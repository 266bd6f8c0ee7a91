"""Conditions and bounds of a filter's theorems."""

import math
from dataclasses import dataclass
from typing import Any

from garrison import _core


@dataclass(frozen=True)
class Check:
    """What `check` found. A condition that fails is data, not an error.

    conditions: dicts with name, value, needed, holds, meaning, required (False: it only
    sharpens the result). quantities: dicts with name, value (nan = does
    not exist), meaning.
    """

    conditions: list[dict[str, Any]]
    quantities: list[dict[str, Any]]

    @property
    def holds(self) -> bool:
        """All required conditions hold."""
        return all(c["holds"] for c in self.conditions if c["required"])

    def __getitem__(self, name: str) -> float:
        """Value of the condition or quantity `name`."""
        for entry in [*self.conditions, *self.quantities]:
            if entry["name"] == name:
                return float(entry["value"])
        known = [e["name"] for e in [*self.conditions, *self.quantities]]
        raise KeyError(f"{name!r}; there are {known}")

    def __str__(self) -> str:
        width = max(len(e["name"]) for e in [*self.conditions, *self.quantities])
        lines = [
            f"{verdict(c):5}  {c['name']:{width}}  {c['value']:<12.6g} needs {c['needed']}" for c in self.conditions
        ]
        lines += [f"{'':5}  {q['name']:{width}}  {q['value']:<12.6g} {q['meaning']}" for q in self.quantities]
        return "\n".join(lines)


def verdict(condition: dict[str, Any]) -> str:
    """One word for people: holds, FAILS, or no (a condition that is not required)."""
    return "holds" if condition["holds"] else "FAILS" if condition["required"] else "no"


def check(
    filter: _core.Filter, model: _core.Model, network: _core.Network, *, seconds: float = math.inf
) -> Check:
    """Evaluate all conditions and bounds of the filter's theorems for this model and network.

    After `seconds` (> 0) searches end with a certified interval and say so; computations that have no partial result
    raise InvalidInput. Ctrl-C ends both. Without `seconds`, searches end after about a second of work, with the same
    result on every machine.

    Raises InvalidInput when parameters, model and network do not fit together.
    """
    return Check(*_core.check(filter, model, network, seconds))
