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
    Plant, network and tuning, reduced to what the theorems need. All sensors have rows of unit length
    and start from the same estimate.
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
    F of (8); rho finite and >= 0.
    """

def best_threshold(setting: Setting, margin: typing.SupportsFloat | typing.SupportsIndex = 1e-06) -> dict:
    """
    Threshold with the least certified asymptotic bound.
    """

def beta_interval(setting: Setting) -> tuple[float, float]:
    """
    Thresholds with (9) for the given initial error; nan when there are none.
    """

def condition11(setting: Setting) -> bool:
    """
    Whether lambda0 > s (11), beyond rounding. Raises InvalidInput.
    """

def constants(setting: Setting) -> dict:
    """
    (8) and (9).
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
    Rounds and threshold that minimise the certified bound: of all rounds in least..most whose bound is
    at most (1 + slack) times the best, the fewest. gamma is the contraction of one round.
    """

def eps_paper(setting: Setting) -> float:
    """
    eps in the proof of theorem 2: (9) is feasible for 1 <= ||A|| < 1 + eps; nan unless lambda0 > s. Raises InvalidInput.
    """

def feasibility_margin(setting: Setting) -> float:
    """
    Above 0 exactly when some threshold and initial error satisfy (9) for this g; -inf when a g >= 1. Reads N, a, lambda0,
    g, s. Raises InvalidInput.
    """

def fixed_points(setting: Setting) -> tuple[float, float]:
    """
    Lower and upper fixed point of (7); nan where there is none.
    """

def minimal_rounds(setting: Setting, gamma: typing.SupportsFloat | typing.SupportsIndex) -> int | None:
    """
    Fewest plain rounds for which some threshold satisfies (9); None when no number is enough.
    """

def normA_max_exact(setting: Setting) -> float:
    """
    Supremum of ||A|| for which some threshold, initial error and rounds satisfy (9): N/(N - lambda0 + s). Reads N,
    lambda0, s. Raises InvalidInput.
    """

def normalise_rows(
    C: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    b_v: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
) -> dict:
    """
    Unit rows, with the noise bounds and the factors for y that belong to them.
    """

def p_at(setting: Setting, t: typing.SupportsInt | typing.SupportsIndex) -> float:
    """
    p(t) of (10).
    """

def rho_sequence(setting: Setting, T: typing.SupportsInt | typing.SupportsIndex) -> list[float]:
    """
    rho_0 .. rho_T of (7).
    """

def scale_states(
    A: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    C: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    b_w: typing.SupportsFloat | typing.SupportsIndex,
    b_v: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    tau: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
) -> dict:
    """
    Coordinates z = diag(tau) x.
    """

def theorem4(setting: Setting, T: typing.SupportsInt | typing.SupportsIndex) -> list:
    """
    Theorem 4 for d = 0..s proved attackers.
    """

def theorem5(
    setting: Setting,
    tau0: typing.SupportsFloat | typing.SupportsIndex,
    varpi: typing.SupportsFloat | typing.SupportsIndex,
) -> tuple[typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"], float]:
    """
    G of theorem 5 and its spectral radius.
    """

def theorem_bounds(
    setting: Setting, varpi: typing.SupportsFloat | typing.SupportsIndex, T: typing.SupportsInt | typing.SupportsIndex
) -> dict:
    """
    Theorems 1 and 3 and proposition 2 with t0 = 1.
    """

def whiten(
    A: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    C: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    b_w: typing.SupportsFloat | typing.SupportsIndex,
    b_v: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
) -> dict:
    """
    Coordinates in which sum C_i'C_i was the identity.
    """
