"""gr.compare: who is how far off, finds whom, says what, and costs how much, under every attack."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping

from numpy.typing import ArrayLike

from garrison import _core, arguments
from garrison.comparison.baselines import BASELINES
from garrison.comparison.contestants import attacks_for, filters_for, typical_size
from garrison.comparison.job import KALMAN, Job
from garrison.comparison.table import NONE, Comparison, Row
from garrison.record import Run
from garrison.varying import VaryingModel, parted, undriven
from garrison.words import hinted, refusal, require_plant

Progress = Callable[[str, int, int], None]


@hinted
def compare(
    model: _core.Model | VaryingModel,
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
    model : Model or VaryingModel
        The plant and its sensors. Filters that need a constant plant are rows that say so.
    network : Network
        Who hears whom.
    attacked : iterable of int
        Agents that lie.
    filters : dict, optional
        Label -> filter, default every family that fits the plant, with plain parameters (where the plant changes, with
        gains that follow it). What a filter refuses is a row with the reason.
    attacks : dict, optional
        Label -> attack, default every one of garrison.attacks that can be set up alone.
    baselines : bool
        Also covariance intersection, median and trimmed mean of estimates, W-MSR, a central L1 decoder and subset
        search, and Kalman filters (plain, gated at 1e-3, Huber's with 1.345) of all measurements and per
        agent; they get the measurements of the first filter's run, in at most five trials (they are slow), and no lies
        in messages.
    size : float, optional
        Of the lies, > 0, in the unit of the measurement; default ten times the noise.
    steps : int
        Samples of a trial, >= 1; at most those that a VaryingModel is given for.
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
    base, parts = parted(model)
    require_plant("compare", base, network)
    model = undriven(model)  # errors do not depend on known inputs
    lying = arguments.whole_numbers("attacked", attacked)
    liars = sorted({arguments.whole("attacked", a, 0, base.agents - 1) for a in lying})
    title, progress = arguments.text("title", title), arguments.callback("progress", progress, "(filter, done, total)")
    own = None if filters is None else arguments.labelled("filters", filters, _core.Filter, "filters")
    theirs = None if attacks is None else arguments.labelled("attacks", attacks, _core.Attack, "attacks")
    if not liars:
        raise refusal("attacked", "nobody", "one agent at least")
    steps = arguments.whole("steps", steps, 2)
    given = [len(part) for part in parts.values()]
    if given and steps > given[0]:
        raise refusal("steps", str(steps), f"at most {given[0]}, for which the plant is given")
    start = arguments.whole("start", start, 1, steps - 1)
    trials = arguments.whole("trials", trials, 1)
    size = typical_size(base) if size is None else _size(size)
    chosen = filters_for(model, network, len(liars), size) if own is None else own
    against = attacks_for(liars, base.states, start, size) if theirs is None else theirs
    job = Job(model, network, liars, steps, start, trials, arguments.whole("seed", seed, 0, 2**63 - 1), x0)
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


def _size(given: float) -> float:
    size = arguments.number("size", given)
    if not 0 < size < math.inf:
        raise refusal("size", f"{size:g}", "a finite number > 0")
    return size
