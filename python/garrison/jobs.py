"""The main job: run a scenario with all its filters, attacked and not, and sum up."""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from garrison import _core, doubts
from garrison.bound_kind import counts
from garrison.checks import Check, check
from garrison.drivers import KEEP, kept, replay, require_room, simulate
from garrison.families import accuses, family_of
from garrison.kalman import central_kalman, local_kalman
from garrison.prepared import Prepared, prepare
from garrison.record import Run
from garrison.run_file import ARRAYS
from garrison.scenario import Scenario
from garrison.scenario.section import renamed
from garrison.varying_network import links_of
from garrison.words import count, refusal

_CONSTANT_PART = (
    "the plant changes in time: conditions and quantities are those of its constant part and do not cover it; what a "
    "certificate is worth is seen in a run"
)
Array = NDArray[np.float64]
Progress = Callable[[str, int, int], None]
Working = Callable[[str, float], None]


@dataclass
class Row:
    """One filter in one condition: under the attacks, or without them."""

    scenario: Scenario = field(repr=False)
    label: str
    attacked: bool
    run: Run | None  # None for the central Kalman filter
    error: Array | None  # (trial, time, agent)
    robust_error: Array | None = None  # the same, to the robust reference

    @cached_property
    def summary(self) -> dict[str, Any]:
        """Numbers for tables, worked out once; what does not exist for this filter is not there."""
        out: dict[str, Any] = {"filter": self.label, "attacked": self.attacked}
        if self.error is not None:
            since = self.error[:, self.scenario.first_attack :]
            out["mean_error"] = float(np.nanmean(since))
            out["worst_error"] = float(np.nanmax(since))
        if self.robust_error is not None and not self.scenario.truth_is_declared:
            out["mean_error_robust"] = float(np.nanmean(self.robust_error[:, 1:]))
        if self.run is not None:
            out |= self._bounds(self.run) | self._accusations(self.run) | self._clipped(self.run)
            out["warnings"] = self.run.warnings
            out["counters"] = {k: v for k, v in self.run.counters.items() if v and k != "sent"}
        return out

    def forget(self, shown: bool) -> None:
        """Drop all arrays but those that pictures show of it, after it is summed up. shown: they show it at all."""
        assert self.summary  # worked out while there is something to sum up
        self.robust_error = None
        self.error = self.error if shown else None
        if self.run is not None:
            self.run.signals, self.run.details = {}, []
            for name in ARRAYS:
                if not (shown and name in ("bound", "published")):
                    setattr(self.run, name, None)

    def _bounds(self, run: Run) -> dict[str, Any]:
        if run.bound is None:
            return {}
        bound = run.bound[:, 1:]
        known = np.isfinite(bound)
        out: dict[str, Any] = {"share_with_bound": float(known.mean())}
        since = run.bound[:, self.scenario.first_attack :]
        if np.isfinite(since).any():
            out["median_bound"] = float(np.median(since[np.isfinite(since)]))
        if run.bound_kind is not None:
            out["bound_kinds"] = counts(run.bound_kind[:, 1:])
        if self.error is not None:
            known &= np.isfinite(self.error[:, 1:])
            out["inside_bound"] = float((self.error[:, 1:] <= bound)[known].mean()) if known.any() else None
        return out

    def _accusations(self, run: Run) -> dict[str, Any]:
        """Who was accused first when, in the first trial; false alarms of all trials where the truth is declared."""
        if not accuses(run.filter, run.accusations):
            return {}
        names = self.scenario.names
        accused = [run.first_accused(k) for k in range(run.shape[0])]
        out: dict[str, Any] = {
            "detected": {names[a]: int(t) for a, t in sorted(accused[0].items(), key=lambda entry: entry[1])}
        }
        if self.scenario.truth_is_declared:
            hit = self.scenario.hit if self.attacked else []
            out["false_alarms"] = sum(a not in hit for found in accused for a in found)
        return out

    def _clipped(self, run: Run) -> dict[str, Any]:
        if run.verdict is None:
            return {}
        share = run.limited(start=self.scenario.first_attack)
        return {"limited": {self.scenario.names[a]: float(v) for a, v in enumerate(share) if v > 0}}


def run_scenario(
    scenario: Scenario,
    progress: Progress | None = None,
    conditions: bool = True,
    working: Working | None = None,
    whole: bool = True,
) -> list[Row]:
    """Run every filter of the scenario under its attacks, and once more without them when there are any.

    Parameters
    ----------
    scenario : Scenario
        As read_scenario returns it.
    progress : callable, optional
        progress(label, done, total) is called at most once per percent of a run.
    conditions : bool
        As in `simulate`: refuse filters whose required conditions fail.
    working : callable, optional
        working(label, seconds) is called about once a second while a filter is designed.
    whole : bool
        Keep all arrays of every run; else of the first row alone, and of others what tables and pictures show, so that
        memory never holds two whole runs.

    Returns
    -------
    list of Row
        One per filter, attacked and not: label, summary, run.

    Raises
    ------
    InvalidInput
        A required condition fails, or what the drivers refuse.
    DesignInfeasible
        A filter cannot be designed.
    """
    if conditions:
        require_conditions(scenario)
    filters = [(label, filter) for label, filter in scenario.filters if filter is not None]
    designs = {label: _designed(scenario, label, filter, working) for label, filter in filters}  # once, for both

    def run(label: str, filter: _core.Filter, attacked: bool) -> Row:
        report = _labelled(progress, f"{label}{', attacked' if attacked else ''}")
        made = _run(scenario, filter, attacked, designs[label], report, conditions)
        return Row(scenario, label, attacked, made, made.error, _distance(made.estimate, scenario.robust))

    found: dict[bool, list[Row]] = {}
    order = [True, False] if scenario.attacks else [False]
    for attacked in reversed(order):  # the one whose arrays stay comes last
        shown = attacked == order[0]
        found[attacked] = _in_one_condition(scenario, attacked, run, None if whole else shown)
    return [row for attacked in order for row in found[attacked]]


def _in_one_condition(
    scenario: Scenario, attacked: bool, run: Callable[[str, _core.Filter, bool], Row], shown: bool | None
) -> list[Row]:
    """A row per filter; the main one, whose measurements Kalman filters take, runs last and stays while they do.

    shown: None keeps all arrays; else those of the main one where pictures show this condition, and what they show of
    the others.
    """
    main = next((label for label, filter in scenario.filters if filter is not None), None)
    rows: dict[str, Row] = {}
    for label, filter in sorted(scenario.filters, key=lambda entry: entry[0] == main):
        if filter is not None:
            rows[label] = run(label, filter, attacked)
            if shown is not None and label != main:
                rows[label].forget(shown)
    log = rows[main].run if main is not None else None
    for label, filter in scenario.filters:
        if filter is None:
            rows[label] = _kalman_row(scenario, label, attacked, log)
    if shown is False and main is not None:
        rows[main].forget(shown)
    return [rows[label] for label, _ in scenario.filters]


def _designed(scenario: Scenario, label: str, filter: _core.Filter, working: Working | None) -> Prepared:
    """The filter for the scenario, with what it is to certify."""

    def tell(what: str, seconds: float) -> None:
        if working is not None:
            working(f"{label}: {what}", seconds)

    return prepare(scenario.model, scenario.network, filter, **certificate_of(scenario, filter), progress=tell)


def require_conditions(scenario: Scenario) -> None:
    """Refuse what `garrison check` refuses of any filter: what runs can be checked."""
    for _, filter in scenario.filters:
        if filter is not None:
            doubts.require_conditions(scenario.model, scenario.network, filter)


def rehearse(scenario: Scenario) -> None:
    """Let every filter run for a single sample, so that everything a run would refuse is refused now."""
    require_conditions(scenario)
    _require_length(scenario)
    for label, filter in scenario.filters:
        if filter is not None:
            keep = _options(scenario, filter, True)["keep"]
            require_room(scenario.model, filter, kept(keep), scenario.run.get("trials", 1), scenario.steps)
            design = _designed(scenario, label, filter, None)
            _run(scenario, filter, True, design, None, conditions=False, rehearsal=True)
        else:
            y = scenario.measurements
            y = np.zeros((1, scenario.model.outputs)) if y is None else y[:1]
            _kalman(scenario, label, y)


def _require_length(scenario: Scenario) -> None:
    """What is known over time is known for the whole run, which a rehearsal of one sample does not see."""
    steps, inputs = scenario.steps, scenario.inputs
    links_of(scenario.ground, {}, steps)
    if inputs is not None and scenario.measurements is None and len(inputs) != steps:
        raise refusal("[run].inputs", f"{count(len(inputs), 'row')}", f"{steps}, one per step of the run")
    if inputs is not None and not np.isfinite(inputs).all():
        at = tuple(int(k) for k in np.argwhere(~np.isfinite(inputs))[0])
        raise refusal(f"inputs[{at[0]}][{at[1]}]", f"{inputs[at]:g}", "a finite number: inputs are known")
    if scenario.varying is not None and scenario.varying.steps < steps:
        got = f"a model over {count(scenario.varying.steps, 'step')}"
        raise refusal("[model]", got, f"at least {steps}, one per step of the run")


def _labelled(progress: Progress | None, label: str) -> Callable[[int, int], None] | None:
    if progress is None:
        return None

    def report(done: int, total: int) -> None:
        progress(label, done, total)

    return report


def certificate_of(scenario: Scenario, filter: _core.Filter) -> dict[str, Any]:
    """What a filter of the scenario is to certify; agents with states of their own have bounds of their own."""
    return {} if family_of(filter).own_plants else scenario.certificate


def checked(scenario: Scenario, filter: _core.Filter) -> tuple[Check, list[str]]:
    """Conditions and quantities of a filter of the scenario, and what to know of them.

    Where the plant changes in time they are those of its constant part, and a certificate is none of them: what it is
    worth depends on the matrices of every sample.
    """
    wanted = certificate_of(scenario, filter) if scenario.varying is None else {}
    found = check(scenario.model, scenario.network, filter, **wanted)
    return found, [] if scenario.varying is None else [_CONSTANT_PART]


def _options(scenario: Scenario, filter: _core.Filter, attacked: bool) -> dict[str, Any]:
    """Arguments that simulate and replay share."""
    options: dict[str, Any] = {k: scenario.run[k] for k in ("trials", "seed", "threads", "start") if k in scenario.run}
    sets = filter.detail_names  # sets over time, for the pictures
    options["keep"] = (*KEEP, "signals", "details") if sets else KEEP
    return options | {"attack": scenario.attacks if attacked else [], "link": scenario.link}


def _run(
    scenario: Scenario,
    filter: _core.Filter,
    attacked: bool,
    design: Prepared,
    progress: Callable[[int, int], None] | None,
    conditions: bool,
    rehearsal: bool = False,
) -> Run:
    options = _options(scenario, filter, attacked)
    options |= {"design": design._design, "progress": progress, "conditions": conditions}
    if rehearsal:
        options["trials"] = 1
    parts = scenario.plant, scenario.ground, filter
    if scenario.inputs is not None:
        options["inputs"] = scenario.inputs[: 1 if rehearsal else None]
    if scenario.measurements is not None:
        y, truth = scenario.measurements, scenario.truth
        if rehearsal:
            rows = 2 if family_of(filter).own_plants else 1  # of vehicles, the first row is the start
            y, truth = y[:rows], None if truth is None else truth[:2]
        return replay(*parts, measurements=y, truth=truth, **options)
    options |= {k: scenario.run[k] for k in ("x0", "start_error") if k in scenario.run}
    return simulate(*parts, steps=1 if rehearsal else scenario.steps, noise=scenario.noise, **options)


def _kalman_row(scenario: Scenario, label: str, attacked: bool, log: Run | None) -> Row:
    """The central Kalman filter on what the main filter's sensors said; agents with plants of their own have none."""
    if log is None or log.measurements is None or family_of(log.filter).own_plants:
        return Row(scenario, label, attacked, None, None)
    simulated = scenario.measurements is None
    logs = log.measurements if simulated else log.measurements[:1]
    truth = log.truth if simulated else scenario.truth
    start = np.asarray(scenario.run.get("start", np.zeros(scenario.model.states)))
    first = start.ravel() if start.size == scenario.model.states else np.zeros(scenario.model.states)
    estimate = np.stack([_kalman(scenario, label, y, first) for y in logs])
    return Row(scenario, label, attacked, None, _distance(estimate, truth), _distance(estimate, scenario.robust))


def _kalman(scenario: Scenario, label: str, y: Array, start: Array | None = None) -> Array:
    """Estimates (samples + 1, agents or 1, n) of a Kalman filter of the scenario."""
    inputs = None if scenario.inputs is None else scenario.inputs[: len(y)]
    known: dict[str, Any] = {"inputs": inputs, "start": start, **scenario.screens[label]}
    try:
        if label in scenario.local:
            return local_kalman(scenario.plant, scenario.network, y, **known)
        return central_kalman(scenario.plant, y, **known)[:, None]
    except _core.Error as error:
        raise renamed(error, label) from None


def _distance(estimate: Array | None, states: Array | None) -> Array | None:
    """Lengths (trial, time, agent) of the differences of estimates to states ([trial,] time, n)."""
    if estimate is None or states is None:
        return None
    return np.asarray(np.linalg.norm(estimate - np.expand_dims(states, -2), axis=3))


def signal_size(scenario: Scenario) -> float | None:
    """Mean length of the reference state: what an estimate of 0 would be off by."""
    return None if scenario.truth is None else float(np.nanmean(np.linalg.norm(scenario.truth[1:], axis=1)))
