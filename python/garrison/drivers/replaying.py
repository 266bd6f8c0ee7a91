"""Feed recorded measurements to a filter."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from garrison import _core, arguments, doubts, run_options
from garrison.drivers.common import (
    Attacks,
    Progress,
    arguments_of_both,
    designed,
    destination,
    made_of,
    recorded,
    require_room,
    require_taken,
    sink_of,
    with_recipe,
)
from garrison.drivers.keeping import KEEP, Keep, kept
from garrison.nonlinear import NonlinearModel, split
from garrison.numeric import matched, numbers, output_names
from garrison.record import Run
from garrison.store import written
from garrison.stored import stored
from garrison.varying import Inputs, VaryingModel, inputs_of
from garrison.varying_network import VaryingNetwork, links_of
from garrison.words import hinted, require_order


@hinted
def replay(
    model: _core.Model | VaryingModel | NonlinearModel,
    network: _core.Network | VaryingNetwork,
    filter: _core.Filter,
    *,
    measurements: ArrayLike,
    inputs: Inputs = None,
    truth: ArrayLike | None = None,
    start: ArrayLike | None = None,
    attack: Attacks = (),
    trials: int | None = None,
    first_trial: int = 0,
    seed: int = 0,
    link: Mapping[str, Any] | None = None,
    keep: Keep = KEEP,
    to: str | Path | None = None,
    threads: int = 0,
    progress: Progress | None = None,
    conditions: bool = True,
    certificate: str = "none",
    failure: float = 1e-6,
    attacked: int | None = None,
    levels: tuple[float, float] | None = None,
    memory: bool = False,
    design: _core.Design | None = None,
) -> Run:
    """Feed recorded measurements to a filter.

    Parameters
    ----------
    model : Model, VaryingModel or NonlinearModel
        The plant and its sensors.
    network : Network or VaryingNetwork
        Who hears whom.
    filter : Filter
        One of garrison.filters, or a filter of your own.
    measurements : (samples, outputs) array
        nan or masked = missing; row r belongs to time r + 1. A pandas table with columns named as the network's
        agents (or the model's outputs) is matched by name. In families with a sample at the start (platoon) row r
        belongs to time r. A leading axis of trials is allowed, one log per trial; otherwise the one log serves
        all trials.
    inputs : (samples, p) array, table or function of t, optional
        Known inputs of a model with B, as in `simulate`: row t led from time t to t + 1.
    truth : (samples + 1, n) array, optional
        From time 0; (samples, N, n) in families with a sample at the start. May have a leading axis of trials.
    start : (n,) or (N, n) array, optional
        Initial estimate, common or one per agent, default 0.
    attack : Attack or sequence of them
        On top of the log, in order.
    trials : int, optional
        Repetitions, default one per log.
    first_trial : int
        As in `simulate`.
    seed : int
        Of noise, attacks and links, >= 0. Equal arguments give bit-identical results.
    link : mapping, optional
        drop and delay (probabilities); delay_rounds: how many rounds a late message is late, >= 1 (its receiver has
        ended the round by then, so that for estimates it is lost); cuts:
        a list of (sender, receiver, start, stop), None for all agents or no end; lost: recorded losses, a list of
        (sample, round, sender, receiver).
    keep : iterable of str, or mapping
        Which arrays of the run are filled: "estimate", "report" (bounds, test statistics, thresholds and verdicts),
        "measurements", "signals" (what the family says of itself, by name), "details" (lists such as sets), "box"
        (the bound of each coordinate, with "report"); beside them errors and truth. A mapping says it of each of these
        and of "error" and "truth", "all", `garrison.every(k)` or `garrison.reduce(..)`, and what it does not name is
        not kept: {} keeps counters alone.
    to : str or Path, optional
        A folder that ends in .zarr (extra: store): the run is written there as it goes, and memory holds a block of
        samples (16 MB) and open chunks per trial that runs, however long the run is. The run that is returned reads
        its arrays where they are indexed (garrison.StoredRun). It has the bits of a run in memory, but no warning that
        looks at whole arrays. Lists (accusations, details) stay in memory until the end. The folder appears when the
        run is over: one that fails or is interrupted leaves what was there.
    threads : int
        0 = all cores it may use; the result does not depend on it. Filters and attacks of your own
        (garrison.Filter, garrison.attacks.custom), and plants by functions, always run in one.
    progress : callable, optional
        progress(done, total) is called at most once per percent of the samples. The design before them tells of its own
        progress in `prepare`, whose result runs, too.
    conditions : bool
        Evaluate the filter's conditions first, and put the required ones that are not met into the run's
        `warnings`.
    certificate : {"none", "local", "flooded", "direct"}
        What to certify at run time, see `prepare`.
    failure : float
        Probability in [0, 1), per agent and sample, that a certified bound is wrong; 0 = never, with bounded
        noise.
    attacked : int, optional
        Most sources that lie, >= 0; default the filter's parameter of that name.
    levels : tuple of two floats, optional
        (z1, z2) instead of the covariances' own: what clean records exceed at the rate `failure`, whatever their law
        (`Fitted.levels`, `calibrate`). A bound is then wrong with at most five times that and a quarter.
    memory : bool
        Certify from all measurements so far, too, see `prepare`.
    design : Design, optional
        Made before of these very three (`prepare` does that).

    Returns
    -------
    Run
        Arrays (trial, time, agent, ..).

    Raises
    ------
    InvalidInput
        Something does not fit; the message says which, and what was expected.
    DesignInfeasible
        No gains exist for this model, network and filter.
    IoError
        A file cannot be read or written (`to`).
    """
    base, changes = split(model)
    plain = network.network if isinstance(network, VaryingNetwork) else network
    require_order("replay", base, plain, filter)
    names = output_names(base, plain)
    y = numbers("measurements", matched("measurements", measurements, names))
    trials = (len(y) if y.ndim == 3 else 1) if trials is None else arguments.whole("trials", trials, 1)
    wanted = arguments.flag("conditions", conditions)
    attacks, keeping = run_options.attacks(attack), kept(keep)
    samples = y.shape[-2] if y.ndim >= 2 else 0
    ground, links = links_of(network, run_options.link(link), samples)
    known: dict[str, Any] = {"inputs": inputs_of(base, inputs, samples)} | changes
    require_taken(filter, attacks, known["functions"], certificate)
    path = destination(to, keeping, base, ground, filter)
    if path is None:
        require_room(base, filter, keeping, trials, samples, run_options.certified(certificate) or design is not None)
    with written(path, base, filter, trials, keeping.every) as store:
        sink = sink_of(filter, trials, keeping, store)
        design = designed(base, ground, filter, design, certificate, failure, attacked, levels, memory)
        data = _core.replay(
            design,
            measurements=y,
            truth=None if truth is None else numbers("truth", truth),
            **arguments_of_both(
                filter,
                attacks,
                links,
                keeping,
                known,
                sink,
                trials=trials,
                first_trial=first_trial,
                seed=seed,
                threads=threads,
                start=start,
                progress=progress,
            ),
        )
        run = recorded(data, base, ground, filter, design, attacks, wanted, known, data["steps"])
        run.warnings += doubts.of_silence(names, y.reshape(-1, base.outputs))
        if keeping.logs and any(a.target == "measurement" for a in attacks):
            run.log = np.array(y if y.ndim == 3 else y[None])
        both = made_of(trials, first_trial, seed, start, attacks, links, keeping, design, wanted, known)
        run = with_recipe(run, {"driver": "replay"} | both, sink, store)
    return run if path is None else stored(path)
