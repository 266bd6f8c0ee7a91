"""Simulate a plant, attack it, filter it."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from garrison import _core, arguments, run_options
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
from garrison.numeric import numbers
from garrison.objects import plain_data
from garrison.record import Run
from garrison.store import written
from garrison.stored import stored
from garrison.varying import Inputs, VaryingModel, inputs_of
from garrison.varying_network import VaryingNetwork, links_of
from garrison.words import hinted, require_order


@hinted
def simulate(
    model: _core.Model | VaryingModel | NonlinearModel,
    network: _core.Network | VaryingNetwork,
    filter: _core.Filter,
    *,
    steps: int,
    inputs: Inputs = None,
    attack: Attacks = (),
    trials: int = 1,
    first_trial: int = 0,
    seed: int = 0,
    x0: ArrayLike | None = None,
    start: ArrayLike | None = None,
    start_error: float = 0.0,
    noise: str | ArrayLike = "auto",
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
    """Simulate the plant, attack it, filter it.

    Parameters
    ----------
    model : Model, VaryingModel or NonlinearModel
        The plant and its sensors.
    network : Network or VaryingNetwork
        Who hears whom.
    filter : Filter
        One of garrison.filters, or a filter of your own.
    steps : int
        Samples, >= 1.
    inputs : (steps, p) array, table or function of t, optional
        Known inputs of a model with B: row t is u(t), which leads from time t to t + 1. A pandas table with columns
        named as the model's inputs is matched by name. Estimates, errors and bounds are those of the state
        (docs/adr/0016); lies in messages are about the state without the inputs' response.
    attack : Attack or sequence of them
        Applied in order.
    trials : int
        Independent repetitions, >= 1.
    first_trial : int
        Trial k of this run has the bits of trial first_trial + k of a run from 0, so that a run can be had in
        parts; first_trial + trials <= 2^24.
    x0 : (n,) array, optional
        True initial state, default 0; (N, n) in families whose agents drive plants of their own, default: where
        they should be.
    start : (n,) or (N, n) array, optional
        Initial estimate, common or one per agent, default 0.
    start_error : float
        Moves `start` by a random vector of at most that length per trial, >= 0.
    noise : {"auto", "uniform", "extreme", "normal", "none"} or array
        "uniform" within the model's bounds, "extreme" at them. Families whose agents drive plants of their own
        have laws of their own, and take recorded disturbances, one row per time 0..steps, in place of a law
        (garrison.platoon).
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
        Arrays (trial, time, agent, ..), time 0..steps.

    Raises
    ------
    InvalidInput
        Something does not fit; the message says which, and what was expected.
    DesignInfeasible
        No gains exist for this model, network and filter.
    IoError
        A file cannot be read or written (`to`).
    """
    steps, trials = arguments.whole("steps", steps, 1), arguments.whole("trials", trials, 1)
    base, changes = split(model)
    ground, links = links_of(network, run_options.link(link), steps)
    require_order("simulate", base, ground, filter)
    known: dict[str, Any] = {"inputs": inputs_of(base, inputs, steps)} | changes
    wanted = arguments.flag("conditions", conditions)
    attacks, keeping = run_options.attacks(attack), kept(keep)
    require_taken(filter, attacks, known["functions"], certificate)
    path = destination(to, keeping, base, ground, filter)
    if path is None:
        require_room(base, filter, keeping, trials, steps, run_options.certified(certificate) or design is not None)
    with written(path, base, filter, trials, keeping.every) as store:
        sink = sink_of(filter, trials, keeping, store)
        design = designed(base, ground, filter, design, certificate, failure, attacked, levels, memory)
        data = _core.simulate(
            design,
            steps=steps,
            x0=np.zeros(0) if x0 is None else numbers("x0", x0).ravel(),
            start_error=arguments.moderate("start_error", start_error),
            noise=noise if isinstance(noise, str) else "auto",
            disturbances=np.zeros((0, 0)) if isinstance(noise, str) else arguments.table("noise", noise),
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
        drawn = noise if isinstance(noise, str) else plain_data(numbers("noise", noise))
        own = {
            "driver": "simulate",
            "steps": steps,
            "x0": plain_data(x0),
            "start_error": float(start_error),
            "noise": drawn,
        }
        both = made_of(trials, first_trial, seed, start, attacks, links, keeping, design, wanted, known)
        run = with_recipe(run, own | both, sink, store)
    return run if path is None else stored(path)
