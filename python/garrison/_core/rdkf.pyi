"""
Covariances, constants and step of the resilient distributed Kalman filter.
"""

from __future__ import annotations
import collections.abc
import garrison._core
import numpy
import numpy.typing
import typing

__all__: list[str] = [
    "Setting",
    "SteadyState",
    "constants",
    "detectable",
    "ipopt_available",
    "lyapunov",
    "scalar_basin",
    "step",
]

class SteadyState:
    """
    Solution of (5): one matrix per agent each.
    """
    def __copy__(self) -> typing.Any: ...
    def __deepcopy__(self, memo: dict) -> typing.Any: ...
    def __eq__(self, other: typing.Any) -> typing.Any: ...
    def __getstate__(self) -> dict: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        P: collections.abc.Sequence[typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"]],
        Pbar: collections.abc.Sequence[typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"]],
        Q: collections.abc.Sequence[typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"]],
        sweeps: typing.SupportsInt | typing.SupportsIndex,
        change: typing.SupportsFloat | typing.SupportsIndex,
    ) -> None: ...
    def __reduce__(self) -> tuple: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, arg0: dict) -> None: ...
    @property
    def P(self) -> list[typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]]:
        """
        (5), (n, n) per agent
        """
    @property
    def Pbar(self) -> list[typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]]:
        """
        (6)
        """
    @property
    def Q(self) -> list[typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]]:
        """
        (1/d_i) sum of Pbar_j^-1 over the agent and its neighbours
        """
    @property
    def change(self) -> float:
        """
        relative change in the last sweep
        """
    @property
    def sweeps(self) -> int: ...

class Setting:
    """
    A model and a network with covariances, connection and detectability checked.
    Raises InvalidInput where a covariance is missing or not positive definite, the network is not
    connected, or (A, C) is not detectable.
    """
    def __init__(self, model: garrison._core.Model, network: garrison._core.Network) -> None: ...
    def __reduce__(self) -> tuple: ...
    def steady_state(
        self,
        start: collections.abc.Sequence[typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"]] = [],
        tolerance: typing.SupportsFloat | typing.SupportsIndex = 1e-14,
        most_sweeps: typing.SupportsInt | typing.SupportsIndex = 20000,
    ) -> SteadyState:
        """
        Solution of (5), from `start` (one matrix per agent; empty = zero). The limit does not depend on it.
        """
    def sweep(
        self, P: collections.abc.Sequence[typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"]]
    ) -> list[typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]]:
        """
        One application of (5) to one (n, n) matrix per agent.
        """

def constants(
    setting: Setting, steady: SteadyState, weight: typing.SupportsFloat | typing.SupportsIndex, penalty: str = "norm"
) -> dict:
    """
    Bounds, theorem III.3 levels, rates and radii. level['printed'] is not valid.
    """

def detectable(
    A: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    C: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
) -> bool:
    """
    Every mode of A that does not decay is seen by some row of C, (m, n).
    """

def ipopt_available() -> bool:
    """
    This build has the solver "ipopt".
    """

def lyapunov(
    steady: SteadyState, errors: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"]
) -> float:
    """
    max e_i' P_i^-1 e_i for errors (N, n).
    """

def scalar_basin(setting: Setting, steady: SteadyState, weight: typing.SupportsFloat | typing.SupportsIndex) -> float:
    """
    One agent, one state: exact radius of convergence without attack.
    """

def step(
    Q: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    M: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    b: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    x0: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    weight: typing.SupportsFloat | typing.SupportsIndex,
    *,
    penalty: str = "norm",
    smoothing: typing.SupportsFloat | typing.SupportsIndex = 0.0,
    solver: str = "exact",
) -> dict:
    """
    min over x of penalty(b - M x) + (x - x0)'Q(x - x0): (8) with whitened measurements.
    Q (n, n) positive definite, M (q, n). penalty: norm, huber or l1. Returns x, mu, iterations,
    residual_norm = |b - M x| and objective (that of penalty norm).
    """
