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
    Model, graphs and noise of the structural filter's analysis, in the paper's letters. Agents have one scalar
    measurement each; a relay has a row of zeros.

    Parameters
    ----------
    A : (n, n) array
        Of the plant.
    C : (N, n) array
        Row i is c_i'.
    W : (N, N) array
        Mixing weights of the estimates, >= 0, rows sum to 1.
    U : (N, N) array
        Of 0 and 1: [i, j] = 1 when i receives y_j; the diagonal is 1.
    E : (n, n) array, optional
        Covariance of the process noise.
    R : (N, N) array, optional
        Covariance of the measurement noise.

    Raises
    ------
    InvalidInput
        Shapes do not fit, or W or U is no such matrix.
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
    Who alarms when: |residual| >= threshold. A residual of nan is an alarm.

    Parameters
    ----------
    residuals : (T, N) array
        Of every agent.
    threshold : (N,) array
        In the same units.

    Returns
    -------
    list of T lists of int
        Agents, sorted.

    Raises
    ------
    InvalidInput
        Shapes do not fit.
    """

def best_scalar_gain(
    a: typing.SupportsFloat | typing.SupportsIndex,
    W: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
) -> tuple[float, float]:
    """
    The gain with the least spectral radius where agent 0 alone sees one scalar state
    (docs/filters/structural.md#d20).

    Parameters
    ----------
    a : float
        x(k+1) = a x(k) + noise.
    W : (N, N) array
        Mixing weights.

    Returns
    -------
    (float, float)
        The gain k and that radius.

    Raises
    ------
    InvalidInput
        A number that is not finite, or W is not square.
    """

def chi_square_level(
    degrees: typing.SupportsInt | typing.SupportsIndex, rate: typing.SupportsFloat | typing.SupportsIndex
) -> float:
    """
    x with P(chi-square >= x) = rate.

    Parameters
    ----------
    degrees : int
        Of freedom, >= 1.
    rate : float
        Above 0 and below 1.

    Returns
    -------
    float

    Raises
    ------
    InvalidInput
        A number out of range.
    """

def coupled_riccati(
    setting: Setting,
    most_sweeps: typing.SupportsInt | typing.SupportsIndex = 20000,
    tolerance: typing.SupportsFloat | typing.SupportsIndex = 1e-14,
) -> dict:
    """
    Gains and covariance bounds of the coupled Riccati recursion (docs/filters/structural.md#d-riccati).

    Parameters
    ----------
    setting : Setting
        With E and R.
    most_sweeps : int
        1..1e7.
    tolerance : float
        Relative change at which it has converged, 0..1.

    Returns
    -------
    dict
        K, P and Pprior: N arrays (n, n), P a bound of cov(e_i) after the measurement and Pprior before it;
        converged (else nothing is certified); sweeps.

    Raises
    ------
    InvalidInput
        A bad setting, or a number out of range.
    """

def covariance_bound(
    setting: Setting,
    K: collections.abc.Sequence[typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"]],
    printed: bool = False,
) -> dict:
    """
    (10) and (16), bounds on the covariance of the stacked error.

    Parameters
    ----------
    setting : Setting
        With E and R.
    K : sequence of N (n, n) arrays
        Gains.
    printed : bool
        Take the paper's noise term, which does not hold.

    Returns
    -------
    dict
        a1, a2, b, Rbar_norm, bound and Q1; inf when |Ahat|_2 >= 1.

    Raises
    ------
    InvalidInput
        A bad setting.
    """

def design_gains(setting: Setting, method: str = "auto") -> dict:
    """
    Gains with rho(Ahat) < 1.

    Parameters
    ----------
    setting : Setting
        With E and R (projection needs none).
    method : str
        "riccati", "kalman", "projection", "h2", or "auto", the first of riccati, kalman, h2 with
        which that holds.

    Returns
    -------
    dict
        K (N arrays (n, n)), method, rho, and P: bounds of cov(e_i) where the coupled Riccati recursion
        settled, else empty.

    Raises
    ------
    DesignInfeasible
        With the spectral radius reached.
    InvalidInput
        A bad setting, or an unknown method.
    """

def error_radius(
    setting: Setting, K: collections.abc.Sequence[typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"]]
) -> float:
    """
    rho(Ahat) of (5): errors stay bounded exactly when it is below 1.

    Parameters
    ----------
    setting : Setting
        A, C, W and U are read.
    K : sequence of N (n, n) arrays
        Gains.

    Returns
    -------
    float
        Per sample.

    Raises
    ------
    InvalidInput
        A bad setting or gains that do not fit.
    """

def exposure(
    setting: Setting,
    K: collections.abc.Sequence[typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"]],
    false_alarm: typing.SupportsFloat | typing.SupportsIndex = 0.01,
    detection: typing.SupportsFloat | typing.SupportsIndex = 0.99,
) -> list:
    """
    What a constant attack on each agent can do before it is seen, at steady state.

    Parameters
    ----------
    setting : Setting
        With E and R.
    K : sequence of N (n, n) arrays
        Gains with rho(Ahat) < 1.
    false_alarm : float
        Rate per sample of the tests, above 0 and below 1.
    detection : float
        Probability per sample that counts as seen, above 0 and below 1.

    Returns
    -------
    list of N dict
        smallest_seen, the least size that some agent's test sees; seen_by, that agent;
        harm_per_unit, the largest steady |mean error| per unit of attack; largest_harm, that of an attack of just
        this size.

    Raises
    ------
    InvalidInput
        A number out of range, or rho(Ahat) >= 1.
    """

def false_alarm_of_level(ratio: typing.SupportsFloat | typing.SupportsIndex) -> float:
    """
    False-alarm rate at which a residual of `ratio` standard deviations is just an alarm.

    Parameters
    ----------
    ratio : float
        >= 0.

    Returns
    -------
    float
        Probability per sample.

    Raises
    ------
    InvalidInput
        ratio < 0.
    """

def h2_gains(
    setting: Setting,
    start: collections.abc.Sequence[typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"]],
    hubs: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] = [],
    epsilon: typing.SupportsFloat | typing.SupportsIndex = 0.01,
) -> list[typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]]:
    """
    Gains of least tr Q, under the isolation constraint (18) for some agents.

    Parameters
    ----------
    setting : Setting
        With E and R.
    start : sequence of N (n, n) arrays
        Gains to begin with; they need not be stable.
    hubs : sequence of int
        Agents for which (18) is to hold; none = no constraint.
    epsilon : float
        Of (18), 0 <= epsilon < 1.

    Returns
    -------
    list of N (n, n) arrays
        With rho(Ahat) < 1.

    Raises
    ------
    DesignInfeasible
        With the spectral radius reached.
    InvalidInput
        A bad setting, or a number out of range.
    """

def isolation_ratios(
    setting: Setting, K: collections.abc.Sequence[typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"]]
) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
    """
    (18): how much an attack on j moves the residual of i, by that of j itself, in its first sample.

    Parameters
    ----------
    setting : Setting
        C and U are read.
    K : sequence of N (n, n) arrays
        Gains.

    Returns
    -------
    (N, N) array
        Row i, column j; 0 on the diagonal, inf where the denominator is 0.

    Raises
    ------
    InvalidInput
        A bad setting or gains that do not fit.
    """

def joint_kalman(
    setting: Setting,
    most_sweeps: typing.SupportsInt | typing.SupportsIndex = 20000,
    tolerance: typing.SupportsFloat | typing.SupportsIndex = 1e-14,
) -> dict:
    """
    Gains from the joint covariance of all agents.

    Parameters
    ----------
    setting : Setting
        With E and R.
    most_sweeps : int
        1..1e7.
    tolerance : float
        Relative change at which it has converged, 0..1.

    Returns
    -------
    dict
        K (N arrays (n, n)), converged and sweeps.

    Raises
    ------
    InvalidInput
        A bad setting, or a number out of range.
    """

def kappa(m: typing.SupportsFloat | typing.SupportsIndex) -> float:
    """
    erf(m / sqrt 2): 1 - false-alarm rate at m standard deviations.

    Parameters
    ----------
    m : float
        > 0.

    Returns
    -------
    float
        0..1.

    Raises
    ------
    InvalidInput
        m is not > 0.
    """

def level_of_false_alarm(rate: typing.SupportsFloat | typing.SupportsIndex) -> float:
    """
    How many standard deviations have this false-alarm rate.

    Parameters
    ----------
    rate : float
        Probability per sample, above 0 and below 1.

    Returns
    -------
    float
        m > 0.

    Raises
    ------
    InvalidInput
        The rate is out of range.
    """

def power(
    mean: typing.SupportsFloat | typing.SupportsIndex,
    std: typing.SupportsFloat | typing.SupportsIndex,
    threshold: typing.SupportsFloat | typing.SupportsIndex,
) -> float:
    """
    P(|N(mean, std^2)| >= threshold): how likely the test detects an attack.

    Parameters
    ----------
    mean : float
        By which the attack moves the residual.
    std : float
        Standard deviation of the residual, > 0.
    threshold : float
        Of the test, >= 0, in the same unit.

    Returns
    -------
    float
        Probability per sample.

    Raises
    ------
    InvalidInput
        A number out of range.
    """

def predictions(
    setting: Setting, estimates: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"]
) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
    """
    sum_j W_ij A xhat_j of every agent.

    Parameters
    ----------
    setting : Setting
        A and W are read.
    estimates : (N, n) array
        xhat of the last sample.

    Returns
    -------
    (N, n) array

    Raises
    ------
    InvalidInput
        Shapes do not fit.
    """

def projection_gains(setting: Setting) -> list[typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]]:
    """
    K_i that minimise |(I - K_i D_i) A| (Frobenius norm): closed form, no noise model.

    Parameters
    ----------
    setting : Setting
        A, C and U are read.

    Returns
    -------
    list of N (n, n) arrays

    Raises
    ------
    InvalidInput
        A bad setting.
    """

def setting(model: garrison._core.Model, network: garrison._core.Network, filter: garrison._core.Filter) -> Setting:
    """
    The setting that a Structural filter is designed for on this model and network.

    Parameters
    ----------
    model : Model
        One output per agent, with covariances.
    network : Network
        Of the same agents.
    filter : Filter
        A garrison.filters.Structural.

    Returns
    -------
    Setting

    Raises
    ------
    InvalidInput
        They do not fit each other.
    """

def stationary(
    setting: Setting,
    K: collections.abc.Sequence[typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"]],
    lags: typing.SupportsInt | typing.SupportsIndex = 0,
) -> dict:
    """
    Exact stationary moments of errors and residuals.

    Parameters
    ----------
    setting : Setting
        With E and R.
    K : sequence of N (n, n) arrays
        Gains.
    lags : int
        Covariances of residuals are given up to this lag, >= 0.

    Returns
    -------
    dict
        rho; Q (N n, N n), covariance of the stacked error, its Q_norm and Q_agent_traces (N,);
        covariances, lags + 1 arrays (N, N) of residuals; residual_std and innovation_std (N,); dc_gain (N, N) and
        dc_error (N n, N), steady residuals and errors per unit of a constant attack.

    Raises
    ------
    InvalidInput
        A bad setting, or rho(Ahat) >= 1: there is no steady state.
    """

def step_response(
    setting: Setting,
    K: collections.abc.Sequence[typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"]],
    agent: typing.SupportsInt | typing.SupportsIndex,
    rows: typing.SupportsInt | typing.SupportsIndex,
) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
    """
    Noise-free residuals to a unit step on the measurement of one agent.

    Parameters
    ----------
    setting : Setting
        A, C, W and U are read.
    K : sequence of N (n, n) arrays
        Gains.
    agent : int
        Who is attacked, 0..N-1.
    rows : int
        Samples, >= 0.

    Returns
    -------
    (rows, N) array
        Residuals, from the first sample of the attack on.

    Raises
    ------
    InvalidInput
        A bad setting, or a number out of range.
    """

def template_statistics(
    residuals: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    covariances: collections.abc.Sequence[typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"]],
    dc_gain: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
    """
    Fit of every full window to the steady response to an attack on each agent; the largest names the agent.

    Parameters
    ----------
    residuals : (T, N) array
        Of every agent.
    covariances : sequence of w (N, N) arrays
        Of `stationary`, lags 0..w-1; w is the window.
    dc_gain : (N, N) array
        Of `stationary`.

    Returns
    -------
    (T, N) array
        nan until a window is full.

    Raises
    ------
    InvalidInput
        Shapes do not fit, or there is no covariance.
    """

def thresholds(
    residual_std: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
    m: typing.SupportsFloat | typing.SupportsIndex,
) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
    """
    m standard deviations of every residual.

    Parameters
    ----------
    residual_std : (N,) array
        Standard deviations, >= 0.
    m : float
        > 0.

    Returns
    -------
    (N,) array
        In the units of the residuals.

    Raises
    ------
    InvalidInput
        A number out of range.
    """

def thresholds_printed(
    setting: Setting, Q1: typing.SupportsFloat | typing.SupportsIndex, m: typing.SupportsFloat | typing.SupportsIndex
) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
    """
    The paper's (17), for comparison only: a variance where a deviation belongs.

    Parameters
    ----------
    setting : Setting
        C and R are read.
    Q1 : float
        Of covariance_bound, >= 0 and finite.
    m : float
        > 0.

    Returns
    -------
    (N,) array

    Raises
    ------
    InvalidInput
        A number out of range.
    """

def thresholds_root(
    setting: Setting, Q1: typing.SupportsFloat | typing.SupportsIndex, m: typing.SupportsFloat | typing.SupportsIndex
) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
    """
    m sqrt(|c_i|^2 Q1 + R_ii), the root of the printed (17): the right unit, hugely conservative.

    Parameters
    ----------
    setting : Setting
        C and R are read.
    Q1 : float
        Of covariance_bound, >= 0 and finite.
    m : float
        > 0.

    Returns
    -------
    (N,) array
        In the units of the residuals.

    Raises
    ------
    InvalidInput
        A number out of range.
    """

def windows_exact(
    residuals: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    covariances: collections.abc.Sequence[typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"]],
) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
    """
    v'S^-1 v over the last residuals v, with their covariance S in time.

    Parameters
    ----------
    residuals : (T, N) array
        Of every agent.
    covariances : sequence of w (N, N) arrays
        Of `stationary`, lags 0..w-1; w is the window.

    Returns
    -------
    (T, N) array
        nan until a window is full.

    Raises
    ------
    InvalidInput
        Shapes do not fit, or there is no covariance.
    """

def windows_naive(
    residuals: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    residual_std: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
    window: typing.SupportsInt | typing.SupportsIndex,
) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
    """
    Sums of squares over the last residuals, as if they were independent in time.

    Parameters
    ----------
    residuals : (T, N) array
        Of every agent.
    residual_std : (N,) array
        Standard deviations, >= 0.
    window : int
        Samples, >= 1.

    Returns
    -------
    (T, N) array
        nan until a window is full.

    Raises
    ------
    InvalidInput
        Shapes do not fit, or a number is out of range.
    """
