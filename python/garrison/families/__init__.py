"""What a filter's family says of its own runs, in one place: nobody else asks for a family's name or parameters."""

from collections.abc import Collection
from typing import Any

from garrison import _core
from garrison.families.family import Family
from garrison.families.platoon import PLATOON, PLATOON_BASELINE
from garrison.words import refusal


def _never(params: dict[str, Any]) -> bool:
    return False


def _promises(params: dict[str, Any]) -> str:
    """What of the saturation filter rests on theorems for linear plants."""
    asked = [name for name in ("initial_error", "detector", "adaptive", "table", "recovery") if params[name]]
    asked = [name for name in asked if params[name] == params[name]]  # nan: not known
    return f"{', '.join(asked)} rest on theorems for linear plants" if asked else ""


_SATURATION = Family(
    accuses=lambda params: bool(params["detector"]),
    proves=True,
    contest=lambda liars, threshold: {"threshold": threshold, "rounds": 6, "attacked": liars},
    linear=_promises,
)
_FAMILIES = {
    "saturation": _SATURATION,
    "scalar_gain": Family(accuses=_never, contest=lambda liars, threshold: {"rounds": 6}, linear=lambda params: ""),
    "lfre": Family(accuses=_never, contest=lambda liars, threshold: {"faulty": liars}),
    "partial_sharing": Family(
        accuses=_never, contest=lambda liars, threshold: {"gain": 0.1}, changing={"gains": "varying"}
    ),
    "structural": Family(accuses=lambda params: True, contest=lambda liars, threshold: {"isolate": True}),
    "platoon": PLATOON,
    "platoon_baseline": PLATOON_BASELINE,
}
_PLAIN = Family()

__all__ = ["Family", "accuses", "family_called", "family_of", "require_common_state"]


def accuses(filter: _core.Filter, accusations: Collection[Any]) -> bool:
    """Whether it is a fact about `filter` whom it has accused: it may accuse, or did so in a run."""
    told = family_of(filter).accuses
    return bool(accusations) if told is None else told(filter.params)


def family_of(filter: _core.Filter) -> Family:
    """What the family of `filter` says; one that says nothing has one plant for all, as filters of one's own have."""
    if filter.own:
        return _PLAIN
    return family_called(filter.name)


def family_called(name: str) -> Family:
    """The same by the family's name."""
    return _FAMILIES.get(name, _PLAIN)


def require_common_state(filter: _core.Filter | None) -> None:
    """Refuse a filter whose agents have states of their own, where sensors are asked about one common state."""
    if filter is not None and family_of(filter).own_plants:
        got = f"{filter.name}, whose agents have states of their own"
        raise refusal("filter", got, "a filter of one common state", "garrison check has the conditions of this one")
