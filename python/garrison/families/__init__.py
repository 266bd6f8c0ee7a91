"""What a filter's family says of its own runs, in one place: nobody else asks for a family's name or parameters."""

from garrison import _core
from garrison.families.family import Family
from garrison.families.platoon import PLATOON, PLATOON_BASELINE

_SATURATION = Family(accuses=lambda params: bool(params["detector"]), proves=True)
_STRUCTURAL = Family(accuses=lambda params: True)
_FAMILIES = {
    "saturation": _SATURATION,
    "structural": _STRUCTURAL,
    "platoon": PLATOON,
    "platoon_baseline": PLATOON_BASELINE,
}
_PLAIN = Family()

__all__ = ["Family", "family_of"]


def family_of(filter: _core.Filter) -> Family:
    """What the family of `filter` says; a family that says nothing accuses nobody and has one plant for all."""
    return _FAMILIES.get(filter.name, _PLAIN)
