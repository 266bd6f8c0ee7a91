"""
Theorems, conditions and design of the saturation filter.
"""

from __future__ import annotations
import numpy
import numpy.typing
import typing

__all__: list[str] = [
    "F",
    "Setting",
    "best_threshold",
    "beta_interval",
    "condition11",
    "constants",
    "design",
    "eps_paper",
    "feasibility_margin",
    "fixed_points",
    "minimal_rounds",
    "normA_max_exact",
    "normalise_rows",
    "p_at",
    "rho_sequence",
    "scale_states",
    "theorem4",
    "theorem5",
    "theorem_bounds",
    "whiten",
]

class Setting:
    """
    Plant, network and tuning, reduced to what the theorems need. All sensors have rows of unit length and start
    from the same estimate.

    Parameters
    ----------
    agents : int
        N >= 1.
    a : float
        ||A||, spectral norm, >= 0.
    lambda0 : float
        (6), or a certified lower bound of it (safe in every theorem), 0..N - s.
    contraction : float
        g, what the rounds of a sample leave of a disagreement, 0..1.
    attacked : int
        s, most sensors attacked at a time, 0..N.
    beta : float
        Threshold, > 0, unit of the measurement; nan where a function does not read it.
    eta0 : float
        Bound on the initial error, > 0, unit of the state; nan likewise.
    b_w : float
        ||w(t)|| <= b_w, >= 0.
    b_v : float
        |v_i(t)| <= b_v of every sensor, >= 0.
    sharp : bool
        The smaller q0 that is as sound (docs/filters/saturation.md#s6); False: as printed in (8).
    """
    def __copy__(self) -> typing.Any: ...
    def __deepcopy__(self, memo: dict) -> typing.Any: ...
    def __eq__(self, other: typing.Any) -> typing.Any: ...
    def __getstate__(self) -> dict: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        agents: typing.SupportsInt | typing.SupportsIndex,
        a: typing.SupportsFloat | typing.SupportsIndex,
        lambda0: typing.SupportsFloat | typing.SupportsIndex,
        contraction: typing.SupportsFloat | typing.SupportsIndex,
        attacked: typing.SupportsInt | typing.SupportsIndex,
        beta: typing.SupportsFloat | typing.SupportsIndex = ...,
        eta0: typing.SupportsFloat | typing.SupportsIndex = ...,
        b_w: typing.SupportsFloat | typing.SupportsIndex = ...,
        b_v: typing.SupportsFloat | typing.SupportsIndex = ...,
        sharp: bool = False,
    ) -> None: ...
    def __reduce__(self) -> tuple: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, arg0: dict) -> None: ...

def F(setting: Setting, rho: typing.SupportsFloat | typing.SupportsIndex) -> float:
    """
    F of (8).

    Parameters
    ----------
    setting : Setting
        All of it.
    rho : float
        Bound on the mean error, >= 0.

    Returns
    -------
    float

    Raises
    ------
    InvalidInput
        A bad setting, a g >= 1, or rho < 0.
    """

def best_threshold(setting: Setting, margin: typing.SupportsFloat | typing.SupportsIndex = 1e-06) -> dict:
    """
    Threshold with the least certified asymptotic bound.

    Parameters
    ----------
    setting : Setting
        All of it but beta.
    margin : float
        How far above the least admissible threshold it stays, relative, >= 0.

    Returns
    -------
    dict
        beta, bound (on the error of every agent as t goes to infinity), eta0 to run with, and beta_lo,
        beta_hi: the admissible thresholds.

    Raises
    ------
    DesignInfeasible
        No threshold is admissible, or the bound only falls as beta goes to 0.
    InvalidInput
        A bad setting.
    """

def beta_interval(setting: Setting) -> tuple[float, float]:
    """
    The thresholds with (9) for the given initial error.

    Parameters
    ----------
    setting : Setting
        All of it but beta.

    Returns
    -------
    (float, float)
        Least and largest; nan when there are none.

    Raises
    ------
    InvalidInput
        A bad setting.
    """

def condition11(setting: Setting) -> bool:
    """
    Whether lambda0 > s (11), beyond rounding.

    Parameters
    ----------
    setting : Setting
        N, lambda0 and s are read.

    Returns
    -------
    bool

    Raises
    ------
    InvalidInput
        A bad setting.
    """

def constants(setting: Setting) -> dict:
    """
    The constants of (8), and condition (9).

    Parameters
    ----------
    setting : Setting
        All of it.

    Returns
    -------
    dict
        p0, q0, F_eta0 (F at eta0), cond9_margin, and cond9: whether (9) holds.

    Raises
    ------
    InvalidInput
        A bad setting, or a g >= 1.
    """

def design(
    setting: Setting,
    gamma: typing.SupportsFloat | typing.SupportsIndex,
    *,
    chebyshev: bool = False,
    least: typing.SupportsInt | typing.SupportsIndex = 1,
    most: typing.SupportsInt | typing.SupportsIndex = 200,
    slack: typing.SupportsFloat | typing.SupportsIndex = 1e-09,
) -> dict:
    """
    Rounds and threshold that minimise the certified bound: of all rounds in least..most whose bound is at most
    (1 + slack) times the best, the fewest.

    Parameters
    ----------
    setting : Setting
        All of it but beta and contraction.
    gamma : float
        Contraction of one round, 0 <= gamma < 1.
    chebyshev : bool
        Chebyshev-filtered rounds.
    least, most : int
        Range of the rounds, 1 <= least <= most.
    slack : float
        What a smaller number of rounds may cost, relative, >= 0.

    Returns
    -------
    dict
        rounds, contraction, beta, bound, eta0 as in best_threshold, and fewest_rounds for which (9) has a
        solution.

    Raises
    ------
    DesignInfeasible
        As best_threshold, also when `most` rounds are too few.
    InvalidInput
        A bad setting, gamma or range.
    """

def eps_paper(setting: Setting) -> float:
    """
    eps in the proof of theorem 2: (9) is feasible for 1 <= ||A|| < 1 + eps.

    Parameters
    ----------
    setting : Setting
        N, lambda0 and s are read.

    Returns
    -------
    float
        nan unless lambda0 > s.

    Raises
    ------
    InvalidInput
        A bad setting.
    """

def feasibility_margin(setting: Setting) -> float:
    """
    How far (9) is from having no threshold and initial error for this g.

    Parameters
    ----------
    setting : Setting
        N, a, lambda0, g and s are read.

    Returns
    -------
    float
        Above 0 exactly when there are some; -inf when a g >= 1.

    Raises
    ------
    InvalidInput
        A bad setting.
    """

def fixed_points(setting: Setting) -> tuple[float, float]:
    """
    The fixed points of (7).

    Parameters
    ----------
    setting : Setting
        All of it.

    Returns
    -------
    (float, float)
        The lower and the upper one; nan where there is none.

    Raises
    ------
    InvalidInput
        A bad setting, or a g >= 1.
    """

def minimal_rounds(setting: Setting, gamma: typing.SupportsFloat | typing.SupportsIndex) -> int | None:
    """
    Fewest plain rounds for which some threshold satisfies (9).

    Parameters
    ----------
    setting : Setting
        N, a, lambda0 and s are read.
    gamma : float
        Contraction of one round, 0 <= gamma < 1.

    Returns
    -------
    int or None
        None when no number of rounds is enough.

    Raises
    ------
    InvalidInput
        A bad setting or gamma.
    """

def normA_max_exact(setting: Setting) -> float:
    """
    Supremum of ||A|| for which some threshold, initial error and rounds satisfy (9): N/(N - lambda0 + s).

    Parameters
    ----------
    setting : Setting
        N, lambda0 and s are read.

    Returns
    -------
    float

    Raises
    ------
    InvalidInput
        A bad setting.
    """

def normalise_rows(
    C: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    b_v: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
) -> dict:
    """
    Unit rows, with the noise bounds and the factors for y that belong to them.

    Parameters
    ----------
    C : (N, n) array
        One row per sensor, none of them 0.
    b_v : (N,) array
        Bounds on their noise, >= 0.

    Returns
    -------
    dict
        C (N, n), b_v (N,), and scale (N,): multiply y_i by scale_i before filtering.

    Raises
    ------
    InvalidInput
        A row of zeros, a wrong size or a bad number.
    """

def p_at(setting: Setting, t: typing.SupportsInt | typing.SupportsIndex) -> float:
    """
    p(t) of (10), the bound on the disagreement.

    Parameters
    ----------
    setting : Setting
        All of it.
    t : int
        Sample, >= 0.

    Returns
    -------
    float
        Unit of the state.

    Raises
    ------
    InvalidInput
        A bad setting, a g >= 1, or t < 0.
    """

def rho_sequence(setting: Setting, T: typing.SupportsInt | typing.SupportsIndex) -> list[float]:
    """
    rho_0 .. rho_T of (7), the bound on the mean error.

    Parameters
    ----------
    setting : Setting
        All of it.
    T : int
        Samples, >= 0.

    Returns
    -------
    list of float
        T + 1 numbers, unit of the state.

    Raises
    ------
    InvalidInput
        A bad setting, a g >= 1, or T < 0.
    """

def scale_states(
    A: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    C: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    b_w: typing.SupportsFloat | typing.SupportsIndex,
    b_v: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    tau: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
) -> dict:
    """
    Coordinates z = diag(tau) x. They bring ||A|| of a chain of integrators near 1.

    Parameters
    ----------
    A : (n, n) array
        Of the plant.
    C : (N, n) array
        One row per sensor, none of them 0.
    b_w : float
        Bound on the process noise, >= 0.
    b_v : (N,) array
        Bounds on the measurement noise, >= 0.
    tau : (n,) array
        Factors, > 0.

    Returns
    -------
    dict
        T (n, n) with z = T x; A, C, b_w, b_v, scale of the new coordinates; stretch = ||T|| (of initial
        errors) and shrink = ||T^-1|| (of error bounds, back to x).

    Raises
    ------
    InvalidInput
        A row of zeros, a wrong size or a bad number.
    """

def theorem4(setting: Setting, T: typing.SupportsInt | typing.SupportsIndex) -> list:
    """
    Theorem 4 for d = 0..s proved attackers.

    Parameters
    ----------
    setting : Setting
        All of it.
    T : int
        The sample at which they are proved, >= 0.

    Returns
    -------
    list of dict
        T, d, rho_T, qbar, rhobar_limit, F_star, W (as printed) and tight (what the proof gives:
        use this one), each a bound in the unit of the state; empty when (9) fails or a g >= 1.

    Raises
    ------
    InvalidInput
        A bad setting, or T < 0.
    """

def theorem5(
    setting: Setting,
    tau0: typing.SupportsFloat | typing.SupportsIndex,
    varpi: typing.SupportsFloat | typing.SupportsIndex,
) -> tuple[typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"], float]:
    """
    G of theorem 5: noise-free errors vanish when it is Schur, (9) holds and all s attackers are proved.

    Parameters
    ----------
    setting : Setting
        All of it.
    tau0, varpi : float
        As in theorem 5, or upper bounds, >= 0.

    Returns
    -------
    ((2, 2) array, float)
        G and its spectral radius.

    Raises
    ------
    InvalidInput
        A bad setting, or a negative number.
    """

def theorem_bounds(
    setting: Setting, varpi: typing.SupportsFloat | typing.SupportsIndex, T: typing.SupportsInt | typing.SupportsIndex
) -> dict:
    """
    Theorems 1 and 3 and proposition 2 with t0 = 1. Entry t - 1 of a list belongs to sample t.

    Parameters
    ----------
    setting : Setting
        All of it.
    varpi : float
        Of theorem 3, or an upper bound of it, >= 0.
    T : int
        Length of the lists, >= 1.

    Returns
    -------
    dict
        cond9, and where it holds thm1_item1 (list), thm1_item2, thm1_item3, prop2_f, cond12_margin,
        cond12, and where that holds thm3_item2 (list), thm3_item3. Bounds on the error of every agent, unit of
        the state; nan or empty where a theorem does not apply.

    Raises
    ------
    InvalidInput
        A bad setting, varpi < 0 or T < 1.
    """

def whiten(
    A: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    C: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    b_w: typing.SupportsFloat | typing.SupportsIndex,
    b_v: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
) -> dict:
    """
    Coordinates z = T x with T'T = sum C_i'C_i, T symmetric: the rows of C point in all directions alike, which
    raises lambda0.

    Parameters
    ----------
    A : (n, n) array
        Of the plant.
    C : (N, n) array
        One row per sensor, none of them 0.
    b_w : float
        Bound on the process noise, >= 0.
    b_v : (N,) array
        Bounds on the measurement noise, >= 0.

    Returns
    -------
    dict
        As scale_states.

    Raises
    ------
    InvalidInput
        As scale_states, also when the sum is singular.
    """
