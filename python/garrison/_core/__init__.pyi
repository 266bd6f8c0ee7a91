"""
Compiled core of garrison. Use it through the garrison package.
"""

from __future__ import annotations
import collections.abc
import numpy
import numpy.typing
import typing
from . import filters
from . import attacks
from . import rdkf
from . import saturation
from . import structure
from . import structural
from . import partial_sharing
from . import platoon
from . import certificate

__all__: list[str] = [
    "Agent",
    "AgentInfo",
    "Attack",
    "Autoregression",
    "Design",
    "DesignInfeasible",
    "Error",
    "Filter",
    "FitOptions",
    "Identified",
    "InvalidInput",
    "IoError",
    "Message",
    "Model",
    "Network",
    "Response",
    "SubsetBound",
    "anomalies",
    "attack_infos",
    "attacks",
    "autoregress",
    "budget",
    "central_kalman",
    "certificate",
    "chebyshev_contraction",
    "check",
    "contradictions",
    "custom_attack",
    "design_summary",
    "discretise",
    "driven",
    "exceedances",
    "extended_kalman",
    "filter_infos",
    "filters",
    "identified",
    "identify",
    "lambda0",
    "lambda0_orthogonal",
    "lfre_parents",
    "local_kalman",
    "make_attack",
    "make_filter",
    "nearest_name",
    "observable",
    "one_step_sparse_observable",
    "partial_sharing",
    "platoon",
    "rdkf",
    "replay",
    "replay_log",
    "s_sparse_observable",
    "saturation",
    "simulate",
    "split_outputs",
    "structural",
    "structure",
    "surely_observable",
    "tau0",
    "varpi",
]

class Error(Exception):
    """
    What garrison refuses, and cannot do; catch this one for all.
    """

class InvalidInput(Error, ValueError):
    """
    Something that was given does not fit: which, what was got, what was expected. A ValueError, too.
    """

class DesignInfeasible(Error, ValueError):
    """
    No gains exist, or none were found, for what was asked: why, and what to change. A ValueError, too.
    """

class IoError(Error, OSError):
    """
    A file cannot be read or written: which, and why. An OSError, too.
    """

class budget:
    """
    `with budget(seconds) as b:` is the time of everything computed in the block. Searches end with what they
    have proved; what has no partial result raises InvalidInput. Ctrl-C ends both.

    Parameters
    ----------
    seconds : float
        > 0; inf = no limit.

    Raises
    ------
    InvalidInput
        Not a number above 0.
    """
    def __enter__(self) -> budget: ...
    def __exit__(self, type: typing.Any, value: typing.Any, traceback: typing.Any) -> None: ...
    def __init__(self, seconds: typing.SupportsFloat | typing.SupportsIndex = ...) -> None: ...
    def __reduce__(self) -> tuple: ...
    @property
    def over(self) -> bool:
        """
        The time is up, or Ctrl-C was pressed.
        """

class Model:
    """
    The plant x(t+1) = A x(t) + B u(t) + w(t), y_i(t) = C_i x(t) + v_i(t). Immutable.

    Parameters
    ----------
    A : (n, n) array
        Of the plant.
    C : sequence of (m_i, n) arrays, or (N, n) array
        One per agent (m_i = 0: a relay), or rows.
    process_bound : float, optional
        ||w|| <= it, >= 0; None or nan = not known.
    measurement_bound : float or (N,) array, optional
        |v_i| <= it; one for all, or one per agent.
    process_covariance : (n, n) array, float or (N, n, n) array, optional
        A number is times the identity; N of them where each agent takes another one for w (no noise is simulated from
        those).
    measurement_covariance : float, or one (m_i, m_i) array or number per agent, optional
        Of v_i.
    states : n names, optional
        Default x1, x2, ..
    outputs : names, optional
        One per measurement of the whole network, agent by agent.
    sources : names, optional
        Who can falsify each measurement; several outputs of one receiver have one source.
    units : dict or str, optional
        From names of states and outputs to units, or one unit for all.
    exposed : sequence of int, optional
        Per agent, how many of its first outputs an attacker can reach; default all.
    B : (n, p) array, optional
        What known inputs u do to the state; runs then take `inputs`, one row u(t) per step. Default: no inputs.
    inputs : p names, optional
        One per column of B.

    Raises
    ------
    InvalidInput
        Shapes or names do not fit, or a number is not finite.
    """
    @staticmethod
    def from_continuous(
        A: typing.Any,
        C: typing.Any,
        period: typing.SupportsFloat | typing.SupportsIndex,
        *,
        process_intensity: typing.Any = None,
        process_bound: typing.Any = None,
        measurement_bound: typing.Any = None,
        measurement_covariance: typing.Any = None,
        states: typing.Any = None,
        outputs: typing.Any = None,
        sources: typing.Any = None,
        units: typing.Any = None,
        exposed: typing.Any = None,
        B: typing.Any = None,
        inputs: typing.Any = None,
    ) -> Model:
        """
        The model of dx/dt = A x + B u + white noise, u held between samples, sampled exactly (C. F. Van Loan, IEEE
        TAC 23 (3), 1978).

        Parameters
        ----------
        A : (n, n) array
            Of the differential equation, per unit of time.
        C : sequence of (m_i, n) arrays, or (N, n) array
            As in Model.
        period : float
            Time between samples, > 0, in the unit of time of A.
        process_intensity : (n, n) array or float, optional
            Spectral density of the noise, state^2 per time; a
            number is times the identity. The model then has its process_covariance.
        process_bound : float, optional
            Of the noise from sample to sample, as in Model.
        measurement_bound, measurement_covariance, states, outputs, sources, units, exposed : optional
            As in
            Model.
        B : (n, p) array, optional
            What known inputs u do to dx/dt.
        inputs : p names, optional
            One per column of B.

        Returns
        -------
        Model
            From sample to sample.

        Raises
        ------
        InvalidInput
            As Model, or a period that is not > 0.
        """
    def __copy__(self) -> typing.Any: ...
    def __deepcopy__(self, memo: dict) -> typing.Any: ...
    def __eq__(self, other: typing.Any) -> typing.Any: ...
    def __getstate__(self) -> dict: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        A: typing.Any,
        C: typing.Any,
        *,
        process_bound: typing.Any = None,
        measurement_bound: typing.Any = None,
        process_covariance: typing.Any = None,
        measurement_covariance: typing.Any = None,
        states: typing.Any = None,
        outputs: typing.Any = None,
        sources: typing.Any = None,
        units: typing.Any = None,
        exposed: typing.Any = None,
        B: typing.Any = None,
        inputs: typing.Any = None,
    ) -> None: ...
    def __reduce__(self) -> tuple: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, arg0: dict) -> None: ...
    def __str__(self) -> str: ...
    def _repr_html_(self) -> str: ...
    @property
    def A(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (n, n), of the plant.
        """
    @property
    def B(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (n, p); no columns where there are no known inputs.
        """
    @property
    def C(self) -> list[typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]]:
        """
        One (m_i, n) array per agent.
        """
    @property
    def agents(self) -> int:
        """
        N, how many agents.
        """
    @property
    def input_names(self) -> list[str]:
        """
        One name per known input; empty where none were given.
        """
    @property
    def inputs(self) -> int:
        """
        p, how many known inputs.
        """
    @property
    def measurement_bound(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (N,): ||v_i(t)|| is at most this; empty = not known.
        """
    @property
    def measurement_covariance(self) -> typing.Any:
        """
        One (m_i, m_i) array per agent, or None = not known.
        """
    @property
    def output_names(self) -> list[str]:
        """
        One name per measurement of the whole network; empty where none were given.
        """
    @property
    def outputs(self) -> int:
        """
        Scalar measurements per sample of the whole network.
        """
    @property
    def process_bound(self) -> float:
        """
        ||w(t)|| is at most this; nan = not known.
        """
    @property
    def process_covariance(self) -> typing.Any:
        """
        (n, n), one (n, n) array per agent, or None = not known.
        """
    @property
    def sources(self) -> list[str]:
        """
        Who can falsify each measurement; empty where none were given.
        """
    @property
    def state_names(self) -> list[str]:
        """
        n names; x1, x2, .. where none were given.
        """
    @property
    def states(self) -> int:
        """
        n, how many states.
        """
    @property
    def units(self) -> dict[str, str]:
        """
        Unit by the name of a state or output.
        """

class Network:
    """
    Who hears whom. Immutable.

    Parameters
    ----------
    edges : sequence of pairs, networkx graph, or square matrix
        (sender, receiver) pairs of numbers or names, a graph, or an adjacency matrix (sparse, or dense with more than two
        rows; see from_adjacency). Pairs given twice count once.
    agents : int, optional
        Needed when the last ones have no edge.
    directed : bool
        A pair is one way; else both ways.
    names : names, optional
        One per agent. Of a graph, labels 0..N-1 are the numbers of the agents; other whole numbers are sorted, other labels
        keep their order, and the labels become the names.

    Raises
    ------
    InvalidInput
        A self-loop, a weight, an unknown name, or an index out of range.
    """
    @staticmethod
    def band(
        agents: typing.SupportsInt | typing.SupportsIndex, range: typing.SupportsInt | typing.SupportsIndex
    ) -> Network:
        """
        i and j hear each other when |i - j| <= range.

        Parameters
        ----------
        agents : int
            How many, N >= 1.
        range : int
            How many places away an agent hears, >= 1.

        Returns
        -------
        Network

        Raises
        ------
        InvalidInput
            A number out of range, or more edges than memory holds.
        """
    @staticmethod
    def complete(agents: typing.SupportsInt | typing.SupportsIndex) -> Network:
        """
        Everybody hears everybody.

        Parameters
        ----------
        agents : int
            How many, N >= 1.

        Returns
        -------
        Network

        Raises
        ------
        InvalidInput
            No agent, or more edges than memory holds.
        """
    @staticmethod
    def erdos_renyi(
        agents: typing.SupportsInt | typing.SupportsIndex,
        probability: typing.SupportsFloat | typing.SupportsIndex,
        seed: typing.SupportsInt | typing.SupportsIndex = 0,
    ) -> Network:
        """
        Every pair is a link with this probability; it need not be connected (see `connected`).

        Parameters
        ----------
        agents : int
            How many, N >= 1.
        probability : float
            Of each link, 0..1.
        seed : int
            >= 0; equal seeds give equal networks.

        Returns
        -------
        Network

        Raises
        ------
        InvalidInput
            A number out of range.
        """
    @staticmethod
    def from_adjacency(matrix: typing.Any, directed: bool = False, names: typing.Any = None) -> Network:
        """
        From a square matrix of zeros and ones. Explicit zeros are no links; the diagonal is ignored.

        Parameters
        ----------
        matrix : (N, N) array, sparse matrix or DataFrame
            Entry (i, j) says that i hears j. Names of a DataFrame's
            columns become the agents'.
        directed : bool
            Entries are one way; else the matrix is symmetric.
        names : names, optional
            One per agent.

        Returns
        -------
        Network

        Raises
        ------
        InvalidInput
            Not square, not symmetric (unless directed), or another number.
        """
    @staticmethod
    def grid(
        rows: typing.SupportsInt | typing.SupportsIndex, columns: typing.SupportsInt | typing.SupportsIndex
    ) -> Network:
        """
        rows x columns agents, row by row; neighbours in a row or column hear each other.

        Parameters
        ----------
        rows : int
            How many, >= 1.
        columns : int
            How many, >= 1.

        Returns
        -------
        Network

        Raises
        ------
        InvalidInput
            A number out of range, or more agents than memory holds.
        """
    @staticmethod
    def path(agents: typing.SupportsInt | typing.SupportsIndex) -> Network:
        """
        i hears i - 1 and i + 1, from end to end.

        Parameters
        ----------
        agents : int
            How many, N >= 1.

        Returns
        -------
        Network

        Raises
        ------
        InvalidInput
            No agent, or more than memory holds.
        """
    @staticmethod
    def random_geometric(
        agents: typing.SupportsInt | typing.SupportsIndex,
        radius: typing.SupportsFloat | typing.SupportsIndex,
        seed: typing.SupportsInt | typing.SupportsIndex = 0,
    ) -> Network:
        """
        Points uniform in the unit square, edges below `radius`; it need not be connected (see `connected`).

        Parameters
        ----------
        agents : int
            How many, N >= 1.
        radius : float
            Agents closer than this hear each other, > 0; the square has sides of 1.
        seed : int
            Of the positions, >= 0; equal seeds give equal networks.

        Returns
        -------
        Network

        Raises
        ------
        InvalidInput
            A number out of range.
        """
    @staticmethod
    def ring(agents: typing.SupportsInt | typing.SupportsIndex) -> Network:
        """
        i hears i - 1 and i + 1, around.

        Parameters
        ----------
        agents : int
            How many, N >= 1.

        Returns
        -------
        Network

        Raises
        ------
        InvalidInput
            No agent, or more than memory holds.
        """
    @staticmethod
    def star(agents: typing.SupportsInt | typing.SupportsIndex) -> Network:
        """
        Agent 0 and each of the others hear each other.

        Parameters
        ----------
        agents : int
            How many, N >= 1.

        Returns
        -------
        Network

        Raises
        ------
        InvalidInput
            No agent, or more than memory holds.
        """
    def __copy__(self) -> typing.Any: ...
    def __deepcopy__(self, memo: dict) -> typing.Any: ...
    def __eq__(self, other: typing.Any) -> typing.Any: ...
    def __getstate__(self) -> dict: ...
    def __hash__(self) -> int: ...
    def __init__(
        self, edges: typing.Any, agents: typing.Any = None, directed: bool = False, names: typing.Any = None
    ) -> None: ...
    def __reduce__(self) -> tuple: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, arg0: dict) -> None: ...
    def __str__(self) -> str: ...
    def _repr_html_(self) -> str: ...
    def index(self, agent: typing.Any) -> int:
        """
        The number of the agent with this name (or number).

        Parameters
        ----------
        agent : str or int
            A name of the network, or a number 0..N-1.

        Returns
        -------
        int
            0..N-1.

        Raises
        ------
        InvalidInput
            There is no such agent.
        """
    def laplacian(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (N, N): how many an agent hears on the diagonal, -1 for each of them.
        """
    def laplacian_spectrum(self) -> tuple[float, float]:
        """
        (lambda_2, lambda_max) of the Laplacian; undirected networks only.
        """
    def laplacian_weights(
        self, step: typing.SupportsFloat | typing.SupportsIndex
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        I - step * Laplacian

        Parameters
        ----------
        step : float
            What an agent takes of each difference to a neighbour, > 0.

        Returns
        -------
        (N, N) array
            Weights; rows sum to 1.

        Raises
        ------
        InvalidInput
            A step that is not finite and > 0.
        """
    def max_degree_weights(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        I - Laplacian / (1 + largest degree)
        """
    def metropolis_weights(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        Doubly stochastic (N, N) weights; undirected only.
        """
    def neighbours(self, agent: typing.Any) -> list[int]:
        """
        The agents that one agent hears.

        Parameters
        ----------
        agent : str or int
            A name of the network, or a number 0..N-1.

        Returns
        -------
        list of int
            Sorted.

        Raises
        ------
        InvalidInput
            There is no such agent.
        """
    @property
    def agents(self) -> int:
        """
        How many, N.
        """
    @property
    def connected(self) -> bool:
        """
        Everybody can reach everybody (directed: along the links).
        """
    @property
    def directed(self) -> bool:
        """
        Whether a pair of edges is one way.
        """
    @property
    def edges(self) -> list[tuple[int, int]]:
        """
        Each link once: (smaller, larger) number, or (sender, receiver) when directed.
        """
    @property
    def names(self) -> list[str]:
        """
        One per agent; empty where none were given.
        """

class AgentInfo:
    """
    What one agent of a filter of your own knows of itself.
    """
    def __reduce__(self) -> tuple: ...
    def __repr__(self) -> str: ...
    @property
    def A(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        Of the plant, (n, n).
        """
    @property
    def C(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        Its own rows, (outputs, n).
        """
    @property
    def agents(self) -> int:
        """
        Agents of the whole network.
        """
    @property
    def gains(self) -> typing.Any:
        """
        What design() returned.
        """
    @property
    def id(self) -> int:
        """
        Its number, 0..agents-1.
        """
    @property
    def measurement_variance(self) -> typing.Any:
        """
        Variances of its outputs in this sample, (outputs,); None: not known.
        """
    @property
    def name(self) -> str:
        """
        Its name in the network, or nothing.
        """
    @property
    def neighbours(self) -> list[int]:
        """
        Agents that it hears.
        """
    @property
    def process_covariance(self) -> typing.Any:
        """
        Of the step to this sample, (n, n); None: not known.
        """

class Filter:
    """
    A filter: a family of garrison.filters with its parameters, or a class of your own derived from this one.

    A filter of your own has these methods, called in every sample for every agent; it runs in simulate and replay with
    the same links, attacks, records and reports as every family. It is single-threaded, and slow: Python runs
    at every agent, sample and round. `agent` is a garrison.AgentInfo, `state` is the agent's own object and may be
    changed in place, a message is a dict of named arrays, inbox a dict: sender -> message (lost ones are not in it).

      sense(agent, state, y, t) -> message     once per sample; y (outputs,), nan = missing
      fuse(agent, state, inbox, round) -> message   `rounds` times per sample; what the last one returns is not sent

    and optionally:

      rounds = 1                               rounds per sample (attribute, or set in __init__)
      signals = ("name", ...)                  numbers of `report` that a run can keep; names that a file can hold
      layout(model) -> {"estimate": n}         fields of a message and how many numbers each has (the default)
      design(model, network) -> gains          once; agents find it as agent.gains
      start(agent, x0) -> state                an object or dict with "estimate", (n,); default: just that
      report(agent, state) -> dict             bound, statistic, threshold, verdict (garrison.Verdict or its name), accused
                                               (list of agents), and the signals; what is left out does not exist
      rejoin(agent, state, inbox, t)           for an estimate that is not finite; default: median of "estimate" of the inbox
      expected(agent, state) -> (outputs,)     what it predicts to measure next; default C A estimate
      alarm_level(agent, state) -> number      deviation from that which it tolerates; default inf

    A message of None sends nothing. Attributes set in __init__ (after super().__init__()) are the parameters: they stand
    in the repr, in pickles and in saved runs, which hold no functions and no objects of other classes. What a method
    raises comes back with its traceback and a note that names the agent and the sample.
    """
    def __eq__(self, other: typing.Any) -> typing.Any: ...
    def __getstate__(self) -> dict: ...
    def __hash__(self) -> int: ...
    def __init__(self) -> None: ...
    def __reduce__(self) -> tuple: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, arg0: dict) -> None: ...
    @property
    def detail_names(self) -> list[str]:
        """
        Names of the lists (sets, gains) that a run can keep.
        """
    @property
    def name(self) -> str:
        """
        As in `garrison list`.
        """
    @property
    def own(self) -> bool:
        """
        Written in Python: a class derived from garrison.Filter.
        """
    @property
    def params(self) -> dict:
        """
        Parameters by name, those with defaults too.
        """
    @property
    def signal_names(self) -> list[str]:
        """
        Names of the signals that a run can keep.
        """

class Attack:
    """
    An attack with its schedule; made by the functions of garrison.attacks. Immutable.
    """
    def __copy__(self) -> typing.Any: ...
    def __deepcopy__(self, memo: dict) -> typing.Any: ...
    def __eq__(self, other: typing.Any) -> typing.Any: ...
    def __getstate__(self) -> dict: ...
    def __hash__(self) -> int: ...
    def __reduce__(self) -> tuple: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, arg0: dict) -> None: ...
    @property
    def agents(self) -> list[int]:
        """
        Every agent that is attacked at some time.
        """
    @property
    def name(self) -> str:
        """
        As in `garrison list`.
        """
    @property
    def own(self) -> bool:
        """
        Its lies come from a Python function.
        """
    @property
    def params(self) -> dict:
        """
        Parameters by name, those with defaults too.
        """
    @property
    def probability(self) -> float:
        """
        Chance per sample that it acts, 0..1.
        """
    @property
    def schedule(self) -> list:
        """
        (start, agents) phases.
        """
    @property
    def start(self) -> int:
        """
        First sample that may be attacked.
        """
    @property
    def stop(self) -> typing.Any:
        """
        First sample that is not attacked any more; None = never.
        """
    @property
    def target(self) -> str:
        """
        What it changes: "measurement" or "message".
        """

class Message:
    """
    A message between agents of the same design; compares by value.

    What an agent sends is a list of fields: numbers, optional numbers (nan = absent), flags, counts
    and sets. sender, sample and round are the driver's, not the agent's.
    """
    @staticmethod
    def from_bytes(data: typing.Any) -> Message:
        """
        The message that to_bytes() wrote.

        Parameters
        ----------
        data : bytes
            All of it.

        Returns
        -------
        Message

        Raises
        ------
        InvalidInput
            Anything else.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __getstate__(self) -> bytes: ...
    def __hash__(self) -> int: ...
    def __reduce__(self) -> tuple: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, arg0: bytes) -> None: ...
    def __str__(self) -> str: ...
    def replace(self, field: str, value: typing.Any) -> Message:
        """
        The same message with another value in one field: a lie.

        Parameters
        ----------
        field : str
            Name of a field, as in `fields`.
        value : array, float, bool or set of int
            Of the kind and size that the field has.

        Returns
        -------
        Message

        Raises
        ------
        InvalidInput
            No such field, or a value that does not fit it.
        """
    def to_bytes(self) -> bytes:
        """
        Everything, to be kept or sent by other means; see from_bytes.
        """
    @property
    def body(self) -> bytes:
        """
        The bytes that travel, without sender, sample and round.
        """
    @property
    def family(self) -> str:
        """
        Name of the filter that sent it.
        """
    @property
    def fields(self) -> dict:
        """
        Name -> value of every field: arrays, nan where a number is absent, bool, int, list of agents; a set of
        labels as (ids, complement).
        """
    @property
    def round(self) -> int:
        """
        For which round of the sample, 0..
        """
    @property
    def sample(self) -> int:
        """
        Of which sample.
        """
    @property
    def sender(self) -> int:
        """
        Number of the agent.
        """

class Agent:
    """
    One agent on its own: `sense` once per sample, then `fuse` once per round, with the same bits as inside
    simulate and replay. Time is the caller's: it may start at any sample, and says nothing that a gap may have
    broken.

    Parameters
    ----------
    model : Model
        The plant and all sensors.
    network : Network
        Who hears whom.
    filter : Filter
        A family of garrison.filters, or a filter of your own.
    id : int
        Which agent, 0..N-1.

    Raises
    ------
    InvalidInput
        Sizes do not fit, or there is no such agent.
    DesignInfeasible
        The filter cannot be designed for this model and network.
    """
    @staticmethod
    def from_part(data: typing.Any, snapshot: typing.Any = None) -> Agent:
        """
        The agent whose part of a design Prepared.part(id) wrote; nothing is designed.

        Parameters
        ----------
        data : bytes
            The part.
        snapshot : bytes, optional
            Of `save`; the agent goes on from there. Default: at the beginning of a run.

        Returns
        -------
        Agent

        Raises
        ------
        InvalidInput
            No part of a design, or a snapshot of another agent or design.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __getstate__(self) -> bytes: ...
    def __hash__(self) -> int: ...
    def __init__(
        self, model: Model, network: Network, filter: Filter, id: typing.SupportsInt | typing.SupportsIndex
    ) -> None: ...
    def __reduce__(self) -> tuple: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, arg0: bytes) -> None: ...
    def __str__(self) -> str: ...
    def fuse(self, inbox: collections.abc.Sequence[Message | None]) -> Message | None:
        """
        End the round with the neighbours' messages of it. Messages of an earlier sample or round are dropped and
        counted, as are bodies that no agent could have sent.

        Parameters
        ----------
        inbox : sequence of Message or None
            At most one per neighbour, in any order; leave missing ones out, or
            give None.

        Returns
        -------
        Message or None
            The next message.

        Raises
        ------
        InvalidInput
            Called before `sense`, or a message of a stranger, another design or a later sample, or two
            of one neighbour.
        """
    def join(
        self,
        t: typing.SupportsInt | typing.SupportsIndex,
        inbox: collections.abc.Sequence[Message],
        speak: bool = False,
    ) -> None:
        """
        Take over an estimate from what the neighbours sent in the first round of a sample, as an agent that starts
        in a running network: its next sample is t + 1. Where nobody was heard the agent keeps its own, and says
        nothing until it hears somebody.

        Parameters
        ----------
        t : int
            The sample.
        inbox : sequence of Message
            At most one per neighbour.
        speak : bool
            Send the own estimate although nobody was heard, for networks in which nobody else speaks,
            either.

        Raises
        ------
        InvalidInput
            As `fuse`, or a sample that is not after the last one.
        """
    def load(self, data: typing.Any) -> None:
        """
        Go on from a snapshot.

        Parameters
        ----------
        data : bytes
            Of `save`, of this agent and design. A plant that `vary` told is not in it and has to be told again.

        Raises
        ------
        InvalidInput
            A snapshot of another agent or design, damaged bytes, or within a sample.
        """
    def reset(
        self,
        x0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
        t: typing.SupportsInt | typing.SupportsIndex | None = None,
    ) -> None:
        """
        Start anew with an estimate. At any t but the beginning nothing is known of how far x0 is off: there is no
        bound and no test until the family can vouch again, and in its next sample the agent sends nothing (None)
        and takes an estimate from what its neighbours send.

        Parameters
        ----------
        x0 : (n,) array
            Estimate of the state, in its units; finite, at most 1e150.
        t : int, optional
            The sample that x0 is the estimate of. Default: the beginning of a run.

        Raises
        ------
        InvalidInput
            A wrong size, a number that is not finite, or a sample before the beginning of a run.
        """
    def save(self) -> bytes:
        """
        A snapshot as bytes, between samples only; the agent that loads it goes on with the same bits.
        """
    def sense(
        self,
        t: typing.SupportsInt | typing.SupportsIndex,
        y: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex],
    ) -> Message | None:
        """
        Take the measurement of sample t. Samples missed since the last one are made up for, without measurements
        and messages.

        Parameters
        ----------
        t : int
            The sample; later than the last one.
        y : (m_i,) floats
            One number per row of C[id], in its unit; nan = missing.

        Returns
        -------
        Message or None
            The first message of this sample; None where the estimate is of no use (not finite).

        Raises
        ------
        InvalidInput
            A wrong size, a round that is not finished, or a sample that is not after the last one or
            too long after it.
        """
    def uncover(self) -> None:
        """
        Something was missed that only the caller knows of, such as more than `attacked` measurements of
        the whole network in one sample: no bound and no test rests on the past any more.
        """
    def vary(
        self,
        *,
        A: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"] | None = None,
        C: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"] | None = None,
        process_covariance: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"] | None = None,
        measurement_covariance: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"] | None = None,
    ) -> None:
        """
        The plant of the next samples, until told again; for the filters that take a VaryingModel, with the bits of its
        simulation. What is left out is the design's. `reset` and `load` go back to the design's: a snapshot does not hold the
        plant, and an agent that goes on from one has to be told again.

        Parameters
        ----------
        A : (n, n) array, optional
            Leads to the next sample.
        C : (m_i, n) array, optional
            Of the own sensor.
        process_covariance : (n, n) array, optional
            Of the noise on the way to the next sample; positive semidefinite.
        measurement_covariance : (m_i, m_i) array, optional
            Of the own sensor; positive definite.

        Raises
        ------
        InvalidInput
            Sizes that do not fit, numbers that are not finite, covariances that are none, a filter that is designed for
            one plant, an agent with a certificate, or a call within a sample.
        """
    @property
    def accused(self) -> list[int]:
        """
        Agents that this one has accused.
        """
    @property
    def bound(self) -> float:
        """
        On the error of its estimate, in the norm of the state; inf or nan: none, bound_kind says why.
        """
    @property
    def bound_kind(self) -> int:
        """
        Value of garrison.BoundKind: where the bound comes from, or why there is none.
        """
    @property
    def box(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) bounds on the error of each coordinate; `bound` is that of all together.
        """
    @property
    def control(self) -> float:
        """
        Control input applied until the next sample; nan if the family has none.
        """
    @property
    def dropped(self) -> int:
        """
        Messages that were late, or whose body no agent could have sent.
        """
    @property
    def estimate(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,)
        """
    @property
    def family(self) -> str:
        """
        Name of the filter.
        """
    @property
    def id(self) -> int:
        """
        Its number, 0..N-1.
        """
    @property
    def neighbours(self) -> list[int]:
        """
        Agents that it hears.
        """
    @property
    def proved(self) -> list[int]:
        """
        Sources that its certificate with memory has shown to be attacked, numbered in the order of their first
        measurement in the network.
        """
    @property
    def resets(self) -> int:
        """
        How often the estimate was of no use and was taken anew from the neighbours.
        """
    @property
    def round(self) -> int:
        """
        Rounds of this sample that are done.
        """
    @property
    def rounds(self) -> int:
        """
        Rounds per sample.
        """
    @property
    def sample(self) -> int:
        """
        The sample it is in, or has finished.
        """
    @property
    def statistic(self) -> float:
        """
        Of the test of its own sensor; nan = not tested.
        """
    @property
    def threshold(self) -> float:
        """
        The level that the statistic is compared with; nan = not tested.
        """
    @property
    def verdict(self) -> int:
        """
        Value of garrison.Verdict, of its own sensor.
        """

class Design:
    """
    A filter designed for one model and network.
    """
    @staticmethod
    def from_bytes(data: typing.Any) -> Design: ...
    @staticmethod
    def from_gains(
        model: Model,
        network: Network,
        filter: Filter,
        gains: typing.Any,
        certificate: str = "none",
        failure: typing.SupportsFloat | typing.SupportsIndex = 1e-06,
        attacked: typing.SupportsInt | typing.SupportsIndex = 0,
        levels: tuple[typing.SupportsFloat | typing.SupportsIndex, typing.SupportsFloat | typing.SupportsIndex] = (
            0.0,
            0.0,
        ),
        memory: bool = False,
    ) -> Design:
        """
        The design of a filter written in Python, from what its `design` returned before.
        """
    def __init__(
        self,
        model: Model,
        network: Network,
        filter: Filter,
        certificate: str = "none",
        failure: typing.SupportsFloat | typing.SupportsIndex = 1e-06,
        attacked: typing.SupportsInt | typing.SupportsIndex = 0,
        levels: tuple[typing.SupportsFloat | typing.SupportsIndex, typing.SupportsFloat | typing.SupportsIndex] = (
            0.0,
            0.0,
        ),
        memory: bool = False,
        progress: typing.Any = None,
    ) -> None: ...
    def __reduce__(self) -> tuple: ...
    def agent(self, id: typing.SupportsInt | typing.SupportsIndex) -> Agent: ...
    def part(self, id: typing.SupportsInt | typing.SupportsIndex) -> bytes:
        """
        What agent `id` needs of the design, as bytes.
        """
    def to_bytes(self) -> bytes: ...
    @property
    def certificate(self) -> typing.Any:
        """
        What its runs certify (certificate, failure, attacked, levels and memory if given); None = nothing but the family's own bound.
        """
    @property
    def filter(self) -> typing.Any: ...
    @property
    def gains(self) -> typing.Any:
        """
        What `design` of a filter written in Python returned; None of a family's.
        """
    @property
    def model(self) -> Model: ...
    @property
    def network(self) -> Network: ...
    @property
    def outline(self) -> list[str]:
        """
        What the gains consist of, a line each.
        """

class SubsetBound:
    """
    Result of a search over the s removed sensors; the true value lies in [lower, upper]. Safe in theorems:
    lower of lambda0, upper of varpi and tau0.

    Parameters
    ----------
    lower, upper : float
        The value lies between them.
    exact : bool
        The search finished.
    removed : sequence of int
        Worst set found, sorted.
    nodes : int
        Sets, parts of sets, or cones of directions, that were looked at.
    method : str
        How it was found, in words.
    """
    def __copy__(self) -> typing.Any: ...
    def __deepcopy__(self, memo: dict) -> typing.Any: ...
    def __eq__(self, other: typing.Any) -> typing.Any: ...
    def __getstate__(self) -> dict: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        lower: typing.SupportsFloat | typing.SupportsIndex,
        upper: typing.SupportsFloat | typing.SupportsIndex,
        exact: bool,
        removed: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex],
        nodes: typing.SupportsInt | typing.SupportsIndex,
        method: str,
    ) -> None: ...
    def __reduce__(self) -> tuple: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, arg0: dict) -> None: ...
    @property
    def exact(self) -> bool:
        """
        The search finished.
        """
    @property
    def lower(self) -> float:
        """
        The value is at least this.
        """
    @property
    def method(self) -> str:
        """
        How it was found, in words.
        """
    @property
    def nodes(self) -> int:
        """
        Sets, parts of sets, or cones of directions, that were looked at.
        """
    @property
    def removed(self) -> list[int]:
        """
        Worst set found, sorted.
        """
    @property
    def upper(self) -> float:
        """
        And at most this; equal to lower: exact.
        """

class FitOptions:
    """
    What a model was identified with; see garrison.fit.
    """
    def __copy__(self) -> typing.Any: ...
    def __deepcopy__(self, memo: dict) -> typing.Any: ...
    def __eq__(self, other: typing.Any) -> typing.Any: ...
    def __getstate__(self) -> dict: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        factors: typing.SupportsInt | typing.SupportsIndex,
        harmonics: typing.SupportsInt | typing.SupportsIndex,
        period: typing.SupportsFloat | typing.SupportsIndex,
        root: bool,
        factor: typing.SupportsFloat | typing.SupportsIndex,
    ) -> None: ...
    def __reduce__(self) -> tuple: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, arg0: dict) -> None: ...
    @property
    def factor(self) -> float: ...
    @property
    def factors(self) -> int: ...
    @property
    def harmonics(self) -> int: ...
    @property
    def period(self) -> float:
        """
        samples
        """
    @property
    def root(self) -> bool: ...
    @property
    def standardise(self) -> bool | None: ...

class Identified:
    """
    A model identified from clean records; use garrison.fit.
    """
    def __copy__(self) -> typing.Any: ...
    def __deepcopy__(self, memo: dict) -> typing.Any: ...
    def __eq__(self, other: typing.Any) -> typing.Any: ...
    def __getstate__(self) -> dict: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        options: FitOptions,
        season: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
        scale: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
        weight: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
        A: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
        C: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
        share: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
        process_covariance: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
        measurement_variance: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
        process_bound: typing.SupportsFloat | typing.SupportsIndex,
        measurement_bound: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
    ) -> None: ...
    def __reduce__(self) -> tuple: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, arg0: dict) -> None: ...
    def measurements(
        self,
        raw: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
        first: typing.SupportsInt | typing.SupportsIndex,
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        Measurements (T, N) of other records under this model.
        """
    def reference_states(
        self, measured: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"]
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        Least-squares states (T, n) of clean measurements of the same time.
        """
    @property
    def A(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (n, n)
        """
    @property
    def C(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (N, n), rows of unit length
        """
    @property
    def measurement_bound(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (N,)
        """
    @property
    def measurement_variance(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (N,)
        """
    @property
    def options(self) -> FitOptions: ...
    @property
    def process_bound(self) -> float: ...
    @property
    def process_covariance(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (n, n)
        """
    @property
    def scale(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (N,): anomaly / scale = measurement
        """
    @property
    def season(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (1 + 2 harmonics, N)
        """
    @property
    def share(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (n,): part of the variance that each factor carries
        """
    @property
    def weight(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (N,): of a measurement in the least squares of the state
        """

class Autoregression:
    """
    A vector autoregression in companion form: state z(t), .., z(t - order + 1).
    """
    def __copy__(self) -> typing.Any: ...
    def __deepcopy__(self, memo: dict) -> typing.Any: ...
    def __eq__(self, other: typing.Any) -> typing.Any: ...
    def __getstate__(self) -> dict: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        order: typing.SupportsInt | typing.SupportsIndex,
        A: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
        B: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
        residual_covariance: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
        residual_bound: typing.SupportsFloat | typing.SupportsIndex,
        residuals: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
        held_out: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex],
        samples: typing.SupportsInt | typing.SupportsIndex,
    ) -> None: ...
    def __reduce__(self) -> tuple: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, arg0: dict) -> None: ...
    @property
    def A(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (n, n), n = stations times order.
        """
    @property
    def B(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (n, inputs).
        """
    @property
    def held_out(self) -> list[float]:
        """
        Mean log-likelihood of a held-out sample under orders 1, 2, ..; empty where the order was given.
        """
    @property
    def order(self) -> int:
        """
        How many samples of the past count.
        """
    @property
    def residual_bound(self) -> float:
        """
        Largest residual of the records, a length.
        """
    @property
    def residual_covariance(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (N, N)
        """
    @property
    def residuals(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (T, N), nan where the past is not complete.
        """
    @property
    def samples(self) -> int:
        """
        Samples with a complete past, on which it rests.
        """

class Response:
    """
    What known inputs alone do to a plant: s(t+1) = A s(t) + B u(t), s(0) = 0. With x = z + s, z is a plant
    without inputs of which y - C s is measured: an agent driven by hand gets `without` of its measurement, and
    its estimate plus `state` is one of x, with the same error and bound (docs/adr/0016).

    Parameters
    ----------
    model : Model
        With B.
    """
    def __init__(self, model: Model) -> None: ...
    def __reduce__(self) -> tuple: ...
    def advance(
        self,
        inputs: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
        *,
        A: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"] | None = None,
        B: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"] | None = None,
    ) -> None:
        """
        Moves to the next sample.

        Parameters
        ----------
        inputs : (p,) array
            u of this sample, one number per column of B.
        A : (n, n) array, optional
            Leads to the next sample where the plant changes; default the model's.
        B : (n, p) array, optional
            Likewise.

        Raises
        ------
        InvalidInput
            A wrong size, a number that is not finite, or a response that overflows.
        """
    def without(
        self,
        y: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
        C: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        What a filter without inputs is to get of a measurement: y - C s.

        Parameters
        ----------
        y : (m,) array
            The measurement; nan = missing.
        C : (m, n) array
            Its rows.

        Returns
        -------
        (m,) array

        Raises
        ------
        InvalidInput
            Sizes do not fit.
        """
    @property
    def sample(self) -> int:
        """
        The present sample, from 0.
        """
    @property
    def state(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        s, (n,).
        """

def anomalies(
    raw: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    first: typing.SupportsInt | typing.SupportsIndex,
    *,
    harmonics: typing.SupportsInt | typing.SupportsIndex,
    period: typing.SupportsFloat | typing.SupportsIndex,
    root: bool,
    factor: typing.SupportsFloat | typing.SupportsIndex,
) -> tuple[
    typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"],
    typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"],
]:
    """
    (records without their seasonal cycle (T, N), the cycle's coefficients).
    """

def attack_infos() -> list:
    """
    All attacks with the description of their parameters.
    """

def autoregress(
    z: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    u: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    *,
    order: typing.SupportsInt | typing.SupportsIndex = 0,
    most: typing.SupportsInt | typing.SupportsIndex = 4,
    held_out: typing.SupportsFloat | typing.SupportsIndex = 0.25,
) -> Autoregression:
    """
    Fit z(t) = A_1 z(t-1) + .. + B u(t) + e to (T, N) numbers without mean and season, nan = missing; u (T, p).
    """

def central_kalman(
    model: Model,
    measurements: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    x0: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    start_variance: typing.SupportsFloat | typing.SupportsIndex,
    gate: typing.SupportsFloat | typing.SupportsIndex = 0.0,
    huber: typing.SupportsFloat | typing.SupportsIndex = ...,
    inputs: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"] = ...,
    series: dict = {},
) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
    """
    Estimates (T + 1, n) of a central Kalman filter.
    """

def chebyshev_contraction(
    gamma: typing.SupportsFloat | typing.SupportsIndex, rounds: typing.SupportsInt | typing.SupportsIndex
) -> float:
    """
    What `rounds` Chebyshev-filtered rounds (0..1e6) leave of a disagreement that one plain round shrinks to
    `gamma`, in [0, 1].
    """

def check(
    model: Model,
    network: Network,
    filter: Filter,
    seconds: typing.SupportsFloat | typing.SupportsIndex = ...,
    progress: typing.Any = None,
) -> tuple[list, list]:
    """
    Conditions and quantities of the family's theorems, as two lists of dicts. Searches end after `seconds` with a
    certified interval; a computation without partial results raises InvalidInput then. Ctrl-C ends it, too. progress(what, seconds) is called about once a second.
    """

def contradictions(
    model: Model,
    measurements: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    *,
    attacked: typing.SupportsInt | typing.SupportsIndex,
    for_good: bool,
    constant: bool,
    owner: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex],
    inputs: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
) -> list:
    """
    (bound, row) per trial: which bound measurements (trials, samples, outputs) refute whichever `attacked` sources lie, and
    where; (None, -1) = none. owner: whose each measurement is, [] = its agent's; inputs: row r leads from sample r to the next one.
    """

def custom_attack(
    name: str,
    function: typing.Any,
    schedule: collections.abc.Sequence[
        tuple[
            typing.SupportsInt | typing.SupportsIndex,
            collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex],
        ]
    ],
    stop: typing.SupportsInt | typing.SupportsIndex | None = None,
    probability: typing.SupportsFloat | typing.SupportsIndex = 1.0,
) -> Attack:
    """
    An attack by a Python function; use garrison.attacks.custom.
    """

def design_summary(data: typing.Any) -> dict:
    """
    What a design file says of itself: filter, params, agents, states, bytes, hash, agent.
    """

def discretise(
    A: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
    process_intensity: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
    period: typing.SupportsFloat | typing.SupportsIndex,
    B: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
) -> tuple[
    typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"],
    typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"],
    typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"],
]:
    """
    (A, covariance, B) from sample to sample of dx/dt = A x + B u + white noise, u held in between.
    """

def driven(
    A: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
    x: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
    B: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
    u: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
    """
    A x + B u.
    """

def exceedances(
    statistic: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    threshold: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
) -> tuple[numpy.typing.NDArray[numpy.int64], numpy.typing.NDArray[numpy.int64]]:
    """
    (tests, above) per agent, the last axis: samples with a test (no nan), and those above its threshold.
    """

def extended_kalman(
    f: collections.abc.Callable,
    h: collections.abc.Callable,
    measurements: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    x0: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    P0: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    process_covariance: dict,
    measurement_variance: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
    inputs: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    f_jacobian: typing.Any = None,
    h_jacobian: typing.Any = None,
    gate: typing.SupportsFloat | typing.SupportsIndex = 0.0,
    huber: typing.SupportsFloat | typing.SupportsIndex = ...,
) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
    """
    Estimates (T + 1, n) of an extended Kalman filter.
    """

def filter_infos() -> list:
    """
    All families with the description of their parameters.
    """

def identified(
    autoregression: Autoregression,
    season: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
    *,
    harmonics: typing.SupportsInt | typing.SupportsIndex,
    period: typing.SupportsFloat | typing.SupportsIndex,
    root: bool,
    factor: typing.SupportsFloat | typing.SupportsIndex,
    noise: typing.SupportsFloat | typing.SupportsIndex,
) -> Identified:
    """
    An autoregression as an Identified model.
    """

def identify(
    raw: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    first: typing.SupportsInt | typing.SupportsIndex,
    *,
    factors: typing.SupportsInt | typing.SupportsIndex = 2,
    harmonics: typing.SupportsInt | typing.SupportsIndex = 2,
    period: typing.SupportsFloat | typing.SupportsIndex = 365.25,
    root: bool = False,
    factor: typing.SupportsFloat | typing.SupportsIndex = 1.0,
    standardise: bool | None = None,
) -> Identified:
    """
    Fit a model to clean records (T, N), nan = missing.
    """

def lambda0(
    C: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    s: typing.SupportsInt | typing.SupportsIndex,
    max_nodes: typing.SupportsInt | typing.SupportsIndex = 20000000,
    max_seconds: typing.SupportsFloat | typing.SupportsIndex = ...,
) -> SubsetBound:
    """
    (6) of the saturation paper: least lambda_min(sum C_i'C_i) over all sets of N - s rows of C.

    Parameters
    ----------
    C : (N, n) array
        One row per sensor.
    s : int
        Rows that are left out, 0..N.
    max_nodes : int
        The search ends after so many sets, >= 1, with an interval (with up to two states, or three and
        more than 20 rows: after as much work as so many looks at all rows).
    max_seconds : float
        Or after so many seconds, >= 0.

    Returns
    -------
    SubsetBound
        Its `lower` is safe in every theorem.

    Raises
    ------
    InvalidInput
        A number out of range, or not finite.
    """

def lambda0_orthogonal(
    C: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    s: typing.SupportsInt | typing.SupportsIndex,
) -> float | None:
    """
    Closed form of lambda0 for rows that are parallel or orthogonal; None for others.
    """

def lfre_parents(model: Model, network: Network, filter: Filter) -> list[list[int]]:
    """
    Parents of every agent in an Lfre filter.
    """

def local_kalman(
    model: Model,
    network: Network,
    measurements: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    start: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    start_variance: typing.SupportsFloat | typing.SupportsIndex,
    gate: typing.SupportsFloat | typing.SupportsIndex = 0.0,
    huber: typing.SupportsFloat | typing.SupportsIndex = ...,
    inputs: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"] = ...,
    series: dict = {},
) -> list[typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]]:
    """
    Estimates (T + 1, n) of every agent's own Kalman filter, a list.
    """

def make_attack(
    name: str,
    schedule: collections.abc.Sequence[
        tuple[
            typing.SupportsInt | typing.SupportsIndex,
            collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex],
        ]
    ],
    stop: typing.SupportsInt | typing.SupportsIndex | None = None,
    probability: typing.SupportsFloat | typing.SupportsIndex = 1.0,
    params: dict = {},
) -> Attack:
    """
    The attack `name`. schedule: (start, agents) phases in order of time.
    """

def make_filter(name: str, params: dict = {}) -> Filter:
    """
    The filter of this name; unknown names are refused with the nearest one.

    Parameters
    ----------
    name : str
        As in `garrison list`.
    params : dict
        Parameters by name; the rest have their defaults.

    Returns
    -------
    Filter
        An object of the family's class.

    Raises
    ------
    InvalidInput
        An unknown name, or a parameter that is unknown or out of range.
    """

def nearest_name(unknown: str, known: collections.abc.Sequence[str]) -> str:
    """
    The known name closest to `unknown`, or an empty text.
    """

def observable(
    A: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    C: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
) -> bool:
    """
    Whether (A, C) is observable.

    Parameters
    ----------
    A : (n, n) array
        Of the plant.
    C : (m, n) array
        All rows.

    Returns
    -------
    bool

    Raises
    ------
    InvalidInput
        Shapes do not fit, or rounding of the numbers decides and one cannot tell;
        structure.visibility says how far that is.
    """

def one_step_sparse_observable(
    C: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    s: typing.SupportsInt | typing.SupportsIndex,
) -> bool:
    """
    Whether any N - s rows of C span the state.

    Parameters
    ----------
    C : (N, n) array
        One row per sensor.
    s : int
        Rows that are lost, 0..N.

    Returns
    -------
    bool

    Raises
    ------
    InvalidInput
        A number out of range, or not finite.
    """

def replay(
    design: Design,
    *,
    measurements: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    truth: typing.Annotated[numpy.typing.ArrayLike, numpy.float64] | None,
    trials: typing.SupportsInt | typing.SupportsIndex,
    first_trial: typing.SupportsInt | typing.SupportsIndex,
    seed: typing.SupportsInt | typing.SupportsIndex,
    threads: typing.SupportsInt | typing.SupportsIndex,
    start: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"] | None,
    attacks: collections.abc.Sequence[Attack],
    link: dict,
    keep: collections.abc.Sequence[str],
    inputs: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
    series: dict,
    functions: dict,
    progress: typing.Any,
    sink: typing.Any = None,
    block_bytes: typing.SupportsInt | typing.SupportsIndex = 16777216,
) -> dict:
    """
    Arrays of a replayed run; use garrison.replay.
    """

def replay_log(log: typing.Any) -> dict:
    """
    Do again what the log of a node (bytes of an MCAP file) says. Returns agent, family, calls, estimates (compared),
    differ (estimates that differ in a bit, and calls that were refused), first and last sample, ended (the node was
    stopped, not killed). Raises InvalidInput for anything but a log.
    """

def s_sparse_observable(
    A: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    C: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    s: typing.SupportsInt | typing.SupportsIndex,
    seconds: typing.SupportsFloat | typing.SupportsIndex = 30.0,
) -> bool:
    """
    Whether (A, kept rows) is observable whichever s rows of C are lost.

    Parameters
    ----------
    A : (n, n) array
        Of the plant.
    C : (N, n) array
        One row per sensor.
    s : int
        Rows that are lost, 0..N.
    seconds : float
        Time that the search may take.

    Returns
    -------
    bool

    Raises
    ------
    InvalidInput
        A number out of range, rounding decides, or `seconds` do not suffice.
    """

def simulate(
    design: Design,
    *,
    steps: typing.SupportsInt | typing.SupportsIndex,
    x0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
    start_error: typing.SupportsFloat | typing.SupportsIndex,
    noise: str,
    disturbances: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
    trials: typing.SupportsInt | typing.SupportsIndex,
    first_trial: typing.SupportsInt | typing.SupportsIndex,
    seed: typing.SupportsInt | typing.SupportsIndex,
    threads: typing.SupportsInt | typing.SupportsIndex,
    start: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"] | None,
    attacks: collections.abc.Sequence[Attack],
    link: dict,
    keep: collections.abc.Sequence[str],
    inputs: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
    series: dict,
    functions: dict,
    progress: typing.Any,
    sink: typing.Any = None,
    block_bytes: typing.SupportsInt | typing.SupportsIndex = 16777216,
) -> dict:
    """
    Arrays of a simulated run; use garrison.simulate.
    """

def split_outputs(model: Model, network: Network) -> tuple[Model, Network, list[int]]:
    """
    The same plant with an agent per output: an agent with m outputs becomes m agents that hear each other.

    Parameters
    ----------
    model : Model
        Agents with any number of outputs.
    network : Network
        Of the same agents.

    Returns
    -------
    (Model, Network, list of int)
        The model and network of the single outputs, and per new agent the one
        that it came from.

    Raises
    ------
    InvalidInput
        Model and network have another number of agents.
    """

def surely_observable(
    A: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    C: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
) -> bool:
    """
    The same, False where one cannot tell.
    """

def tau0(
    C: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    A: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    s: typing.SupportsInt | typing.SupportsIndex,
) -> SubsetBound:
    """
    Theorem 5: largest (1/N) ||[C_i'C_i A]|| over sets of N - s rows.
    """

def varpi(
    C: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    A: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    s: typing.SupportsInt | typing.SupportsIndex,
) -> SubsetBound:
    """
    Theorem 3: largest ||(I - (1/N) sum C_i'C_i) A|| over sets of N - s rows.
    """

__version__: str = "0.1.0"
