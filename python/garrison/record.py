"""What a run leaves behind: arrays, accusations, counters, and the objects it was made of."""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from garrison import _core, run_file
from garrison.alarms import Alarm, intervals
from garrison.arguments import alone, entries, whole
from garrison.bound_kind import BoundKind
from garrison.drawing import animated, drawn
from garrison.families import family_of
from garrison.notebook import of_run
from garrison.paths import path as path_of
from garrison.recipe import code
from garrison.result import same
from garrison.verdict import Verdict
from garrison.words import Hinting, count, hinted_methods, near, refusal

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Array = NDArray[np.float64]


@hinted_methods
class Run(metaclass=Hinting):
    """Arrays of a finished run, indexed [trial, time, agent, ...]; time 0 is the start, nan = does not exist.

    An array that was not kept, or that cannot exist (errors without truth), is None. Runs compare with ==, copy and
    pickle; `save` and `Run.load` keep everything.

    Attributes
    ----------
    model, network, filter : Model, Network, Filter
        What ran.
    truth : (trial, time, n) array
        (trial, time, agent, n) of agents with states of their own.
    estimate : (trial, time, agent, n) array
        Of the state, by every agent.
    error, bound : (trial, time, agent) array
        Distance of the estimate to the truth, and what it is at most.
    bound_kind : (trial, time, agent) array
        Values of garrison.BoundKind, which say where a bound comes from, or why it is inf or nan.
    box : (trial, time, agent, n) array
        What the error of each coordinate is at most.
    published : (trial, time, agent) array
        With a certificate, the bound of the filter's family alone.
    statistic, threshold : (trial, time, agent) array
        Of the test of each agent's sensor.
    verdict : (trial, time, agent) array
        Values of garrison.Verdict.
    measurements : (trial, time 1.., output) array
        As the network received them; from time 0 in families with a sample at the start.
    log : (1 or trial, sample, output) array
        Of a replay with attacks on measurements that keeps measurements: what it was given, before the attacks.
    inputs : (step, input) array
        Known ones; row t led from time t to t + 1.
    varying : dict
        What of the plant changed, by name (VaryingModel).
    signals : dict
        Name -> (trial, time, agent) array.
    reduced : dict
        What `garrison.reduce` was asked for, by names as "error_q95_over_agent": arrays without the axes that went.
    accusations : list of (trial, time, sets)
        The agents that each agent takes for attacked, whenever one of the sets changed.
    proved : list of (trial, time, sets)
        With a certificate with memory: the names of the sources that each agent's has shown to be attacked, whenever
        one of the sets changed; agents where the model names no sources.
    details : list of (trial, time, agent, name, values)
        Lists of the family (sets, gains), whenever one of them changed.
    counters : dict
        Lost, late, forged and refused messages, missing and non-finite measurements, overflows.
    warnings : list of str
        Doubts about this run, for people.
    bytes_per_step : int
        Payload of all messages of one sample, when none is lost.
    made : dict
        What made the run, as plain data: driver, seed, attacks, links, ... (`again`).
    """

    def __init__(
        self,
        data: dict[str, Any],
        model: _core.Model,
        network: _core.Network,
        filter: _core.Filter,
        varying: dict[str, Array] | None = None,
    ) -> None:
        self.model = model
        self.varying = dict(varying or {})
        self.inputs: Array | None = data.get("inputs")
        #: what made the run, as plain data: driver, seed, attacks, links, ...; see garrison.again
        self.made: dict[str, Any] = dict(data.get("made", {}))
        self.network = network
        self.filter = filter
        self.truth: Array | None = data.get("truth")
        self.measurements: Array | None = data.get("measurements")
        self.log: Array | None = data.get("log")
        self.estimate: Array | None = data.get("estimate")
        self.error: Array | None = data.get("error")
        self.bound: Array | None = data.get("bound")
        self.bound_kind: NDArray[np.uint8] | None = data.get("bound_kind")
        self.box: Array | None = data.get("box")
        self.published: Array | None = data.get("published")
        self.statistic: Array | None = data.get("statistic")
        self.threshold: Array | None = data.get("threshold")
        self.verdict: NDArray[np.uint8] | None = data.get("verdict")
        signals = data.get("signals")
        self.signals: dict[str, Array] = (
            {} if signals is None else {name: signals[:, :, k] for k, name in enumerate(data["signal_names"])}
        )
        self.reduced: dict[str, Array] = dict(data.get("reduced", {}))
        #: (trial, time, sets): the agents that each agent takes for attacked, whenever one of the sets changed
        self.accusations: list[tuple[int, int, list[list[int]]]] = data["accusations"]
        #: (trial, time, sets): the sources that each agent's certificate has shown to be attacked
        self.proved: list[tuple[int, int, list[list[str]]]] = data.get("proved", [])
        #: (trial, time, agent, name, values): lists of the family (sets, gains), whenever one of them changed
        self.details: list[tuple[int, int, int, str, list[float]]] = data["details"]
        #: lost, late, forged and refused messages, missing and non-finite measurements, overflows
        self.counters: dict[str, int] = data["counters"]
        #: doubts about this run, for people: required conditions that are not met, estimates that diverge, what the
        #: filter's family has to say (needs keep "report")
        self.warnings: list[str] = list(data["warnings"])
        #: payload of all messages of one sample, when none is lost
        self.bytes_per_step: int = data["bytes_per_step"]

    @property
    def shape(self) -> tuple[int, int, int]:
        """(trials, times, agents); times counts the start."""
        found = next((a for a in (self.error, self.estimate, self.bound, self.verdict) if a is not None), None)
        if found is None:
            return next((s.shape for s in self.signals.values()), (0, 0, self.network.agents))
        return found.shape[0], found.shape[1], found.shape[2]

    def limited(self, trial: int = 0, start: int = 1) -> Array:
        """Share of the samples at which each agent's measurement was suspected (clipped).

        Parameters
        ----------
        trial : int
            Which one, from 0.
        start : int
            First sample that counts, from 0.

        Returns
        -------
        (N,) array
            0..1.

        Raises
        ------
        InvalidInput
            There is no such trial or sample, or the run has no verdicts.
        """
        if self.verdict is None:
            raise refusal("limited", "a run without verdicts", 'keep to contain "report"')
        first = whole("start", start, 0, self.verdict.shape[1] - 1)
        suspected = self.verdict[self._trial(trial), first:] == Verdict.SUSPECTED
        return np.asarray(suspected.mean(axis=0), dtype=float)

    def why_no_bound(self, agent: int | str, time: int, trial: int = 0) -> str:
        """Why an agent has no bound at a time.

        Parameters
        ----------
        agent : int or str
            By number, 0..N-1, or name.
        time : int
            0 (the start) .. samples.
        trial : int
            Which one, from 0.

        Returns
        -------
        str
            A sentence; empty where there is a bound.

        Raises
        ------
        InvalidInput
            There is no such agent, time or trial, or the run has no bounds.
        """
        if self.bound_kind is None:
            raise refusal("why_no_bound", "a run without bounds", 'keep to contain "report"')
        _, times, agents = self.shape
        named = self._agents([agent]) if isinstance(agent, str) else None
        i = named[0] if named else whole("agent", agent, 0, agents - 1)
        t = whole("time", time, 0, times - 1)
        return BoundKind(int(self.bound_kind[self._trial(trial), t, i])).why

    def first_accused(self, trial: int = 0) -> dict[int, int]:
        """When each accused agent was first taken for attacked, by any agent.

        Parameters
        ----------
        trial : int
            Which one, from 0.

        Returns
        -------
        dict of int to int
            Agent -> first time.

        Raises
        ------
        InvalidInput
            There is no such trial.
        """
        trial = self._trial(trial)
        first: dict[int, int] = {}
        for k, time, sets in self.accusations:
            if k == trial:
                for agent in {a for s in sets for a in s}:
                    first.setdefault(agent, time)
        return first

    def alarms(self, trial: int | None = None) -> list[Alarm]:
        """When each agent's measurement was suspected (clipped) or taken for attacked: intervals of equal verdicts.

        Parameters
        ----------
        trial : int, optional
            This one alone; default: all.

        Returns
        -------
        list of Alarm
            In order of trial, start and agent.

        Raises
        ------
        InvalidInput
            There is no such trial, or the run has no verdicts (keep "report").
        """
        if self.verdict is None:
            raise refusal("alarms", "a run without verdicts", 'keep to contain "report"')
        wanted = None if trial is None else self._trial(trial)
        found = intervals(self.verdict, list(self.network.names))
        return [alarm for alarm in found if wanted is None or alarm.trial == wanted]

    def _trial(self, trial: int) -> int:
        return whole("trial", trial, 0, max(self.shape[0] - 1, 0))

    def save(self, path: str | Path) -> None:
        """Write everything to a file (created, or replaced), without pickles; read it with `Run.load`.

        Parameters
        ----------
        path : str or Path
            A NumPy .npz archive; netCDF where the name ends in .nc (extra: xarray, with a netCDF backend of it: scipy,
            h5netcdf or netCDF4), or a folder of zarr where it ends in .zarr (packages xarray and zarr): the dataset of
            `to_xarray`, which other programs read.

        Raises
        ------
        InvalidInput
            The run holds what files cannot, such as a function of your own.
        IoError
            The file cannot be written.
        """
        run_file.save(self, path_of("path", path))

    @staticmethod
    def load(path: str | Path) -> Run:
        """The run that `save` wrote, or that was written as it went, all of it.

        Parameters
        ----------
        path : str or Path
            Of the file or folder.

        Returns
        -------
        Run

        Raises
        ------
        IoError
            The file cannot be read, or holds no run.
        InvalidInput
            It is too large for memory.
        """
        return run_file.load(path_of("path", path), partial(assembled, Run))

    def __reduce__(self) -> Any:
        parts = self.model, self.network, self.filter, self.made
        return assembled, (Run, *parts, run_file.lists_of(self), run_file.arrays_of(self))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Run):
            return NotImplemented
        parts = ("model", "network", "filter", *run_file.LISTS)
        alike = all(same(getattr(self, k), getattr(other, k)) for k in parts)
        return alike and same(_in_memory(self), _in_memory(other))

    def __hash__(self) -> int:
        return hash((self.model, self.network, self.filter, self.shape))

    def plot(self, trial: int = 0, *, agents: Iterable[int | str] | None = None, compare: Iterable[Run] = ()) -> Figure:
        """Errors with their bounds, and statistics against thresholds, of one trial (extra: plot).

        The process's matplotlib backend stays as it is.

        Parameters
        ----------
        trial : int
            Which one, from 0.
        agents : sequence of int or str, optional
            Those that are shown, by number or name; default: all.
        compare : sequence of Run
            Other runs, whose errors are drawn into the same figure.

        Returns
        -------
        matplotlib Figure

        Raises
        ------
        InvalidInput
            There is no such trial or agent, or matplotlib is not installed.
        """
        trial, chosen = self._trial(trial), self._agents(agents)
        others = entries("plot: compare", compare, "other runs")
        for other in others:
            if not isinstance(other, Run):
                raise refusal("plot: compare", f"a {type(other).__name__}", "other runs")
            other._trial(trial)
        string = family_of(self.filter).picture == "string"
        if string and chosen is None and not others and self.truth is not None and self.bound is not None:
            return drawn("string_figure", self, trial)
        return drawn("run_figure", self, trial, chosen, others)

    def _agents(self, given: Iterable[int | str] | None) -> list[int] | None:
        """Numbers of agents that were given by number or name."""
        if given is None:
            return None
        names, last = list(self.network.names), self.network.agents - 1
        found = []
        listed = [given] if isinstance(given, str) or alone(given) else given
        for one in entries("agents", listed, "numbers or names of agents"):
            if isinstance(one, str):
                if one not in names:
                    raise refusal("agents", repr(one), "names of the network", near(one, names))
                found.append(names.index(one))
            else:
                found.append(whole("agents", one, 0, last))
        if not found:
            raise refusal("agents", "nobody", "agents to be shown, or None for all of them")
        return found

    def animate(self, path: str | Path, trial: int = 0) -> None:
        """Write a GIF of vehicles in a string (extra: plot); keep "details" and "measurements" for it.

        Parameters
        ----------
        path : str or Path
            Of the GIF (created, or replaced).
        trial : int
            Which one, from 0.

        Raises
        ------
        InvalidInput
            There is no such trial, or the run is not one of vehicles.
        IoError
            The file cannot be written.
        """
        trial = self._trial(trial)
        if family_of(self.filter).picture != "string" or self.truth is None or self.measurements is None:
            raise refusal("animate", "a run without vehicles or measurements", "one of a platoon")
        animated(self, path_of("path", path), trial)

    def to_xarray(self) -> Any:
        """An xarray.Dataset of all arrays and signals (extra: xarray).

        Coordinates: trial, time, agent, state and output by name where they have names, state_unit and output_unit,
        sample (the time of a measurement). Attributes: model, network and filter as JSON, counters and warnings. A
        signal whose name is that of another array or coordinate, or none in netCDF, is called signal_<name>.
        """
        from garrison.labelled import dataset

        return dataset(self, run_file.labelled(self))

    def to_pandas(self) -> Any:
        """A pandas.DataFrame in long form (extra: pandas): one row per trial, time and agent.

        Columns trial, time, agent (its name where the network has names), the estimate x0, x1, ... and the truth
        true_x0, ... (state names where the model has them), the box box_x0, ..., error, bound, statistic, threshold,
        verdict (as a word), and the signals that were kept; a signal or state whose name another column has is called
        signal_<name> or state_<name>. `attrs["units"]`: units of columns by name, where the model has them.
        """
        from garrison.longform import frame

        return frame(self)

    def _repr_html_(self) -> str:
        return of_run(self)

    def __repr__(self) -> str:
        """The call that makes it once more, if that is not longer than people read; else what it is in short."""
        if (call := code(self)) is not None:
            return call
        trials, times, agents = self.shape
        sizes = (count(trials, "trial"), count(max(times - 1, 0), "sample"), count(agents, "agent"))
        return f"<Run of {self.filter.name}: {', '.join(sizes)}>"


def _in_memory(run: Run) -> dict[str, NDArray[Any]]:
    """Its arrays, read where they are in a store."""
    return {name: np.asarray(value) for name, value in run_file.arrays_of(run).items()}


def assembled(
    kind: type[Run],
    model: _core.Model,
    network: _core.Network,
    filter: _core.Filter,
    made: dict[str, Any],
    lists: dict[str, Any],
    found: dict[str, NDArray[Any]],
) -> Run:
    """The run of what it was made of, its lists, and its arrays by the names of a saved run."""
    arrays = {key: found[key] for key in run_file.ARRAYS if key in found}
    run = kind(lists | {"made": made} | arrays, model, network, filter, run_file.marked(found, run_file.VARYING))
    run.signals = run_file.marked(found, run_file.SIGNAL)
    run.reduced = run_file.marked(found, run_file.REDUCED)
    return run
