"""Noise that is larger than the model says: what the data of a run themselves say against the assumptions."""

import math
from collections import Counter
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from garrison import _core
from garrison.bound_kind import BoundKind
from garrison.certifying.contradiction import beyond, of_apart, of_dependence
from garrison.families import accuses, family_of
from garrison.words import count

Array = NDArray[np.float64]
#: times `false_alarm` that most sensors must exceed, and standard deviations of a rate beyond that
_TIMES, _SURE = 1.5, 4.0
#: fewest sensors of which a median says something while one lies
_SENSORS = 3
#: most sensors that measure the same and are compared with each other
_EQUAL = 64
#: part of measurements that rounding may change
_ROUNDING = 1e-12


class Names(NamedTuple):
    """What agents, sources and states of a run are called."""

    agents: list[str]  # [] = by their numbers
    sources: list[str]
    states: list[str]

    def agent(self, doubted: dict[str, Any]) -> str:
        """Who doubts, in which trial."""
        k, trial = doubted["agent"], doubted["trial"]
        return (self.agents[k] if self.agents else f"agent {k}") + (f", trial {trial}" if trial else "")


def of_rate(filter: _core.Filter, statistic: Array | None, threshold: Array | None) -> list[str]:
    """A line when most sensors exceed the level of their test far more often than `false_alarm` says.

    The median over sensors counts, so that a few liars raise no doubt about the noise.
    """
    asked = None if filter.own else filter.params.get("false_alarm")  # what one's own means nobody else knows
    if not isinstance(asked, float) or statistic is None or threshold is None:
        return []
    tests, above = _core.exceedances(statistic, threshold)
    over, tests = above[tests > 0], tests[tests > 0]
    if len(tests) < _SENSORS:
        return []
    rate = float(np.median(over / tests))
    independent = float(np.median(tests)) / float(filter.params.get("window", 1))
    if rate <= _TIMES * asked + _SURE * math.sqrt(asked / independent):
        return []
    return [
        f"most sensors exceed the level of their test in a share of {rate:.2g} of the samples, asked {asked:g}: "
        "process_covariance or measurement_covariance is too small, the noise depends on its past, A or C is wrong, "
        "or a lie has moved all estimates; see garrison.calibrate"
    ]


def of_certificates(kind: NDArray[np.generic] | None, failure: float) -> list[str]:
    """A line when measurements contradict what certificates assume more often than `failure`, the chance of one sample.

    kind: values of BoundKind, (trial, time, agent).
    """
    if kind is None:
        return []
    refuted = np.asarray(kind) == int(BoundKind.REFUTED)
    if not refuted.any():  # a mean over long runs takes longer than everything else here
        return []
    samples = refuted[..., 0].size
    if not beyond(float(refuted.mean(axis=(0, 1)).max()), samples, failure):
        return []
    first = int(np.flatnonzero(refuted.any(axis=(0, 2)))[0])
    return [
        f"measurements contradict what the certificate assumes in {refuted.mean():.2g} of all bounds, first at sample "
        f"{first}: measurement_bound, process_bound or the covariances are too small, A or C is wrong, or more than "
        "`attacked` sources lie; bounds of other samples may be wrong, too"
    ]


def of_memory(doubted: list[dict[str, Any]], shape: tuple[int, int, int], failure: float, names: Names) -> list[str]:
    """Lines where data contradict what certificates with memory assume; shape: trials, times, agents of the run."""
    trials, times, agents = shape
    lines: list[str] = []
    if beaten := [d for d in doubted if d["refuted"]]:
        most = max(Counter(d["agent"] for d in beaten).values())
        first = min(beaten, key=lambda d: int(d["refuted_at"]))
        if beyond(most / trials, trials, failure):
            lines.append(
                f"measurements contradict what a certificate with memory assumes, first at sample "
                f"{first['refuted_at']} ({names.agent(first)}): other sources lie than before, or noise is not white, "
                "or larger than modelled; it has started anew"
            )
    if apart := [d for d in doubted if d["apart"]]:
        counted: Counter[int] = Counter()
        for d in apart:
            counted[d["agent"]] += d["apart"]
        worst, most = counted.most_common(1)[0]
        first = min((d for d in apart if d["agent"] == worst), key=lambda d: int(d["apart_at"]))
        where = f"{names.agent(first)}, {names.states[first['apart_in']]}"
        lines += of_apart(most, trials * (times - 1), first["apart_at"], where, failure)
    if doubted:
        d = max(doubted, key=lambda d: float(d["evidence"]))
        where = f"{names.agent(d)}, source {names.sources[d['source']]}"
        lines += of_dependence(d["evidence"], agents * trials, where, d["correlation"], d["pairs"])
    return lines


def of_sources(model: _core.Model, filter: _core.Filter) -> list[str]:
    """A line when a filter counts attacked agents, and a source stands behind several of them."""
    shared = shared_sources(model)
    if not isinstance(filter.params.get("attacked"), int) or not shared:
        return []
    return [
        f"sources of the model stand behind several agents ({', '.join(shared[:3])}): `attacked` of the filter counts "
        "agents, and its bounds and accusations hold for so many of them, not for so many sources; give it as many as "
        "the sources can falsify"
    ]


def of_bounds(
    model: _core.Model,
    filter: _core.Filter,
    measurements: Array | None,
    *,
    attacked: int | None = None,
    inputs: Array | None = None,
    constant: bool = True,
) -> list[str]:
    """A line when measurements (trial, time, output) contradict the bounds of the noise whichever sensors lie.

    attacked: most sources that may lie at a time, where the filter does not say it of its sensors. inputs: of the run,
    the last row leads to the last sample. constant: A holds at all times, and all inputs are known.
    """
    told = None if filter.own else filter.params.get("attacked")
    own = isinstance(told, int) and not shared_sources(model)  # it counts agents
    liars = told if own else attacked
    bounds = np.asarray(model.measurement_bound, dtype=float)
    if measurements is None or liars is None or len(bounds) != model.agents:
        return []
    for_good = family_of(filter).proves and accuses(filter, ())  # whoever has lied once is left out
    most = _pairs(model, measurements, bounds, for_good=for_good) if own else np.zeros(1, dtype=np.int64)
    if most.max() > liars:
        return [
            f"{count(int(most.max()), 'pair')} of sensors that measure the same differ by more than measurement_bound "
            f"allows, and only {count(liars, 'sensor')} may be attacked{_trials(most > liars)}: measurement_bound is "
            "too small, or more of them lie"
        ]
    found = _core.contradictions(
        model,
        measurements,
        attacked=liars,
        for_good=for_good,
        constant=constant,
        owner=[] if own else _sources(model),
        inputs=np.zeros((0, 0)) if inputs is None else inputs[len(inputs) - measurements.shape[1] + 1 :],
    )
    # what one sample shows says more than what two do
    words = next((bound for bound in ("measurement_bound", "process_bound") if (bound in dict(found))), None)
    if words is None:
        return []
    there = np.array([bound == words for bound, _ in found])
    row = found[int(np.argmax(there))][1]
    ever = "the same all the time" if for_good else "at a time"
    whoever = f"whichever {liars} of the sources lie, {ever}" if liars else "and none of the sources may lie"
    if words == "measurement_bound":
        return [
            f"measurements of one sample contradict each other by more than measurement_bound allows, {whoever} (row "
            f"{row} of the measurements{_trials(there)}): measurement_bound is too small, C is wrong, or more of them "
            "lie"
        ]
    return [
        f"measurements change from one sample to the next by more than process_bound and measurement_bound allow, "
        f"{whoever} (from row {row} of the measurements on{_trials(there)}): process_bound or measurement_bound is too "
        "small, A or C is wrong, or more of them lie"
    ]


def _trials(there: NDArray[np.bool_]) -> str:
    """In which trials something is, where there are several."""
    if len(there) == 1:
        return ""
    return f", trial {int(np.argmax(there))}; in {int(there.sum())} of {len(there)} trials"


def _sources(model: _core.Model) -> list[int]:
    """A number per measurement, the same for those of one source; [] where every agent is one."""
    numbered: dict[str, int] = {}
    return [numbered.setdefault(name, len(numbered)) for name in model.sources]


def shared_sources(model: _core.Model) -> list[str]:
    """Names of the sources that stand behind outputs of several agents."""
    sources = model.sources
    if len(set(sources)) == len(sources):
        return []
    behind: dict[str, set[int]] = {}
    names = iter(sources)
    for agent, C in enumerate(model.C):
        for _, name in zip(C, names, strict=False):
            behind.setdefault(name, set()).add(agent)
    return [name for name, agents in behind.items() if len(agents) > 1]


def _pairs(model: _core.Model, measurements: Array, bounds: Array, *, for_good: bool) -> NDArray[np.int64]:
    """Per trial, pairs without a common sensor that measure the same and differ by more than the sum of their bounds.

    Over the whole record where the attacked ones stay the same, else in one sample.
    """
    groups = _groups(model)
    pairs = _for_good if for_good else _in_one_sample
    found: NDArray[np.int64] = np.zeros(measurements.shape[:1] + (() if for_good else measurements.shape[1:2]), int)
    with np.errstate(invalid="ignore", over="ignore"):
        for columns, agents in groups:
            found += pairs(measurements[..., columns], bounds[agents])
    return found if for_good else found.max(axis=1, initial=0)


def _groups(model: _core.Model) -> list[tuple[list[int], list[int]]]:
    """Columns of measurements, and agents, that measure the same, where there are at least two."""
    same: dict[bytes, tuple[list[int], list[int]]] = {}
    column = 0
    for agent, C in enumerate(model.C):
        row = np.asarray(C, dtype=float)
        if len(row) == 1:
            columns, agents = same.setdefault((row + 0.0).tobytes(), ([], []))
            columns.append(column)
            agents.append(agent)
        column += len(row)
    return [(columns[:_EQUAL], agents[:_EQUAL]) for columns, agents in same.values() if len(columns) > 1]


def _in_one_sample(y: Array, bounds: Array) -> NDArray[np.int64]:
    """Pairs without a common sensor that contradict each other, (trial, time): the extremes, then the next ones, ..."""
    ordered = np.sort(np.where(np.isfinite(y), y, np.nan), axis=-1)  # nan at the end
    known = np.isfinite(ordered).sum(axis=-1)
    pairs = np.zeros(y.shape[:-1], dtype=np.int64)
    limit = 2.0 * float(bounds.max()) * (1.0 + 1e-9) + _ROUNDING * np.where(np.isfinite(y), np.abs(y), 0.0).max(axis=-1)
    for k in range(y.shape[-1] // 2):
        top = known - 1 - k
        upper = np.take_along_axis(ordered, np.maximum(top, 0)[..., None], axis=-1)[..., 0]
        pairs += (top > k) & (upper - ordered[..., k] > limit)
    return pairs


def _for_good(y: Array, bounds: Array) -> NDArray[np.int64]:
    """The same per trial, for pairs that contradict each other in any sample."""
    free = np.ones((len(y), y.shape[-1]), dtype=bool)
    pairs = np.zeros(len(y), dtype=np.int64)
    for i in range(y.shape[-1]):
        for j in range(i):
            limit = (bounds[i] + bounds[j]) * (1.0 + 1e-9) + _ROUNDING * np.maximum(
                np.abs(y[..., i]), np.abs(y[..., j])
            )
            apart = free[:, i] & free[:, j] & (np.abs(y[..., i] - y[..., j]) > limit).any(axis=1)
            free[apart, i] = free[apart, j] = False
            pairs += apart
    return pairs
