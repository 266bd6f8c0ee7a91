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
    "observer_table",
    "order_bound",
    "order_rule",
    "order_rule_box",
    "range_row",
    "scan",
    "smallest_undetectable",
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
    ||x - center|| <= radius, |x_k - center_k| <= box_k where there is a box, and
    (x - center)' shape^-1 (x - center) <= stretch^2 where there is a shape.
    radius inf: the rows at hand cannot answer; nan: the data refute the assumption.
    """
    def __init__(
        self,
        center: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
        radius: typing.SupportsFloat | typing.SupportsIndex,
        box: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"] | None = None,
    ) -> None:
        """
        center (n,), radius >= 0, box (n,) >= 0. Raises InvalidInput.
        """
    def __reduce__(self) -> tuple: ...
    def bound_around(self, estimate: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]) -> float:
        """
        Bound on ||estimate - x|| for any estimate (n,); inf without an answer, nan when refuted.
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
        (N,): fails with probability <= N T P(|N(0,1)| > z) + delta for each agent and step.
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
        ||w|| <= bw, ages 0..steps. Raises InvalidInput.
        """
    @staticmethod
    def bounded_entries(
        A: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
        steps: typing.SupportsInt | typing.SupportsIndex,
        Gam: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
        bw: typing.SupportsFloat | typing.SupportsIndex,
    ) -> Propagation:
        """
        w = Gam w~ with |w~_i| <= bw; Gam (n, q). Raises InvalidInput.
        """
    @staticmethod
    def gaussian(
        A: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
        steps: typing.SupportsInt | typing.SupportsIndex,
        Q: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
        delta: typing.SupportsFloat | typing.SupportsIndex,
    ) -> Propagation:
        """
        w ~ N(0, Q); fails with probability delta per use. Raises InvalidInput.
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
        w = Gam w~, w~ ~ N(0, I): zc for each coordinate, z2 for the vector. Raises InvalidInput.
        """
    def __reduce__(self) -> tuple: ...
    def age(self, then: Region, age: typing.SupportsInt | typing.SupportsIndex) -> Region:
        """
        The Region of today for one that held `age` steps ago; its box is never wider than what the ball, the box and the ellipsoid give.
        """

class Recovery:
    """
    L: excess over the table after lost messages. A state is (lam, x): every agent behind the
    estimate was within x of the lossless run at time lam, and nothing was lost after; (0, 0).
    """
    @staticmethod
    def lost(
        t: typing.SupportsInt | typing.SupportsIndex,
        b: typing.SupportsFloat | typing.SupportsIndex,
        d: typing.SupportsFloat | typing.SupportsIndex,
    ) -> tuple[int, float]:
        """
        After a loss in step t: b bounds ||e_i(t)||, d is the table's d_i(t).
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
        ||e_i(t)|| <= d_i(t) + this.
        """
    def level_excess(
        self,
        agent: typing.SupportsInt | typing.SupportsIndex,
        state: tuple[typing.SupportsInt | typing.SupportsIndex, typing.SupportsFloat | typing.SupportsIndex],
        t: typing.SupportsInt | typing.SupportsIndex,
    ) -> float:
        """
        level_j(t+1) = nominal + this.
        """
    def merge(
        self,
        p: tuple[typing.SupportsInt | typing.SupportsIndex, typing.SupportsFloat | typing.SupportsIndex],
        q: tuple[typing.SupportsInt | typing.SupportsIndex, typing.SupportsFloat | typing.SupportsIndex],
        t: typing.SupportsInt | typing.SupportsIndex,
    ) -> tuple[int, float]:
        """
        Of two states seen at t, the one that dominates both.
        """
    def rebase(
        self,
        state: tuple[typing.SupportsInt | typing.SupportsIndex, typing.SupportsFloat | typing.SupportsIndex],
        t: typing.SupportsInt | typing.SupportsIndex,
    ) -> tuple[int, float]:
        """
        The state seen at time t: carried over every multiple of K.
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
        One step; returns the bound. Raises InvalidInput.
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
    The measurements of several steps as one regression z = N theta + o. Call begin, a prior, then for each step add its
    rows and advance. x(k+1) = A x(k) + u + Gam w~(k).
    """
    def __init__(
        self,
        states: typing.SupportsInt | typing.SupportsIndex,
        noise: typing.SupportsInt | typing.SupportsIndex,
        steps: typing.SupportsInt | typing.SupportsIndex,
        sources: typing.SupportsInt | typing.SupportsIndex,
        capacity: typing.SupportsInt | typing.SupportsIndex,
    ) -> None:
        """
        For at most `steps` steps of `states` numbers, Gam (states, noise), and `capacity` measurements of sources 0..sources-1.
        Raises InvalidInput.
        """
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
        A measurement y = c x + v of the present step: c (n,), v ~ N(0, variance) and at most bias on top, or
        bounded: |v| <= bias alone. False: it says nothing (nan, c = 0, no such source, full, ..) and is left out.
        """
    def advance(
        self,
        A: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
        Gam: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
        u: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    ) -> None:
        """
        To the next step: A (n, n), Gam (n, noise), u (n,). Raises InvalidInput.
        """
    def begin(
        self,
        steps: typing.SupportsInt | typing.SupportsIndex,
        process_bound: typing.SupportsFloat | typing.SupportsIndex = ...,
    ) -> None:
        """
        Empties the window. w~ ~ N(0, I), or |w~_i| <= process_bound. Raises InvalidInput.
        """
    def prior_gaussian(
        self,
        c0: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
        P0: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    ) -> None:
        """
        x(0) - c0 ~ N(0, P0); c0 (n,), P0 (n, n) positive definite; right after begin. Raises InvalidInput.
        """
    def prior_set(
        self,
        c0: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
        P0: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
        r0: typing.SupportsFloat | typing.SupportsIndex,
        weight: typing.SupportsFloat | typing.SupportsIndex = 4.0,
    ) -> None:
        """
        (x(0) - c0)' P0^-1 (x(0) - c0) <= r0^2 for certain; weight: as how many deviations r0 counts. Raises InvalidInput.
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
    B: one Kalman filter per set of s sources left out; the attacked set never changes. sources: a list of (C (k, n),
    variances (k,)).
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
    ) -> None:
        """
        A, Q (n, n). Raises InvalidInput, also when C(sources, s) > limit.
        """
    def __reduce__(self) -> tuple: ...
    def merge(
        self, most: typing.SupportsInt | typing.SupportsIndex, z2: typing.SupportsFloat | typing.SupportsIndex
    ) -> None:
        """
        At most `most` members from now on, each leaving out more. Raises InvalidInput.
        """
    def restart(self, region: Region) -> None:
        """
        All members anew from a Region that contains x. Raises InvalidInput without an answer.
        """
    def start_gaussian(
        self,
        c0: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
        P0: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    ) -> None:
        """
        x - c0 ~ N(0, P0) before the first update. Raises InvalidInput.
        """
    def start_set(
        self,
        c0: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
        P0: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
        r0: typing.SupportsFloat | typing.SupportsIndex,
    ) -> None:
        """
        (x - c0)' P0^-1 (x - c0) <= r0^2 before the first update. Raises InvalidInput.
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
        One step. y: all outputs one after the other, nan = missing; A, Q, sources: where they differ from the
        design's; u (n,): known input. Returns a WindowWitness; raises InvalidInput.
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
    Whether a flooded number is its owner's, for paths (owner, relay, ..) that brought the same one; the budget is then
    s + liars. Raises InvalidInput.
    """

def after_injection(
    norm_A: typing.SupportsFloat | typing.SupportsIndex,
    b: typing.SupportsFloat | typing.SupportsIndex,
    bw: typing.SupportsFloat | typing.SupportsIndex,
    kappa: typing.SupportsFloat | typing.SupportsIndex,
) -> float:
    """
    R: norm_A b + bw + |kappa|, the bound after predicting and injecting a known innovation.
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
    A: from leverage_window (1 leaf) to subsets_window (all), within a budget of `leaves`. Raises InvalidInput.
    """

def averaged(
    weights: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    estimates: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    bounds: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
) -> Region:
    """
    R: Region around the weighted sum of estimates (q, n) whose errors are at most bounds (q,), inf = not known;
    weights (q,) of any sign with sum 1. Raises InvalidInput.
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
    B2, design time: (n + 1,): per coordinate and in the 2-norm (last), what a living member's error never exceeds;
    inf: not detectable without some 2s sources. z2, zc at delta / C(sources, s). Raises InvalidInput.
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
    B2, design time: (n,): half widths that the box of a bank never exceeds; the rest as in bank_steady.
    """

def calibrated_levels(
    V: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    R: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    s: typing.SupportsInt | typing.SupportsIndex,
    delta: typing.SupportsFloat | typing.SupportsIndex,
) -> tuple[float, float]:
    """
    Distribution-free (z1, z2) for one state from clean residuals V (T, N), times C = +-1; R (N,) variances.
    Exact for exchangeable samples; delta >= 2/(T+1). Raises InvalidInput, also beyond 2e8 sums.
    """

def cells(
    regions: collections.abc.Sequence[Region], s: typing.SupportsInt | typing.SupportsIndex
) -> tuple[
    typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
]:
    """
    C: (lo, hi), (n,) each: per coordinate the hull of the points in at least len(regions) - s of the boxes; nan:
    more than s wrong; inf: not enough. Raises InvalidInput.
    """

def chi(
    delta: typing.SupportsFloat | typing.SupportsIndex, degrees: typing.SupportsInt | typing.SupportsIndex
) -> float:
    """
    c with P(chi-square > c^2) = delta; delta in (0, 1), degrees >= 1.
    """

def ellipsoid(
    center: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    shape: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    stretch: typing.SupportsFloat | typing.SupportsIndex,
) -> Region:
    """
    The Region (x - center)' shape^-1 (x - center) <= stretch^2, with its box and ball. Raises InvalidInput.
    """

def empirical_quantile(
    measured: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    delta: typing.SupportsFloat | typing.SupportsIndex,
    confidence: typing.SupportsFloat | typing.SupportsIndex = 0.95,
) -> typing.Annotated[list[float], "FixedSize(3)"]:
    """
    (value, lower, upper): a level that a share `delta` of clean numbers `measured` (T,) exceeds, and where the true one is with that confidence if they are independent; nan where T is too small. nan = missing.
    """

def error_system(
    A: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    C: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    J: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    silent: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] = [],
) -> ErrorSystem:
    """
    Lemma 1. A (n, n); C (N, n), rows of length 1 or 0; J (N, N), the averaging of one step, row sums 1;
    silent: sensors that inject nothing. Raises InvalidInput.
    """

def gaussian_levels(
    delta: typing.SupportsFloat | typing.SupportsIndex,
    rows: typing.SupportsInt | typing.SupportsIndex,
    states: typing.SupportsInt | typing.SupportsIndex,
) -> tuple[float, float]:
    """
    (z1, z2) of the witnesses that fail together with probability <= delta, half for each.
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
    Theorem TG: w ~ N(0, Q) (n, n), v_j ~ N(0, R[j]) (N,); z: level of the event. Raises InvalidInput.
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
    Bounded noise, exactly: (lo, hi), (n,) each, by linear programs over all sets of s sources left out. nan: more
    than s are attacked; inf: the rows cannot answer. Raises InvalidInput.
    """

def informed(
    system: ErrorSystem,
    start: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
    steps: typing.SupportsInt | typing.SupportsIndex,
    bw: typing.SupportsFloat | typing.SupportsIndex,
    bv: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
    """
    Theorem I, bounded noise: (steps, N), row k-1 bounds ||e_i(t0 + k)||. system: with the proved sensors silent;
    start (N,): bounds at t0. Raises InvalidInput.
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
    Theorem I, Gaussian noise. P0 (N n, N n): zero unless t0 was fixed in advance. Raises InvalidInput.
    """

def intersection(regions: collections.abc.Sequence[Region]) -> Region:
    """
    The Region that all of these leave, which hold on the same event; refuted when it is empty.
    """

def interval(
    y: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    width: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    s: typing.SupportsInt | typing.SupportsIndex,
) -> tuple[float, float]:
    """
    W0, one state: (lo, hi) of the points in at least m - s of the intervals y +- width, y (m,) = C y, nan =
    missing. (nan, nan): more than s attacked; (-inf, inf): not enough rows.
    """

def kernels(system: ErrorSystem, window: typing.SupportsInt | typing.SupportsIndex) -> Kernels:
    """
    Kernels of K = window lags, best so many that Rb[K].sum(1) < 1e-3. Raises InvalidInput.
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
    W2: region of the state from one sample's rows y (m,), nan = missing; C (m, n); variances R (m,).
    At most s of all sources lie. z1, z2: gaussian_levels(); widths (m,): bounded noise |v| <= width instead.
    prior: a Region that contains x. sources (m,): of each row, empty = its position; proved: sources known to
    be attacked, which then must never change. Returns a Witness; raises InvalidInput.
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
    W2M: the state of the window's last step, at most s sources lie (moving: s in each step). z1, z2, zc:
    window_levels(), 0 with bounded noise. proved, honest: sources known to be so. Returns a WindowWitness; raises InvalidInput.
    """

def lists_complete(
    step: typing.SupportsInt | typing.SupportsIndex,
    diameter: typing.SupportsInt | typing.SupportsIndex,
    rounds: typing.SupportsInt | typing.SupportsIndex,
) -> int:
    """
    t0 of theorem I: the step from which all lists are complete.
    """

def meters(
    H: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    source: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] = [],
) -> Meters:
    """
    H (rows, n), divided by the deviations, reference removed; source (rows,). Raises InvalidInput.
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
    O: bounds of one observer with gain L (n, m) and clipped innovations, sets that move every step. |v| <= bv (m,),
    ||w~|| <= bw, ||e(0)|| <= start; source (m,): of each row. Raises InvalidInput.
    """

def order_bound(
    r: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    width: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    s: typing.SupportsInt | typing.SupportsIndex,
) -> float:
    """
    W0, one state: bound on |xhat - x| from r (m,) = C (y - C xhat) and widths (m,), at most s attacked.
    """

def order_rule(
    values: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    f: typing.SupportsInt | typing.SupportsIndex,
) -> float:
    """
    The (f+1)-th smallest of upper bounds of which at most f are wrong; inf with f or fewer, nan = none.
    """

def order_rule_box(
    regions: collections.abc.Sequence[Region],
    estimate: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    f: typing.SupportsInt | typing.SupportsIndex,
) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
    """
    (n,): bounds on |estimate_i - x_i| from regions of which at most f are wrong. Raises InvalidInput.
    """

def range_row(
    p: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    c0: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    rho: typing.SupportsFloat | typing.SupportsIndex,
) -> tuple[typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"], float, float] | None:
    """
    (h, offset, bias): |x - p| = offset + h x within bias for x in the proved ball (c0, rho); None when it reaches p.
    """

def scan(
    r: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    R: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    s: typing.SupportsInt | typing.SupportsIndex,
    z1: typing.SupportsFloat | typing.SupportsIndex,
    z2: typing.SupportsFloat | typing.SupportsIndex,
) -> tuple[float, float]:
    """
    W1, one state, Gaussian noise: (lo, hi) of x - xhat from r (m,) = C (y - C xhat); R (m,) variances.
    """

def smallest_undetectable(
    H: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    most: typing.SupportsInt | typing.SupportsIndex,
    tries: typing.SupportsFloat | typing.SupportsIndex = 10000000.0,
) -> SmallestAttack:
    """
    Exact search up to `most` meters, given up after `tries` sets. Raises InvalidInput.
    """

def sub_gaussian_chi(
    delta: typing.SupportsFloat | typing.SupportsIndex, degrees: typing.SupportsInt | typing.SupportsIndex
) -> float:
    """
    sqrt(n + 2 sqrt(n u) + 2 u), u = ln(1/delta) (Hsu, Kakade, Zhang 2012): chi for such noise.
    """

def sub_gaussian_levels(
    delta: typing.SupportsFloat | typing.SupportsIndex,
    rows: typing.SupportsInt | typing.SupportsIndex,
    states: typing.SupportsInt | typing.SupportsIndex,
) -> tuple[float, float]:
    """
    The same for sub-Gaussian noise.
    """

def sub_gaussian_two_sided(delta: typing.SupportsFloat | typing.SupportsIndex) -> float:
    """
    sqrt(2 ln(2/delta)): two_sided for noise with a sub-Gaussian proxy variance.
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
    W3M: the same by all sets of s sources left out, the attacked set fixed in the window; sharper. z3: chi of all
    residuals of such a set. Raises InvalidInput, also when there are more than `limit` sets.
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
    W3D, design time: (n,) half widths that subsets_window never exceeds whatever s attackers do; inf: not
    observable without some 2s sources. Raises InvalidInput.
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
    Theorem T, bounded noise ||w|| <= bw, |v_j| <= bv[j] (N,). start: bound on all ||e_i(0)||; beta: fixed level,
    None = adaptive; fixed: the attacked set never changes. Raises InvalidInput.
    """

def two_sided(delta: typing.SupportsFloat | typing.SupportsIndex) -> float:
    """
    z with P(|N(0,1)| > z) = delta; delta in (0, 1).
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
    (statistic (N,), lag-1 correlation (N,), p-value) of the Ljung-Box test of residuals (T, N), nan = missing; the p-value is that of the worst sensor times N: small = a residual depends on its past.
    """

def window_levels(
    delta: typing.SupportsFloat | typing.SupportsIndex,
    rows: typing.SupportsInt | typing.SupportsIndex,
    states: typing.SupportsInt | typing.SupportsIndex,
) -> tuple[float, float, float]:
    """
    (z1, z2, zc) of the window certificates that fail together with probability <= delta. Raises InvalidInput.
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
    W3: the same by all sets of sources that may be the honest ones, C(sources, s) of them; sharper.
    z3: chi(delta3, m - s - n), only where the law of the noise is known. Raises InvalidInput, also when there
    are more than `limit` sets.
    """
