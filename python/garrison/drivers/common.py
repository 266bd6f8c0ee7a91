"""What simulate and replay share: what they are given, and the run that they return."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

from numpy.typing import ArrayLike

from garrison import _core, arguments, doubts, refuted, run_options
from garrison.certifying.plant import sources_of
from garrison.drivers.keeping import Kept
from garrison.families import family_of
from garrison.objects import described, described_attack, plain_data, plain_lists
from garrison.record import Run
from garrison.reductions import Reductions, numbers_of
from garrison.sizes import require_memory
from garrison.store import UNSEEN, Store, place
from garrison.words import count, refusal

Progress = Callable[[int, int], None]
Attacks = _core.Attack | Iterable[_core.Attack]

#: trials have numbers below this one
MOST_TRIALS = 2**24


#: bytes of one agent in the arrays of "report", and in that of the family's own bound with a certificate
_REPORT, _PUBLISHED = 3 * 8 + 2, 8
_ADVICE = 'take fewer steps or trials; in Python keep less (keep=...), or write it as it goes (to="run.zarr")'


def require_room(
    model: _core.Model, filter: _core.Filter, keep: Kept, trials: int, steps: int, certified: bool = False
) -> None:
    """Refuse a run whose arrays would not fit into the memory limit, before anything is computed."""
    n, N = model.states, model.agents
    row = {
        "truth": 8 * n * (N if family_of(filter).own_plants else 1),
        "error": 8 * N,
        "estimate": 8 * N * n,
        "report": (_REPORT + _PUBLISHED * certified) * N,
        "measurements": 8 * model.outputs,
        "signals": 8 * len(filter.signal_names) * N,
        "box": 8 * N * n,
    }
    bytes_of_one = sum(row.get(name, 0) for name in keep.whole)
    got = f"{count(steps, 'sample')} in {count(trials, 'trial')} of {count(N, 'agent')}, {bytes_of_one} bytes a sample"
    lengths = {"trial": trials, "time": steps + 1, "sample": steps + 1, "agent": N, "state": n, "output": model.outputs}
    together = trials * (steps + 1.0) * bytes_of_one / 8.0 + numbers_of(filter, keep.reduced, lengths)
    require_memory("steps, trials", got, together, _ADVICE)


def destination(
    to: str | Path | None, keep: Kept, model: _core.Model, network: _core.Network, filter: _core.Filter
) -> Path | None:
    """Where the run is written as it goes; None: nowhere, it stays in memory."""
    if to is not None:
        described(model, network, filter)  # refuses before the run what no file can hold
        return place(to)
    if keep.reduced and (beside := [name for name in keep.whole if name != "details"]):
        words = "reductions alone, of a run in memory"
        raise refusal(
            "keep", f"{', '.join(beside)} beside garrison.reduce without to", words, 'to="run.zarr" takes both'
        )
    for name, step in keep.every.items():
        first = step - 1 if name == "measurements" else 0  # of sample 1 on, other arrays of time 0 on
        advice = f'to="run.zarr"; in memory slices do it: run.{name}[:, {first or ""}::{step}]'
        raise refusal(
            f"keep[{name!r}]", f"garrison.every({step}) without to", "a run that is written as it goes", advice
        )
    return None


def require_taken(
    filter: _core.Filter, attacks: list[_core.Attack], functions: dict[str, Any], certificate: str
) -> None:
    """Refuse what needs a linear plant before it is designed for the constant part, which is none."""
    if not functions:
        return
    if why := "" if filter.own else family_of(filter).linear(filter.params):
        takes = (
            "ScalarGain, Saturation without a promise (initial_error, detector, adaptive, table), or one of your own"
        )
        raise refusal("filter", f"{filter.name} with a NonlinearModel", takes, f"{why}; docs/how-to/changing-plants.md")
    if any(attack.name == "false_trajectory" for attack in attacks):
        advice = "its story moves by A; garrison.attacks.custom takes yours"
        raise refusal("attack", "false_trajectory with a NonlinearModel", "another one", advice)
    if run_options.certified(certificate) and not functions["linear"]:
        advice = "certificates rest on rows of C; docs/how-to/changing-plants.md"
        raise refusal("certificate", f"{certificate!r} with a NonlinearModel without linear outputs", '"none"', advice)


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


def threads_of(filter: _core.Filter, attacks: list[_core.Attack], threads: int, known: dict[str, Any]) -> int:
    """Python code runs in one thread: a filter, an attack or a plant of one's own need not be thread-safe."""
    found = arguments.whole("threads", threads, 0)
    return 1 if filter.own or known["functions"] or any(attack.own for attack in attacks) else found


def arguments_of_both(
    filter: _core.Filter,
    attacks: list[_core.Attack],
    links: dict[str, Any],
    keeping: Kept,
    known: dict[str, Any],
    sink: Store | Reductions | None,
    *,
    trials: int,
    first_trial: int,
    seed: int,
    threads: int,
    start: ArrayLike | None,
    progress: Progress | None,
) -> dict[str, Any]:
    """What the core's drivers take alike, checked."""
    return {
        "trials": trials,
        "first_trial": arguments.whole("first_trial", first_trial, 0, MOST_TRIALS - trials),
        "seed": arguments.whole("seed", seed, 0, 2**64 - 1),
        "threads": threads_of(filter, attacks, threads, known),
        "start": None if start is None else arguments.table("start", start),
        "attacks": attacks,
        "link": links,
        "keep": keeping.names,
        **known,
        "progress": arguments.callback("progress", progress),
        "sink": sink and sink.take,
    }


def recorded(
    data: dict[str, Any],
    model: _core.Model,
    network: _core.Network,
    filter: _core.Filter,
    design: _core.Design,
    attacks: list[_core.Attack],
    conditions: bool,
    known: dict[str, Any],
    steps: int,
) -> Run:
    """The run of what a driver recorded, with warnings of all that speaks against it."""
    series, functions = known["series"], bool(known["functions"])
    sources = list(dict.fromkeys(sources_of(model)))
    named = [(k, t, [[sources[j] for j in some] for some in sets]) for k, t, sets in data["proved"]]
    doubted = data["doubted"]
    data = {key: value for key, value in data.items() if key != "doubted"} | {"proved": named}
    run = Run(data | ({"inputs": known["inputs"]} if model.inputs else {}), model, network, filter, series)
    if conditions and not series and not functions:
        run.warnings[:0] = doubts.of_conditions(model, network, filter)
    if "A" in series or "C" in series:
        run.warnings.append("the plant changes in time: no theorem and no condition of a filter covers it")
    if functions:
        run.warnings.append("the plant is nonlinear: no theorem and no condition of a filter covers it")
    driven = functions or "C" in series or family_of(filter).own_plants  # where rows of zeros are meant
    run.warnings += [] if driven else doubts.of_blind(model)
    run.warnings += refuted.of_sources(model, filter)
    run.warnings += doubts.of_attacks(attacks, steps)
    run.warnings += doubts.of_alarms(filter, steps)
    run.warnings += doubts.of_losses(run.bound, run.verdict, run.counters)
    quiet = max((a.start for a in attacks), default=0)
    if "C" not in series and not functions:
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
    size = (data["trials"], steps + 1, model.agents)  # of the run, whatever of it is kept
    run.warnings += refuted.of_memory(doubted, size, (design.certificate or {}).get("failure", 0.0), names)
    run.warnings += refuted.of_rate(filter, run.statistic, run.threshold)
    run.warnings += [] if functions or "A" in series else doubts.of_divergence(model, run.estimate, run.error, quiet)
    return run


def sink_of(filter: _core.Filter, trials: int, keep: Kept, store: Store | None) -> Store | Reductions | None:
    """Where a run goes as it goes on; None: nowhere, it stays in memory."""
    if not keep.reduced:
        return store
    return Reductions(filter, trials, keep.reduced, keep.keeps, None if store is None else store.take)


def with_recipe(run: Run, made: dict[str, Any], sink: Store | Reductions | None, store: Store | None) -> Run:
    """The run with what made it, and the doubts that depend on that; the rest of what its store is to hold, too."""
    run.made = plain_lists(made)
    if isinstance(sink, Reductions):
        run.reduced = sink.arrays()
        run.warnings += [UNSEEN] if store is None else []
    run.warnings += refuted.of_certificates(run.bound_kind, made.get("failure", 0.0))
    if store is not None:
        run.warnings.append(UNSEEN)
        store.finish(run)
    return run


def made_of(
    trials: int,
    first_trial: int,
    seed: int,
    start: ArrayLike | None,
    attacks: list[_core.Attack],
    links: dict[str, Any],
    kept: Kept,
    design: _core.Design,
    conditions: bool,
    known: dict[str, Any],
) -> dict[str, Any]:
    """Arguments of both drivers as plain data, for `again`."""
    made = {"trials": trials, "first_trial": first_trial, "seed": int(seed), "start": plain_data(start), "link": links}
    made["conditions"] = conditions
    made |= {"functions": True} if known["functions"] else {}
    return made | {"keep": kept.said, "attack": [described_attack(a) for a in attacks]} | dict(design.certificate or {})
