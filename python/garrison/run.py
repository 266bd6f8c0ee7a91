"""Drivers and their results."""

from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from garrison import _core

Array = NDArray[np.float64]
Progress = Callable[[int, int], None]

VERDICTS = ("cleared", "suspected", "attacked", "silent", "not tested")


class Run:
    """Arrays of a finished run, indexed [trial, time, agent, ...]; time 0 is the start, nan = does not exist.

    truth (trial, time, n), or (trial, time, agent, n) of agents with states of their own; estimate (trial, time, agent,
    n); error, bound, statistic, threshold (trial, time, agent); verdict (trial, time, agent): index into
    garrison.run.VERDICTS; measurements (trial, time 1.., output; from time 0 in families with a sample at the start),
    as the filter received them; signals: name -> (trial, time, agent). An array that was not kept, or that cannot
    exist (errors without truth), is None.
    """

    def __init__(self, data: dict[str, Any], model: _core.Model, network: _core.Network, filter: _core.Filter) -> None:
        self.model = model
        self.network = network
        self.filter = filter
        self.truth: Array | None = data.get("truth")
        self.measurements: Array | None = data.get("measurements")
        self.estimate: Array | None = data.get("estimate")
        self.error: Array | None = data.get("error")
        self.bound: Array | None = data.get("bound")
        self.statistic: Array | None = data.get("statistic")
        self.threshold: Array | None = data.get("threshold")
        self.verdict: NDArray[np.uint8] | None = data.get("verdict")
        signals = data.get("signals")
        self.signals: dict[str, Array] = (
            {} if signals is None else {name: signals[:, :, k] for k, name in enumerate(data["signal_names"])}
        )
        #: (trial, time, sets): what each agent believes to be attacked, whenever one of the sets changed
        self.accusations: list[tuple[int, int, list[list[int]]]] = data["accusations"]
        #: (trial, time, agent, name, values): lists of the family (sets, gains), whenever one of them changed
        self.details: list[tuple[int, int, int, str, list[float]]] = data["details"]
        #: lost, late, forged and refused messages, missing and non-finite measurements, overflows
        self.counters: dict[str, int] = data["counters"]
        #: what the filter's family has to say of this run, for people (needs keep "report")
        self.warnings: list[str] = data["warnings"]
        #: payload of all messages of one sample, when none is lost
        self.bytes_per_step: int = data["bytes_per_step"]

    def limited(self, trial: int = 0, start: int = 1) -> Array:
        """Share of the samples from `start` on at which each agent's measurement was limited (suspected)."""
        if self.verdict is None:
            raise _core.InvalidInput('limited: got a run without verdicts, expected keep to contain "report"')
        suspected = self.verdict[trial, start:] == VERDICTS.index("suspected")
        return np.asarray(suspected.mean(axis=0), dtype=float)

    def first_accused(self, trial: int = 0) -> dict[int, int]:
        """Agent -> first time at which some agent believed it to be attacked."""
        first: dict[int, int] = {}
        for k, time, sets in self.accusations:
            if k == trial:
                for agent in {a for s in sets for a in s}:
                    first.setdefault(agent, time)
        return first

    def save(self, path: str | Path) -> None:
        """Write all arrays to a NumPy .npz file (created, or replaced)."""
        arrays = {name: value for name, value in vars(self).items() if isinstance(value, np.ndarray)}
        arrays |= {f"signal_{name}": value for name, value in self.signals.items()}
        with Path(path).open("wb") as file:
            np.savez_compressed(file, **arrays)  # type: ignore[arg-type]

    def plot(self, trial: int = 0) -> Any:
        """Errors with their bounds, and statistics against thresholds, as a matplotlib figure (extra: plot)."""
        if self.truth is not None and self.truth.ndim == 4 and self.bound is not None:
            from garrison.vehicles import string_figure

            return string_figure(self, trial)
        from garrison.plots import run_figure

        return run_figure(self, trial)

    def animate(self, path: str | Path, trial: int = 0) -> None:
        """Write a GIF of vehicles in a string (extra: plot); keep "details" and "measurements" for it."""
        if self.truth is None or self.truth.ndim != 4 or self.measurements is None:
            raise _core.InvalidInput("animate: got a run without vehicles or measurements, expected one of a platoon")
        from garrison.vehicles import animate

        animate(self, path, trial)

    def to_xarray(self) -> Any:
        """An xarray.Dataset of all arrays, with named dimensions (extra: xarray)."""
        import xarray as xr

        dims = {
            "truth": ("trial", "time", "state")
            if self.truth is None or self.truth.ndim == 3
            else ("trial", "time", "agent", "state"),
            "estimate": ("trial", "time", "agent", "state"),
            "measurements": ("trial", "sample", "output"),
        }
        names = ("truth", "measurements", "estimate", "error", "bound", "statistic", "threshold", "verdict")
        found = {name: getattr(self, name) for name in names if getattr(self, name) is not None}
        return xr.Dataset({k: (dims.get(k, ("trial", "time", "agent")), v) for k, v in found.items()})

    def __repr__(self) -> str:
        shape = next(a.shape for a in (self.error, self.estimate, self.bound) if a is not None)
        return f"Run({self.filter.name}: {shape[0]} trial(s), {shape[1] - 1} samples, {shape[2]} agents)"


def _start(start: ArrayLike | None, states: int) -> Array | None:
    if start is None:
        return None
    rows = np.atleast_1d(np.asarray(start, dtype=float))
    return rows.reshape(1, -1) if rows.ndim == 1 else rows


def simulate(
    model: _core.Model,
    network: _core.Network,
    filter: _core.Filter,
    *,
    steps: int,
    attack: _core.Attack | Iterable[_core.Attack] = (),
    trials: int = 1,
    seed: int = 0,
    x0: ArrayLike | None = None,
    start: ArrayLike | None = None,
    start_error: float = 0.0,
    noise: str | ArrayLike = "auto",
    link: Mapping[str, float] | None = None,
    keep: Iterable[str] = ("estimate", "report", "measurements"),
    threads: int = 0,
    progress: Progress | None = None,
) -> Run:
    """Simulate the plant, attack it, filter it.

    steps: samples >= 1. attack: one or more, applied in order. x0: (n,) true initial state, default 0. start: (n,)
    common initial estimate, or (N, n) one per agent, default 0; start_error moves it by a random vector of at most
    that length per trial. noise: "uniform" within the model's bounds, "extreme" at them, "normal", "none", "auto";
    families whose agents drive plants of their own have laws of their own, x0 (N, n), default: where they should be,
    and take recorded disturbances, one row per time 0..steps, in place of a law (garrison.platoon).
    link: drop and delay (probabilities), delay_rounds. keep: of "estimate", "report", "signals", "measurements",
    "details" (lists such as sets).
    threads: 0 = all cores; the result does not depend on it. progress(done, total) is called now and then.
    Same arguments, same bits. Raises InvalidInput when something does not fit.
    """
    data = _core.simulate(
        _core.Design(model, network, filter),
        steps=steps,
        x0=np.zeros(0) if x0 is None else np.asarray(x0, dtype=float).ravel(),
        start_error=start_error,
        noise=noise if isinstance(noise, str) else "auto",
        disturbances=np.zeros((0, 0)) if isinstance(noise, str) else np.atleast_2d(np.asarray(noise, dtype=float)),
        trials=trials,
        seed=seed,
        threads=threads,
        start=_start(start, model.states),
        attacks=[attack] if isinstance(attack, _core.Attack) else list(attack),
        link=dict(link or {}),
        keep=list(keep),
        progress=progress,
    )
    return Run(data, model, network, filter)


def replay(
    filter: _core.Filter,
    model: _core.Model,
    network: _core.Network,
    *,
    measurements: ArrayLike,
    truth: ArrayLike | None = None,
    start: ArrayLike | None = None,
    attack: _core.Attack | Iterable[_core.Attack] = (),
    trials: int | None = None,
    seed: int = 0,
    link: Mapping[str, float] | None = None,
    keep: Iterable[str] = ("estimate", "report", "measurements"),
    threads: int = 0,
    progress: Progress | None = None,
) -> Run:
    """Feed recorded measurements, (samples, outputs), nan = missing; row r belongs to time r + 1.

    In families with a sample at the start (platoon) row r belongs to time r, and truth is (samples, N, n).
    truth: (samples + 1, n), from time 0, or None. Both may have a leading axis of trials, one log per trial;
    otherwise the one log serves all `trials` (default 1). Attacks come on top of the log. The rest as in simulate.
    """
    y = np.asarray(measurements, dtype=float)
    if trials is None:
        trials = len(y) if y.ndim == 3 else 1
    data = _core.replay(
        _core.Design(model, network, filter),
        measurements=y,
        truth=None if truth is None else np.asarray(truth, dtype=float),
        trials=trials,
        seed=seed,
        threads=threads,
        start=_start(start, model.states),
        attacks=[attack] if isinstance(attack, _core.Attack) else list(attack),
        link=dict(link or {}),
        keep=list(keep),
        progress=progress,
    )
    return Run(data, model, network, filter)


def central_kalman(
    model: _core.Model,
    measurements: ArrayLike,
    *,
    start: ArrayLike | None = None,
    start_variance: float = 1.0,
) -> Array:
    """Estimates (samples + 1, n) of a central Kalman filter that sees all measurements (samples, outputs).

    The unprotected ideal that distributed filters are compared with. Needs the model's covariances; nan = missing.
    """
    x0 = np.zeros(model.states) if start is None else np.asarray(start, dtype=float)
    return _core.central_kalman(model, np.asarray(measurements, dtype=float), x0, start_variance)
