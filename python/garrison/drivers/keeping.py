"""What a run keeps: names of arrays, or a mapping that says it of each."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from garrison import arguments
from garrison.words import Hinting, hinted, near, refusal, shown

#: what a run keeps when nothing else is asked for, and everything that it can keep
KEEP = ("estimate", "report", "measurements")
KEEPABLE = (*KEEP, "signals", "details", "box")
#: what it keeps as well where only names are given
ALWAYS = ("error", "truth")
#: what has no times of which some could be left out
_LISTS = ("details",)


@dataclass(frozen=True)
class Every(metaclass=Hinting):
    """Of an array, the times that are multiples of `step`; `garrison.every` makes it."""

    step: int

    def __repr__(self) -> str:
        return f"garrison.every({self.step})"


@hinted
def every(step: int) -> Every:
    """Of an array, keep the times 0, step, 2 step, .. alone, as in `keep={"estimate": gr.every(100)}`.

    Parameters
    ----------
    step : int
        At least 1.

    Returns
    -------
    Every
        For `keep` of a run that is written as it goes (`to`).

    Raises
    ------
    InvalidInput
        step is no whole number >= 1.
    """
    return Every(arguments.whole("every", step, 1))


#: names of arrays, or by name "all", "none" or `every`
Keep = Iterable[str] | Mapping[str, str | Every]


@dataclass(frozen=True)
class Kept:
    """What was asked for. said: as plain data, for `again`; every: steps of arrays that are thinned."""

    said: list[str] | dict[str, Any]
    names: list[str]
    every: dict[str, int]

    @property
    def logs(self) -> bool:
        """Whether all measurements are kept."""
        return "measurements" in self.names and "measurements" not in self.every


def kept(keep: Any) -> Kept:
    """What `keep` asks for; refused where it is nothing that a run keeps."""
    if not isinstance(keep, Mapping):
        names = arguments.choices("keep", keep, KEEPABLE)
        return Kept(names, [*names, *ALWAYS], {})
    known = (*KEEPABLE, *ALWAYS)
    steps: dict[str, int | None] = {}
    for name, value in keep.items():
        if name not in known:
            advice = near(name, known) if isinstance(name, str) else ""
            raise refusal("keep", shown(name), f"some of {', '.join(known)}", advice)
        if (found := _step(name, value)) != 0:
            steps[name] = found
    thinned = {name: step for name, step in steps.items() if step is not None and step > 1}
    return Kept({name: _said(thinned.get(name)) for name in steps}, list(steps), thinned)


def _said(step: int | None) -> str | dict[str, int]:
    return "all" if step is None else {"every": step}


def _step(name: str, value: Any) -> int | None:
    """The step of an array; None: all times, 0: nothing."""
    if value is True or (isinstance(value, str) and value == "all"):
        return None
    if value is None or value is False or (isinstance(value, str) and value == "none"):
        return 0
    if isinstance(value, Mapping) and list(value) == ["every"]:  # as a run remembers it
        value = every(value["every"])
    if isinstance(value, Every) and name not in _LISTS:
        return value.step
    words = '"all" or "none"' + ("" if name in _LISTS else ", or garrison.every(step)")
    raise refusal(f"keep[{name!r}]", shown(value), words)
