"""A filter designed once, for any number of runs and agents; it can leave the process."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

from garrison import _core, arguments, drivers, run_options
from garrison.arguments import whole
from garrison.checks import Check, check
from garrison.paths import read, write
from garrison.record import Run
from garrison.result import same
from garrison.words import Hinting, hinted, hinted_methods, refusal, require_order, shown


@hinted_methods
class Prepared(metaclass=Hinting):
    """A filter designed for one model and network: `prepare` makes it, `save` and `load` carry it elsewhere.

    The gains travel with it, so that every run and agent of it has the same bits, here and on another machine; nothing
    is designed again. Copies and pickles; equal to another one of an equal model, network and filter that certifies
    the same. One of a filter of your own has no design file.

    Parameters
    ----------
    design : Design
        Of the core; `prepare` gives it.
    """

    def __init__(self, design: _core.Design) -> None:
        if not isinstance(design, _core.Design):
            raise refusal("Prepared.design", shown(design), "a design", "garrison.prepare makes it")
        self._design = design

    @property
    def model(self) -> _core.Model:
        """The plant it was designed for."""
        return self._design.model

    @property
    def network(self) -> _core.Network:
        """The network it was designed for."""
        return self._design.network

    @property
    def certificate(self) -> dict[str, Any] | None:
        """What its runs and agents certify: arguments of `prepare`; None = the filter's own bound alone."""
        found = self._design.certificate
        return None if found is None else dict(found)

    @property
    def filter(self) -> _core.Filter:
        """The filter with its parameters."""
        filter: _core.Filter = self._design.filter
        return filter

    def check(self) -> Check:
        """Conditions and bounds of the filter's theorems, as `garrison.check`."""
        return check(self.model, self.network, self.filter, **(self.certificate or {}))

    def simulate(self, **arguments: Any) -> Run:
        """`garrison.simulate` with this design.

        Parameters
        ----------
        **arguments
            Keyword arguments of `garrison.simulate`, but for what the design has settled.

        Returns
        -------
        Run

        Raises
        ------
        InvalidInput
            As garrison.simulate.
        """
        return drivers.simulate(self.model, self.network, self.filter, **self._with_design(arguments))

    def replay(self, **arguments: Any) -> Run:
        """`garrison.replay` with this design.

        Parameters
        ----------
        **arguments
            Keyword arguments of `garrison.replay`, but for what the design has settled.

        Returns
        -------
        Run

        Raises
        ------
        InvalidInput
            As garrison.replay.
        """
        return drivers.replay(self.model, self.network, self.filter, **self._with_design(arguments))

    def agent(self, id: int) -> _core.Agent:
        """One agent on its own. It holds what it needs of the gains, nothing of the others'.

        Parameters
        ----------
        id : int
            Which agent, 0..N-1.

        Returns
        -------
        Agent

        Raises
        ------
        InvalidInput
            There is no such agent.
        """
        return self._design.agent(self._agent(id))

    def part(self, id: int) -> bytes:
        """What one agent needs of this design; see `garrison.Agent.from_part`.

        Parameters
        ----------
        id : int
            Which agent, 0..N-1.

        Returns
        -------
        bytes

        Raises
        ------
        InvalidInput
            There is no such agent, or the filter is one of your own.
        """
        return self._design.part(self._agent(id))

    def to_bytes(self) -> bytes:
        """The design file (`save`) as bytes."""
        return self._design.to_bytes()

    @classmethod
    def from_bytes(cls, data: bytes) -> "Prepared":
        """The design that to_bytes() wrote.

        Parameters
        ----------
        data : bytes
            All of it.

        Returns
        -------
        Prepared

        Raises
        ------
        InvalidInput
            Anything else.
        """
        return cls(_core.Design.from_bytes(data))

    def save(self, path: str | Path, agent: int | None = None) -> None:
        """Write the design file (created, or replaced), or the part of one agent.

        Parameters
        ----------
        path : str or Path
            Of the file.
        agent : int, optional
            Write the part of this agent alone, 0..N-1.

        Raises
        ------
        InvalidInput
            There is no such agent, or the filter is one of your own.
        IoError
            The file cannot be written.
        """
        write("save", path, self.to_bytes() if agent is None else self.part(agent))

    @classmethod
    def load(cls, path: str | Path) -> "Prepared":
        """The design in a file.

        Parameters
        ----------
        path : str or Path
            Of a file that `save` wrote.

        Returns
        -------
        Prepared

        Raises
        ------
        InvalidInput
            The file is damaged, of another version or no design.
        IoError
            The file cannot be read.
        """
        data = read("load", path, "a file that `save` of a prepared filter wrote")
        try:
            return cls.from_bytes(data)
        except _core.InvalidInput as error:
            raise _core.InvalidInput(f"{path}: {error}") from None

    @property
    def outline(self) -> list[str]:
        """What the gains consist of, a line each."""
        return list(self._design.outline)

    def _with_design(self, arguments: dict[str, Any]) -> dict[str, Any]:
        if "design" in arguments:
            raise refusal("design", "one to a filter that is prepared", "none", "it runs with its own")
        return arguments | {"design": self._design}

    def _agent(self, id: int) -> int:
        last = self.network.agents - 1
        found = whole("id", id, 0)
        if found > last:
            raise refusal("id", str(found), f"an agent in 0..{last}")
        return found

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Prepared) and same(self._made_from(), other._made_from())

    def __hash__(self) -> int:
        return hash((self.model, self.network, self.filter))

    def __reduce__(self) -> tuple[Any, ...]:
        if not self.filter.own:
            return Prepared.from_bytes, (self.to_bytes(),)
        return _from_gains, (self.model, self.network, self.filter, self._design.gains, self.certificate)

    def _made_from(self) -> tuple[Any, ...]:
        return self.model, self.network, self.filter, self.certificate

    def __repr__(self) -> str:
        wanted = "".join(f", {k}={v!r}" for k, v in (self.certificate or {}).items())
        return f"garrison.prepare({self.model!r}, {self.network!r}, {self.filter!r}{wanted})"


def _from_gains(
    model: _core.Model, network: _core.Network, filter: _core.Filter, gains: Any, wanted: dict[str, Any] | None
) -> Prepared:
    """A filter of one's own with what its `design` returned before."""
    return Prepared(_core.Design.from_gains(model, network, filter, gains, **(wanted or {})))


@hinted
def prepare(
    model: _core.Model,
    network: _core.Network,
    filter: _core.Filter,
    *,
    certificate: str = "none",
    failure: float = 1e-6,
    attacked: int | None = None,
    levels: tuple[float, float] | None = None,
    memory: bool = False,
    progress: Callable[[str, float], None] | None = None,
) -> Prepared:
    """Design the filter for this model and network, once.

    Parameters
    ----------
    model : Model
        The plant and its sensors.
    network : Network
        Who hears whom.
    filter : Filter
        One of garrison.filters, or a filter of your own.
    certificate : {"none", "local", "flooded", "direct"}
        What every agent proves of its error at run time, whatever filter it runs, whatever at most `attacked`
        sources send (docs/certificates.md). "local": from its own measurement and its neighbours'; "flooded":
        from all that the rounds of a sample bring, with larger messages; "none": the filter's own bound alone, no
        byte more. "direct": as "local" without what others found, so that bounds hold although agents lie in their
        messages, each counting as an attacked source. What is lost on the way makes a bound larger, never wrong.
    failure : float
        Probability in [0, 1), per agent and sample, that such a bound is wrong, for the model's covariances; 0 =
        never, for noise within its bounds.
    attacked : int, optional
        Most sources that lie, >= 0; default the filter's parameter of that name. A source is an agent, or what
        the model names as source. Where it is more than the filter's parameter, the
        filter's own bound does not count.
    levels : tuple of two floats, optional
        (z1, z2) instead of the covariances' own: what clean records exceed at the rate `failure`, whatever their law
        (`Fitted.levels`, `calibrate`). A bound is then wrong with at most five times that and a quarter.
    memory : bool
        Certify from all measurements so far, too, not from those of one sample alone: a bank of filters at every
        agent (docs/certificates.md, section 9; kind `MEMORY`), whose bounds also exist where one sample does not
        determine the state, and get ever sharper. Stronger assumptions: the liars are always the same, and noise
        is white, with the covariances of the model. After a refutation, a restart or a gap of more than 1000
        samples it starts anew. Takes failure > 0, without `levels`.
    progress : callable, optional
        progress(what, seconds) is called about once a second: what is computed, and for how long already.

    Returns
    -------
    Prepared
        For any number of runs and agents; can be saved.

    Raises
    ------
    InvalidInput
        Parameters, model and network do not fit together.
    DesignInfeasible
        No gains exist.
    """
    require_order("prepare", model, network, filter)
    wanted = run_options.certificate(filter, certificate, failure, attacked, levels, memory)
    tell = arguments.callback("progress", progress, "(what, seconds)")
    return Prepared(_core.Design(model, network, filter, **wanted, progress=tell))
