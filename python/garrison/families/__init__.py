"""What a filter's family says of its own runs, in one place: nobody else asks for a family's name or parameters."""

from garrison import _core
from garrison.families.family import Family
from garrison.families.platoon import PLATOON, PLATOON_BASELINE

_SATURATION = Family(
    accuses=lambda params: bool(params["detector"]),
    proves=True,
    contest=lambda liars, threshold: {"threshold": threshold, "rounds": 6, "attacked": liars},
)
_FAMILIES = {
    "saturation": _SATURATION,
    "scalar_gain": Family(contest=lambda liars, threshold: {"rounds": 6}),
    "lfre": Family(contest=lambda liars, threshold: {"faulty": liars}),
    "partial_sharing": Family(contest=lambda liars, threshold: {"gain": 0.1}),
    "structural": Family(accuses=lambda params: True, contest=lambda liars, threshold: {"isolate": True}),
    "platoon": PLATOON,
    "platoon_baseline": PLATOON_BASELINE,
}
_PLAIN = Family()

__all__ = ["Family", "family_called", "family_of"]


def family_of(filter: _core.Filter) -> Family:
    """What the family of `filter` says; a family that says nothing accuses nobody and has one plant for all."""
    return family_called(filter.name)


def family_called(name: str) -> Family:
    """The same by the family's name."""
    return _FAMILIES.get(name, _PLAIN)
