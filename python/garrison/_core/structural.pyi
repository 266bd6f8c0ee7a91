"""
Errors, thresholds and gain designs of the structural filter.
"""

from __future__ import annotations
import collections.abc
import garrison._core
import numpy
import numpy.typing
import typing

__all__: list[str] = [
    "Setting",
    "alarms",
    "best_scalar_gain",
    "chi_square_level",
    "coupled_riccati",
    "covariance_bound",
    "design_gains",
    "error_radius",
    "exposure",
    "false_alarm_of_level",
    "h2_gains",
    "isolation_ratios",
    "joint_kalman",
    "kappa",
    "level_of_false_alarm",
    "power",
    "predictions",
    "projection_gains",
    "setting",
    "stationary",
    "step_response",
    "template_statistics",
    "thresholds",
    "thresholds_printed",
    "thresholds_root",
    "windows_exact",
    "windows_naive",
]

class Setting:
    """
    Model, graphs and noise of the structural filter's analysis, in the paper's letters.
    A (n, n), C (N, n), W and U (N, N), E (n, n), R (N, N).
    """
    def __copy__(self) -> typing.Any: ...
    def __deepcopy__(self, memo: dict) -> typing.Any: ...
    def __eq__(self, other: typing.Any) -> typing.Any: ...
    def __getstate__(self) -> dict: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        A: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
        C: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
        W: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
        U: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
        E: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"] | None = None,
        R: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"] | None = None,
    ) -> None: ...
    def __reduce__(self) -> tuple: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, arg0: dict) -> None: ...
    @property
    def A(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (n, n)
        """
    @property
    def C(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (N, n), row i = c_i'
        """
    @property
    def E(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (n, n): covariance of the process noise.
        """
    @property
    def R(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (N, N): covariance of the measurement noise.
        """
    @property
    def U(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (N, N) of 0 and 1: [i, j] = 1 when i receives y_j.
        """
    @property
    def W(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (N, N): mixing weights of the estimates, >= 0, rows sum to 1.
        """

def alarms(
    residuals: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    threshold: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
) -> list[list[int]]:
    """
    Agents with |r| >= threshold per row of residuals (T, N); nan is an alarm.
    """

def best_scalar_gain(
    a: typing.SupportsFloat | typing.SupportsIndex,
    W: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
) -> tuple[float, float]:
    """
    (k, least spectral radius) where agent 0 alone sees one scalar state.
    """

def chi_square_level(
    degrees: typing.SupportsInt | typing.SupportsIndex, rate: typing.SupportsFloat | typing.SupportsIndex
) -> float:
    """
    x with P(chi-square with `degrees` >= x) = rate, 0 < rate < 1, degrees >= 1. Raises InvalidInput.
    """

def coupled_riccati(
    setting: Setting,
    most_sweeps: typing.SupportsInt | typing.SupportsIndex = 20000,
    tolerance: typing.SupportsFloat | typing.SupportsIndex = 1e-14,
) -> dict:
    """
    Gains and covariance bounds of the coupled Riccati recursion.
    """

def covariance_bound(
    setting: Setting,
    K: collections.abc.Sequence[typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"]],
    printed: bool = False,
) -> dict:
    """
    (10) and (16); printed = True takes the paper's noise term, which does not hold.
    """

def design_gains(setting: Setting, method: str = "auto") -> dict:
    """
    Gains with rho(Ahat) < 1: method "riccati", "kalman", "projection", "h2", or "auto", the
    first of riccati, kalman, h2 with which that holds. P bounds cov(e_i) where the coupled Riccati
    recursion settled, else it is empty. Raises DesignInfeasible with the spectral radius reached.
    """

def error_radius(
    setting: Setting, K: collections.abc.Sequence[typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"]]
) -> float:
    """
    rho(Ahat) of (5).
    """

def exposure(
    setting: Setting,
    K: collections.abc.Sequence[typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"]],
    false_alarm: typing.SupportsFloat | typing.SupportsIndex = 0.01,
    detection: typing.SupportsFloat | typing.SupportsIndex = 0.99,
) -> list:
    """
    What a constant attack on each agent can do before it is seen, at steady state: the least size that
    some agent's test detects with probability `detection` per sample and that agent, the largest steady
    |mean error| per unit of attack, and that of an attack of just this size.
    """

def false_alarm_of_level(ratio: typing.SupportsFloat | typing.SupportsIndex) -> float:
    """
    False-alarm rate at which a residual of `ratio` standard deviations is just an alarm.
    """

def h2_gains(
    setting: Setting,
    start: collections.abc.Sequence[typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"]],
    hubs: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] = [],
    epsilon: typing.SupportsFloat | typing.SupportsIndex = 0.01,
) -> list[typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]]:
    """
    Gains of least tr Q, under the isolation constraint (18) for `hubs`.
    """

def isolation_ratios(
    setting: Setting, K: collections.abc.Sequence[typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"]]
) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
    """
    (18), (N, N).
    """

def joint_kalman(
    setting: Setting,
    most_sweeps: typing.SupportsInt | typing.SupportsIndex = 20000,
    tolerance: typing.SupportsFloat | typing.SupportsIndex = 1e-14,
) -> dict:
    """
    Gains K (N arrays (n, n)) from the joint covariance of all agents, whether they converged, and sweeps.
    """

def kappa(m: typing.SupportsFloat | typing.SupportsIndex) -> float:
    """
    erf(m / sqrt 2): 1 - false-alarm rate at m standard deviations.
    """

def level_of_false_alarm(rate: typing.SupportsFloat | typing.SupportsIndex) -> float:
    """
    m with this false-alarm rate.
    """

def power(
    mean: typing.SupportsFloat | typing.SupportsIndex,
    std: typing.SupportsFloat | typing.SupportsIndex,
    threshold: typing.SupportsFloat | typing.SupportsIndex,
) -> float:
    """
    P(|N(mean, std^2)| >= threshold).
    """

def predictions(
    setting: Setting, estimates: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"]
) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
    """
    sum_j W_ij A xhat_j, (N, n) from (N, n).
    """

def projection_gains(setting: Setting) -> list[typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]]:
    """
    K_i that minimise |(I - K_i D_i) A| (Frobenius norm), N arrays (n, n): closed form, no noise model.
    """

def setting(model: garrison._core.Model, network: garrison._core.Network, filter: garrison._core.Filter) -> Setting:
    """
    The setting that a Structural filter is designed for on this model and network.
    """

def stationary(
    setting: Setting,
    K: collections.abc.Sequence[typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"]],
    lags: typing.SupportsInt | typing.SupportsIndex = 0,
) -> dict:
    """
    Exact stationary moments of errors and residuals; refuses rho(Ahat) >= 1.
    """

def step_response(
    setting: Setting,
    K: collections.abc.Sequence[typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"]],
    agent: typing.SupportsInt | typing.SupportsIndex,
    rows: typing.SupportsInt | typing.SupportsIndex,
) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
    """
    Noise-free residuals (rows, N) to a unit step on y_agent.
    """

def template_statistics(
    residuals: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    covariances: collections.abc.Sequence[typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"]],
    dc_gain: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
    """
    Fit of every full window to the response to an attack on each agent.
    """

def thresholds(
    residual_std: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
    m: typing.SupportsFloat | typing.SupportsIndex,
) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
    """
    m standard deviations of every residual.
    """

def thresholds_printed(
    setting: Setting, Q1: typing.SupportsFloat | typing.SupportsIndex, m: typing.SupportsFloat | typing.SupportsIndex
) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
    """
    The paper's (17), for comparison only.
    """

def thresholds_root(
    setting: Setting, Q1: typing.SupportsFloat | typing.SupportsIndex, m: typing.SupportsFloat | typing.SupportsIndex
) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
    """
    (N,): m sqrt(|c_i|^2 Q1 + R_ii), the root of the printed (17): the right unit, hugely conservative.
    """

def windows_exact(
    residuals: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    covariances: collections.abc.Sequence[typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"]],
) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
    """
    v'S^-1 v over the last len(covariances) residuals.
    """

def windows_naive(
    residuals: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    residual_std: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
    window: typing.SupportsInt | typing.SupportsIndex,
) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
    """
    (T, N): sums of squares over the last `window` residuals (T, N), as if they were independent in time; nan until it
    is full.
    """
