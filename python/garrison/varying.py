"""Plants that change in time: a constant part, and what replaces it step by step; known inputs."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from garrison import _core, notebook
from garrison.arguments import whole
from garrison.numeric import matched, numbers
from garrison.varying_noise import below_each_other
from garrison.words import Hinting, count, hinted, hinted_methods, refusal, shown

Array = NDArray[np.float64]
#: matrices over time, or a function of the time
OverTime = ArrayLike | Callable[[int], ArrayLike]
#: known inputs: an array, a table or a function of the time; None: none
Inputs = OverTime | None
_PARTS = ("A", "B", "C", "process_covariance", "measurement_covariance")


@hinted_methods
class VaryingModel(metaclass=Hinting):
    """A plant that changes in time: x(t+1) = A(t) x(t) + B(t) u(t) + w(t), y(t) = C(t) x(t) + v(t).

    Taken by `simulate`, `replay`, `compare`, `central_kalman` and `local_kalman`. Filters: `ScalarGain`, `Saturation`
    without detector, adaptive and table, `PartialSharing(gains="varying")`, whose gains follow it, and filters of your
    own (`agent.A`, `agent.C` are those of the sample); the others are designed for one A and C and refuse it. No
    theorem of theirs covers it, so their bounds are absent (`BoundKind.VARYING`). Certificates hold: each sample has
    its rows and variances; where A or process_covariance changes, regions of earlier samples count with `memory` only.
    Where only C changes, between finitely many rows (sightings), give a constant Model all rows and measure nan where
    there is no sighting: everything holds then.
    Immutable; compares by value, copies and pickles.

    Parameters
    ----------
    model : Model
        The constant part: sizes, noise, names, and the matrices that do not change.
    A : (T, n, n) array or function, optional
        A[t] leads from time t to t + 1. A function is called with t = 0..steps-1.
    B : (T, n, p) array or function, optional
        Likewise; needs a model with B.
    C : list of (T, m_i, n) arrays, (T, outputs, n) array or function, optional
        Entry r is that of sample r + 1, one array per agent or all rows on top of each other. A function is called with
        t = 1..steps and returns the rows of all agents, (outputs, n) or a list with those of each.
    process_covariance : (T, n, n) array or function, optional
        Of w(t); simulated, and used by the Kalman filters, `PartialSharing` and certificates.
    measurement_covariance : list of (T, m_i, m_i) arrays, (T, outputs) array or function, optional
        Of v(t), used likewise; entry r is that of sample r + 1. One array per agent; or the variances of all outputs,
        which are independent then; or (T, outputs, most m_i), those of all agents below each other with zeros right of
        smaller ones, as `parts` has it. A function is called with t = 1..steps and returns a number for all outputs,
        their variances, or a list with the (m_i, m_i) of each agent.
    steps : int, optional
        T, where functions are given.

    Raises
    ------
    InvalidInput
        Shapes do not fit the model, or each other.
    """

    @hinted
    def __init__(
        self,
        model: _core.Model,
        *,
        A: OverTime | None = None,
        B: OverTime | None = None,
        C: OverTime | Sequence[ArrayLike] | None = None,
        process_covariance: OverTime | None = None,
        measurement_covariance: OverTime | Sequence[ArrayLike] | None = None,
        steps: int | None = None,
    ) -> None:
        if not isinstance(model, _core.Model):
            raise refusal("VaryingModel.model", shown(model), "a garrison.Model, the constant part")
        n, p, m = model.states, model.inputs, model.outputs
        T = None if steps is None else whole("steps", steps, 1)
        rows = [len(c) for c in model.C]
        given = {
            "A": _over_time("A", A, (n, n), T, 0),
            "B": _over_time("B", B, (n, p), T, 0),
            "C": _over_time("C", _stacked(C, rows), (m, n), T, 1),
            "process_covariance": _over_time("process_covariance", process_covariance, (n, n), T, 0),
            "measurement_covariance": _over_time(
                "measurement_covariance",
                below_each_other(measurement_covariance, rows),
                (m, max(rows, default=0)),
                T,
                1,
            ),
        }
        self._model = model
        self._parts = {name: value for name, value in given.items() if value is not None}
        if not self._parts:
            raise refusal("VaryingModel", "nothing that changes", f"one of {', '.join(_PARTS)} over time")
        lengths = {name: len(value) for name, value in self._parts.items()}
        if len(set(lengths.values())) > 1:
            got = ", ".join(f"{name} of {count(length, 'step')}" for name, length in lengths.items())
            raise refusal("VaryingModel", got, "equally many of each")
        for value in self._parts.values():
            value.flags.writeable = False

    @classmethod
    @hinted
    def from_continuous(
        cls,
        A: ArrayLike,
        C: Any,
        times: ArrayLike,
        *,
        process_intensity: ArrayLike | float | None = None,
        B: ArrayLike | None = None,
        **model: Any,
    ) -> VaryingModel:
        """The plant dx/dt = A x + B u + white noise at irregular times, exactly (Van Loan 1978); u is held in between.

        Parameters
        ----------
        A : (n, n) array
            Of the differential equation, per unit of time.
        C : sequence of (m_i, n) arrays, or (N, n) array
            As in Model.
        times : (T + 1,) array
            Increasing, in the unit of time of A; the first is that of the start, sample t is at times[t].
        process_intensity : (n, n) array or float, optional
            Spectral density of the noise, state^2 per time; a number is times the identity.
        B : (n, p) array, optional
            What known inputs u do to dx/dt.
        **model
            The rest as in Model.

        Returns
        -------
        VaryingModel

        Raises
        ------
        InvalidInput
            Times that do not increase, or what Model refuses.
        """
        at = numbers("times", times)
        if at.ndim != 1 or len(at) < 2 or not np.isfinite(at).all() or not (np.diff(at) > 0).all():
            raise refusal("times", f"{shown(times)}", "at least two finite numbers, each larger than the one before")
        plant = np.atleast_2d(numbers("A", A))
        n = len(plant)
        intensity = np.zeros((n, n)) if process_intensity is None else numbers("process_intensity", process_intensity)
        if intensity.ndim == 0:
            intensity = intensity * np.eye(n)
        G = np.zeros((n, 0)) if B is None else np.asarray(numbers("B", B)).reshape(n, -1)
        found = [_core.discretise(plant, intensity, float(period), G) for period in np.diff(at)]
        parts: dict[str, Any] = {"A": np.array([f[0] for f in found])}
        if process_intensity is not None:
            parts["process_covariance"] = np.array([f[1] for f in found])
            model = {"process_covariance": found[0][1]} | model
        if B is not None:
            parts["B"] = np.array([f[2] for f in found])
            model = {"B": found[0][2]} | model
        return cls(_core.Model(found[0][0], C, **model), **parts)

    @property
    def model(self) -> _core.Model:
        """The constant part."""
        return self._model

    @property
    def steps(self) -> int:
        """How many steps it is given for."""
        return len(next(iter(self._parts.values())))

    @property
    def parts(self) -> dict[str, Array]:
        """What changes, by name: (T, rows, n) arrays; C with the rows of all agents on top of each other."""
        return dict(self._parts)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, VaryingModel):
            return NotImplemented
        same = self._model == other._model and self._parts.keys() == other._parts.keys()
        return same and all(np.array_equal(v, other._parts[k]) for k, v in self._parts.items())

    def __hash__(self) -> int:
        return hash((self._model, tuple(self._parts), self.steps))

    def __reduce__(self) -> Any:
        return _varying, (self._model, dict(self._parts))

    def __deepcopy__(self, memo: Any) -> VaryingModel:
        return self

    def __repr__(self) -> str:
        parts = "".join(f", {k}={v.tolist()!r}" for k, v in self._parts.items())
        return f"garrison.VaryingModel({self._model!r}{parts})"

    def __str__(self) -> str:
        return f"{self._model} and {', '.join(self._parts)} over {self.steps} steps"

    def _repr_html_(self) -> str:
        return notebook.of_model(self._model, f"{', '.join(self._parts)} over {self.steps} steps")


def _varying(model: _core.Model, parts: dict[str, Any]) -> VaryingModel:
    return VaryingModel(model, **parts)


def _stacked(given: Any, rows: list[int]) -> Any:
    """C of all agents on top of each other: from one array per agent, or a function that returns such a list."""
    if callable(given):
        return lambda t: _on_top(f"C({t})", given(t))
    if isinstance(given, (list, tuple)) and len(given) == len(rows) and all(np.ndim(one) == 3 for one in given):
        parts = [numbers(f"C[{i}]", one) for i, one in enumerate(given)]
        for i, (part, m) in enumerate(zip(parts, rows, strict=True)):
            if part.shape[1] != m or len(part) != len(parts[0]):
                raise refusal(f"C[{i}]", f"{part.shape}", f"({len(parts[0])}, {m}, n), as the model has {m} rows there")
        return np.concatenate(parts, axis=1)
    return given


def _on_top(which: str, value: Any) -> Any:
    if isinstance(value, (list, tuple)) and any(np.ndim(one) == 2 for one in value):
        return np.concatenate([np.atleast_2d(numbers(f"{which}[{i}]", one)) for i, one in enumerate(value)])
    return value


def at_time(which: str, function: Any, t: int) -> Array:
    """What a function of t gives. Its own errors stay its own, but for one that says it is no function of t."""
    try:
        value = function(t)
    except TypeError as error:
        raise refusal(f"{which}({t})", f"a TypeError ({error})", "a function of t, a whole number") from error
    return numbers(f"{which}({t})", value)


def _over_time(
    name: str, given: OverTime | None, shape: tuple[int, int], steps: int | None, first: int
) -> Array | None:
    if given is None:
        return None
    if callable(given):
        if steps is None:
            raise refusal(f"VaryingModel.{name}", "a function and no steps", "steps, how many times it is asked for")
        values = [at_time(name, given, t) for t in range(first, first + steps)]
        for t, value in enumerate(values, first):
            if value.shape != shape:
                raise refusal(f"{name}({t})", f"{value.shape}", f"{shape}")
        return np.array(values)
    value = numbers(name, given)
    if value.ndim != 3 or value.shape[1:] != shape or len(value) == 0:
        raise refusal(f"VaryingModel.{name}", f"{value.shape}", f"(steps, {shape[0]}, {shape[1]})")
    if steps is not None and len(value) != steps:
        raise refusal(f"VaryingModel.{name}", count(len(value), "step"), f"{steps}, as `steps` says")
    if not np.isfinite(value).all():
        raise refusal(f"VaryingModel.{name}", "a number that is not finite", "finite numbers")
    return value.copy()


def parted(model: Any) -> tuple[Any, dict[str, Array]]:
    """The constant part of a plant, and what changes of it, as the core takes it."""
    return (model.model, model.parts) if isinstance(model, VaryingModel) else (model, {})


def undriven(model: Any) -> Any:
    """The plant without its known inputs: errors and bounds of all filters are the same (docs/adr/0016)."""
    if isinstance(model, VaryingModel):
        base, parts = undriven(model.model), dict[str, Any](model.parts)
        parts.pop("B", None)
        return VaryingModel(base, **parts) if parts else base
    if not model.inputs:
        return model
    kept = {k: v for k, v in model.__getstate__().items() if k not in ("B", "inputs")}
    if "units" in kept:
        kept["units"] = {k: v for k, v in kept["units"].items() if k not in model.input_names}
    return _core.Model(**kept)


def inputs_of(model: _core.Model, given: Any, steps: int) -> Array:
    """Known inputs, (steps, p): from an array, a table matched by name or a function of t = 0..steps-1."""
    if given is None:
        return np.zeros((0, 0))
    if callable(given):
        given = [at_time("inputs", given, t).ravel() for t in range(steps)]
    found = numbers("inputs", matched("inputs", given, list(model.input_names) or None))
    if found.ndim == 1 and model.inputs == 1:
        found = found[:, None]
    if found.ndim != 2:
        raise refusal("inputs", f"{found.shape}", f"({steps}, {model.inputs}), a row u(t) per step")
    return found


__all__ = ["Inputs", "VaryingModel", "inputs_of", "parted", "undriven"]
