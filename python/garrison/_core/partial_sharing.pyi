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
    Which entries every agent shares, and when.
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
    ) -> None:
        """
        start: (N, m) of zeros and ones; shift: tau.
        """
    def __reduce__(self) -> tuple: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, arg0: dict) -> None: ...
    def at(
        self, k: typing.SupportsInt | typing.SupportsIndex
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        s(k), (N, m).
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
    Exact covariances, stability and attacks of a PartialSharing filter on a model and network.

    N agents, m states; network covariances are (N m, N m), agent by agent. k counts samples from
    0: k = t - 1. Sigma: (N m, N m), zero on regular agents, None = no attack. P_0 and the start
    belong to k = 0.
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
        """
    def cycle_radius(self) -> float:
        """
        Exact stability: below 1 exactly when covariances stay bounded (per sample).
        """
    def decrease_matrix(
        self, gamma: typing.SupportsFloat | typing.SupportsIndex, phase: typing.SupportsInt | typing.SupportsIndex = 0
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        M(gamma) of note 7 at a phase, (N m, N m).
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
        (29) along Algorithm 1, gains of (11) from P_0 on: nmse (steps + 1,), P at the end.
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
        (4)-(7) with cross-covariances, for comparison: not always better than Algorithm 1 (note 16).
        """
    def gains(self, k: typing.SupportsInt | typing.SupportsIndex) -> dict:
        """
        P_i(k) of (11) and the gains of step k: P, K, C, F.
        """
    def gamma_lyapunov(self) -> float:
        """
        Certified: no gain up to here lets the Lyapunov function of the errors grow.
        """
    def gamma_star(self, fraction: typing.SupportsFloat | typing.SupportsIndex | None = None) -> float:
        """
        (22), advisory: false as printed, vacuous when 0: docs/filters/partial_sharing.md#m7.
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
        (23)-(26) per agent. moments: "p_e" is (26) as printed, "full" the same with p_e = 1, "uniform" and
        "cycle" are (25) with exact moments over random starts, or on this cycle. Not the true covariance.
        """
    def mse_local(
        self,
        moments: str,
        Sigma: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"] | None = None,
        byzantine: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] | None = None,
    ) -> float:
        """
        Their (38).
        """
    def periodic_covariance(
        self,
        Sigma: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"] | None = None,
        byzantine: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] | None = None,
    ) -> list[typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]]:
        """
        Exact periodic steady state of (29), one (N m, N m) per phase. Raises InvalidInput when unstable.
        """
    def periodic_mse(
        self,
        Sigma: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"] | None = None,
        byzantine: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] | None = None,
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        Its MSE = trace / N by phase.
        """
    def recursion8(
        self,
        Sigma: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"] | None,
        k0: typing.SupportsInt | typing.SupportsIndex,
        steps: typing.SupportsInt | typing.SupportsIndex,
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        MSE' after each update (8) from the steady state on.
        """
    def spread(
        self,
        byzantine: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex],
        block: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (B m, B m) of the Byzantine agents as (N m, N m).
        """
    def steady_attack_matrix(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        N of note 13 for all agents: tr(Sigma N) is what any Sigma adds to the cycle-averaged NMSE.
        """
    def steady_gains(self) -> dict:
        """
        Limits of (9), (11) per agent: P, K, C, F. Raises InvalidInput for an undetectable agent.
        """
    def top_degree(self, count: typing.SupportsInt | typing.SupportsIndex) -> list[int]:
        """
        The agents that most others hear, sorted.
        """
    def worst(
        self,
        byzantine: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex],
        energy: typing.SupportsFloat | typing.SupportsIndex,
        k: typing.SupportsInt | typing.SupportsIndex | None = None,
    ) -> dict:
        """
        Worst covariance with trace <= energy: for the periodic steady state, or for step k alone (37).
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
        Algorithm 2. factor 1 is (36) as printed, 2 the true dependence; newest: Gauss-Seidel, else Jacobi as
        printed. Only factor 2 with newest is monotone. Keys: s, objective per sweep, rounded.
        """
    def best_of_starts(
        self,
        starts: typing.SupportsInt | typing.SupportsIndex = 16,
        seed: typing.SupportsInt | typing.SupportsIndex = 0,
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        Best fixed point of monotone sweeps from random starts.
        """
    def exact(self, max_nodes: typing.SupportsInt | typing.SupportsIndex = 5000000) -> dict:
        """
        Global maximum by branch and bound.
        """
    def objective(self, s: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"]) -> float:
        """
        s'Gs, s (B m,).
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
    """
