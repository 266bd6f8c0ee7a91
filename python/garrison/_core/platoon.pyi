"""
Vehicles in a string: model and analysis. Ids 0..N-1 are the paper's 1..N.
"""

from __future__ import annotations
import collections.abc
import garrison._core
import typing

__all__: list[str] = [
    "DISTURBANCES",
    "Setting",
    "assumption4",
    "best_source",
    "best_threshold",
    "beta1_bar",
    "beta2_bar",
    "beta_interval",
    "beta_interval_safe",
    "f3",
    "f4",
    "gain",
    "grounded_eigenvalues",
    "in_V1",
    "loop_factors",
    "model",
    "nearest",
    "omega_interval",
    "proposition2",
    "runs",
    "safe_limit",
    "theorem1",
    "theorem2",
    "theorem4",
]

class Setting:
    """
    What Assumptions 1 and 2 and the observer's tuning say.

    Parameters
    ----------
    vehicles : int
        N >= 2 L + 1, at least 3.
    range : int
        L >= 1: vehicles hear those at most L places away.
    period : float
        T > 0, s.
    attacked : int
        b, most absolute sensors attacked, 1..L.
    eps : float
        Bound on the process noise (m and m/s), >= 0.
    mu : float
        Bound on the measurement noise (m and m/s), >= 0.
    q : float
        Bound on the initial error (m and m/s), > 0.
    varpi : float
        1/varpi is the gain of vehicles outside V_1; in (1, ||A||/(||A|| - 1)).
    beta : float
        Static threshold, or beta_{i,0} of (25), > 0.
    adaptive : bool
        Threshold of (25); False: beta throughout.

    Raises
    ------
    InvalidInput
        A number out of range.
    """
    def __copy__(self) -> typing.Any: ...
    def __deepcopy__(self, memo: dict) -> typing.Any: ...
    def __eq__(self, other: typing.Any) -> typing.Any: ...
    def __getstate__(self) -> dict: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        vehicles: typing.SupportsInt | typing.SupportsIndex,
        range: typing.SupportsInt | typing.SupportsIndex,
        period: typing.SupportsFloat | typing.SupportsIndex,
        attacked: typing.SupportsInt | typing.SupportsIndex,
        eps: typing.SupportsFloat | typing.SupportsIndex,
        mu: typing.SupportsFloat | typing.SupportsIndex,
        q: typing.SupportsFloat | typing.SupportsIndex,
        varpi: typing.SupportsFloat | typing.SupportsIndex = 2.0,
        beta: typing.SupportsFloat | typing.SupportsIndex,
        adaptive: bool = True,
    ) -> None: ...
    def __reduce__(self) -> tuple: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, arg0: dict) -> None: ...
    @property
    def beta0(self) -> float:
        """
        (20), with mubar
        """
    @property
    def k0(self) -> float:
        """
        (25)
        """
    @property
    def mubar(self) -> float:
        """
        (8)
        """
    @property
    def norm_A(self) -> float:
        """
        ||A|| of A = (1 T; 0 1): T/2 + sqrt(1 + T^2/4).
        """

def assumption4(
    vehicles: typing.SupportsInt | typing.SupportsIndex,
    period: typing.SupportsFloat | typing.SupportsIndex,
    gs: typing.SupportsFloat | typing.SupportsIndex,
    gv: typing.SupportsFloat | typing.SupportsIndex,
) -> bool:
    """
    Assumption 4: gv > T gs > 0 and T^2 gs - 2 T gv > -4/sigma_max(L_g); the string's own loop is stable exactly
    then.

    Parameters
    ----------
    vehicles : int
        N >= 1.
    period : float
        T > 0, s.
    gs : float
        Gain on positions, 1/s^2.
    gv : float
        Gain on velocities, 1/s.

    Returns
    -------
    bool

    Raises
    ------
    InvalidInput
        A number out of range, or not finite.
    """

def best_source(
    vehicle: typing.SupportsInt | typing.SupportsIndex,
    vehicles: typing.SupportsInt | typing.SupportsIndex,
    range: typing.SupportsInt | typing.SupportsIndex,
    free: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex],
    *,
    by_bound: bool,
    alpha: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex],
) -> int:
    """
    j_i of (13): the vehicle from which one without enough sensors in reach takes its estimate.

    Parameters
    ----------
    vehicle : int
        0..N-1.
    vehicles : int
        N.
    range : int
        L >= 1.
    free : sequence of int
        Vehicles whose sensors are known to be free.
    by_bound : bool
        Of two that are equally near take the one with the smaller alpha, else the lower one.
    alpha : (N,) floats
        Bound on the error of every vehicle.

    Returns
    -------
    int
        -1 when there is none.

    Raises
    ------
    InvalidInput
        A number out of range.
    """

def best_threshold(setting: Setting) -> float:
    """
    Threshold of beta_interval_safe with the least safe_limit under the adaptive rule.

    Parameters
    ----------
    setting : Setting
        All but beta.

    Returns
    -------
    float

    Raises
    ------
    DesignInfeasible
        There is none.
    """

def beta1_bar(setting: Setting, omega: typing.SupportsFloat | typing.SupportsIndex) -> float:
    """
    Least threshold of (20).

    Parameters
    ----------
    setting : Setting
        All but beta.
    omega : float
        > 0; the theorems take it below 1.

    Returns
    -------
    float

    Raises
    ------
    InvalidInput
        omega is not > 0.
    """

def beta2_bar(setting: Setting, omega: typing.SupportsFloat | typing.SupportsIndex) -> float:
    """
    Largest threshold of (20).

    Parameters
    ----------
    setting : Setting
        All but beta.
    omega : float
        > 0; the theorems take it below 1.

    Returns
    -------
    float

    Raises
    ------
    InvalidInput
        omega is not > 0.
    """

def beta_interval(setting: Setting) -> tuple:
    """
    All thresholds that Theorem 1 admits for some omega.

    Parameters
    ----------
    setting : Setting
        All but beta.

    Returns
    -------
    (float, float)
        nan when there is none.
    """

def beta_interval_safe(setting: Setting) -> tuple:
    """
    All thresholds with which the bound that holds contracts.

    Parameters
    ----------
    setting : Setting
        All but beta.

    Returns
    -------
    (float, float)
        nan when there is none.
    """

def f3(setting: Setting, omega: typing.SupportsFloat | typing.SupportsIndex) -> float:
    """
    f_3 of (24).

    Parameters
    ----------
    setting : Setting
        All of it.
    omega : float
        > 0; the theorems take it below 1.

    Returns
    -------
    float

    Raises
    ------
    InvalidInput
        omega is not > 0.
    """

def f4(setting: Setting, omega: typing.SupportsFloat | typing.SupportsIndex) -> float:
    """
    f_4 of (24).

    Parameters
    ----------
    setting : Setting
        All of it.
    omega : float
        > 0; the theorems take it below 1.

    Returns
    -------
    float

    Raises
    ------
    InvalidInput
        omega is not > 0.
    """

def gain(
    beta: typing.SupportsFloat | typing.SupportsIndex,
    eta_s: typing.SupportsFloat | typing.SupportsIndex,
    eta_v: typing.SupportsFloat | typing.SupportsIndex,
    *,
    attacked: bool = False,
    free: bool = False,
) -> float:
    """
    (14): what is used of one innovation.

    Parameters
    ----------
    beta : float
        Threshold, > 0; may be inf.
    eta_s, eta_v : float
        The innovation: position (m) and velocity (m/s), finite.
    attacked : bool
        The sensor is proved to be attacked: 0.
    free : bool
        It is known to be free: 1.

    Returns
    -------
    float
        0..1.

    Raises
    ------
    InvalidInput
        A number out of range.
    """

def grounded_eigenvalues(vehicles: typing.SupportsInt | typing.SupportsIndex) -> list[float]:
    """
    Eigenvalues of the grounded Laplacian L_g.

    Parameters
    ----------
    vehicles : int
        N >= 1.

    Returns
    -------
    list of N float
        Upwards.

    Raises
    ------
    InvalidInput
        vehicles < 1.
    """

def in_V1(
    vehicle: typing.SupportsInt | typing.SupportsIndex,
    vehicles: typing.SupportsInt | typing.SupportsIndex,
    range: typing.SupportsInt | typing.SupportsIndex,
) -> bool:
    """
    (5): whether a vehicle hears 2 L others.

    Parameters
    ----------
    vehicle : int
        0..N-1.
    vehicles : int
        N >= 1.
    range : int
        L >= 1.

    Returns
    -------
    bool

    Raises
    ------
    InvalidInput
        A number out of range.
    """

def loop_factors(
    vehicles: typing.SupportsInt | typing.SupportsIndex,
    period: typing.SupportsFloat | typing.SupportsIndex,
    gs: typing.SupportsFloat | typing.SupportsIndex,
    gv: typing.SupportsFloat | typing.SupportsIndex,
) -> dict:
    """
    Factors of Lemma 2 for P_0 of (31), by 2 x 2 blocks.

    Parameters
    ----------
    vehicles : int
        N >= 1.
    period : float
        T > 0, s.
    gs : float
        Gain on positions, 1/s^2.
    gv : float
        Gain on velocities, 1/s.

    Returns
    -------
    dict
        rho (spectral radius of P_0), M_max, M_min, kappa, xi as printed, and l1, the sharper factor; all
        but rho nan when P_0 is not Schur.

    Raises
    ------
    InvalidInput
        A number out of range, or not finite.
    """

def model(
    vehicles: typing.SupportsInt | typing.SupportsIndex,
    period: typing.SupportsFloat | typing.SupportsIndex,
    inputs: bool = False,
) -> garrison._core.Model:
    """
    Model of vehicles in a string. Outputs per vehicle: absolute position (m) and velocity (m/s), which can be
    attacked; the same relative to the vehicle ahead, which cannot (not of vehicle 0).

    Parameters
    ----------
    vehicles : int
        N >= 3.
    period : float
        Between samples, s, > 0.
    inputs : bool
        One output more, for recorded data: the input applied from this sample on (nan = what the
        filter commanded).

    Returns
    -------
    Model

    Raises
    ------
    InvalidInput
        A number out of range.
    """

def nearest(
    vehicle: typing.SupportsInt | typing.SupportsIndex, vehicles: typing.SupportsInt | typing.SupportsIndex
) -> list[int]:
    """
    (30): the vehicles next to one; -1 stands for the reference, on both sides.

    Parameters
    ----------
    vehicle : int
        -1 (the reference)..N-1.
    vehicles : int
        N >= 1.

    Returns
    -------
    list of int

    Raises
    ------
    InvalidInput
        A number out of range.
    """

def omega_interval(setting: Setting) -> tuple:
    """
    All omega with 0 < beta1_bar < beta2_bar.

    Parameters
    ----------
    setting : Setting
        All but beta.

    Returns
    -------
    (float, float)
        An open interval; nan when there is none.
    """

def proposition2(setting: Setting, omega: typing.SupportsFloat | typing.SupportsIndex) -> bool:
    """
    Whether (23) holds: equivalent to 0 < beta1_bar < beta2_bar (docs/filters/platoon.md#e6).

    Parameters
    ----------
    setting : Setting
        All but beta.
    omega : float
        > 0; the theorems take it below 1.

    Returns
    -------
    bool

    Raises
    ------
    InvalidInput
        omega is not > 0.
    """

def runs(labels: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex]) -> tuple[list[list[int]], int]:
    """
    Maximal runs of successive labels, and the left side of (29): at least how many attacked sensors they take.

    Parameters
    ----------
    labels : sequence of int
        In any order.

    Returns
    -------
    (list of lists of int, int)
    """

def safe_limit(setting: Setting) -> float:
    """
    Limit of the bound that holds, nobody identified.

    Parameters
    ----------
    setting : Setting
        All of it.

    Returns
    -------
    float
        On the error of every vehicle (m and m/s); nan when it grows for ever.
    """

def theorem1(
    setting: Setting,
    *,
    free_in_reach: typing.SupportsInt | typing.SupportsIndex = 0,
    proved: typing.SupportsInt | typing.SupportsIndex = 0,
    distance: typing.SupportsInt | typing.SupportsIndex = 1,
) -> dict:
    """
    Theorem 1, (21) and (22) as printed; safe_limit is the bound that holds.

    Parameters
    ----------
    setting : Setting
        All of it.
    free_in_reach : int
        |S_{i,1}|, sensors in reach known to be free, 0..2 L.
    proved : int
        |S^a_i|, sensors proved to be attacked, 0..b.
    distance : int
        |j_i - i|, places to the next vehicle of V_1, 1..N.

    Returns
    -------
    dict
        k_star, Q, m, and alpha1, alpha2, alpha3: asymptotic bounds (m and m/s).

    Raises
    ------
    InvalidInput
        A number out of range.
    """

def theorem2(
    setting: Setting,
    *,
    free_in_reach: typing.SupportsInt | typing.SupportsIndex = 0,
    proved: typing.SupportsInt | typing.SupportsIndex = 0,
    distance: typing.SupportsInt | typing.SupportsIndex = 1,
) -> dict:
    """
    Theorem 2, (26), with 2L + 1 - b in h1, as (D.2) has it.

    Parameters
    ----------
    setting : Setting
        All of it.
    free_in_reach : int
        |S_{i,1}|, sensors in reach known to be free, 0..2 L.
    proved : int
        |S^a_i|, sensors proved to be attacked, 0..b.
    distance : int
        |j_i - i|, places to the next vehicle of V_1, 1..N.

    Returns
    -------
    dict
        k0, h1, h2, and alpha1, alpha2, alpha3: asymptotic bounds (m and m/s).

    Raises
    ------
    InvalidInput
        A number out of range.
    """

def theorem4(
    vehicles: typing.SupportsInt | typing.SupportsIndex,
    period: typing.SupportsFloat | typing.SupportsIndex,
    gs: typing.SupportsFloat | typing.SupportsIndex,
    gv: typing.SupportsFloat | typing.SupportsIndex,
    eps: typing.SupportsFloat | typing.SupportsIndex,
    alpha: typing.SupportsFloat | typing.SupportsIndex,
) -> dict:
    """
    Limsup of phi (4), the mean deviation from the formation.

    Parameters
    ----------
    vehicles : int
        N >= 1.
    period : float
        T > 0, s.
    gs : float
        Gain on positions, 1/s^2.
    gv : float
        Gain on velocities, 1/s.
    eps : float
        Bound on the process noise (m and m/s), >= 0.
    alpha : float
        Limsup of every vehicle's estimation error, >= 0.

    Returns
    -------
    dict
        eta and bound as printed; eta_safe and bound_safe with the corrected (31)
        (docs/filters/platoon.md#e5); bound_sharp with the sharper factor; spacing, of |gap - desired gap| (m).

    Raises
    ------
    InvalidInput
        A number out of range, or not finite.
    """

DISTURBANCES: int = 7
