"""Who lies, from the measurements of a sample alone: the witness as a detector (W3, W2; docs/certificates.md)."""

from __future__ import annotations

from dataclasses import dataclass
from math import comb
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from garrison import _core
from garrison.arguments import flag, probability, table, whole
from garrison.result import Result
from garrison.run_options import pair_of_levels
from garrison.words import hinted, hinted_methods, refusal, shown


@hinted_methods
@dataclass(eq=False, repr=False)
class Exposed(Result):
    """What the measurements prove.

    Attributes
    ----------
    sources : list
        Who can lie: names, or numbers of agents.
    proved : (samples, sources) array of bool
        Shown to lie at that sample.
    refuted : (samples,) array of bool
        More than `attacked` lie there, and nobody is named.
    sets : int
        How many samples were judged by all sets of honest sources (W3); the others by leverages (W2), which expose
        less.
    """

    sources: list[Any]
    proved: NDArray[np.bool_]
    refuted: NDArray[np.bool_]
    sets: int

    def first(self) -> dict[Any, int]:
        """Source -> row of the measurements at which it was first shown to lie, of those that ever were."""
        found = {s: np.flatnonzero(self.proved[:, k]) for k, s in enumerate(self.sources)}
        return {s: int(rows[0]) for s, rows in found.items() if len(rows)}


@hinted
def expose(
    model: _core.Model,
    measurements: ArrayLike,
    *,
    attacked: int,
    failure: float = 1e-6,
    levels: tuple[float, float] | None = None,
    fixed: bool = False,
    limit: int = 1000,
) -> Exposed:
    """Who is proved to lie, sample by sample, by the measurements of that sample: no filter, network, start or past.

    Where at most s sources lie, a source that fits into no consistent set of all but s of them does. Needs one sample
    to determine the state without any s sources.

    Parameters
    ----------
    model : Model
        With measurement_covariance, diagonal.
    measurements : (samples, outputs) array
        nan = missing. All in one place: what `certificate = "flooded"` brings.
    attacked : int
        s, most sources that lie at a time, >= 0.
    failure : float
        Probability in (0, 1), per sample, that an honest source is accused.
    levels : tuple of two floats, optional
        (z1, z2) instead of the covariances' own (`Fitted.levels`, `calibrate`).
    fixed : bool
        The liars never change: who was proved is left out from then on, which exposes the others earlier.
        Failures add up over the samples.
    limit : int
        All sets are tried (W3) where there are at most so many, in 0..1 000 000; else leverages (W2).

    Returns
    -------
    Exposed
        Who, and since when.

    Raises
    ------
    InvalidInput
        Shapes do not fit, or the noise is not known.
    """
    if not isinstance(model, _core.Model):
        raise refusal("model", shown(model), "a garrison.Model")
    fixed = flag("fixed", fixed)
    y = table("measurements", measurements)
    if y.shape[1] != model.outputs:
        raise refusal("measurements", f"shape {y.shape}", f"(samples, {model.outputs})")
    if model.measurement_covariance is None or len(model.measurement_covariance) == 0:
        raise refusal("model", "no measurement_covariance", "covariances of all measurement noises")
    s = whole("attacked", attacked, 0, model.agents)
    most = whole("limit", limit, 0, 1_000_000)
    delta = probability("failure", failure)
    names, ids = _sources(model)
    C = np.vstack([np.asarray(c, dtype=float).reshape(-1, len(model.A)) for c in model.C])
    R = np.concatenate([_variances(i, r) for i, r in enumerate(model.measurement_covariance)])
    # T1 once, T2 for two sets: without two that cover all honest sources nobody may be named.
    z1, _ = _core.certificate.gaussian_levels(delta, len(R), len(model.A))
    _, z2 = _core.certificate.gaussian_levels(delta / 2, len(R), len(model.A))
    if levels is not None:
        z1, z2 = pair_of_levels(levels)
    found = Exposed(names, np.zeros((len(y), len(names)), bool), np.zeros(len(y), bool), 0)
    known: list[int] = []
    for t, row in enumerate(y):
        present = np.unique(ids[np.isfinite(row)])
        left = max(s - len(known), 0)
        by_sets = comb(len(np.setdiff1d(present, known)), left) <= most and len(present) >= 2 * s
        found.sets += by_sets
        rule = _core.certificate.witness_subsets if by_sets else _core.certificate.leverage_ball
        witness = rule(row, C, R, s, z1, z2, sources=ids.tolist(), proved=known)
        found.refuted[t] = witness.region.refuted
        found.proved[t, witness.proved] = True
        if fixed and not found.refuted[t]:
            known = sorted({*known, *witness.proved})
    return found


def _variances(agent: int, covariance: ArrayLike) -> NDArray[np.float64]:
    R = np.atleast_2d(np.asarray(covariance, dtype=float))
    if not np.array_equal(R, np.diag(np.diag(R))):
        advice = "split or combine the outputs"
        raise refusal(f"measurement_covariance[{agent}]", "correlated outputs", "a diagonal matrix", advice)
    return np.diag(R).copy()


def _sources(model: _core.Model) -> tuple[list[Any], NDArray[np.int64]]:
    """Names, and the number of each row's."""
    if model.sources:
        names: list[Any] = list(dict.fromkeys(model.sources))
        return names, np.array([names.index(one) for one in model.sources])
    rows = [i for i, c in enumerate(model.C) for _ in range(len(np.atleast_2d(c)) if np.size(c) else 0)]
    return list(range(model.agents)), np.array(rows, dtype=np.int64)


__all__ = ["Exposed", "expose"]
