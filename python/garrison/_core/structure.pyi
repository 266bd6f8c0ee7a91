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

    Parameters
    ----------
    rows, columns : int
        >= 0.
    entries : sequence of (column, row) pairs
        Which are not zero; of a system matrix, (j, i) is the link j ->
        i.

    Raises
    ------
    InvalidInput
        An index out of range, or more than memory holds.
    """
    @staticmethod
    def csc(
        rows: typing.SupportsInt | typing.SupportsIndex,
        indptr: typing.Annotated[numpy.typing.ArrayLike, numpy.int32],
        indices: typing.Annotated[numpy.typing.ArrayLike, numpy.int32],
    ) -> Pattern:
        """
        From compressed columns, as scipy.sparse.csc_array has them, without its numbers.

        Parameters
        ----------
        rows : int
            >= 0.
        indptr : (columns + 1,) int array
            Where each column begins.
        indices : int array
            Row of every entry, column by column.

        Returns
        -------
        Pattern

        Raises
        ------
        InvalidInput
            Arrays that do not fit.
        """
    @staticmethod
    def of(
        matrix: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
        tolerance: typing.SupportsFloat | typing.SupportsIndex = 0.0,
    ) -> Pattern:
        """
        The pattern of a dense matrix.

        Parameters
        ----------
        matrix : (m, n) array
            Finite.
        tolerance : float
            Entries with |value| > tolerance are not zero; >= 0.

        Returns
        -------
        Pattern

        Raises
        ------
        InvalidInput
            A number that is not finite, or tolerance < 0.
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
    ) -> None: ...
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
    Structure of a system matrix, worked out once. States are numbered from 0; a pattern entry (j, i) is the
    link j -> i. Methods take `measured`: per agent the state that it measures, a list of states, or None.

    Parameters
    ----------
    pattern : Pattern
        Square.

    Raises
    ------
    InvalidInput
        Not square.
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
        Other states of an agent's class.

        Parameters
        ----------
        measured : sequence of int or None
            The one state that each agent measures.
        agent : int
            Which agent, 0..
        type : str
            "alpha", "beta" or "gamma".

        Returns
        -------
        list of int

        Raises
        ------
        InvalidInput
            There is no such agent, state or class.
        """
    def classes(self, measured: collections.abc.Iterable) -> list[str]:
        """
        Class of each agent, by what it measures (section II-B of the structural paper).

        Parameters
        ----------
        measured : sequence of int, list of int or None
            What each agent measures.

        Returns
        -------
        list of str
            alpha (it measures a state of a contraction), beta (one of a parent component) or gamma
            (neither), per agent.

        Raises
        ------
        InvalidInput
            There is no such state.
        """
    def contraction_of_measured(self, measured: collections.abc.Iterable) -> dict[int, list[int]]:
        """
        The contraction of each measured state. Empty unless there are as many alpha agents, measuring one state
        each, as the structural rank lacks.

        Parameters
        ----------
        measured : sequence of int, list of int or None
            What each agent measures.

        Returns
        -------
        dict
            Measured state -> states of its contraction, sorted.

        Raises
        ------
        InvalidInput
            There is no such state.
        """
    def in_contraction(self, state: typing.SupportsInt | typing.SupportsIndex) -> bool:
        """
        Whether the state is in some contraction: a set of more columns than rows.

        Parameters
        ----------
        state : int
            0..n-1.

        Returns
        -------
        bool

        Raises
        ------
        InvalidInput
            There is no such state.
        """
    def in_parent(self, state: typing.SupportsInt | typing.SupportsIndex) -> bool:
        """
        Whether the state is in a strong component that no link leaves.

        Parameters
        ----------
        state : int
            0..n-1.

        Returns
        -------
        bool

        Raises
        ------
        InvalidInput
            There is no such state.
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
        Algorithm 1: alarmed agents measure another state, one after the other.

        Parameters
        ----------
        measured : sequence of int or None
            The one state that each agent measures.
        alarms : sequence of int
            Alarmed agents.
        types : sequence of str, optional
            Class of each agent; default: `classes`.
        choice : str
            "class" as printed, or "exact", the cheapest state that keeps the system structurally
            observable.
        cost : (agents, states) array, optional
            Of measuring a state; default: all alike.

        Returns
        -------
        (list, list)
            The new measured states, and (agent, type, before, after) of every change.

        Raises
        ------
        InvalidInput
            There is no such agent, state or class, or a wrong size.
        """
    def necessary(self, measured: collections.abc.Iterable) -> list[bool]:
        """
        Which agents cannot be missed: structurally observable, but not without this one.

        Parameters
        ----------
        measured : sequence of int, list of int or None
            What each agent measures.

        Returns
        -------
        list of bool
            Per agent.

        Raises
        ------
        InvalidInput
            There is no such state.
        """
    def observability(self, measured: collections.abc.Iterable) -> dict:
        """
        Structural observability and its two conditions.

        Parameters
        ----------
        measured : sequence of int, list of int or None
            What each agent measures.

        Returns
        -------
        dict
            observable, output_connected, rank_condition: bools.

        Raises
        ------
        InvalidInput
            There is no such state.
        """
    def substitutes(self, measured: collections.abc.Iterable) -> list[list[int]]:
        """
        What each agent could measure instead.

        Parameters
        ----------
        measured : sequence of int, list of int or None
            What each agent measures.

        Returns
        -------
        list of lists of int
            States, per agent.

        Raises
        ------
        InvalidInput
            There is no such state.
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
    Remark 9: the cheapest agents, one per class of states.

    Parameters
    ----------
    cost : (agents, states) array
        Of measuring a state; inf = impossible.
    classes : sequence of sequences of int
        States of each class.

    Returns
    -------
    dict or None
        cost, and picks, (agent, state, class) tuples; None when there is no such choice.

    Raises
    ------
    InvalidInput
        There is no such state, or a cost is negative or nan.
    """

def cheapest_rank_sensors(
    A: Pattern, cost: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"]
) -> typing.Any:
    """
    The cheapest sensors that restore the structural rank.

    Parameters
    ----------
    A : Pattern
        Of the system matrix, n states.
    cost : (agents, n) array
        Of measuring a state; inf = impossible.

    Returns
    -------
    dict or None
        cost, and picks, (agent, state) pairs; None when there are none.

    Raises
    ------
    InvalidInput
        A wrong size, or a cost is negative or nan.
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
    Cheapest strongly connected network from given links. The problem is NP-hard: nothing cheaper than
    lower_bound exists.

    Parameters
    ----------
    agents : int
        >= 1.
    edges : sequence of (from, to) pairs
        Links that can be had.
    weights : sequence of float
        Cost of each, >= 0.
    max_nodes : int
        Choices that are looked at before the search ends, >= 1.

    Returns
    -------
    dict
        exists; edges, cost; lower_bound; exact: whether max_nodes sufficed for cost = lower_bound.

    Raises
    ------
    InvalidInput
        A number out of range, or sizes that differ.
    """

def distributed_observability(
    A: Pattern,
    measured: collections.abc.Iterable,
    W: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
    U: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
) -> dict:
    """
    Structural observability of the pattern pair (W kron A, D_C): by every agent, from what it hears.

    Parameters
    ----------
    A : Pattern
        Of the system matrix, n states.
    measured : sequence of int, list of int or None
        What each of the N agents measures.
    W : (N, N) array
        Whose estimates agents mix: entries that are not 0.
    U : (N, N) array
        Whose measurements agents get: entries that are not 0.

    Returns
    -------
    dict
        observable, output_connected, rank_condition: bools.

    Raises
    ------
    InvalidInput
        Shapes do not fit.
    """

def dulmage_mendelsohn(pattern: Pattern) -> dict:
    """
    Dulmage-Mendelsohn decomposition: coarse parts (hor: more columns than rows, sq: matched, ver: more rows
    than columns), and the square part in fine blocks.

    Parameters
    ----------
    pattern : Pattern
        Of any matrix.

    Returns
    -------
    dict
        structural_rank; int arrays hor_rows, hor_cols, sq_rows, sq_cols, ver_rows, ver_cols; block_start:
        block b holds sq_rows and sq_cols [block_start[b], block_start[b+1]).
    """

def maximum_matching(
    pattern: Pattern,
) -> tuple[int, numpy.typing.NDArray[numpy.int32], numpy.typing.NDArray[numpy.int32]]:
    """
    The largest set of entries of which no two share a row or column.

    Parameters
    ----------
    pattern : Pattern
        Of a matrix (m, n).

    Returns
    -------
    (int, (n,) int array, (m,) int array)
        Size, row of each column, column of each row; -1 = unmatched.
    """

def strong_components(pattern: Pattern) -> tuple[int, numpy.typing.NDArray[numpy.int32]]:
    """
    Strong components of the digraph with links column -> row.

    Parameters
    ----------
    pattern : Pattern
        Of a square matrix (n, n).

    Returns
    -------
    (int, (n,) int array)
        How many, and the component of each vertex.

    Raises
    ------
    InvalidInput
        Not square.
    """

def undetectable_agents(model: garrison._core.Model) -> list[int]:
    """
    Agents whose sensor alone can lie along an unstable mode that nobody else sees.

    Parameters
    ----------
    model : Model
        Any.

    Returns
    -------
    list of int
        Sorted.
    """

def unseen_modes(
    A: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    C: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    least: typing.SupportsFloat | typing.SupportsIndex = 0.0,
) -> list[complex]:
    """
    Eigenvalues of A that the rows of C do not surely show; see visibility.

    Parameters
    ----------
    A : (n, n) array
        Of the plant.
    C : (m, n) array
        Rows; there may be none.
    least : float
        Eigenvalues of smaller modulus are left out; >= 0.

    Returns
    -------
    list of complex

    Raises
    ------
    InvalidInput
        Shapes do not fit, or a number is not finite.
    """

def visibility(
    A: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    C: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    least: typing.SupportsFloat | typing.SupportsIndex = 0.0,
) -> dict:
    """
    What the rows of C show of the modes of A. Units and coordinates do not matter.

    Parameters
    ----------
    A : (n, n) array
        Of the plant.
    C : (m, n) array
        Rows; there may be none.
    least : float
        Modes of smaller modulus are left out; >= 0.

    Returns
    -------
    dict
        sight: "seen", "unseen" or "unclear"; distance, relative, to the nearest pair with an unseen mode,
        and that mode in nearest; eigenvalues in unseen and unclear; text, all of it in words.

    Raises
    ------
    InvalidInput
        Shapes do not fit, or a number is not finite.
    """
