"""A plant in the form that certificates with memory take: outputs with independent noise, grouped by source."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from garrison import _core
from garrison._core import certificate
from garrison.words import refusal

Array = NDArray[np.float64]
#: z1, z2, zc of a bank or a window
Levels = tuple[float, float, float]


class Plant:
    """A, Gam with Gam Gam' = Q, and rows of unit noise variance, each with its source."""

    def __init__(self, model: _core.Model) -> None:
        Q, R = model.process_covariance, model.measurement_covariance
        if Q is None or R is None or isinstance(Q, list):
            had = "one per agent" if isinstance(Q, list) else "no covariance of the noise"
            raise refusal("model", had, "one process_covariance for all, and measurement_covariance")
        self.n = model.states
        self.A, self.Q = np.asarray(model.A, dtype=float), np.asarray(Q, dtype=float)
        self.root = certificate.noise_root(self.Q)
        given = sources_of(model)
        self.names = list(dict.fromkeys(given))
        places = {name: k for k, name in enumerate(self.names)}
        self.source = np.array([places[name] for name in given], dtype=int)
        self.factors = _factors([np.atleast_2d(r) for r in R], self.source)
        rows = [np.asarray(C, dtype=float).reshape(-1, self.n) for C in model.C]
        self.rows = np.concatenate([np.linalg.solve(L, C) for L, C in zip(self.factors, rows, strict=True)])
        #: whether all measurements of one sample determine the state
        self.seen_at_once = bool(np.linalg.matrix_rank(self.rows) == self.n)
        #: outputs in the order of their sources, as a bank takes them
        self.order = np.argsort(self.source, kind="stable")

    def whitened(self, y: Array) -> Array:
        """(samples, outputs) of unit variance; an output is missing where one is that its noise depends on."""
        out, at = np.array(y, dtype=float), 0
        for L in self.factors:
            block = out[:, at : at + len(L)]
            for k in range(len(L)):
                earlier = np.flatnonzero(L[k, :k])
                block[:, k] = (block[:, k] - block[:, earlier] @ L[k, earlier]) / L[k, k]
            at += len(L)
        return out

    def bank(self, s: int, limit: int, sources: Sequence[int] | None = None) -> certificate.Bank:
        """One Kalman filter per set of s sources left out, of some sources or all of them."""
        all_sources = self._sources()
        taken = all_sources if sources is None else [all_sources[k] for k in sources]
        return certificate.Bank(self.A, self.Q, taken, s, limit)

    def steady(self, s: int, levels: Levels, limit: int) -> Array:
        """Half widths that a bank never exceeds (theorem B2)."""
        return certificate.bank_steady_width(self.A, self.Q, self._sources(), s, *levels, limit)

    def window(self, y: Array, moved: Array) -> certificate.Window:
        """One regression over these samples (whitened); moved: what known inputs add to the state of each."""
        found = certificate.Window(self.n, self.root.shape[1], len(y), len(self.names), max(y.size, 1))
        found.begin(len(y))
        for k, sample in enumerate(y):
            if k > 0:
                found.advance(self.A, self.root, moved[k])
            for source, row, value in zip(self.source, self.rows, sample, strict=True):
                found.add(int(source), row, value, 1.0)
        return found

    def _sources(self) -> list[tuple[Array, Array]]:
        parts = [self.rows[self.source == k] for k in range(len(self.names))]
        return [(C, np.ones(len(C))) for C in parts]


def sources_of(model: _core.Model, agents: Iterable[str] | None = None) -> list[str]:
    """Who stands behind each output: an agent, by its name in `agents`, where the model names no sources."""
    names = model_agents(model) if agents is None else agents
    return list(model.sources) or [name for name, C in zip(names, model.C, strict=True) for _ in range(len(C))]


def model_agents(model: _core.Model) -> list[str]:
    """What agents are called as sources."""
    return [f"agent {i}" for i in range(model.agents)]


def _factors(R: list[Array], source: NDArray[np.int_]) -> list[Array]:
    """L with R_i = L L' per agent; noise that two sources share is refused: each could then falsify the other's."""
    found: list[Array] = []
    at = 0
    for i, covariance in enumerate(R):
        own = source[at : at + len(covariance)]
        at += len(covariance)
        if (covariance[own[:, None] != own[None, :]] != 0).any():
            raise refusal(
                f"measurement_covariance[{i}]", "noise that outputs of several sources share", "independent noise",
                "give these outputs one source",
            )  # fmt: skip
        try:
            found.append(np.asarray(np.linalg.cholesky(covariance), dtype=float))
        except np.linalg.LinAlgError:
            raise refusal(f"measurement_covariance[{i}]", "a singular matrix", "a positive definite one") from None
    return found
