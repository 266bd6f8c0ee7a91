"""
Run-time certificates: bounds on an estimate's error whatever at most s sensors say.
"""

from __future__ import annotations
import collections.abc
import numpy
import numpy.typing
import typing

__all__: list[str] = [
    "Bank",
    "ErrorSystem",
    "GaussianTable",
    "Kernels",
    "Meters",
    "ObserverTable",
    "Propagation",
    "Recovery",
    "Region",
    "SmallestAttack",
    "SparseMeters",
    "Table",
    "TwoNumbers",
    "Window",
    "WindowWitness",
    "Witness",
    "accepted",
    "after_injection",
    "anytime_window",
    "averaged",
    "bank_steady",
    "bank_steady_width",
    "calibrated_levels",
    "cells",
    "chi",
    "ellipsoid",
    "empirical_quantile",
    "error_system",
    "gaussian_levels",
    "gaussian_table",
    "hull_window",
    "informed",
    "informed_gaussian",
    "intersection",
    "interval",
    "kernels",
    "leverage_ball",
    "leverage_window",
    "lists_complete",
    "meters",
    "noise_root",
    "observer_table",
    "order_bound",
    "order_rule",
    "order_rule_box",
    "range_row",
    "scan",
    "smallest_undetectable",
    "sparse_meters",
    "sub_gaussian_chi",
    "sub_gaussian_levels",
    "sub_gaussian_two_sided",
    "subsets_window",
    "subsets_window_width",
    "table",
    "two_sided",
    "whiteness",
    "window_levels",
    "witness_subsets",
]

class Region:
    """
    ||x - center|| <= radius, |x_k - center_k| <= box_k where there is a box, and (x - center)' shape^-1 (x -
    center) <= stretch^2 where there is a shape. radius inf: the rows at hand cannot answer; nan: the data
    refute the assumption.

    Parameters
    ----------
    center : (n,) array
        Finite.
    radius : float
        >= 0, inf or nan.
    box : (n,) array, optional
        Half widths, finite and >= 0.

    Raises
    ------
    InvalidInput
        A number out of range, or a wrong size.
    """
    def __init__(
        self,
        center: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
        radius: typing.SupportsFloat | typing.SupportsIndex,
        box: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"] | None = None,
    ) -> None: ...
    def __reduce__(self) -> tuple: ...
    def bound_around(self, estimate: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]) -> float:
        """
        Bound on ||estimate - x|| for any estimate.

        Parameters
        ----------
        estimate : (n,) array
            Finite.

        Returns
        -------
        float
            inf without an answer, nan when refuted.

        Raises
        ------
        InvalidInput
            A wrong size, or a number that is not finite.
        """
    @property
    def answered(self) -> bool:
        """
        radius is finite
        """
    @property
    def box(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"] | None:
        """
        (n,), None where there is none
        """
    @property
    def center(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"] | None:
        """
        (n,), None without an answer
        """
    @property
    def radius(self) -> float:
        """
        ||x - center|| is at most this; inf = the rows at hand cannot answer, nan = the data refute the assumption.
        """
    @property
    def refuted(self) -> bool:
        """
        radius is nan: more than s are attacked
        """
    @property
    def shape(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"] | None:
        """
        (n, n), None where there is none
        """
    @property
    def stretch(self) -> float:
        """
        (x - center)' shape^-1 (x - center) <= stretch^2.
        """

class Witness:
    """
    Answer of leverage_ball and witness_subsets.
    """
    def __reduce__(self) -> tuple: ...
    @property
    def box(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"] | None:
        """
        region.box
        """
    @property
    def center(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"] | None:
        """
        region.center
        """
    @property
    def kept(self) -> list[bool]:
        """
        per row: neither of a proved source nor refuted; False for rows that are absent
        """
    @property
    def proved(self) -> list[int]:
        """
        sources shown to be attacked, with those given
        """
    @property
    def radius(self) -> float:
        """
        region.radius
        """
    @property
    def region(self) -> Region:
        """
        Where the state is.
        """

class ErrorSystem:
    """
    E(t) = M E(t-1) + B_w w(t-1) + B (v(t) + a(t)), agent by agent.
    """
    def __reduce__(self) -> tuple: ...
    @property
    def B(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (N n, N)
        """
    @property
    def B_w(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (N n, n)
        """
    @property
    def M(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (N n, N n)
        """

class Kernels:
    """
    What k steps of the error system do: gb, ge (K, N, N), wb, we (K, N),
    Rb, Re (K+1, N, N).
    """
    def __reduce__(self) -> tuple: ...
    @property
    def Rb(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (K + 1, N, N): [k, i, l] = ||(M^k)_il||.
        """
    @property
    def Re(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (K + 1, N, N): [k, j, l] = |C_j A (M^k)_jl|.
        """
    @property
    def gb(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (K, N, N): [k, i, l] = |block i of M^k B, column l|.
        """
    @property
    def ge(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (K, N, N): [k, j, l] = |C_j A (block j of M^k B, column l)|.
        """
    @property
    def wb(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (K, N): ||block i of M^k B_w||.
        """
    @property
    def we(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (K, N): |C_j A (block j of M^k B_w)|.
        """
    @property
    def window(self) -> int:
        """
        K, how many powers.
        """

class Table:
    """
    Data-free bounds, row t = 0..T, column = agent; infinite where they overflow.
    """
    def __reduce__(self) -> tuple: ...
    @property
    def H(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (T+1, N): bounds on honest innovations; row 0 is nan
        """
    @property
    def d(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (T+1, N): bounds on ||e_i(t)||
        """
    @property
    def eta(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (T+1, N): bounds on |C_j A e_j(t)|
        """
    @property
    def level(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (T+1, N): H or beta; row 0 is nan
        """
    @property
    def steady(self) -> typing.Any:
        """
        {d, eta} (N,) that hold from T on for ever; None: none known
        """

class GaussianTable:
    """
    Table for Gaussian noise; d and eta without the noise itself.
    """
    def __reduce__(self) -> tuple: ...
    def bound(
        self, t: typing.SupportsInt | typing.SupportsIndex, delta: typing.SupportsFloat | typing.SupportsIndex
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        Bounds at one step; each fails with probability <= N T P(|N(0,1)| > z) + delta.

        Parameters
        ----------
        t : int
            0..T.
        delta : float
            Above 0 and below 1.

        Returns
        -------
        (N,) array
            On ||e_i(t)||.

        Raises
        ------
        InvalidInput
            A number out of range.
        """
    @property
    def deviation(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (T+1, N): sqrt of the largest eigenvalue of P_ii
        """
    @property
    def table(self) -> Table:
        """
        Bounds of the run, tested with the limit of the covariance.
        """

class Propagation:
    """
    Regions of some steps ago as regions of today, prepared once.
    """
    @staticmethod
    def bounded(
        A: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
        steps: typing.SupportsInt | typing.SupportsIndex,
        bw: typing.SupportsFloat | typing.SupportsIndex,
    ) -> Propagation:
        """
        For ||w|| <= bw.

        Parameters
        ----------
        A : (n, n) array
            Of the plant.
        steps : int
            Ages 0..steps are prepared.
        bw : float
            >= 0.

        Returns
        -------
        Propagation

        Raises
        ------
        InvalidInput
            A number out of range, or powers of A that overflow.
        """
    @staticmethod
    def bounded_entries(
        A: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
        steps: typing.SupportsInt | typing.SupportsIndex,
        Gam: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
        bw: typing.SupportsFloat | typing.SupportsIndex,
    ) -> Propagation:
        """
        For w = Gam w~ with |w~_i| <= bw.

        Parameters
        ----------
        A : (n, n) array
            Of the plant.
        steps : int
            Ages 0..steps are prepared.
        Gam : (n, q) array
            How the noise enters.
        bw : float
            >= 0.

        Returns
        -------
        Propagation

        Raises
        ------
        InvalidInput
            A number out of range, or powers of A that overflow.
        """
    @staticmethod
    def gaussian(
        A: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
        steps: typing.SupportsInt | typing.SupportsIndex,
        Q: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
        delta: typing.SupportsFloat | typing.SupportsIndex,
    ) -> Propagation:
        """
        For w ~ N(0, Q), white.

        Parameters
        ----------
        A : (n, n) array
            Of the plant.
        steps : int
            Ages 0..steps are prepared.
        Q : (n, n) array
            Covariance.
        delta : float
            Probability to fail per use, above 0 and below 1.

        Returns
        -------
        Propagation

        Raises
        ------
        InvalidInput
            A number out of range, no covariance, or powers of A that overflow.
        """
    @staticmethod
    def gaussian_entries(
        A: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
        steps: typing.SupportsInt | typing.SupportsIndex,
        Gam: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
        zc: typing.SupportsFloat | typing.SupportsIndex,
        z2: typing.SupportsFloat | typing.SupportsIndex,
    ) -> Propagation:
        """
        For w = Gam w~, w~ ~ N(0, I).

        Parameters
        ----------
        A : (n, n) array
            Of the plant.
        steps : int
            Ages 0..steps are prepared.
        Gam : (n, q) array
            How the noise enters.
        zc : float
            Level of each coordinate, >= 0.
        z2 : float
            Level of the vector, >= 0.

        Returns
        -------
        Propagation

        Raises
        ------
        InvalidInput
            A number out of range, or powers of A that overflow.
        """
    def __reduce__(self) -> tuple: ...
    def age(self, then: Region, age: typing.SupportsInt | typing.SupportsIndex) -> Region:
        """
        The Region of today for one that held some steps ago; its box is never wider than what the ball, the box and
        the ellipsoid give. Known inputs move the centre: add theirs.

        Parameters
        ----------
        then : Region
            Of n states.
        age : int
            0..steps.

        Returns
        -------
        Region

        Raises
        ------
        InvalidInput
            Another size, or an age out of range.
        """

class Recovery:
    """
    L: excess over the table after lost messages. A state is (lam, x): every agent behind the estimate was
    within x of the lossless run at time lam, and nothing was lost after; (0, 0) at the start.

    Parameters
    ----------
    kernels : Kernels
        Of kernels().
    s : int
        Sensors attacked at a time, >= 0.

    Raises
    ------
    InvalidInput
        s < 0.
    """
    @staticmethod
    def lost(
        t: typing.SupportsInt | typing.SupportsIndex,
        b: typing.SupportsFloat | typing.SupportsIndex,
        d: typing.SupportsFloat | typing.SupportsIndex,
    ) -> tuple[int, float]:
        """
        The state after a loss.

        Parameters
        ----------
        t : int
            Step of the loss.
        b : float
            Bounds ||e_i(t)||.
        d : float
            d_i(t) of the table.

        Returns
        -------
        (lam, x)
        """
    def __init__(self, kernels: Kernels, s: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __reduce__(self) -> tuple: ...
    def error_excess(
        self,
        agent: typing.SupportsInt | typing.SupportsIndex,
        state: tuple[typing.SupportsInt | typing.SupportsIndex, typing.SupportsFloat | typing.SupportsIndex],
        t: typing.SupportsInt | typing.SupportsIndex,
    ) -> float:
        """
        ||e_i(t)|| is at most d_i(t) of the table and this.

        Parameters
        ----------
        agent : int
            0..N-1.
        state : (lam, x)
            lam <= t, x >= 0.
        t : int
            Present step.

        Returns
        -------
        float

        Raises
        ------
        InvalidInput
            There is no such agent or state.
        """
    def level_excess(
        self,
        agent: typing.SupportsInt | typing.SupportsIndex,
        state: tuple[typing.SupportsInt | typing.SupportsIndex, typing.SupportsFloat | typing.SupportsIndex],
        t: typing.SupportsInt | typing.SupportsIndex,
    ) -> float:
        """
        The level of t + 1 is that of the table and this.

        Parameters
        ----------
        agent : int
            0..N-1.
        state : (lam, x)
            lam <= t, x >= 0.
        t : int
            Present step.

        Returns
        -------
        float

        Raises
        ------
        InvalidInput
            There is no such agent or state.
        """
    def merge(
        self,
        p: tuple[typing.SupportsInt | typing.SupportsIndex, typing.SupportsFloat | typing.SupportsIndex],
        q: tuple[typing.SupportsInt | typing.SupportsIndex, typing.SupportsFloat | typing.SupportsIndex],
        t: typing.SupportsInt | typing.SupportsIndex,
    ) -> tuple[int, float]:
        """
        Of two states seen at one time, the one that dominates both.

        Parameters
        ----------
        p, q : (lam, x)
            lam <= t, x >= 0.
        t : int
            Present step.

        Returns
        -------
        (lam, x)

        Raises
        ------
        InvalidInput
            No such state.
        """
    def rebase(
        self,
        state: tuple[typing.SupportsInt | typing.SupportsIndex, typing.SupportsFloat | typing.SupportsIndex],
        t: typing.SupportsInt | typing.SupportsIndex,
    ) -> tuple[int, float]:
        """
        The state seen at time t: carried over every multiple of K.

        Parameters
        ----------
        state : (lam, x)
            lam <= t, x >= 0.
        t : int
            Present step.

        Returns
        -------
        (lam, x)

        Raises
        ------
        InvalidInput
            No such state.
        """
    @property
    def rb(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (K+1, N)
        """
    @property
    def re(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (K+1, N)
        """

class TwoNumbers:
    """
    M: bound rho + sqrt((N-1)/N) p for unknown averaging with ||J - 11'/N|| <= gamma per step.

    Parameters
    ----------
    A : (n, n) array
        Of the plant.
    C : (N, n) array
        Rows of length 1, or 0.
    s : int
        Sensors attacked at a time, >= 0.
    rho : float
        Bound on the mean of the errors at the start, >= 0.
    p : float
        Bound on their deviations from the mean at the start, >= 0.
    bw : float
        ||w|| <= bw, >= 0.
    bv : (N,) array
        |v_j| <= bv[j], >= 0.

    Raises
    ------
    InvalidInput
        Shapes do not fit, or a number is out of range.
    """
    def __init__(
        self,
        A: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
        C: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
        s: typing.SupportsInt | typing.SupportsIndex,
        rho: typing.SupportsFloat | typing.SupportsIndex,
        p: typing.SupportsFloat | typing.SupportsIndex,
        bw: typing.SupportsFloat | typing.SupportsIndex,
        bv: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    ) -> None: ...
    def __reduce__(self) -> tuple: ...
    def step(self, gamma: typing.SupportsFloat | typing.SupportsIndex) -> float:
        """
        One step.

        Parameters
        ----------
        gamma : float
            >= 0, of this step.

        Returns
        -------
        float
            Bound on every ||e_i||; inf once it overflowed.

        Raises
        ------
        InvalidInput
            gamma < 0.
        """
    @property
    def bound(self) -> float:
        """
        On the error of every agent: rho and its share of p; inf = none.
        """
    @property
    def constants(self) -> dict: ...
    @property
    def levels(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (N,): adaptive levels of the coming step
        """
    @property
    def p(self) -> float:
        """
        Bound on their deviations from the mean.
        """
    @property
    def rho(self) -> float:
        """
        Bound on the mean of the errors.
        """

class Window:
    """
    The measurements of several steps as one regression z = N theta + o, for x(k+1) = A x(k) + u + Gam w~(k).
    Call begin, a prior, then for each step add its rows and advance.

    Parameters
    ----------
    states : int
        n >= 1.
    noise : int
        Columns of Gam, >= 0.
    steps : int
        Most steps, >= 1.
    sources : int
        Sources are 0..sources-1, >= 1.
    capacity : int
        Most measurements, >= 1.

    Raises
    ------
    InvalidInput
        A number out of range, or more than memory is meant for.
    """
    def __init__(
        self,
        states: typing.SupportsInt | typing.SupportsIndex,
        noise: typing.SupportsInt | typing.SupportsIndex,
        steps: typing.SupportsInt | typing.SupportsIndex,
        sources: typing.SupportsInt | typing.SupportsIndex,
        capacity: typing.SupportsInt | typing.SupportsIndex,
    ) -> None: ...
    def __reduce__(self) -> tuple: ...
    def add(
        self,
        source: typing.SupportsInt | typing.SupportsIndex,
        c: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
        y: typing.SupportsFloat | typing.SupportsIndex,
        variance: typing.SupportsFloat | typing.SupportsIndex,
        bias: typing.SupportsFloat | typing.SupportsIndex = 0.0,
        bounded: bool = False,
    ) -> bool:
        """
        A measurement y = c x + v of the present step.

        Parameters
        ----------
        source : int
            Whose it is, 0..sources-1.
        c : (n,) array
            Its row.
        y : float
            nan = missing.
        variance : float
            v ~ N(0, variance), > 0.
        bias : float
            At most so much on top, >= 0.
        bounded : bool
            |v| <= bias alone.

        Returns
        -------
        bool
            False: it says nothing (nan, c = 0, no such source, full, ..) and is left out.
        """
    def advance(
        self,
        A: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
        Gam: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
        u: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    ) -> None:
        """
        To the next step.

        Parameters
        ----------
        A : (n, n) array
            Of the plant.
        Gam : (n, noise) array
            How the noise enters.
        u : (n,) array
            Known input.

        Raises
        ------
        InvalidInput
            Shapes do not fit, or beyond the last step.
        """
    def begin(
        self,
        steps: typing.SupportsInt | typing.SupportsIndex,
        process_bound: typing.SupportsFloat | typing.SupportsIndex = ...,
    ) -> None:
        """
        Empties the window.

        Parameters
        ----------
        steps : int
            Of this window, 1..the most.
        process_bound : float
            |w~_i| <= process_bound, > 0; nan: w~ ~ N(0, I).

        Raises
        ------
        InvalidInput
            A number out of range.
        """
    def prior_gaussian(
        self,
        c0: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
        P0: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    ) -> None:
        """
        x(0) - c0 ~ N(0, P0), right after begin.

        Parameters
        ----------
        c0 : (n,) array
            Finite.
        P0 : (n, n) array
            Positive definite.

        Raises
        ------
        InvalidInput
            A wrong size, no such covariance, or not right after begin.
        """
    def prior_set(
        self,
        c0: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
        P0: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
        r0: typing.SupportsFloat | typing.SupportsIndex,
        weight: typing.SupportsFloat | typing.SupportsIndex = 4.0,
    ) -> None:
        """
        (x(0) - c0)' P0^-1 (x(0) - c0) <= r0^2 for certain, right after begin.

        Parameters
        ----------
        c0 : (n,) array
            Finite.
        P0 : (n, n) array
            Positive definite.
        r0 : float
            >= 0.
        weight : float
            As how many deviations r0 counts, > 0.

        Raises
        ------
        InvalidInput
            A wrong size, a number out of range, or not right after begin.
        """
    @property
    def E(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (n, unknowns): x = E theta + o
        """
    @property
    def N(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (rows, unknowns)
        """
    @property
    def bias(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (rows,): bounds on top of the noise, in deviations
        """
    @property
    def gaussian(self) -> list[bool]:
        """
        per row: N(0, 1) noise
        """
    @property
    def o(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (n,)
        """
    @property
    def prior_length(self) -> float:
        """
        bound on the errors of a set prior together
        """
    @property
    def rows(self) -> int:
        """
        how many, process noise and prior included
        """
    @property
    def source(self) -> list[int]:
        """
        per row; -1: honest (process noise, prior)
        """
    @property
    def step_of(self) -> list[int]:
        """
        per row; -1: process noise
        """
    @property
    def z(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (rows,)
        """

class WindowWitness:
    """
    Answer of a certificate with memory.
    """
    def __reduce__(self) -> tuple: ...
    @property
    def box(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"] | None:
        """
        (n,): |x_i - center_i| <= box_i; None without an answer
        """
    @property
    def center(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"] | None:
        """
        (n,), None without an answer
        """
    @property
    def count(self) -> int:
        """
        consistent subsets, leaves or living members behind it
        """
    @property
    def dropped(self) -> list[int]:
        """
        sources whose rows were not used: the proved, or, where the region is refuted, more than s that contradict, of which no single one is proved
        """
    @property
    def dropped_at(self) -> dict[int, list[int]]:
        """
        {step: sources}: the same with a moving set
        """
    @property
    def mu(self) -> float:
        """
        1 - lambda of W2M: what the attackers leave of the information; nan where it does not apply
        """
    @property
    def proved(self) -> list[int]:
        """
        sources shown to be attacked, with those given; none where the region is refuted
        """
    @property
    def proved_at(self) -> dict[int, list[int]]:
        """
        {step: sources}, with a moving set; none where the region is refuted
        """
    @property
    def radius(self) -> float:
        """
        of the ball; inf: the rows cannot answer; nan: more than s are attacked
        """
    @property
    def region(self) -> Region:
        """
        Where the state is.
        """
    @property
    def shape(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"] | None:
        """
        (n, n): (x - center)' shape^-1 (x - center) <= stretch^2; None without an answer
        """
    @property
    def stretch(self) -> float:
        """
        (x - center)' shape^-1 (x - center) <= stretch^2.
        """

class Bank:
    """
    B: one Kalman filter per set of s sources left out; the attacked set never changes.

    Parameters
    ----------
    A : (n, n) array
        Of the plant.
    Q : (n, n) array
        Covariance of the process noise.
    sources : sequence of ((k, n) array, (k,) array)
        Rows and variances (> 0) of each source.
    s : int
        Attacked sources, >= 0.
    limit : int
        Most members; C(sources, s) are needed.

    Raises
    ------
    InvalidInput
        Shapes do not fit, no covariance, or too many members.
    """
    def __init__(
        self,
        A: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
        Q: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
        sources: collections.abc.Sequence[
            tuple[
                typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
                typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
            ]
        ],
        s: typing.SupportsInt | typing.SupportsIndex,
        limit: typing.SupportsInt | typing.SupportsIndex = 5000,
    ) -> None: ...
    def __reduce__(self) -> tuple: ...
    def merge(
        self, most: typing.SupportsInt | typing.SupportsIndex, z2: typing.SupportsFloat | typing.SupportsIndex
    ) -> None:
        """
        Fewer members from now on, each leaving out more.

        Parameters
        ----------
        most : int
            Members that stay at most, >= 1.
        z2 : float
            As of update; the answer fails with delta(z2) more each time.

        Raises
        ------
        InvalidInput
            A number out of range.
        """
    def restart(self, region: Region) -> None:
        """
        All members anew from a region that contains x.

        Parameters
        ----------
        region : Region
            With an answer; it may depend on all data so far.

        Raises
        ------
        InvalidInput
            A wrong size, or no answer.
        """
    def start_gaussian(
        self,
        c0: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
        P0: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    ) -> None:
        """
        x - c0 ~ N(0, P0) before the first update.

        Parameters
        ----------
        c0 : (n,) array
            Finite.
        P0 : (n, n) array
            Covariance.

        Raises
        ------
        InvalidInput
            A wrong size, or no covariance.
        """
    def start_set(
        self,
        c0: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
        P0: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
        r0: typing.SupportsFloat | typing.SupportsIndex,
    ) -> None:
        """
        (x - c0)' P0^-1 (x - c0) <= r0^2 before the first update.

        Parameters
        ----------
        c0 : (n,) array
            Finite.
        P0 : (n, n) array
            Positive semidefinite.
        r0 : float
            >= 0.

        Raises
        ------
        InvalidInput
            A wrong size, or a number out of range.
        """
    def start_unknown(self) -> None:
        """
        All members anew with nothing known of x: no region before the rows of all living members have
        determined it.
        """
    def update(
        self,
        y: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
        z1: typing.SupportsFloat | typing.SupportsIndex,
        z2: typing.SupportsFloat | typing.SupportsIndex,
        zc: typing.SupportsFloat | typing.SupportsIndex,
        *,
        A: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"] | None = None,
        u: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"] | None = None,
        Q: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"] | None = None,
        sources: collections.abc.Sequence[
            tuple[
                typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
                typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
            ]
        ]
        | None = None,
        predict: bool = True,
    ) -> WindowWitness:
        """
        Theorem B: one step.

        Parameters
        ----------
        y : array
            All outputs one after the other; nan = missing.
        z1, z2, zc : float
            window_levels(), >= 0.
        A, Q : (n, n) array, optional
            Where they differ from the design's.
        u : (n,) array, optional
            Known input.
        sources : as in Bank, optional
            Where they differ from the design's; of the same sizes.
        predict : bool
            False: the measurements belong to the same time as those before.

        Returns
        -------
        WindowWitness
            Refuted when no member lives: restart then.

        Raises
        ------
        InvalidInput
            A wrong size, or a number out of range.
        """
    @property
    def count(self) -> int:
        """
        living members
        """
    @property
    def dependence(self) -> tuple[float, int, float, float]:
        """
        (evidence, source, correlation, pairs): what the innovations of all living members say against white noise, of
        which evidence ever exceeds e with probability at most exp(-e); -inf where nothing was compared.
        """
    @property
    def left_out(self) -> list[list[int]]:
        """
        per living member: the sources it does not read
        """

class ObserverTable:
    """
    Row t = 0..T; infinite from where it overflows or exceeds 1e12.
    """
    def __reduce__(self) -> tuple: ...
    @property
    def d(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (T+1, n+1): |e_i(t)|, and ||e(t)|| (last)
        """
    @property
    def eta(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (T+1, m): |C_r A e(t)|
        """
    @property
    def level(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (T+1, m): where innovations are clipped; row 0 is 0
        """

class SparseMeters:
    """
    What a large static set of meters withstands.
    """
    def __reduce__(self) -> tuple: ...
    @property
    def complete(self) -> bool:
        """
        every row was looked at
        """
    @property
    def critical(self) -> list[int]:
        """
        sources nobody checks
        """
    @property
    def example(self) -> list[int]:
        """
        `most` rows that can
        """
    @property
    def fewest(self) -> int:
        """
        no fewer rows are needed to lie unseen, for certain
        """
    @property
    def least(self) -> float:
        """
        the smallest eigenvalue of H'H is at least this, with rows of length 1
        """
    @property
    def leverage(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (rows,), with rows of length 1; nan: no time
        """
    @property
    def most(self) -> int:
        """
        so many can; as `fewest`: exact
        """
    @property
    def unseen(self) -> list[int]:
        """
        states of which it is not sure that the rows determine them; the rest is then empty
        """

class Meters:
    """
    What a static set of meters withstands.
    """
    def __reduce__(self) -> tuple: ...
    @property
    def bound(self) -> list[float]:
        """
        share of the information that k sources hold at most, k = 0..12
        """
    @property
    def critical(self) -> list[int]:
        """
        sources nobody checks
        """
    @property
    def leverage(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (sources,)
        """
    @property
    def liars(self) -> int:
        """
        any so many may lie and are contradicted
        """
    @property
    def removable(self) -> int:
        """
        any so many may be missing (a lower bound)
        """

class SmallestAttack:
    """
    The smallest set of meters that can lie unseen.
    """
    def __reduce__(self) -> tuple: ...
    @property
    def example(self) -> list[int]:
        """
        Such a set of meters; empty = none was found.
        """
    @property
    def searched(self) -> int:
        """
        no smaller one than this, or as large, for certain
        """
    @property
    def size(self) -> int | None:
        """
        None: none found
        """

def accepted(
    paths: collections.abc.Sequence[collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex]],
    liars: typing.SupportsInt | typing.SupportsIndex,
) -> bool:
    """
    Whether a flooded number is its owner's; the budget of the certificates is then s + liars.

    Parameters
    ----------
    paths : sequence of sequences of int
        (owner, relay, ..) of each that brought the same number.
    liars : int
        Agents that may lie, >= 0.

    Returns
    -------
    bool

    Raises
    ------
    InvalidInput
        liars < 0, an empty path, or paths of different owners.
    """

def after_injection(
    norm_A: typing.SupportsFloat | typing.SupportsIndex,
    b: typing.SupportsFloat | typing.SupportsIndex,
    bw: typing.SupportsFloat | typing.SupportsIndex,
    kappa: typing.SupportsFloat | typing.SupportsIndex,
) -> float:
    """
    R: norm_A b + bw + |kappa|, the bound after predicting and injecting a known innovation.

    Parameters
    ----------
    norm_A : float
        ||A||, >= 0.
    b : float
        Bound before, >= 0.
    bw : float
        Bound on the process noise, >= 0.
    kappa : float
        What was injected; finite.

    Returns
    -------
    float

    Raises
    ------
    InvalidInput
        A number out of range.
    """

def anytime_window(
    window: Window,
    s: typing.SupportsInt | typing.SupportsIndex,
    z1: typing.SupportsFloat | typing.SupportsIndex,
    z2: typing.SupportsFloat | typing.SupportsIndex,
    zc: typing.SupportsFloat | typing.SupportsIndex,
    *,
    leaves: typing.SupportsInt | typing.SupportsIndex,
    proved: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] = [],
    honest: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] = [],
) -> WindowWitness:
    """
    A: from leverage_window (1 leaf) to subsets_window (all), within a budget.

    Parameters
    ----------
    window : Window
        Filled up to its last step.
    s : int
        >= 0.
    z1, z2, zc : float
        window_levels(), >= 0; 0 with bounded noise.
    leaves : int
        Budget, >= 1: the cost is that of so many leverage_window.
    proved, honest : sequence of int
        Sources known to be so.

    Returns
    -------
    WindowWitness

    Raises
    ------
    InvalidInput
        A number out of range, or a window that is not filled.
    """

def averaged(
    weights: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    estimates: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    bounds: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
) -> Region:
    """
    R: Region around the weighted sum of the estimates that arrived.

    Parameters
    ----------
    weights : (q,) array
        Of any sign, with sum 1.
    estimates : (q, n) array
        One per row, finite.
    bounds : (q,) array
        On their errors, >= 0; inf or nan = none known.

    Returns
    -------
    Region

    Raises
    ------
    InvalidInput
        Sizes that differ, or a number out of range.
    """

def bank_steady(
    A: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    Q: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    sources: collections.abc.Sequence[
        tuple[
            typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
            typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
        ]
    ],
    s: typing.SupportsInt | typing.SupportsIndex,
    z1: typing.SupportsFloat | typing.SupportsIndex,
    z2: typing.SupportsFloat | typing.SupportsIndex,
    zc: typing.SupportsFloat | typing.SupportsIndex,
    limit: typing.SupportsInt | typing.SupportsIndex = 100000,
) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
    """
    B2, design time: what a living member's error never exceeds once the start has decayed.

    Parameters
    ----------
    A : (n, n) array
        Of the plant.
    Q : (n, n) array
        Covariance of the process noise.
    sources : as in Bank
        Every row is taken to arrive in each step.
    s : int
        Attacked sources, >= 0.
    z1, z2, zc : float
        Levels of the bank; z2 and zc at delta / C(sources, s).
    limit : int
        Most pairs of sets.

    Returns
    -------
    (n + 1,) array
        Per coordinate, and in the 2-norm (last); inf: not detectable without some 2s sources.

    Raises
    ------
    InvalidInput
        Shapes do not fit, a number out of range, or too many pairs.
    """

def bank_steady_width(
    A: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    Q: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    sources: collections.abc.Sequence[
        tuple[
            typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
            typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
        ]
    ],
    s: typing.SupportsInt | typing.SupportsIndex,
    z1: typing.SupportsFloat | typing.SupportsIndex,
    z2: typing.SupportsFloat | typing.SupportsIndex,
    zc: typing.SupportsFloat | typing.SupportsIndex,
    limit: typing.SupportsInt | typing.SupportsIndex = 100000,
) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
    """
    B2, design time: half widths that the box of a bank never exceeds once the start has decayed.

    Parameters
    ----------
    A : (n, n) array
        Of the plant.
    Q : (n, n) array
        Covariance of the process noise.
    sources : as in Bank
        Every row is taken to arrive in each step.
    s : int
        Attacked sources, >= 0.
    z1, z2, zc : float
        Levels of the bank; z2 and zc at delta / C(sources, s).
    limit : int
        Most pairs of sets.

    Returns
    -------
    (n,) array
        inf: not detectable without some 2s sources.

    Raises
    ------
    InvalidInput
        As bank_steady.
    """

def calibrated_levels(
    V: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    R: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    s: typing.SupportsInt | typing.SupportsIndex,
    delta: typing.SupportsFloat | typing.SupportsIndex,
) -> tuple[float, float]:
    """
    Distribution-free levels for one state and rows C = +-1. Exact for exchangeable samples.

    Parameters
    ----------
    V : (T, N) array
        Clean residuals, times C.
    R : (N,) array
        Variances, > 0.
    s : int
        Attacked sensors, 0..N-1.
    delta : float
        At least 2/(T+1), below 1.

    Returns
    -------
    (z1, z2)
        As of gaussian_levels.

    Raises
    ------
    InvalidInput
        A number out of range, or more than 2e8 sums would be needed.
    """

def cells(
    regions: collections.abc.Sequence[Region], s: typing.SupportsInt | typing.SupportsIndex
) -> tuple[
    typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
]:
    """
    C: per coordinate the hull of the points in all but s of the boxes.

    Parameters
    ----------
    regions : sequence of Region
        At least one; of disjoint cells of sources, or of distinct neighbours.
    s : int
        Regions that may be wrong, >= 0.

    Returns
    -------
    (lo, hi), (n,) arrays
        nan: more than s wrong; inf: not enough.

    Raises
    ------
    InvalidInput
        No region, sizes that differ, or s < 0.
    """

def chi(
    delta: typing.SupportsFloat | typing.SupportsIndex, degrees: typing.SupportsInt | typing.SupportsIndex
) -> float:
    """
    c with P(chi-square > c^2) = delta: the length that a standard Gaussian vector exceeds.

    Parameters
    ----------
    delta : float
        Above 0 and below 1.
    degrees : int
        Numbers of the vector, >= 1.

    Returns
    -------
    float

    Raises
    ------
    InvalidInput
        A number out of range.
    """

def ellipsoid(
    center: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    shape: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    stretch: typing.SupportsFloat | typing.SupportsIndex,
) -> Region:
    """
    The Region (x - center)' shape^-1 (x - center) <= stretch^2, with its box and ball.

    Parameters
    ----------
    center : (n,) array
        Finite.
    shape : (n, n) array
        Symmetric, positive semidefinite.
    stretch : float
        >= 0.

    Returns
    -------
    Region

    Raises
    ------
    InvalidInput
        Sizes that differ, or a number out of range.
    """

def empirical_quantile(
    measured: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    delta: typing.SupportsFloat | typing.SupportsIndex,
    confidence: typing.SupportsFloat | typing.SupportsIndex = 0.95,
) -> typing.Annotated[list[float], "FixedSize(3)"]:
    """
    A level that a share of clean numbers exceeds.

    Parameters
    ----------
    measured : (T,) array
        Clean numbers; nan = missing.
    delta : float
        The share, above 0 and below 1.
    confidence : float
        Of the interval, above 0 and below 1, if the numbers are independent.

    Returns
    -------
    (value, lower, upper)
        The level, and where the true one is; nan where T is too small.

    Raises
    ------
    InvalidInput
        A number out of range.
    """

def error_system(
    A: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    C: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    J: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    silent: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] = [],
) -> ErrorSystem:
    """
    Lemma 1: the errors of all agents as one system.

    Parameters
    ----------
    A : (n, n) array
        Of the plant.
    C : (N, n) array
        Rows of length 1, or 0.
    J : (N, N) array
        The averaging of one step, row sums 1.
    silent : sequence of int
        Sensors that inject nothing.

    Returns
    -------
    ErrorSystem

    Raises
    ------
    InvalidInput
        Shapes do not fit, or a row is not as said.
    """

def gaussian_levels(
    delta: typing.SupportsFloat | typing.SupportsIndex,
    rows: typing.SupportsInt | typing.SupportsIndex,
    states: typing.SupportsInt | typing.SupportsIndex,
) -> tuple[float, float]:
    """
    Levels of the witnesses that fail together with probability <= delta, half for each.

    Parameters
    ----------
    delta : float
        Above 0 and below 1.
    rows : int
        Measurements of one sample, >= 1.
    states : int
        n >= 1.

    Returns
    -------
    (z1, z2)
        Of every single measurement, and of the least-squares vector.

    Raises
    ------
    InvalidInput
        A number out of range.
    """

def gaussian_table(
    kernels: Kernels,
    *,
    s: typing.SupportsInt | typing.SupportsIndex,
    start: typing.SupportsFloat | typing.SupportsIndex,
    T: typing.SupportsInt | typing.SupportsIndex,
    Q: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
    R: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
    z: typing.SupportsFloat | typing.SupportsIndex,
    beta: typing.SupportsFloat | typing.SupportsIndex | None = None,
    fixed: bool = False,
) -> GaussianTable:
    """
    Theorem TG: the table for Gaussian noise.

    Parameters
    ----------
    kernels : Kernels
        Of kernels().
    s : int
        Sensors attacked at a time, >= 0.
    start : float
        Bound on all ||e_i(0)||, >= 0.
    T : int
        Last step, >= 1.
    Q : (n, n) array
        w ~ N(0, Q).
    R : (N,) array
        v_j ~ N(0, R[j]), >= 0.
    z : float
        Level of the event, in deviations, >= 0.
    beta : float, optional
        Fixed level, >= 0; None = adaptive.
    fixed : bool
        The attacked set never changes.

    Returns
    -------
    GaussianTable

    Raises
    ------
    InvalidInput
        A number out of range, or no covariance.
    """

def hull_window(
    window: Window,
    s: typing.SupportsInt | typing.SupportsIndex,
    limit: typing.SupportsInt | typing.SupportsIndex = 2000,
) -> tuple[
    typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
]:
    """
    Bounded noise, exactly: hull of the states that explain the rows, by linear programs over all sets of s
    sources left out.

    Parameters
    ----------
    window : Window
        Of bounded rows only, without a prior, filled up to its last step.
    s : int
        >= 0.
    limit : int
        Most sets, >= 1.

    Returns
    -------
    (lo, hi), (n,) arrays
        nan: more than s are attacked; inf: the rows cannot answer.

    Raises
    ------
    InvalidInput
        Another window, a number out of range, or more than `limit` sets.
    """

def informed(
    system: ErrorSystem,
    start: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
    steps: typing.SupportsInt | typing.SupportsIndex,
    bw: typing.SupportsFloat | typing.SupportsIndex,
    bv: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
    """
    Theorem I, bounded noise: bounds once all agents have proved all attackers.

    Parameters
    ----------
    system : ErrorSystem
        With the proved sensors silent.
    start : (N,) array
        Bounds on all ||e_l(t0)||, >= 0.
    steps : int
        >= 1.
    bw : float
        ||w|| <= bw, >= 0.
    bv : (N,) array
        |v_j| <= bv[j], >= 0.

    Returns
    -------
    (steps, N) array
        Row k-1 bounds ||e_i(t0 + k)||.

    Raises
    ------
    InvalidInput
        A number out of range, or sizes that differ.
    """

def informed_gaussian(
    system: ErrorSystem,
    start: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
    steps: typing.SupportsInt | typing.SupportsIndex,
    Q: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
    R: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
    P0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
    delta: typing.SupportsFloat | typing.SupportsIndex,
) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
    """
    Theorem I, Gaussian noise; each bound fails with probability delta.

    Parameters
    ----------
    system : ErrorSystem
        With the proved sensors silent.
    start : (N,) array
        Bounds on all ||e_l(t0)||, >= 0.
    steps : int
        >= 1.
    Q : (n, n) array
        w ~ N(0, Q).
    R : (N,) array
        v_j ~ N(0, R[j]), >= 0.
    P0 : (N n, N n) array
        Covariance of the noise part at t0: zero unless t0 was fixed in advance.
    delta : float
        Above 0 and below 1.

    Returns
    -------
    (steps, N) array
        Row k-1 bounds ||e_i(t0 + k)||.

    Raises
    ------
    InvalidInput
        A number out of range, no covariance, or sizes that differ.
    """

def intersection(regions: collections.abc.Sequence[Region]) -> Region:
    """
    The Region that all of these leave, which hold on the same event.

    Parameters
    ----------
    regions : sequence of Region
        At least one.

    Returns
    -------
    Region
        Refuted when it is empty.

    Raises
    ------
    InvalidInput
        No region, or sizes that differ.
    """

def interval(
    y: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    width: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    s: typing.SupportsInt | typing.SupportsIndex,
) -> tuple[float, float]:
    """
    W0, one state: the points that lie in at least m - s of the intervals y +- width.

    Parameters
    ----------
    y : (m,) array
        C y of sensors with C = +-1; nan = missing.
    width : (m,) array
        Bounds of their noise, >= 0.
    s : int
        >= 0.

    Returns
    -------
    (lo, hi)
        (nan, nan): more than s attacked; (-inf, inf): not enough rows.

    Raises
    ------
    InvalidInput
        Sizes that differ, or a number out of range.
    """

def kernels(system: ErrorSystem, window: typing.SupportsInt | typing.SupportsIndex) -> Kernels:
    """
    What so many steps of an error system do.

    Parameters
    ----------
    system : ErrorSystem
        Of error_system().
    window : int
        K >= 1 steps, best so many that Rb[K].sum(1) < 1e-3.

    Returns
    -------
    Kernels

    Raises
    ------
    InvalidInput
        K < 1, too large, or powers that overflow.
    """

def leverage_ball(
    y: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    C: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    R: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    s: typing.SupportsInt | typing.SupportsIndex,
    z1: typing.SupportsFloat | typing.SupportsIndex = 0.0,
    z2: typing.SupportsFloat | typing.SupportsIndex = 0.0,
    *,
    widths: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"] | None = None,
    prior: Region | None = None,
    proved: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] = [],
    sources: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] = [],
) -> Witness:
    """
    W2: region of the state from the rows of one sample. At most s of all sources lie.

    Parameters
    ----------
    y : (m,) array
        Measurements; nan = missing.
    C : (m, n) array
        Their rows.
    R : (m,) array
        Variances, > 0.
    s : int
        >= 0.
    z1, z2 : float
        gaussian_levels(), >= 0; 0 with bounded noise.
    widths : (m,) array, optional
        Bounded noise |v| <= width instead, >= 0.
    prior : Region, optional
        Contains x.
    proved : sequence of int
        Sources known to be attacked, which then must never change.
    sources : sequence of m int
        Of each row; empty = its position.

    Returns
    -------
    Witness

    Raises
    ------
    InvalidInput
        A number out of range, or sizes that differ.
    """

def leverage_window(
    window: Window,
    s: typing.SupportsInt | typing.SupportsIndex,
    z1: typing.SupportsFloat | typing.SupportsIndex,
    z2: typing.SupportsFloat | typing.SupportsIndex,
    zc: typing.SupportsFloat | typing.SupportsIndex,
    *,
    moving: bool = False,
    proved: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] = [],
    honest: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] = [],
) -> WindowWitness:
    """
    W2M: region of the state of the window's last step, at most s sources lie.

    Parameters
    ----------
    window : Window
        Filled up to its last step.
    s : int
        >= 0.
    z1, z2, zc : float
        window_levels(), >= 0; 0 with bounded noise.
    moving : bool
        s sources in each step, else one set for the whole window.
    proved, honest : sequence of int
        Sources known to be so.

    Returns
    -------
    WindowWitness

    Raises
    ------
    InvalidInput
        A number out of range, `proved` with a moving set, or a window that is not filled.
    """

def lists_complete(
    step: typing.SupportsInt | typing.SupportsIndex,
    diameter: typing.SupportsInt | typing.SupportsIndex,
    rounds: typing.SupportsInt | typing.SupportsIndex,
) -> int:
    """
    t0 of theorem I: the step from which all lists are complete.

    Parameters
    ----------
    step : int
        At whose end the first list was complete, >= 0.
    diameter : int
        Of the network, >= 0.
    rounds : int
        Hops per step, >= 1.

    Returns
    -------
    int

    Raises
    ------
    InvalidInput
        A number out of range.
    """

def meters(
    H: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    source: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] = [],
) -> Meters:
    """
    What a static set of meters withstands.

    Parameters
    ----------
    H : (rows, n) array
        Divided by the deviations, reference removed.
    source : sequence of int
        Of each row; empty = its position.

    Returns
    -------
    Meters

    Raises
    ------
    InvalidInput
        Shapes do not fit, or the rows do not determine the state.
    """

def noise_root(
    Q: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
    """
    Gam of Window.advance for process noise of a covariance: Gam Gam' = Q.

    Parameters
    ----------
    Q : (n, n) array
        Symmetric, positive semidefinite.

    Returns
    -------
    (n, k) array
        Without directions in which there is no noise.

    Raises
    ------
    InvalidInput
        No covariance.
    """

def observer_table(
    A: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    C: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    L: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    Gam: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    bv: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    *,
    s: typing.SupportsInt | typing.SupportsIndex,
    bw: typing.SupportsFloat | typing.SupportsIndex,
    start: typing.SupportsFloat | typing.SupportsIndex,
    T: typing.SupportsInt | typing.SupportsIndex,
    lags: typing.SupportsInt | typing.SupportsIndex,
    source: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] = [],
) -> ObserverTable:
    """
    O: bounds of one observer with clipped innovations, sets that move every step.

    Parameters
    ----------
    A : (n, n) array
        Of the plant.
    C : (m, n) array
        Rows.
    L : (n, m) array
        Gain.
    Gam : (n, q) array
        How the process noise enters.
    bv : (m,) array
        |v| <= bv, >= 0.
    s : int
        Sources attacked in each step, >= 0.
    bw : float
        ||w~|| <= bw, >= 0.
    start : float
        ||e(0)|| <= start, >= 0.
    T : int
        Last step, >= 1.
    lags : int
        Lags that are unrolled, >= 1.
    source : sequence of m int
        Of each row; empty = its position.

    Returns
    -------
    ObserverTable

    Raises
    ------
    InvalidInput
        Shapes do not fit, or a number is out of range.
    """

def order_bound(
    r: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    width: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    s: typing.SupportsInt | typing.SupportsIndex,
) -> float:
    """
    W0, one state: bound on |xhat - x| with at most s attacked.

    Parameters
    ----------
    r : (m,) array
        C (y - C xhat) of sensors with C = +-1; nan = missing.
    width : (m,) array
        Bounds of their noise, >= 0.
    s : int
        >= 0.

    Returns
    -------
    float
        inf with s or fewer sensors.

    Raises
    ------
    InvalidInput
        Sizes that differ, or a number out of range.
    """

def order_rule(
    values: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    f: typing.SupportsInt | typing.SupportsIndex,
) -> float:
    """
    The (f+1)-th smallest of upper bounds on one number, of which at most f are wrong.

    Parameters
    ----------
    values : (q,) array
        Bounds; nan = none.
    f : int
        >= 0.

    Returns
    -------
    float
        inf with f or fewer bounds.

    Raises
    ------
    InvalidInput
        f < 0.
    """

def order_rule_box(
    regions: collections.abc.Sequence[Region],
    estimate: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    f: typing.SupportsInt | typing.SupportsIndex,
) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
    """
    Bounds on each |estimate_i - x_i| from regions of which at most f are wrong.

    Parameters
    ----------
    regions : sequence of Region
        Of distinct senders.
    estimate : (n,) array
        Any.
    f : int
        >= 0.

    Returns
    -------
    (n,) array
        inf with f or fewer regions.

    Raises
    ------
    InvalidInput
        Sizes that differ, or f < 0.
    """

def range_row(
    p: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    c0: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    rho: typing.SupportsFloat | typing.SupportsIndex,
) -> tuple[typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"], float, float] | None:
    """
    A distance to a known point as a row of the regression: |x - p| = offset + h x within bias.

    Parameters
    ----------
    p : (n,) array
        The point.
    c0 : (n,) array
        Centre of a ball that is proved to hold x.
    rho : float
        Its radius, >= 0.

    Returns
    -------
    (h, offset, bias) or None
        None when the ball reaches p.

    Raises
    ------
    InvalidInput
        Sizes that differ, or a number out of range.
    """

def scan(
    r: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    R: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    s: typing.SupportsInt | typing.SupportsIndex,
    z1: typing.SupportsFloat | typing.SupportsIndex,
    z2: typing.SupportsFloat | typing.SupportsIndex,
) -> tuple[float, float]:
    """
    W1, one state, Gaussian noise: interval of x - xhat.

    Parameters
    ----------
    r : (m,) array
        C (y - C xhat) of sensors with C = +-1; nan = missing.
    R : (m,) array
        Variances, > 0.
    s : int
        >= 0.
    z1, z2 : float
        gaussian_levels(), >= 0.

    Returns
    -------
    (lo, hi)
        (nan, nan): more than s attacked; (-inf, inf): not enough rows.

    Raises
    ------
    InvalidInput
        Sizes that differ, or a number out of range.
    """

def smallest_undetectable(
    H: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    most: typing.SupportsInt | typing.SupportsIndex,
    tries: typing.SupportsFloat | typing.SupportsIndex = 10000000.0,
) -> SmallestAttack:
    """
    Exact search for the smallest set of meters that can lie unseen.

    Parameters
    ----------
    H : (rows, n) array
        As of meters; no row of zeros.
    most : int
        Largest set that is looked for, >= 1.
    tries : float
        Sets that are looked at before the search ends.

    Returns
    -------
    SmallestAttack

    Raises
    ------
    InvalidInput
        Shapes do not fit, or a number is out of range.
    """

def sparse_meters(
    shape: tuple[typing.SupportsInt | typing.SupportsIndex, typing.SupportsInt | typing.SupportsIndex],
    rows: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex],
    columns: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex],
    values: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    source: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] = [],
    dense: typing.SupportsInt | typing.SupportsIndex = 4000,
) -> SparseMeters:
    """
    What a large static set of meters withstands, H by its entries.
    Parts of H that have no state in common with the rest are searched one by one. Ends with its budget.

    Parameters
    ----------
    shape : (int, int)
        Rows and states of H, both >= 1.
    rows, columns : sequences of int
        Where H is not 0; entries at one place add up.
    values : (k,) array
        What stands there, divided by the deviations, reference removed.
    source : sequence of int
        Of each row; empty = its position.
    dense : int
        Parts of up to so many rows are searched exactly, larger ones give bounds; >= 0.

    Returns
    -------
    SparseMeters

    Raises
    ------
    InvalidInput
        Sizes do not fit, a place is outside of the shape, or a number is not finite.
    """

def sub_gaussian_chi(
    delta: typing.SupportsFloat | typing.SupportsIndex, degrees: typing.SupportsInt | typing.SupportsIndex
) -> float:
    """
    sqrt(n + 2 sqrt(n u) + 2 u), u = ln(1/delta) (Hsu, Kakade, Zhang 2012): chi for noise with a sub-Gaussian
    proxy variance.

    Parameters
    ----------
    delta : float
        Above 0 and below 1.
    degrees : int
        n >= 1.

    Returns
    -------
    float

    Raises
    ------
    InvalidInput
        A number out of range.
    """

def sub_gaussian_levels(
    delta: typing.SupportsFloat | typing.SupportsIndex,
    rows: typing.SupportsInt | typing.SupportsIndex,
    states: typing.SupportsInt | typing.SupportsIndex,
) -> tuple[float, float]:
    """
    gaussian_levels for sub-Gaussian noise.

    Parameters
    ----------
    delta : float
        Above 0 and below 1.
    rows : int
        Measurements of one sample, >= 1.
    states : int
        n >= 1.

    Returns
    -------
    (z1, z2)
        Of every single measurement, and of the least-squares vector.

    Raises
    ------
    InvalidInput
        A number out of range.
    """

def sub_gaussian_two_sided(delta: typing.SupportsFloat | typing.SupportsIndex) -> float:
    """
    sqrt(2 ln(2/delta)): two_sided for noise with a sub-Gaussian proxy variance.

    Parameters
    ----------
    delta : float
        Above 0 and below 1.

    Returns
    -------
    float

    Raises
    ------
    InvalidInput
        delta is out of range.
    """

def subsets_window(
    window: Window,
    s: typing.SupportsInt | typing.SupportsIndex,
    z1: typing.SupportsFloat | typing.SupportsIndex,
    z2: typing.SupportsFloat | typing.SupportsIndex,
    zc: typing.SupportsFloat | typing.SupportsIndex,
    *,
    z3: typing.SupportsFloat | typing.SupportsIndex | None = None,
    proved: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] = [],
    limit: typing.SupportsInt | typing.SupportsIndex = 3000,
) -> WindowWitness:
    """
    W3M: the region of leverage_window by all sets of s sources left out, the attacked set fixed in the window;
    sharper.

    Parameters
    ----------
    window : Window
        Filled up to its last step.
    s : int
        >= 0.
    z1, z2, zc : float
        window_levels(), >= 0.
    z3 : float, optional
        chi of all residuals of such a set.
    proved : sequence of int
        Sources known to be attacked.
    limit : int
        Most sets, >= 1.

    Returns
    -------
    WindowWitness

    Raises
    ------
    InvalidInput
        A number out of range, a window that is not filled, or more than `limit` sets.
    """

def subsets_window_width(
    window: Window,
    s: typing.SupportsInt | typing.SupportsIndex,
    z1: typing.SupportsFloat | typing.SupportsIndex,
    zc: typing.SupportsFloat | typing.SupportsIndex,
    *,
    z3: typing.SupportsFloat | typing.SupportsIndex | None = None,
    limit: typing.SupportsInt | typing.SupportsIndex = 60000,
) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
    """
    W3D, design time: half widths that subsets_window never exceeds whatever s attackers do.

    Parameters
    ----------
    window : Window
        Filled up to its last step; its data are not read.
    s : int
        >= 0.
    z1, zc : float
        As of subsets_window, at delta / C(sources, s).
    z3 : float, optional
        As of subsets_window.
    limit : int
        Most pairs of sets, >= 1.

    Returns
    -------
    (n,) array
        inf: not observable without some 2s sources.

    Raises
    ------
    InvalidInput
        A number out of range, a window that is not filled, or more than `limit` pairs.
    """

def table(
    kernels: Kernels,
    *,
    s: typing.SupportsInt | typing.SupportsIndex,
    start: typing.SupportsFloat | typing.SupportsIndex,
    T: typing.SupportsInt | typing.SupportsIndex,
    bw: typing.SupportsFloat | typing.SupportsIndex,
    bv: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
    beta: typing.SupportsFloat | typing.SupportsIndex | None = None,
    fixed: bool = False,
) -> Table:
    """
    Theorem T, bounded noise: bounds on every agent's error without data.

    Parameters
    ----------
    kernels : Kernels
        Of kernels().
    s : int
        Sensors attacked at a time, >= 0.
    start : float
        Bound on all ||e_i(0)||, >= 0.
    T : int
        Last step, >= 1.
    bw : float
        ||w|| <= bw, >= 0.
    bv : (N,) array
        |v_j| <= bv[j], >= 0.
    beta : float, optional
        Fixed level, >= 0; None = adaptive.
    fixed : bool
        The attacked set never changes.

    Returns
    -------
    Table

    Raises
    ------
    InvalidInput
        A number out of range, or more than memory is meant for.
    """

def two_sided(delta: typing.SupportsFloat | typing.SupportsIndex) -> float:
    """
    z with P(|N(0,1)| > z) = delta.

    Parameters
    ----------
    delta : float
        Above 0 and below 1.

    Returns
    -------
    float

    Raises
    ------
    InvalidInput
        delta is out of range.
    """

def whiteness(
    residuals: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    lags: typing.SupportsInt | typing.SupportsIndex = 10,
) -> tuple[
    typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    float,
]:
    """
    Ljung-Box test of residuals against "each is independent of its past".

    Parameters
    ----------
    residuals : (T, N) array
        Of N sensors; nan = missing.
    lags : int
        1..T-1.

    Returns
    -------
    (statistic (N,), correlation (N,), p_value)
        The correlation is that of lag 1; p_value is that of the
        worst sensor times N: small = a residual depends on its past.

    Raises
    ------
    InvalidInput
        No sensor, or lags out of range.
    """

def window_levels(
    delta: typing.SupportsFloat | typing.SupportsIndex,
    rows: typing.SupportsInt | typing.SupportsIndex,
    states: typing.SupportsInt | typing.SupportsIndex,
) -> tuple[float, float, float]:
    """
    Levels of the window certificates that fail together with probability <= delta.

    Parameters
    ----------
    delta : float
        Above 0 and below 1.
    rows : int
        Measurements of the window, >= 1.
    states : int
        n >= 1.

    Returns
    -------
    (z1, z2, zc)
        Of every single measurement, of the vector, and of each coordinate.

    Raises
    ------
    InvalidInput
        A number out of range.
    """

def witness_subsets(
    y: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    C: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    R: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    s: typing.SupportsInt | typing.SupportsIndex,
    z1: typing.SupportsFloat | typing.SupportsIndex,
    z2: typing.SupportsFloat | typing.SupportsIndex,
    *,
    z3: typing.SupportsFloat | typing.SupportsIndex | None = None,
    proved: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] = [],
    sources: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] = [],
    limit: typing.SupportsInt | typing.SupportsIndex = 5000,
) -> Witness:
    """
    W3: the region of leverage_ball by all sets of sources that may be the honest ones, C(sources, s) of them;
    sharper.

    Parameters
    ----------
    y : (m,) array
        Measurements; nan = missing.
    C : (m, n) array
        Their rows.
    R : (m,) array
        Variances, > 0.
    s : int
        >= 0.
    z1, z2 : float
        gaussian_levels(), >= 0.
    z3 : float, optional
        chi(delta3, m - s - n), only where the law of the noise is known.
    proved : sequence of int
        Sources known to be attacked, which then must never change.
    sources : sequence of m int
        Of each row; empty = its position.
    limit : int
        Most sets, >= 1.

    Returns
    -------
    Witness

    Raises
    ------
    InvalidInput
        A number out of range, sizes that differ, or more than `limit` sets.
    """
