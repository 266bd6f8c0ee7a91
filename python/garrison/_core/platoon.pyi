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
    What Assumptions 1 and 2 and the observer's tuning say: N vehicles, range L, period T,
    b attacked sensors, noise bounds eps and mu, initial error q, threshold beta.
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
    Assumption 4: gv > T gs > 0 and T^2 gs - 2 T gv > -4/sigma_max(L_g); the string's own loop is stable exactly then.
    Raises InvalidInput.
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
    j_i of (13); -1 when there is none.
    """

def best_threshold(setting: Setting) -> float:
    """
    Threshold with the least such limit under the adaptive rule. Raises DesignInfeasible.
    """

def beta1_bar(setting: Setting, omega: typing.SupportsFloat | typing.SupportsIndex) -> float:
    """
    (20); omega > 0.
    """

def beta2_bar(setting: Setting, omega: typing.SupportsFloat | typing.SupportsIndex) -> float:
    """
    (20); omega > 0.
    """

def beta_interval(setting: Setting) -> tuple:
    """
    All thresholds that Theorem 1 admits for some omega.
    """

def beta_interval_safe(setting: Setting) -> tuple:
    """
    All thresholds with which the bound that holds contracts.
    """

def f3(setting: Setting, omega: typing.SupportsFloat | typing.SupportsIndex) -> float:
    """
    (24); omega > 0.
    """

def f4(setting: Setting, omega: typing.SupportsFloat | typing.SupportsIndex) -> float:
    """
    (24); omega > 0.
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
    (14) of one innovation.
    """

def grounded_eigenvalues(vehicles: typing.SupportsInt | typing.SupportsIndex) -> list[float]:
    """
    Of L_g, upwards.
    """

def in_V1(
    vehicle: typing.SupportsInt | typing.SupportsIndex,
    vehicles: typing.SupportsInt | typing.SupportsIndex,
    range: typing.SupportsInt | typing.SupportsIndex,
) -> bool:
    """
    (5): hears 2L others.
    """

def loop_factors(
    vehicles: typing.SupportsInt | typing.SupportsIndex,
    period: typing.SupportsFloat | typing.SupportsIndex,
    gs: typing.SupportsFloat | typing.SupportsIndex,
    gv: typing.SupportsFloat | typing.SupportsIndex,
) -> dict:
    """
    Factors of Lemma 2 for P_0 of (31) by 2 x 2 blocks; all but rho nan when P_0 is not Schur.
    """

def model(
    vehicles: typing.SupportsInt | typing.SupportsIndex,
    period: typing.SupportsFloat | typing.SupportsIndex,
    inputs: bool = False,
) -> garrison._core.Model:
    """
    Model of N vehicles (position m, velocity m/s) sampled every `period` s. Outputs per vehicle: absolute
    position and velocity (attackable); relative ones to the vehicle ahead (secured, not of vehicle 0); with
    `inputs`, for recorded data, the input applied from this sample on (nan = what the filter commanded).
    """

def nearest(
    vehicle: typing.SupportsInt | typing.SupportsIndex, vehicles: typing.SupportsInt | typing.SupportsIndex
) -> list[int]:
    """
    (30): the next ones; -1 stands for the reference, on both sides.
    """

def omega_interval(setting: Setting) -> tuple:
    """
    All omega with 0 < beta1_bar < beta2_bar; (nan, nan) when there is none.
    """

def proposition2(setting: Setting, omega: typing.SupportsFloat | typing.SupportsIndex) -> bool:
    """
    (23); omega > 0.
    """

def runs(labels: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex]) -> tuple[list[list[int]], int]:
    """
    Maximal runs of successive labels, and the left side of (29).
    """

def safe_limit(setting: Setting) -> float:
    """
    Limit of the bound that holds, nobody identified; nan when it grows for ever.
    """

def theorem1(
    setting: Setting,
    *,
    free_in_reach: typing.SupportsInt | typing.SupportsIndex = 0,
    proved: typing.SupportsInt | typing.SupportsIndex = 0,
    distance: typing.SupportsInt | typing.SupportsIndex = 1,
) -> dict:
    """
    (21), (22) as printed.
    """

def theorem2(
    setting: Setting,
    *,
    free_in_reach: typing.SupportsInt | typing.SupportsIndex = 0,
    proved: typing.SupportsInt | typing.SupportsIndex = 0,
    distance: typing.SupportsInt | typing.SupportsIndex = 1,
) -> dict:
    """
    (26), with 2L+1-b in h1.
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
    Limsup of (4): as printed, with the corrected (31), and with the sharper factor.
    """

DISTURBANCES: int = 7
