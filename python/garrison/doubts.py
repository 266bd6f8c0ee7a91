"""Doubts about a run that only show when it is looked at from outside: conditions that are not met, divergence."""

import math

import numpy as np
from numpy.typing import NDArray

from garrison import _core
from garrison.checks import check
from garrison.verdict import Verdict
from garrison.words import count

Array = NDArray[np.float64]
#: growth of the error over half a run, beyond that of the plant, from which on it is called divergence
_GROWTH = 1e3
#: samples without a bound, or a test, at the end of a run from which on that is told
_OVER = 10
#: names shown in one line
_NAMES = 5
#: most samples of which a median is taken
_WIDTH = 24
#: most states of the whole network, and sets of sensors, up to which conditions are evaluated without being asked
_STATES, _SUBSETS = 400, 20_000


def _cheap(model: _core.Model, filter: _core.Filter) -> bool:
    attacked = max(0, int(filter.params.get("attacked", 0)))  # what is wrong with it the filter says
    return model.agents * model.states <= _STATES and math.comb(model.agents, min(attacked, model.agents)) <= _SUBSETS


def require_conditions(model: _core.Model, network: _core.Network, filter: _core.Filter) -> None:
    """Refuse what `check` refuses, where it takes little time."""
    if not filter.own and _cheap(model, filter):
        check(model, network, filter)


def of_conditions(model: _core.Model, network: _core.Network, filter: _core.Filter) -> list[str]:
    """One line per required condition that is not met (filters of one's own state none), or that was not evaluated."""
    if filter.own:
        return []
    if not _cheap(model, filter):
        return ["conditions were not checked, which takes long for a network of this size: garrison.check does"]
    try:
        failed = check(model, network, filter).failed
    except _core.Error as error:
        return [f"conditions could not be checked: {error}"]
    return [
        f"condition not met: {c['name']} is {c['value']:.4g}, needs {c['needed']} ({c['meaning']}); "
        "what the theorems promise does not hold for this run"
        for c in failed
    ]


def of_blind(model: _core.Model) -> list[str]:
    """A line that names sensors whose row of C is zero, which no filter can use; or that there is no sensor at all."""
    if model.outputs == 0:
        return ["no agent has a sensor (every C is empty): estimates are predictions from the start alone"]
    if np.concatenate(model.C).any(axis=1).all():
        return []
    blind = [
        f"agent {i}" + (f" (output {k})" if len(rows) > 1 else "")
        for i, rows in enumerate(model.C)
        for k, row in enumerate(rows)
        if not np.any(row)
    ]
    which = ", ".join(blind[:_NAMES]) + (f" and {len(blind) - _NAMES} more" if len(blind) > _NAMES else "")
    return [f"a sensor of {which} sees nothing of the state (its row of C is zero): what it says is not used"]


def of_attacks(attacks: list[_core.Attack], samples: int) -> list[str]:
    """One line per attack on nobody, or that starts after the last sample."""
    nobody = [f"the attack {a.name} names no agent: nothing is attacked" for a in attacks if not a.agents]
    return nobody + [
        f"the attack {attack.name} starts at sample {attack.start}, after the last one ({samples}): nothing is attacked"
        for attack in attacks
        if attack.agents and attack.start > samples >= 0
    ]


#: parameters that ask for samples before the first test or alarm: what they are, and what is absent without them
_WAITS = {
    "window": ("samples of a test", "nothing can be tested"),
    "settle": ("samples without a test", "nothing can be tested"),
    "alarm_after": ("tests in a row", "no alarm is possible"),
}


def waits(filter: _core.Filter) -> list[tuple[str, int, str]]:
    """Parameter, samples that a run needs for it to do anything, and what is absent in a shorter one.

    What the attributes of a filter of one's own mean nobody else knows.
    """
    found: list[tuple[str, int, str]] = []
    if filter.own:
        return found
    for name, (_, absent) in _WAITS.items():
        value = filter.params.get(name)
        if isinstance(value, int):
            found.append((name, value + (name == "settle"), absent))
    return found


def of_alarms(filter: _core.Filter, samples: int) -> list[str]:
    """Lines where the run is over before the filter could test, or raise an alarm, or where most of it is over."""
    lines = []
    for name, needed, absent in waits(filter):
        about = f"{name} = {filter.params[name]} {_WAITS[name][0]}"
        if needed > samples >= 0:
            lines.append(f"{about}, but the run has {count(samples, 'sample')}: {absent}")
        elif 2 * (needed - 1) >= samples >= 0 and name != "alarm_after":
            lines.append(f"{about}: the first {needed - 1} of {samples} samples were not tested")
    return lines


def of_silence(names: list[str] | None, measurements: Array) -> list[str]:
    """A line that names the outputs of which a recording (sample, output) holds nothing."""
    silent = ~np.isfinite(measurements).any(axis=0)
    if not silent.any():
        return []
    if silent.all():
        return ["the recording holds no measurement at all: every value is missing, and nothing was estimated from it"]
    which = [names[k] if names else f"output {k}" for k in np.flatnonzero(silent)]
    shown = ", ".join(which[:_NAMES]) + (f" and {len(which) - _NAMES} more" if len(which) > _NAMES else "")
    return [
        f"the recording holds no measurement of {shown}: nothing can be said of {'it' if len(which) == 1 else 'them'}"
    ]


def of_losses(bound: Array | None, verdict: NDArray[np.uint8] | None, counters: dict[str, int]) -> list[str]:
    """Lines where bounds or tests were there and then end, for everybody and to the end of the run.

    bound, verdict: (trial, time, agent). Only where something was lost: that is why, and not visible otherwise.
    """
    if not any(counters.get(name, 0) for name in ("lost", "late", "refused", "missing", "nonfinite")):
        return []
    found = []
    why = "rests on a message that did not come in time, or on more measurements at once than came"
    if bound is not None and (last := _end(np.isfinite(bound))) is not None:
        cure = 'a certificate ("local", "flooded") does not need every message'
        found.append(f"no agent has a bound after sample {last}: it {why}; {cure}")
    if verdict is not None:
        tested = (verdict != Verdict.NOT_TESTED) & (verdict != Verdict.SILENT)
        if (last := _end(tested)) is not None:
            found.append(f"no sensor is tested after sample {last}: the test {why}")
    return found


def _end(there: NDArray[np.bool_]) -> int | None:
    """Last time at which somebody has it, where that is in the run and long before its end."""
    times = np.flatnonzero(there.any(axis=(0, 2)))
    left = there.shape[1] - 1 - (times[-1] if len(times) else 0)
    return int(times[-1]) if len(times) and times[-1] > 0 and left >= _OVER else None


def of_divergence(model: _core.Model, estimate: Array | None, error: Array | None, quiet_from: int) -> list[str]:
    """A line when errors (or, without truth, estimates) grow without bound, beyond the plant's own growth.

    Compares the end with the middle, so an attack must not start in between: quiet_from, first sample from which on
    no attack starts any more.
    """
    if estimate is not None and not np.isfinite(estimate[:, -1]).all():
        return ["estimates are not finite at the end of the run: the filter diverged"]
    what, size = ("errors", error) if error is not None else ("estimates", _lengths(estimate))
    half = 0 if size is None else size.shape[1] // 2
    if size is None or half < 5 or quiet_from > half:
        return []
    # Medians over time: a single wild measurement is no divergence. nan (no truth there) is passed over.
    last, width = len(size[0]) - 1, min(half // 5, _WIDTH)
    windows = (slice(half - width, half + 1), slice(last - width, last + 1))
    middle, end = (_median(np.fmax.reduce(np.fmax.reduce(size[:, w], axis=2), axis=0)) for w in windows)
    limit = _GROWTH * max(middle, float(np.finfo(float).tiny))
    if math.isnan(middle) or math.isnan(end) or end <= limit or end <= limit * _plant_growth(model, last + 1 - half):
        return []
    return [f"the {what} grow from {middle:.3g} in the middle to {end:.3g} at the end of the run: the filter diverges"]


def _median(values: Array) -> float:
    """The upper one of the two in the middle; np.median takes ten times as long for so few."""
    return float(np.sort(values)[len(values) // 2])


def _lengths(estimate: Array | None) -> Array | None:
    return None if estimate is None else np.asarray(np.linalg.norm(estimate, axis=3))


def _plant_growth(model: _core.Model, samples: int) -> float:
    """Largest growth of a state of the plant over so many samples, in the Frobenius norm; at least 1."""
    with np.errstate(over="ignore", invalid="ignore"):
        growth = float(np.linalg.norm(np.linalg.matrix_power(np.asarray(model.A), samples)))
    return max(1.0, growth) if math.isfinite(growth) else math.inf
