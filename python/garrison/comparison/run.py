"""gr.compare: who is how far off, finds whom, says what, and costs how much, under every attack."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from garrison import _core, arguments
from garrison.comparison.baselines import BASELINES, DISTRIBUTED, Plant, plant_of
from garrison.comparison.contestants import attacks_for, filters_for, typical_size
from garrison.drawing import drawn
from garrison.drivers import simulate
from garrison.families import family_of
from garrison.kalman import central_kalman, local_kalman
from garrison.prepared import prepare
from garrison.record import Run
from garrison.varying import undriven
from garrison.words import Hinting, hinted, hinted_methods, refusal, require_plant

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Array = NDArray[np.float64]
Progress = Callable[[str, int, int], None]
Row = dict[str, Any]

NONE = "none"
#: Kalman filters of all measurements, or of each agent's and its neighbours', with what protects them
KALMAN: dict[str, dict[str, float]] = {
    "central Kalman filter": {},
    "gated Kalman filter (central)": {"gate": 1e-3},
    "Huber Kalman filter (central)": {"huber": 1.345},
    "Kalman filter (per agent)": {},
    "gated Kalman filter (per agent)": {"gate": 1e-3},
    "Huber Kalman filter (per agent)": {"huber": 1.345},
}
#: columns of the table after filter and attack
COLUMNS = (
    "q50", "q95", "q99", "detection_delay", "false_alarms", "bound_share", "inside_bound", "bytes_per_sample",
    "microseconds", "status",
)  # fmt: skip


@hinted_methods
@dataclass
class Comparison(metaclass=Hinting):
    """rows: a dict per filter and attack ("none" first), None where something does not exist for it.

    q50, q95, q99: quantiles of the errors of honest agents' estimates from the attack's start on, over agents, samples
    and trials. detection_delay: samples until an attacked agent is accused, median over the trials where one was;
    false_alarms: agents accused per trial
    while they were honest. bound_share, inside_bound: samples with an error bound, and errors
    within it, 0..1. bytes_per_sample: of all messages. microseconds: per agent and sample, conditions and design left
    out. status: "ok", or why there are no numbers.
    """

    title: str
    attacked: list[int]
    rows: list[Row]

    def table(self, column: str = "q95") -> tuple[list[str], list[str], Array]:
        """(filters, attacks, numbers): one column of all rows as a matrix, nan where it does not exist."""
        filters = list(dict.fromkeys(row["filter"] for row in self.rows))
        attacks = list(dict.fromkeys(row["attack"] for row in self.rows))
        numbers = np.full((len(filters), len(attacks)), np.nan)
        for row in self.rows:
            value = row[column]
            if value is not None:
                numbers[filters.index(row["filter"]), attacks.index(row["attack"])] = value
        return filters, attacks, numbers

    def summary(self) -> list[Row]:
        """A row per filter: its error (q95) without an attack and the worst with lies in measurements and in messages,
        by which attack; the least inside_bound, and means of the other columns over the attacks.
        """
        message = {info["name"] for info in _core.attack_infos() if info["target"] == "message"}
        out = []
        for label in dict.fromkeys(row["filter"] for row in self.rows):
            rows = [row for row in self.rows if row["filter"] == label]
            fine = [row for row in rows if row["q95"] is not None]
            lied = [row for row in fine if row["attack"] != NONE]
            found: Row = {"filter": label, "none": next((r["q95"] for r in fine if r["attack"] == NONE), None)}
            for name, some in (
                ("measurements", [row for row in lied if row["attack"] not in message]),
                ("messages", [row for row in lied if row["attack"] in message]),
            ):
                worst = max(some, key=lambda row: float(row["q95"]), default=None)
                found |= {name: worst and worst["q95"], f"{name}_by": worst and worst["attack"]}
            for name in ("detection_delay", "false_alarms", "bound_share", "bytes_per_sample", "microseconds"):
                values = [row[name] for row in fine if row[name] is not None]
                found[name] = float(np.mean(values)) if values else None
            inside = [row["inside_bound"] for row in fine if row["inside_bound"] is not None]
            found["inside_bound"] = min(inside, default=None)
            found["status"] = "ok" if fine else rows[0]["status"]
            out.append(found)
        return out

    def to_pandas(self) -> Any:
        """The rows as a pandas.DataFrame (extra: pandas)."""
        import pandas as pd

        return pd.DataFrame(self.rows)

    def plot(self) -> Figure:
        """95 % quantiles of the errors as a map of filters and attacks (extra: plot)."""
        return drawn("comparison_figure", self)


@hinted
def compare(
    model: _core.Model,
    network: _core.Network,
    attacked: Iterable[int],
    *,
    filters: Mapping[str, _core.Filter] | None = None,
    attacks: Mapping[str, _core.Attack] | None = None,
    baselines: bool = True,
    size: float | None = None,
    steps: int = 100,
    start: int = 20,
    trials: int = 20,
    seed: int = 0,
    x0: ArrayLike | None = None,
    title: str = "",
    progress: Progress | None = None,
) -> Comparison:
    """Run filters and baselines on the same plant, noise and attacks.

    Parameters
    ----------
    model : Model
        The plant and its sensors.
    network : Network
        Who hears whom.
    attacked : iterable of int
        Agents that lie.
    filters : dict, optional
        Label -> filter, default every family that fits the plant, with plain parameters. What a filter refuses is
        a row with the reason.
    attacks : dict, optional
        Label -> attack, default every one of garrison.attacks that can be set up alone.
    baselines : bool
        Also covariance intersection, median and trimmed mean of estimates, W-MSR, a central L1 decoder and subset
        search, and Kalman filters (plain, gated at 1e-3, Huber's with 1.345) of all measurements and per
        agent; they get the measurements of the first filter's run, in at most five trials (they are slow), and no lies
        in messages.
    size : float, optional
        Of the lies, in the unit of the measurement, default ten times the noise.
    steps : int
        Samples of a trial, >= 1.
    start : int
        First attacked sample.
    trials : int
        Repetitions, >= 1.
    seed : int
        Of noise and attacks, >= 0.
    x0 : (n,) array, optional
        True initial state, default 0.
    title : str
        For tables and pictures.
    progress : callable, optional
        progress(filter, done, total) is called before every run.

    Returns
    -------
    Comparison
        Errors by filter and attack; `plot()` draws them.

    Raises
    ------
    InvalidInput
        Something does not fit; the message says which, and what was expected.
    """
    require_plant("compare", model, network)
    model = undriven(model)  # errors do not depend on known inputs
    given = arguments.whole_numbers("attacked", attacked)
    liars = sorted({arguments.whole("attacked", a, 0, model.agents - 1) for a in given})
    title, progress = arguments.text("title", title), arguments.callback("progress", progress, "(filter, done, total)")
    own = None if filters is None else arguments.labelled("filters", filters, _core.Filter, "filters")
    theirs = None if attacks is None else arguments.labelled("attacks", attacks, _core.Attack, "attacks")
    if not liars:
        raise refusal("attacked", "nobody", "one agent at least")
    steps = arguments.whole("steps", steps, 2)
    start = arguments.whole("start", start, 1, steps - 1)
    trials = arguments.whole("trials", trials, 1)
    size = typical_size(model, steps) if size is None else arguments.number("size", size)
    chosen = filters_for(model, network, len(liars), size) if own is None else own
    against = attacks_for(liars, model.states, start, size) if theirs is None else theirs
    job = _Job(model, network, liars, steps, start, trials, arguments.whole("seed", seed, 0, 2**63 - 1), x0)
    conditions: list[tuple[str, _core.Attack | None]] = [(NONE, None), *against.items()]
    extra = [*BASELINES, *KALMAN] if arguments.flag("baselines", baselines) else []
    total, done = (len(chosen) + len(extra)) * len(conditions), 0
    rows: list[Row] = []
    logs: dict[str, Run] = {}
    for label, filter in chosen.items():
        for name, attack in conditions:
            if progress is not None:
                progress(label, done, total)
            done += 1
            row, run = job.family(filter, attack)
            rows.append({"filter": label, "attack": name} | row)
            if run is not None and name not in logs:
                logs[name] = run
    for label in extra:
        for name, attack in conditions:
            if progress is not None:
                progress(label, done, total)
            done += 1
            rows.append({"filter": label, "attack": name} | job.baseline(label, attack, logs.get(name)))
    if progress is not None:
        progress("done", total, total)
    return Comparison(title, liars, rows)


@dataclass
class _Job:
    """What all runs share."""

    model: _core.Model
    network: _core.Network
    liars: list[int]
    steps: int
    start: int
    trials: int
    seed: int
    x0: ArrayLike | None

    def family(self, filter: _core.Filter, attack: _core.Attack | None) -> tuple[Row, Run | None]:
        """Numbers of a filter of the library, and its run."""
        keep = ("report", "measurements")
        options: dict[str, Any] = {"steps": self.steps, "trials": self.trials, "seed": self.seed, "x0": self.x0}
        parts = self.model, self.network, filter
        try:
            design = prepare(*parts)
            began = time.perf_counter()
            run = simulate(
                *parts, **options, attack=attack or [], keep=keep, conditions=False, threads=1, design=design._design
            )
        except _core.Error as error:
            return _empty(" ".join(str(error).split())), None
        seconds = time.perf_counter() - began
        row = _empty("ok") | self._errors(run.error) | self._alarms(run, attack) | _bounds(run)
        row["bytes_per_sample"] = run.bytes_per_step
        row["microseconds"] = 1e6 * seconds / (self.trials * self.steps * self.model.agents)
        return row, run

    def baseline(self, label: str, attack: _core.Attack | None, log: Run | None) -> Row:
        """Numbers of a baseline on the measurements of a run."""
        if attack is not None and attack.target == "message":
            return _empty("does not apply: it takes the messages as they were sent")
        if log is None or log.measurements is None or log.truth is None:
            return _empty("no filter ran that it could read the measurements of")
        few = min(self.trials, 5)
        try:
            plant = plant_of(self.model, self.network, len(self.liars))
            began = time.perf_counter()
            found = [self._estimate(label, plant, log.measurements[k]) for k in range(few)]
        except (_core.Error, np.linalg.LinAlgError) as error:
            return _empty(" ".join(str(error).split()))
        seconds = time.perf_counter() - began
        distance = np.linalg.norm(np.array(found) - log.truth[:few, :, None], axis=3)
        row = _empty("ok") | self._errors(distance)
        row["microseconds"] = 1e6 * seconds / (few * self.steps * self.model.agents)
        if label in DISTRIBUTED:
            n = self.model.states
            row["bytes_per_sample"] = 8 * (n + n * (n + 1) // 2) * sum(len(heard) for heard in plant.heard)
        return row

    def _estimate(self, label: str, plant: Plant, y: Array) -> Array:
        if label not in KALMAN:
            return BASELINES[label](plant, y)
        R = self.model.measurement_covariance
        model = self.model
        if R is None or model.process_covariance is None:
            model = _core.Model(plant.A, plant.C, process_covariance=plant.Q, measurement_covariance=plant.R)
        if label.endswith("(per agent)"):
            return local_kalman(model, self.network, y, **KALMAN[label])
        return np.repeat(central_kalman(model, y, **KALMAN[label])[:, None], plant.agents, axis=1)

    def _errors(self, error: Array | None) -> Row:
        if error is None:
            return {}
        honest = [i for i in range(error.shape[2]) if i not in self.liars] or list(range(error.shape[2]))
        since = error[:, self.start :, honest]
        shares = {"q50": 0.5, "q95": 0.95, "q99": 0.99}
        return {name: float(np.nanquantile(since, share)) for name, share in shares.items()}

    def _alarms(self, run: Run, attack: _core.Attack | None) -> Row:
        if not family_of(run.filter).accuses(run.filter.params):
            return {}
        hit = self.liars if attack is not None else []
        first: list[dict[int, int]] = [{} for _ in range(self.trials)]  # accusations that are right
        false: set[tuple[int, int]] = set()  # (trial, agent)
        for trial, at, sets in run.accusations:
            for agent in {a for some in sets for a in some}:
                if agent in hit and at >= self.start:
                    first[trial].setdefault(agent, at)
                else:
                    false.add((trial, agent))
        delays = [min(found.values()) for found in first if found]
        delay = float(np.median(delays)) - self.start if delays else None
        return {"detection_delay": delay, "false_alarms": len(false) / self.trials}


def _bounds(run: Run) -> Row:
    if run.bound is None or run.error is None:
        return {}
    bound, error = run.bound[:, 1:], run.error[:, 1:]
    known = np.isfinite(bound) & np.isfinite(error)
    inside = float((error <= bound)[known].mean()) if known.any() else None
    return {"bound_share": float(np.isfinite(bound).mean()), "inside_bound": inside}


def _empty(status: str) -> Row:
    return dict.fromkeys(COLUMNS) | {"status": status}
