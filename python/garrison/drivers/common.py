"""What simulate and replay share: what they are given, and the run that they return."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from numpy.typing import ArrayLike

from garrison import _core, arguments, doubts, refuted, run_options
from garrison.certifying.plant import sources_of
from garrison.families import family_of
from garrison.objects import described_attack, plain_data, plain_lists
from garrison.record import Run
from garrison.sizes import require_memory
from garrison.words import count, refusal

Progress = Callable[[int, int], None]
Attacks = _core.Attack | Iterable[_core.Attack]

#: what a run keeps when nothing else is asked for, and everything that it can keep
KEEP = ("estimate", "report", "measurements")
KEEPABLE = (*KEEP, "signals", "details", "box")
#: trials have numbers below this one
MOST_TRIALS = 2**24


def require_room(model: _core.Model, filter: _core.Filter, keep: Iterable[str], trials: int, steps: int) -> None:
    """Refuse a run whose arrays would not fit into the memory limit, before anything is computed."""
    n, N = model.states, model.agents
    row = {
        "estimate": N * n,
        "report": 6 * N,
        "measurements": model.outputs,
        "signals": len(filter.signal_names) * N,
        "box": N * n,
    }
    doubles = trials * (steps + 1.0) * (n + sum(row.get(name, 0) for name in keep))
    require_memory("steps, trials", f"{count(steps, 'sample')} in {count(trials, 'trial')}", doubles)


def designed(
    model: _core.Model,
    network: _core.Network,
    filter: _core.Filter,
    design: _core.Design | None,
    certificate: str,
    failure: float,
    attacked: int | None,
    levels: tuple[float, float] | None,
    memory: bool,
) -> _core.Design:
    """The design that is given, or that of the three with what is to be certified."""
    wanted = run_options.certificate(filter, certificate, failure, attacked, levels, memory)
    if design is None:
        return _core.Design(model, network, filter, **wanted)
    if wanted:
        raise refusal("certificate", f"{certificate!r} with a design", "none", "garrison.prepare takes it")
    return design


def threads_of(filter: _core.Filter, attacks: list[_core.Attack], threads: int) -> int:
    """Python code runs in one thread: a filter or an attack of one's own need not be thread-safe."""
    found = arguments.whole("threads", threads, 0)
    return 1 if filter.own or any(attack.own for attack in attacks) else found


def recorded(
    data: dict[str, Any],
    model: _core.Model,
    network: _core.Network,
    filter: _core.Filter,
    design: _core.Design,
    attacks: list[_core.Attack],
    conditions: bool,
    known: dict[str, Any],
) -> Run:
    """The run of what a driver recorded, with warnings of all that speaks against it."""
    series = known["series"]
    sources = list(dict.fromkeys(sources_of(model)))
    named = [(k, t, [[sources[j] for j in some] for some in sets]) for k, t, sets in data["proved"]]
    doubted = data["doubted"]
    data = {key: value for key, value in data.items() if key != "doubted"} | {"proved": named}
    run = Run(data | ({"inputs": known["inputs"]} if model.inputs else {}), model, network, filter, series)
    if conditions and not series:
        run.warnings[:0] = doubts.of_conditions(model, network, filter)
    if "A" in series or "C" in series:
        run.warnings.append("the plant changes in time: no theorem and no condition of a filter covers it")
    driven = "C" in series or family_of(filter).own_plants  # where rows of zeros are meant
    run.warnings += [] if driven else doubts.of_blind(model)
    run.warnings += refuted.of_sources(model, filter)
    run.warnings += doubts.of_attacks(attacks, run.shape[1] - 1)
    run.warnings += doubts.of_alarms(filter, run.shape[1] - 1)
    run.warnings += doubts.of_losses(run.bound, run.verdict, run.counters)
    quiet = max((a.start for a in attacks), default=0)
    if "C" not in series:
        u = known["inputs"]
        run.warnings += refuted.of_bounds(
            model,
            filter,
            run.measurements,
            attacked=(design.certificate or {}).get("attacked"),
            inputs=u if len(u) else None,
            constant=not series and bool(not model.inputs or len(u)),
        )
    names = refuted.Names(list(network.names), sources, list(model.state_names))
    run.warnings += refuted.of_memory(doubted, run.shape, (design.certificate or {}).get("failure", 0.0), names)
    run.warnings += refuted.of_rate(filter, run.statistic, run.threshold)
    run.warnings += [] if "A" in series else doubts.of_divergence(model, run.estimate, run.error, quiet)
    return run


def with_recipe(run: Run, made: dict[str, Any]) -> Run:
    """The run with what made it, and the doubts that depend on that."""
    run.made = plain_lists(made)
    run.warnings += refuted.of_certificates(run.bound_kind, made.get("failure", 0.0))
    return run


def made_of(
    trials: int,
    first_trial: int,
    seed: int,
    start: ArrayLike | None,
    attacks: list[_core.Attack],
    links: dict[str, Any],
    kept: list[str],
    design: _core.Design,
    conditions: bool,
) -> dict[str, Any]:
    """Arguments of both drivers as plain data, for `again`."""
    made = {"trials": trials, "first_trial": first_trial, "seed": int(seed), "start": plain_data(start), "link": links}
    made["conditions"] = conditions
    return made | {"keep": kept, "attack": [described_attack(a) for a in attacks]} | dict(design.certificate or {})
