"""
Structural analysis: what follows from the zeros of a system alone.
"""

from __future__ import annotations
import collections.abc
import garrison._core
import numpy
import numpy.typing
import typing

__all__: list[str] = [
    "Pattern",
    "System",
    "cheapest_per_class",
    "cheapest_rank_sensors",
    "cheapest_strong_subgraph",
    "distributed_observability",
    "dulmage_mendelsohn",
    "maximum_matching",
    "strong_components",
    "undetectable_agents",
    "unseen_modes",
    "visibility",
]

class Pattern:
    """
    Zero pattern of a matrix: which entries are not zero. Immutable.
    """
    @staticmethod
    def csc(
        rows: typing.SupportsInt | typing.SupportsIndex,
        indptr: typing.Annotated[numpy.typing.ArrayLike, numpy.int32],
        indices: typing.Annotated[numpy.typing.ArrayLike, numpy.int32],
    ) -> Pattern:
        """
        Compressed columns (scipy.sparse.csc_array's indptr and indices), without doubles.
        """
    @staticmethod
    def of(
        matrix: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
        tolerance: typing.SupportsFloat | typing.SupportsIndex = 0.0,
    ) -> Pattern:
        """
        Entries with |value| > tolerance of a dense matrix.
        """
    def __copy__(self) -> typing.Any: ...
    def __deepcopy__(self, memo: dict) -> typing.Any: ...
    def __eq__(self, other: typing.Any) -> typing.Any: ...
    def __getstate__(self) -> dict: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        rows: typing.SupportsInt | typing.SupportsIndex,
        columns: typing.SupportsInt | typing.SupportsIndex,
        entries: collections.abc.Sequence[
            tuple[typing.SupportsInt | typing.SupportsIndex, typing.SupportsInt | typing.SupportsIndex]
        ],
    ) -> None:
        """
        entries: (column, row) pairs; of a system matrix, (j, i) is the link j -> i.
        """
    def __reduce__(self) -> tuple: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, arg0: dict) -> None: ...
    def transposed(self) -> Pattern:
        """
        The pattern of the transposed matrix.
        """
    @property
    def columns(self) -> int:
        """
        How many.
        """
    @property
    def entries(self) -> int:
        """
        How many may be other than zero.
        """
    @property
    def rows(self) -> int:
        """
        How many.
        """

class System:
    """
    Structure of a system matrix, worked out once. `measured`: per agent the state that it
    measures, a list of states, or None. States from 0; a pattern entry (j, i) is j -> i.
    """
    def __copy__(self) -> typing.Any: ...
    def __deepcopy__(self, memo: dict) -> typing.Any: ...
    def __eq__(self, other: typing.Any) -> typing.Any: ...
    def __getstate__(self) -> dict: ...
    def __hash__(self) -> int: ...
    def __init__(self, pattern: Pattern) -> None: ...
    def __reduce__(self) -> tuple: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, arg0: dict) -> None: ...
    def class_candidates(
        self, measured: collections.abc.Iterable, agent: typing.SupportsInt | typing.SupportsIndex, type: str
    ) -> list[int]:
        """
        Other states of the agent's class.
        """
    def classes(self, measured: collections.abc.Iterable) -> list[str]:
        """
        alpha, beta or gamma per agent.
        """
    def contraction_of_measured(self, measured: collections.abc.Iterable) -> dict[int, list[int]]:
        """
        Measured state -> its contraction, sorted. Empty unless there are as many alpha agents, measuring one state
        each, as the structural rank lacks.
        """
    def in_contraction(self, state: typing.SupportsInt | typing.SupportsIndex) -> bool:
        """
        Whether the state is in some contraction: a set of more columns than rows.
        """
    def in_parent(self, state: typing.SupportsInt | typing.SupportsIndex) -> bool:
        """
        Whether the state is in a strong component that no link leaves.
        """
    def mitigate(
        self,
        measured: collections.abc.Iterable,
        alarms: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex],
        types: collections.abc.Sequence[str] | None = None,
        choice: str = "exact",
        cost: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"] | None = None,
    ) -> tuple[list, list]:
        """
        Algorithm 1: (new measured states, log of (agent, type, before, after)), one alarmed agent at a
        time. choice: "class" as printed, or "exact", the cheapest state that keeps the system
        structurally observable; cost is (agents, states), None: all alike.
        """
    def necessary(self, measured: collections.abc.Iterable) -> list[bool]:
        """
        Structurally observable, but not without this one agent.
        """
    def observability(self, measured: collections.abc.Iterable) -> dict:
        """
        Structural observability and its two conditions.
        """
    def substitutes(self, measured: collections.abc.Iterable) -> list[list[int]]:
        """
        Per agent, every state that it could measure instead.
        """
    @property
    def components(self) -> list[list[int]]:
        """
        Strong components, lists of states, parents first.
        """
    @property
    def contraction_components(self) -> list[list[int]]:
        """
        Overlapping contractions joined; does not depend on the matching.
        """
    @property
    def contraction_union(self) -> list[int]:
        """
        States of all contractions, sorted; does not depend on the matching.
        """
    @property
    def parent_components(self) -> list[list[int]]:
        """
        Components that no link leaves.
        """
    @property
    def parts(self) -> dict:
        """
        Coarse Dulmage-Mendelsohn parts, sorted.
        """
    @property
    def states(self) -> int:
        """
        How many, n.
        """
    @property
    def structural_rank(self) -> int:
        """
        Rank of A for almost all values of its entries.
        """

def cheapest_per_class(
    cost: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    classes: collections.abc.Sequence[collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex]],
) -> typing.Any:
    """
    Remark 9: {cost, picks (agent, state, class)} of one agent per class; None when there is none.
    """

def cheapest_rank_sensors(
    A: Pattern, cost: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"]
) -> typing.Any:
    """
    {cost, picks (agent, state)} of the cheapest sensors that restore the rank; None when there are none.
    """

def cheapest_strong_subgraph(
    agents: typing.SupportsInt | typing.SupportsIndex,
    edges: collections.abc.Sequence[
        tuple[typing.SupportsInt | typing.SupportsIndex, typing.SupportsInt | typing.SupportsIndex]
    ],
    weights: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex],
    max_nodes: typing.SupportsInt | typing.SupportsIndex = 2000000,
) -> dict:
    """
    Cheapest strongly connected network from (from, to) edges, weights >= 0. The problem is NP-hard:
    exact says whether max_nodes choices sufficed for cost = lower_bound; nothing cheaper than
    lower_bound exists.
    """

def distributed_observability(
    A: Pattern,
    measured: collections.abc.Iterable,
    W: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
    U: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
) -> dict:
    """
    Structural observability of the pattern pair (W kron A, D_C).
    """

def dulmage_mendelsohn(pattern: Pattern) -> dict:
    """
    Dulmage-Mendelsohn: coarse parts (hor: more columns than rows, sq: matched, ver: more rows than
    columns) and the square part in fine blocks; block b holds sq_rows and sq_cols [block_start[b],
    block_start[b+1]).
    """

def maximum_matching(
    pattern: Pattern,
) -> tuple[int, numpy.typing.NDArray[numpy.int32], numpy.typing.NDArray[numpy.int32]]:
    """
    (size, row of each column, column of each row); -1 = unmatched.
    """

def strong_components(pattern: Pattern) -> tuple[int, numpy.typing.NDArray[numpy.int32]]:
    """
    (count, component of each vertex) of the digraph with links column -> row.
    """

def undetectable_agents(model: garrison._core.Model) -> list[int]:
    """
    Agents whose sensor alone can lie along an unstable mode that nobody else sees.
    """

def unseen_modes(
    A: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    C: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    least: typing.SupportsFloat | typing.SupportsIndex = 0.0,
) -> list[complex]:
    """
    Eigenvalues of modulus >= least that the rows of C do not surely show; see visibility.
    """

def visibility(
    A: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    C: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    least: typing.SupportsFloat | typing.SupportsIndex = 0.0,
) -> dict:
    """
    What the rows of C show of the modes of A of modulus >= least: "seen", "unseen" or "unclear", with the
    relative distance to the nearest pair with an unseen mode. Units and coordinates do not matter.
    """
