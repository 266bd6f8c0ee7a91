"""The inputs of a partial-sharing case as objects of the library."""

from functools import cached_property
from typing import Any

import numpy as np

import garrison as gr
from garrison._core import Filter
from garrison._core import partial_sharing as theory
from garrison.verify.compare import Array, Inputs, array, numbers

START = 1  # library time of k = 0


def _rows(value: Any, columns: int) -> Array:
    """A matrix; [] for an agent without sensors."""
    given = numbers(value)
    return given if given.size else np.zeros((0, columns))


#: names of the library -> letters of the cases, for messages
_LETTERS = {
    "process_covariance": "Q (covariance of the process noise)",
    "measurement_covariance": "R (covariance of the measurement noise)",
    "C[": "H",
}


def _model(*given: Any, **noise: Any) -> gr.Model:
    try:
        return gr.Model(*given, **noise)
    except gr.InvalidInput as error:
        letter = next((word for name, word in _LETTERS.items() if str(error).startswith(name)), None)
        raise gr.InvalidInput(f"{letter}: {error}" if letter else str(error)) from error


class Case:
    """Inputs of one file as objects of the library."""

    def __init__(self, inputs: Inputs, **changes: Any) -> None:
        i = self.inputs = inputs | changes
        self.agents = int(i["L"])
        A = numbers(i["A"])
        self.states = m = len(A)
        H = [_rows(h, m) for h in (i["H"] * self.agents if i.get("H_same_for_all") else i["H"])]
        if i.get("R") is None:
            R = [r * np.eye(len(h)) for r, h in zip(i["R_scale_times_identity"], H, strict=True)]
        else:
            R = [_rows(r, len(h)) for r, h in zip(i["R"], H, strict=True)]
        self.model = _model(A, H, process_covariance=numbers(i["Q"]), measurement_covariance=R)
        self.network = gr.Network(
            [tuple(e) for e in i["edges"]], agents=self.agents, directed=bool(i.get("directed", False))
        )
        self.s0 = numbers(i["s0"])
        self._require_selection()

    def _require_selection(self) -> None:
        wanted = (self.agents, self.states)
        if self.s0.shape != wanted:
            raise gr.InvalidInput(
                f"selection s0: got shape {self.s0.shape}, expected {wanted}: l of m entries per agent"
            )
        ones = self.s0.sum(axis=1)
        given = self.inputs.get("l", ones[0])
        if (ones != given).any() or not 1 <= given <= self.states:
            raise gr.InvalidInput(f"selection s0: got rows with {sorted(set(ones))} ones, expected l = {given} in each")
        tau = array(self.inputs["tau"])
        if not np.isfinite(tau) or tau != int(tau):
            raise gr.InvalidInput(f"shift tau: got {tau}, expected a whole number")
        if self.inputs.get("k0", 0) < 0:
            raise gr.InvalidInput(f"k0: got {self.inputs['k0']}, expected a time >= 0")

    def filter(self, **changes: Any) -> Filter:
        """The filter of the case; gains never frozen, as in the definition."""
        i = self.inputs
        given: dict[str, Any] = {
            "gain": float(array(i["gamma"])),
            "selection": self.s0.ravel().tolist(),
            "shift": int(i["tau"]),
            "start_is_prediction": True,
            "gains": "varying",
        }
        if "P0" in i:
            given["start_covariance"] = numbers(i["P0"]).ravel().tolist()
        return gr.filters.make_filter("partial_sharing", given | changes)

    def analysis(self, **changes: Any) -> theory.Analysis:
        """Its analysis."""
        return theory.Analysis(self.model, self.network, self.filter(**changes))

    @cached_property
    def base(self) -> theory.Analysis:
        """The analysis with the case's own numbers."""
        return self.analysis()

    @property
    def gamma(self) -> float:
        """The case's gamma."""
        return float(array(self.inputs["gamma"]))

    @cached_property
    def steps(self) -> int:
        """Updates of the run."""
        for key in ("y", "delta"):
            if key in self.inputs:
                return len(self.inputs[key])
        return 0

    @cached_property
    def y(self) -> Array:
        """Measurements, (steps, all outputs)."""
        rows = []
        for k, yk in enumerate(self.inputs["y"]):
            found = [numbers(yi).ravel() for yi in yk]
            wanted = [len(C) for C in self.model.C]
            if [len(f) for f in found] != wanted:
                raise gr.InvalidInput(f"y[{k}]: got {[len(f) for f in found]} numbers, expected {wanted}")
            rows.append(np.concatenate(found))
        return np.array(rows).reshape(self.steps, -1)

    @cached_property
    def byzantine(self) -> list[int]:
        """Agents that lie."""
        found = self.inputs.get("byzantine", self.inputs.get("delta_sparse", {}).get("byzantine", []))
        return [int(b) for b in found]

    @cached_property
    def delta(self) -> Array | None:
        """Perturbations of all agents, (steps, agents, states)."""
        if "delta" in self.inputs:
            given = numbers(self.inputs["delta"])
        elif "delta_sparse" in self.inputs:
            sparse = self.inputs["delta_sparse"]
            given = np.zeros((self.steps, self.agents, self.states))
            rows = numbers(sparse["rows"])
            given[sparse["k0"] : sparse["k0"] + len(rows), sparse["byzantine"]] = rows
        else:
            return None
        if given.shape != (self.steps, self.agents, self.states) or not np.isfinite(given).all():
            raise gr.InvalidInput(
                f"delta: got shape {given.shape}, expected finite numbers for every step, agent and state"
            )
        honest = [i for i in range(self.agents) if i not in self.byzantine] if self.byzantine else []
        if honest and np.any(given[:, honest] != 0):
            raise gr.InvalidInput(
                "delta: got nonzero numbers on a regular agent, expected them on byzantine agents only"
            )
        return given

    @cached_property
    def Sigma(self) -> Array | None:
        """The attack covariance of the network that the case gives, checked against its Byzantine agents."""
        if "Sigma_byzantine_block" in self.inputs:
            return np.asarray(self.base.spread(self.byzantine, numbers(self.inputs["Sigma_byzantine_block"])))
        key = next((k for k in ("Sigma", "Sigma_random") if k in self.inputs), None)
        return None if key is None else numbers(self.inputs[key])

    @property
    def liars(self) -> list[int] | None:
        """What Sigma is checked against; None when the case names nobody."""
        return self.byzantine or None

    def estimates(self, **changes: Any) -> Array:
        """Predictions xhat of Algorithm 1, (steps + 1, agents, states)."""
        start = numbers(self.inputs["xhat0"])
        if start.shape != (self.agents, self.states) or not np.isfinite(start).all():
            raise gr.InvalidInput(f"xhat0: got shape {start.shape}, expected a finite initial estimate for every agent")
        if self.delta is None:
            attack: Any = ()
        else:
            everybody = range(self.agents)
            attack = gr.attacks.make(
                "perturb", everybody, start=START, width=self.agents * self.states, deltas=self.delta.ravel().tolist()
            )
        run = gr.replay(
            self.model,
            self.network,
            self.filter(**changes),
            measurements=self.y,
            start=start,
            attack=attack,
            keep=["estimate"],
        )
        assert run.estimate is not None
        # The run keeps the updated estimates; the case the predictions from them.
        return np.concatenate([start[None], run.estimate[0, 1:] @ self.model.A.T])

    def full(self, **more: Any) -> dict[str, Any]:
        """The full solution over the case's steps."""
        start = numbers(self.inputs.get("xhat0", np.zeros((self.agents, self.states)).tolist()))
        given: dict[str, Any] = {"y": self.y} if "y" in self.inputs else {}
        if self.delta is not None:
            given["delta"] = self.delta.reshape(self.steps, -1)
        return dict(self.base.full_solution(self.steps, start, **(given | more)))

    def trajectory(self, **more: Any) -> dict[str, Any]:
        """(29) along Algorithm 1, attacked as the case says."""
        if self.Sigma is not None and ("Sigma" in self.inputs or "Sigma_byzantine_block" in self.inputs):
            more = {"Sigma": self.Sigma, "k0": self.inputs.get("k0", 0), "byzantine": self.liars} | more
        return dict(self.base.error_covariance(self.steps, **more))

    def blocks(self, vector: Array) -> Array:
        """(B m,) as (B, m)."""
        return np.asarray(vector).reshape(-1, self.states)
