"""Plants that are nonlinear, by functions of all agents at once."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from garrison import _core
from garrison.arguments import require_arguments, whole, whole_numbers
from garrison.linear_rows import Rows, linear_rows
from garrison.numeric import whole_of
from garrison.varying import parted
from garrison.words import Hinting, count, hinted, hinted_methods, refusal, shown

Array = NDArray[np.float64]
#: what h and its derivative may return: all agents on top of each other, or one array per agent
ByAgent = ArrayLike | Sequence[ArrayLike]


@hinted_methods
class NonlinearModel(metaclass=Hinting):
    """A nonlinear plant by functions: x(t+1) = f(x(t), u(t), t) + w(t), y(t) = h(x(t), t) + v(t).

    Taken by `simulate` and `replay`. Filters: `ScalarGain`, `Saturation` with nothing that promises a bound (no
    initial_error, detector, adaptive, table), and filters of your own. Every agent predicts f of its own estimate, and
    uses its measurement along dh/dx at its own prediction: the innovation is y_i - h_i(f(xhat_i)). Rounds, saturation,
    links, lies and attacks are those of linear plants. No theorem covers it, so bounds are absent
    (`BoundKind.VARYING`). Certificates bound errors by the measurements of one sample, where enough outputs are
    `linear`; what moves by A (earlier samples, memory, tables) is absent. Rows of dh/dx should be at most about 1 long
    (a run warns where they are not): divide outputs by their length. A filter of your own finds the prediction in
    `state.estimate`, the identity in `agent.A`, its rows in `agent.C`, and the innovation as
    y - agent.C @ state.estimate.

    Functions are called for all agents at once. X is an array (k, n) with a row per agent, which differ, as estimates
    do: `X[:, 0]` is the first state of all of them. They run in one thread; what they raise passes.

    Parameters
    ----------
    f : function (X, u, t) -> (k, n)
        The state at t + 1 of every row, whatever their number k; u is (p,), empty without inputs.
    h : function (X, t) -> (outputs,), or rows
        What all sensors measure, those of agent i at X[i]: agent by agent, as (N, m) where each has m outputs, or a
        list with an array per agent. Where all outputs are linear: their rows instead, as C of Model.
    states : int or n names
        How many states there are; names: default x1, x2, ..
    outputs : sequence of int
        How many outputs each agent has, >= 0.
    inputs : int or p names, optional
        Known inputs u; runs then take `inputs`, one row u(t) per step.
    h_jacobian : function (X, t) -> (outputs, n), optional
        dh/dx, the rows of agent i at X[i]: agent by agent, as (N, m, n), or a list of N arrays. Default: central
        differences, 2n calls of h per sample.
    linear : (outputs, n) array or list of N arrays (m_i, n), optional
        Rows of outputs that are linear, h_r(x) = row x at all x and t, and nan in the rows of others. A run refuses
        rows that h contradicts. Certificates rest on these outputs alone.
    process_bound, measurement_bound, process_covariance, measurement_covariance : optional
        Of w and v, as in Model.
    output_names : names, optional
        One per measurement of the whole network, agent by agent.
    sources, units, exposed : optional
        As in Model.

    Raises
    ------
    InvalidInput
        Sizes or names do not fit, or something is no function. What functions return is checked when they run.
    """

    @hinted
    def __init__(
        self,
        f: Callable[..., ArrayLike],
        h: Callable[..., ByAgent] | ByAgent,
        *,
        states: int | Sequence[str],
        outputs: Sequence[int],
        inputs: int | Sequence[str] = 0,
        h_jacobian: Callable[..., ByAgent] | None = None,
        linear: ByAgent | None = None,
        process_bound: float | None = None,
        measurement_bound: ArrayLike | None = None,
        process_covariance: ArrayLike | float | None = None,
        measurement_covariance: Any = None,
        output_names: Sequence[str] | None = None,
        sources: Sequence[str] | None = None,
        units: dict[str, str] | str | None = None,
        exposed: Sequence[int] | None = None,
    ) -> None:
        alone = isinstance(h, (list, tuple, np.ndarray))
        if alone and linear is not None:
            raise refusal("NonlinearModel.linear", "rows beside rows as h", "one of them")
        self._functions: dict[str, Any] = {"f": f, "h": None if alone else h, "h_jacobian": h_jacobian}
        for name, takes in {"f": ("X", "u", "t"), "h": ("X", "t"), "h_jacobian": ("X", "t")}.items():
            if not (alone and name == "h"):
                _require_function(name, self._functions[name], takes)
        n, names = _sized("states", states, 1)
        p, known = _sized("inputs", inputs, 0)
        rows = whole_numbers("NonlinearModel.outputs", outputs)
        if not rows:
            raise refusal("NonlinearModel.outputs", "none", "how many outputs each agent has")
        seen = linear_rows(h if alone else linear, rows, n)
        self._linear = np.flatnonzero(np.isfinite(seen).all(axis=1)).tolist()
        if alone:
            if len(self._linear) < sum(rows):
                raise refusal("NonlinearModel.h", "rows of nan", "numbers, or a function and `linear` beside it")
            self._functions["h"] = Rows(seen, rows)
        C = np.split(np.nan_to_num(seen, nan=0.0), np.cumsum(rows)[:-1])
        optional: dict[str, Any] = {"states": names, "outputs": output_names, "sources": sources, "units": units}
        optional |= {"exposed": exposed} | ({"B": np.zeros((n, p)), "inputs": known} if p else {})
        self._model = _core.Model(
            np.eye(n),
            C,
            process_bound=process_bound,
            measurement_bound=measurement_bound,
            process_covariance=process_covariance,
            measurement_covariance=measurement_covariance,
            **optional,
        )

    @property
    def model(self) -> _core.Model:
        """Sizes, noise and names. No plant: its A is the identity, its B zero, its C zero but for linear rows."""
        return self._model

    @property
    def functions(self) -> dict[str, Any]:
        """f, h and h_jacobian (None: central differences) by name."""
        return dict(self._functions)

    @property
    def linear(self) -> list[int]:
        """Outputs that are linear, by number; their rows are in `model.C`."""
        return list(self._linear)

    @property
    def central(self) -> tuple[Callable[..., Array], Callable[..., Array]]:
        """(f, h) of one state x (n,), as `extended_kalman` takes them."""
        f, h, agents = self._functions["f"], self._functions["h"], self._model.agents

        def moved(x: Array, u: Array, t: int) -> Array:
            return np.asarray(f(x[None], u, t), dtype=float).ravel()

        def measured(x: Array, t: int) -> Array:
            found = h(np.tile(x, (agents, 1)), t)
            parts = found if isinstance(found, (list, tuple)) else [found]
            return np.concatenate([np.ravel(np.asarray(part, dtype=float)) for part in parts])

        return moved, measured

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, NonlinearModel):
            return NotImplemented
        same = self._model == other._model and self._linear == other._linear
        return same and self._functions == other._functions

    def __hash__(self) -> int:
        return hash((self._model, tuple(self._functions.values())))

    def __reduce__(self) -> Any:
        raise refusal("NonlinearModel", "pickle or copy", "none", "its functions are not kept; make it anew from them")

    def __repr__(self) -> str:
        named = ", ".join(getattr(one, "__name__", "function") for one in self._functions.values() if one is not None)
        sizes = (count(self._model.states, "state"), count(self._model.agents, "agent"))
        return f"<NonlinearModel of {named}: {', '.join(sizes)}>"


def _require_function(name: str, given: Any, takes: tuple[str, ...]) -> None:
    optional = name == "h_jacobian"
    if given is None and optional:
        return
    if not callable(given):
        words = f"a function of ({', '.join(takes)})"
        raise refusal(f"NonlinearModel.{name}", shown(given), words + (", or None" if optional else ""))
    require_arguments(f"NonlinearModel.{name}", given, takes)


def _sized(which: str, given: Any, least: int) -> tuple[int, Any]:
    """A number, and names where these were given instead."""
    if isinstance(given, str) or whole_of(given) is not None or not isinstance(given, Sequence):
        return whole(f"NonlinearModel.{which}", given, least), None
    return max(len(given), least), list(given)


def split(model: Any) -> tuple[Any, dict[str, Any]]:
    """The constant part of any plant, and what drivers are told besides: what changes, or functions."""
    if isinstance(model, NonlinearModel):
        return model.model, {"series": {}, "functions": model.functions | {"linear": model.linear}}
    plain, series = parted(model)
    return plain, {"series": series, "functions": {}}


__all__ = ["ByAgent", "NonlinearModel", "split"]
