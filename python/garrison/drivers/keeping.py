"""What a run keeps: names of arrays, or a mapping that says it of each."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

from garrison import arguments
from garrison.labelled import axes_of_any
from garrison.reductions import share_of
from garrison.store import REPORT
from garrison.words import Hinting, hinted, near, refusal, shown

#: what a run keeps when nothing else is asked for, and everything that it can keep
KEEP = ("estimate", "report", "measurements")
KEEPABLE = (*KEEP, "signals", "details", "box")
#: what it keeps as well where only names are given
ALWAYS = ("error", "truth")
#: what has no times of which some could be left out
_LISTS = ("details",)
#: arrays of which statistics may be kept: not kinds and verdicts
_REDUCIBLE = ("error", "estimate", "truth", "box", "measurements", "bound", "published", "statistic", "threshold")
_STATISTICS = ("max", "min", "mean", "count")
_AXES = ("trial", "time", "sample", "agent", "state", "output")


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


@dataclass(frozen=True)
class Reduce(metaclass=Hinting):
    """Of an array, statistics over some of its axes; `garrison.reduce` makes it."""

    statistics: tuple[str, ...]
    over: tuple[str, ...]

    def __repr__(self) -> str:
        words = ", ".join(repr(word) for word in self.statistics)
        return f"garrison.reduce({words}, over={list(self.over)!r})"


@hinted
def reduce(*statistics: str, over: str | Iterable[str]) -> Reduce:
    """Of an array, keep statistics alone, as in `keep={"error": gr.reduce("max", "q95", over="agent")}`.

    They are worked out while the run goes on, which never holds the array: `run.reduced["error_q95_over_agent"]`.

    Parameters
    ----------
    *statistics : str
        "max", "min", "mean", "count" (of numbers that exist; all others leave nan out), "q95" and the like: a quantile
        in percent, to a thousandth of its value. None depends on the threads.
    over : str, or iterable of str
        Axes that go: "trial", "time", "agent", "state" ("sample", "output" of measurements).

    Returns
    -------
    Reduce
        For `keep`, of error, estimate, truth, box, measurements and what "report" holds: bound, published, statistic,
        threshold.

    Raises
    ------
    InvalidInput
        There is no such statistic or axis.
    """
    words = arguments.texts("reduce", list(statistics))
    for word in words:
        if word not in _STATISTICS and share_of(word) is None:
            raise refusal("reduce", repr(word), f"{', '.join(_STATISTICS)}, or q0 to q100", near(word, _STATISTICS))
    if not words:
        raise refusal("reduce", "no statistic", f"some of {', '.join(_STATISTICS)}, q0 to q100")
    axes = arguments.choices("over", over, _AXES)
    if not axes:
        raise refusal("over", "no axis", f"some of {', '.join(_AXES)}")
    return Reduce(tuple(dict.fromkeys(words)), tuple(sorted(set(axes), key=_AXES.index)))


#: names of arrays, or by name "all", "none", `every` or `reduce`
Keep = Iterable[str] | Mapping[str, str | Every | Reduce]


@dataclass(frozen=True)
class Kept:
    """What was asked for. said: as plain data, for `again`; names: what the core is to make; every: steps of arrays
    that are thinned; reduced: statistics of arrays that are not kept themselves, and the axes that go."""

    said: list[str] | dict[str, Any]
    names: list[str]
    every: dict[str, int]
    reduced: dict[str, tuple[list[str], list[str]]] = field(default_factory=dict)
    whole: list[str] = field(default_factory=list)  # of names, what is kept and not only reduced

    def keeps(self, array: str) -> bool:
        """Whether an array is kept itself."""
        return ("report" if array in REPORT else array) in self.whole

    @property
    def logs(self) -> bool:
        """Whether all measurements are kept."""
        return "measurements" in self.names and "measurements" not in self.every


def kept(keep: Any) -> Kept:
    """What `keep` asks for; refused where it is nothing that a run keeps."""
    if not isinstance(keep, Mapping):
        names = arguments.choices("keep", keep, KEEPABLE)
        return Kept(names, [*names, *ALWAYS], {}, whole=[*names, *ALWAYS])
    known = (*KEEPABLE, *ALWAYS)
    steps: dict[str, int | None] = {}
    reduced: dict[str, Reduce] = {}
    for name, value in keep.items():
        if (found_one := _reduction(name, value)) is not None:
            reduced[name] = found_one
            continue
        if name not in known:
            advice = near(name, known) if isinstance(name, str) else ""
            raise refusal("keep", shown(name), f"some of {', '.join(known)}", advice)
        if (found := _step(name, value)) != 0:
            steps[name] = found
    thinned = {name: step for name, step in steps.items() if step is not None and step > 1}
    said: dict[str, Any] = {name: _said(thinned.get(name)) for name in steps}
    said |= {name: {"reduce": list(one.statistics), "over": list(one.over)} for name, one in reduced.items()}
    needed = ["report" if name in REPORT else name for name in reduced]
    names = list(dict.fromkeys([*steps, *needed]))
    return Kept(
        said, names, thinned, {name: (list(r.statistics), list(r.over)) for name, r in reduced.items()}, list(steps)
    )


def _reduction(name: Any, value: Any) -> Reduce | None:
    """The reduction of an array; None: something else is asked for."""
    if isinstance(value, Mapping) and set(value) == {"reduce", "over"}:  # as a run remembers it
        value = reduce(*value["reduce"], over=value["over"])
    if not isinstance(value, Reduce):
        return None
    if name not in _REDUCIBLE:
        advice = near(name, _REDUCIBLE) if isinstance(name, str) else ""
        raise refusal("keep", f"{shown(name)} with garrison.reduce", f"one of {', '.join(_REDUCIBLE)}", advice)
    axes = axes_of_any(name)
    if wrong := [axis for axis in value.over if axis not in axes]:
        raise refusal(f"keep[{name!r}]: over", ", ".join(wrong), f"some of {', '.join(axes)}")
    return value


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
    words = '"all" or "none"' + ("" if name in _LISTS else ", garrison.every(step) or garrison.reduce(..)")
    raise refusal(f"keep[{name!r}]", shown(value), words)
