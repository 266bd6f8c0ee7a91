"""
Run-time certificates: bounds on an estimate's error whatever at most s sensors say.
"""

from __future__ import annotations
import collections.abc
import numpy
import numpy.typing
import typing

__all__: list[str] = [
    "ErrorSystem",
    "GaussianTable",
    "Kernels",
    "Propagation",
    "Recovery",
    "Region",
    "Table",
    "TwoNumbers",
    "Witness",
    "after_injection",
    "averaged",
    "calibrated_levels",
    "chi",
    "empirical_quantile",
    "error_system",
    "gaussian_levels",
    "gaussian_table",
    "informed",
    "informed_gaussian",
    "interval",
    "kernels",
    "leverage_ball",
    "lists_complete",
    "order_bound",
    "order_rule",
    "scan",
    "sub_gaussian_chi",
    "sub_gaussian_levels",
    "sub_gaussian_two_sided",
    "table",
    "whiteness",
    "two_sided",
    "witness_subsets",
]

class Region:
    """
    ||x - center|| <= radius, and |x_k - center_k| <= box_k where there is a box.
    radius inf: the rows at hand cannot answer; nan: the data refute the assumption.
    """
    def __init__(
        self,
        center: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
        radius: typing.SupportsFloat | typing.SupportsIndex,
    ) -> None: ...
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
    def radius(self) -> float: ...
    @property
    def refuted(self) -> bool:
        """
        radius is nan: more than s are attacked
        """

class Witness:
    """
    Answer of leverage_ball and witness_subsets.
    """
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
    def region(self) -> Region: ...

class ErrorSystem:
    """
    E(t) = M E(t-1) + B_w w(t-1) + B (v(t) + a(t)), agent by agent.
    """
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
    @property
    def Rb(self) -> numpy.typing.NDArray[numpy.float64]: ...
    @property
    def Re(self) -> numpy.typing.NDArray[numpy.float64]: ...
    @property
    def gb(self) -> numpy.typing.NDArray[numpy.float64]: ...
    @property
    def ge(self) -> numpy.typing.NDArray[numpy.float64]: ...
    @property
    def wb(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]: ...
    @property
    def we(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]: ...
    @property
    def window(self) -> int: ...

class Table:
    """
    Data-free bounds, row t = 0..T, column = agent; infinite where they overflow.
    """
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
    def table(self) -> Table: ...

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
    def gaussian(
        A: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
        steps: typing.SupportsInt | typing.SupportsIndex,
        Q: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
        delta: typing.SupportsFloat | typing.SupportsIndex,
    ) -> Propagation:
        """
        w ~ N(0, Q); fails with probability delta per use. Raises InvalidInput.
        """
    def age(self, then: Region, age: typing.SupportsInt | typing.SupportsIndex) -> Region:
        """
        The Region of today for one that held `age` steps ago.
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
    def step(self, gamma: typing.SupportsFloat | typing.SupportsIndex) -> float:
        """
        One step; returns the bound. Raises InvalidInput.
        """
    @property
    def bound(self) -> float: ...
    @property
    def constants(self) -> dict: ...
    @property
    def levels(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (N,): adaptive levels of the coming step
        """
    @property
    def p(self) -> float: ...
    @property
    def rho(self) -> float: ...

def after_injection(
    norm_A: typing.SupportsFloat | typing.SupportsIndex,
    b: typing.SupportsFloat | typing.SupportsIndex,
    bw: typing.SupportsFloat | typing.SupportsIndex,
    kappa: typing.SupportsFloat | typing.SupportsIndex,
) -> float:
    """
    R: norm_A b + bw + |kappa|, the bound after predicting and injecting a known innovation.
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

def chi(
    delta: typing.SupportsFloat | typing.SupportsIndex, degrees: typing.SupportsInt | typing.SupportsIndex
) -> float:
    """
    c with P(chi-square > c^2) = delta; delta in (0, 1), degrees >= 1.
    """

def empirical_quantile(
    measured: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    delta: typing.SupportsFloat | typing.SupportsIndex,
    confidence: typing.SupportsFloat | typing.SupportsIndex = 0.95,
) -> typing.Annotated[list[float], "FixedSize(3)"]:
    """
    (value, lower, upper): a level that a share `delta` of clean numbers `measured` (T,) exceeds, and where the true one is with
    that confidence if they are independent; nan where T is too small. nan = missing.
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

def lists_complete(
    step: typing.SupportsInt | typing.SupportsIndex,
    diameter: typing.SupportsInt | typing.SupportsIndex,
    rounds: typing.SupportsInt | typing.SupportsIndex,
) -> int:
    """
    t0 of theorem I: the step from which all lists are complete.
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

def whiteness(
    residuals: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    lags: typing.SupportsInt | typing.SupportsIndex = 10,
) -> tuple[
    typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    float,
]:
    """
    (statistic (N,), lag-1 correlation (N,), p-value) of the Ljung-Box test of residuals (T, N), nan = missing; the
    p-value is that of the worst sensor times N: small = a residual depends on its past.
    """
