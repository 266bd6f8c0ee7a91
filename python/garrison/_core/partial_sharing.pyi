"""
Analysis of the partial-sharing filter; errata of its paper: docs/filters/partial_sharing.md.
"""

from __future__ import annotations
import collections.abc
import garrison._core
import numpy
import numpy.typing
import typing

__all__: list[str] = ["Analysis", "Selection", "SelectionProblem", "WorstAttack", "worst_covariance"]

class Selection:
    """
    Which entries every agent shares, and when: those of sample 0, moved on by tau from sample to sample.

    Parameters
    ----------
    start : (N, m) array
        Of zeros and ones: what agents share at k = 0.
    shift : int
        tau, any whole number.

    Raises
    ------
    InvalidInput
        Another entry than 0 and 1.
    """
    def __copy__(self) -> typing.Any: ...
    def __deepcopy__(self, memo: dict) -> typing.Any: ...
    def __eq__(self, other: typing.Any) -> typing.Any: ...
    def __getstate__(self) -> dict: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        start: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
        shift: typing.SupportsInt | typing.SupportsIndex,
    ) -> None: ...
    def __reduce__(self) -> tuple: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, arg0: dict) -> None: ...
    def at(
        self, k: typing.SupportsInt | typing.SupportsIndex
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        s(k).

        Parameters
        ----------
        k : int
            Sample.

        Returns
        -------
        (N, m) array
            Of zeros and ones.
        """
    def moments_cycle(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        Time mean of s s' over one period, (N m, N m).
        """
    def moments_uniform(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        E{s s'} over independent uniform subsets, (N m, N m).
        """
    @property
    def frequency(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (N, m): share of the samples in which each entry is sent.
        """
    @property
    def period(self) -> int:
        """
        Samples until all selections repeat.
        """
    @property
    def shift(self) -> int:
        """
        tau mod m.
        """

class Analysis:
    """
    Exact covariances, stability and attacks of a PartialSharing filter on a model and network. N agents, m
    states; network covariances are (N m, N m), agent by agent. k counts samples from 0: k = t - 1. P_0 and the
    start belong to k = 0.

    Parameters
    ----------
    model : Model
        With process_covariance and measurement_covariance.
    network : Network
        Of the same agents.
    filter : Filter
        A garrison.filters.PartialSharing.

    Raises
    ------
    InvalidInput
        They do not fit each other, or a covariance is missing.
    """
    def __init__(
        self, model: garrison._core.Model, network: garrison._core.Network, filter: garrison._core.Filter
    ) -> None: ...
    def __reduce__(self) -> tuple: ...
    def coupling_form(
        self, byzantine: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex]
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        U of (31).

        Parameters
        ----------
        byzantine : sequence of int
            B attacked agents.

        Returns
        -------
        (B m, B m) array

        Raises
        ------
        InvalidInput
            A bad agent.
        """
    def cycle_radius(self) -> float:
        """
        Exact stability: below 1 exactly when covariances stay bounded (per sample).
        """
    def decrease_matrix(
        self, gamma: typing.SupportsFloat | typing.SupportsIndex, phase: typing.SupportsInt | typing.SupportsIndex = 0
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        M(gamma): where it is positive semidefinite the Lyapunov function of the errors falls
        (docs/filters/partial_sharing.md#m7).

        Parameters
        ----------
        gamma : float
            Gain, >= 0.
        phase : int
            Sample of the period of the selection, from 0.

        Returns
        -------
        (N m, N m) array

        Raises
        ------
        InvalidInput
            A number out of range.
        """
    def error_covariance(
        self,
        steps: typing.SupportsInt | typing.SupportsIndex,
        Sigma: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"] | None = None,
        k0: typing.SupportsInt | typing.SupportsIndex = 0,
        byzantine: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] | None = None,
        common_start: bool = True,
        iid_selections: bool = False,
    ) -> dict:
        """
        (29) along Algorithm 1, with the gains of (11) from P_0 on.

        Parameters
        ----------
        steps : int
            0..1e6.
        Sigma : (N m, N m) array, optional
            Covariance of the attack, zero on regular agents; None = no attack.
        k0 : int
            First step that is attacked, >= 0.
        byzantine : sequence of int, optional
            Agents that Sigma may speak of; default all.
        common_start : bool
            All agents have one initial error, else independent ones.
        iid_selections : bool
            The mean over selections that are drawn anew in every sample.

        Returns
        -------
        dict
            nmse, (steps + 1,) traces of P; and P (N m, N m) at the end.

        Raises
        ------
        InvalidInput
            A number out of range, or no covariance.
        """
    def full_solution(
        self,
        steps: typing.SupportsInt | typing.SupportsIndex,
        start: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
        y: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"] = ...,
        delta: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"] = ...,
        Sigma: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"] | None = None,
        k0: typing.SupportsInt | typing.SupportsIndex = 0,
        common_start: bool = True,
    ) -> dict:
        """
        (4)-(7) with cross-covariances, for comparison: not always better than Algorithm 1
        (docs/filters/partial_sharing.md#m16).

        Parameters
        ----------
        steps : int
            0..1e6.
        start : (N, m) array
            Estimates at k = 0.
        y : (steps, outputs) array
            Measurements of the whole network per step; without it covariances only.
        delta : (steps, N m) array
            Perturbations per step; default none.
        Sigma : (N m, N m) array, optional
            Covariance of the attack; None = no attack.
        k0 : int
            First step that is attacked, >= 0.
        common_start : bool
            All agents have one initial error, else independent ones.

        Returns
        -------
        dict
            estimate, steps + 1 arrays (N, m) of predictions; trace of P per step; K and C of the last step,
            per agent; P (N m, N m) at the end.

        Raises
        ------
        InvalidInput
            Shapes do not fit, or a number is out of range.
        """
    def gains(self, k: typing.SupportsInt | typing.SupportsIndex) -> dict:
        """
        P_i(k) of (11) and the gains of step k.

        Parameters
        ----------
        k : int
            0..1e6.

        Returns
        -------
        dict
            P, K, C and F, one array per agent.

        Raises
        ------
        InvalidInput
            k is out of range.
        """
    def gamma_lyapunov(self) -> float:
        """
        Certified: no gain up to here lets the Lyapunov function of the errors grow.
        """
    def gamma_star(self, fraction: typing.SupportsFloat | typing.SupportsIndex | None = None) -> float:
        """
        (22), advisory: false as printed, vacuous when 0 (docs/filters/partial_sharing.md#m7).

        Parameters
        ----------
        fraction : float, optional
            p_e, 0..1; default: that of the filter.

        Returns
        -------
        float
            Gain; inf when nobody hears anybody.

        Raises
        ------
        InvalidInput
            A fraction out of range.
        """
    def lambda_I(self) -> list[typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]]:
        """
        Lambda_I per agent, (m, m).
        """
    def local_covariances(
        self,
        moments: str,
        Sigma: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"] | None = None,
        byzantine: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] | None = None,
    ) -> list[typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]]:
        """
        (23)-(26) per agent. They drop the correlation of neighbours and are not the true covariance.

        Parameters
        ----------
        moments : str
            "p_e" is (26) as printed, "full" the same with p_e = 1, "uniform" and "cycle" are (25) with
            exact moments over random starts, or on this cycle.
        Sigma : (N m, N m) array, optional
            Covariance of the attack, zero on regular agents; None = no attack.
        byzantine : sequence of int, optional
            Agents that Sigma may speak of; default all.

        Returns
        -------
        list of N (m, m) arrays

        Raises
        ------
        InvalidInput
            Unknown moments, or no covariance.
        """
    def mse_local(
        self,
        moments: str,
        Sigma: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"] | None = None,
        byzantine: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] | None = None,
    ) -> float:
        """
        Their (38), the mean of their traces.

        Parameters
        ----------
        moments : str
            As in local_covariances.
        Sigma : (N m, N m) array, optional
            As in local_covariances.
        byzantine : sequence of int, optional
            As in local_covariances.

        Returns
        -------
        float
            state^2.

        Raises
        ------
        InvalidInput
            As local_covariances.
        """
    def periodic_covariance(
        self,
        Sigma: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"] | None = None,
        byzantine: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] | None = None,
    ) -> list[typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]]:
        """
        Exact periodic steady state of (29).

        Parameters
        ----------
        Sigma : (N m, N m) array, optional
            Covariance of the attack, zero on regular agents; None = no attack.
        byzantine : sequence of int, optional
            Agents that Sigma may speak of; default all.

        Returns
        -------
        list of (N m, N m) arrays
            One per sample of the period of the selection.

        Raises
        ------
        InvalidInput
            Unstable error dynamics, or no covariance.
        """
    def periodic_mse(
        self,
        Sigma: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"] | None = None,
        byzantine: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] | None = None,
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        Mean square error of the agents in the periodic steady state, trace / N.

        Parameters
        ----------
        Sigma : (N m, N m) array, optional
            Covariance of the attack, zero on regular agents; None = no attack.
        byzantine : sequence of int, optional
            Agents that Sigma may speak of; default all.

        Returns
        -------
        array
            One number per sample of the period of the selection, state^2.

        Raises
        ------
        InvalidInput
            Unstable error dynamics, or no covariance.
        """
    def recursion8(
        self,
        Sigma: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"] | None,
        k0: typing.SupportsInt | typing.SupportsIndex,
        steps: typing.SupportsInt | typing.SupportsIndex,
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        MSE' after each update (8), from the steady state on.

        Parameters
        ----------
        Sigma : (N m, N m) array or None
            Covariance of the attack, zero on regular agents; None = no attack.
        k0 : int
            First step, >= 0.
        steps : int
            0..1e6.

        Returns
        -------
        (steps,) array
            state^2.

        Raises
        ------
        InvalidInput
            A number out of range, or no covariance.
        """
    def spread(
        self,
        byzantine: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex],
        block: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        A covariance of the attacked agents as one of the network.

        Parameters
        ----------
        byzantine : sequence of int
            B attacked agents.
        block : (B m, B m) array
            Covariance, agents in ascending order.

        Returns
        -------
        (N m, N m) array
            Zero elsewhere.

        Raises
        ------
        InvalidInput
            A bad agent, or a wrong size.
        """
    def steady_attack_matrix(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        N of docs/filters/partial_sharing.md#m13 for all agents: tr(Sigma N) is what any Sigma adds to the cycle-averaged NMSE.
        """
    def steady_gains(self) -> dict:
        """
        Limits of (9), (11) per agent: P, K, C, F. Raises InvalidInput for an undetectable agent.
        """
    def top_degree(self, count: typing.SupportsInt | typing.SupportsIndex) -> list[int]:
        """
        The agents that most others hear; among equals the lower ones.

        Parameters
        ----------
        count : int
            0..N.

        Returns
        -------
        list of int
            Sorted.

        Raises
        ------
        InvalidInput
            count is out of range.
        """
    def worst(
        self,
        byzantine: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex],
        energy: typing.SupportsFloat | typing.SupportsIndex,
        k: typing.SupportsInt | typing.SupportsIndex | None = None,
    ) -> dict:
        """
        Worst covariance of a given energy.

        Parameters
        ----------
        byzantine : sequence of int
            Attacked agents, at least one.
        energy : float
            Trace of the covariance, >= 0.
        k : int, optional
            For step k alone (37); default: for the periodic steady state.

        Returns
        -------
        dict
            With B attacked agents: form (B m, B m), what a covariance costs: tr(covariance form); direction (B
            m,); gain, the largest cost; covariance (B m, B m) that reaches it.

        Raises
        ------
        InvalidInput
            A bad agent or energy, or unstable error dynamics.
        """
    @property
    def bytes_per_step(self) -> int:
        """
        Payload of all messages of one sample.
        """
    @property
    def selection(self) -> Selection:
        """
        Which entries are shared when.
        """
    @property
    def shared_fraction(self) -> float:
        """
        p_e = l/m, the largest of the agents.
        """

class WorstAttack(garrison._core.Attack):
    """
    A coordinated attack of largest effect; usable wherever an attack is.
    """
    def __getstate__(self) -> dict: ...
    def __reduce__(self) -> tuple: ...
    def __setstate__(self, arg0: dict) -> None: ...
    @property
    def covariance(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (B m, B m), Byzantine agents in ascending order.
        """
    @property
    def direction(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        Unit top eigenvector of the form, largest entry positive.
        """
    @property
    def form(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        What any covariance costs: tr(covariance form).
        """
    @property
    def gain(self) -> float:
        """
        What it adds to the NMSE: in the mean of a cycle (steady), or in one step.
        """

class SelectionProblem:
    """
    max s'Gs over 0/1 vectors of `blocks` blocks with at most `most` ones each (31)-(36).

    Parameters
    ----------
    G : (B m, B m) array
        Symmetric, positive semidefinite.
    blocks : int
        B >= 1.
    most : int
        0..m.

    Raises
    ------
    InvalidInput
        Shapes do not fit, or a number is out of range.
    """
    def __copy__(self) -> typing.Any: ...
    def __deepcopy__(self, memo: dict) -> typing.Any: ...
    def __eq__(self, other: typing.Any) -> typing.Any: ...
    def __getstate__(self) -> dict: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        G: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
        blocks: typing.SupportsInt | typing.SupportsIndex,
        most: typing.SupportsInt | typing.SupportsIndex,
    ) -> None: ...
    def __reduce__(self) -> tuple: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, arg0: dict) -> None: ...
    def ascent(
        self,
        start: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
        sweeps: typing.SupportsInt | typing.SupportsIndex,
        factor: typing.SupportsFloat | typing.SupportsIndex = 2.0,
        newest: bool = True,
        rounding: bool = False,
    ) -> dict:
        """
        Algorithm 2. Only factor 2 with newest is monotone.

        Parameters
        ----------
        start : (B m,) array
            Zeros and ones to begin with.
        sweeps : int
            >= 0.
        factor : float
            1 is (36) as printed, 2 the true dependence on a block.
        newest : bool
            Blocks see the newest of the others (Gauss-Seidel), else those of the sweep before (Jacobi,
            as printed).
        rounding : bool
            Make the `most` largest entries of each block 1 at the end, as printed.

        Returns
        -------
        dict
            s (B m,), objective before the first sweep and after each, and rounded, the objective after
            rounding.

        Raises
        ------
        InvalidInput
            A wrong size, or a number out of range.
        """
    def best_of_starts(
        self,
        starts: typing.SupportsInt | typing.SupportsIndex = 16,
        seed: typing.SupportsInt | typing.SupportsIndex = 0,
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        Best fixed point of monotone sweeps from random starts.

        Parameters
        ----------
        starts : int
            How many, >= 1.
        seed : int
            Of the starts, >= 0; equal seeds give equal answers.

        Returns
        -------
        (B m,) array

        Raises
        ------
        InvalidInput
            A number out of range.
        """
    def exact(self, max_nodes: typing.SupportsInt | typing.SupportsIndex = 5000000) -> dict:
        """
        Global maximum by branch and bound.

        Parameters
        ----------
        max_nodes : int
            The search ends after so many parts of sets, >= 1.

        Returns
        -------
        dict
            s (B m,) and objective, the best found; exact: whether the search ended; upper, a bound on the
            maximum; nodes looked at.

        Raises
        ------
        InvalidInput
            max_nodes < 1.
        """
    def objective(self, s: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"]) -> float:
        """
        s'Gs.

        Parameters
        ----------
        s : (B m,) array
            Any numbers.

        Returns
        -------
        float

        Raises
        ------
        InvalidInput
            A wrong size.
        """

def worst_covariance(
    analysis: Analysis,
    byzantine: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex],
    energy: typing.SupportsFloat | typing.SupportsIndex,
    kind: str,
    start: typing.SupportsInt | typing.SupportsIndex,
    stop: typing.SupportsInt | typing.SupportsIndex | None,
) -> WorstAttack:
    """
    Use garrison.attacks.worst_covariance.

    Parameters
    ----------
    analysis : Analysis
        Of the filter that is attacked.
    byzantine : sequence of int
        Attacked agents, at least one.
    energy : float
        Trace of the covariance, >= 0.
    kind : str
        "steady" or "one_step".
    start : int
        First sample that is attacked.
    stop : int or None
        First sample that is not attacked any more; None = never.

    Returns
    -------
    WorstAttack

    Raises
    ------
    InvalidInput
        A bad agent, energy or kind, or unstable error dynamics.
    """
