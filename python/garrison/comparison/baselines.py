"""What people use instead: small baselines that read recorded measurements. All are run in Python, for comparison only.

Each takes the plant and the measurements (T, M), nan = missing, and returns estimates (T + 1, N, n) from a start at 0.
"""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from garrison import _core
from garrison.varying import VaryingModel, parted
from garrison.words import refusal

Array = NDArray[np.float64]

#: variance of the process noise beside what the model says: covariances are inverted
_TINY = 1e-12
#: sets of sensors that the subset search goes through at most, per sample
_MOST_SETS = 500


@dataclass(frozen=True)
class Moment:
    """Matrices of one sample: A and Q lead to it, C and R are what the agents see."""

    A: Array
    C: list[Array]
    Q: Array
    R: list[Array]

    def split(self, y: Array) -> list[Array]:
        """The measurements of a sample, agent by agent."""
        ends = np.cumsum([len(c) for c in self.C])[:-1]
        return np.split(y, ends)


@dataclass(frozen=True)
class Plant:
    """A plant and who hears whom.

    constant: of the model, with the covariances of sample 1 where it has none; moments: of every sample where something
    changes.
    """

    constant: Moment
    moments: list[Moment]
    heard: list[list[int]]
    liars: int

    @property
    def agents(self) -> int:
        """N"""
        return len(self.heard)

    @property
    def states(self) -> int:
        """n"""
        return len(self.constant.A)

    def at(self, t: int) -> Moment:
        """Of sample t >= 1."""
        return self.moments[t - 1] if self.moments else self.constant


def plant_of(model: _core.Model | VaryingModel, network: _core.Network, liars: int) -> Plant:
    """Raises InvalidInput where nothing is known of the noise."""
    base, parts = parted(model)
    constant = _moment(base, parts)
    steps = len(next(iter(parts.values()))) if parts else 0
    moments = [_changed(constant, {name: part[t] for name, part in parts.items()}) for t in range(steps)]
    return Plant(constant, moments, [list(network.neighbours(i)) for i in range(base.agents)], liars)


def _blocks(R: Array, C: list[Array]) -> list[Array]:
    """The covariance of each agent, of all below each other."""
    ends = np.cumsum([len(c) for c in C])[:-1]
    return [block[:, : len(block)] for block in np.split(R, ends)]


def _changed(moment: Moment, now: dict[str, Array]) -> Moment:
    """The matrices of a sample, where `now` has some of them as `VaryingModel.parts` has."""
    Q, C, R = moment.Q, moment.C, moment.R
    if "process_covariance" in now:
        Q = now["process_covariance"] + _TINY * np.eye(len(Q))
    if "C" in now:
        C = moment.split(now["C"])
    if "measurement_covariance" in now:
        R = _blocks(now["measurement_covariance"], C)
    return Moment(now.get("A", moment.A), C, Q, R)


def _moment(model: _core.Model, parts: dict[str, Array]) -> Moment:
    """Covariances even where only bounds are known (a bound taken as two deviations), or only those over time."""
    n = model.states
    Q, R = model.process_covariance, model.measurement_covariance
    if isinstance(Q, list):
        Q = Q[0]
    if Q is None and "process_covariance" in parts:
        Q = parts["process_covariance"][0]
    if Q is None:
        if not np.isfinite(model.process_bound):
            raise refusal("baseline", "a model without process noise", "a bound or a covariance")
        Q = (model.process_bound / 2) ** 2 / n * np.eye(n)
    C = [np.asarray(c).reshape(-1, n) for c in model.C]
    if R is None and "measurement_covariance" in parts:
        R = _blocks(parts["measurement_covariance"][0], C)
    if R is None:
        bounds = np.asarray(model.measurement_bound).ravel()
        if not bounds.size:
            raise refusal("baseline", "a model without measurement noise", "bounds or covariances")
        R = [(b / 2) ** 2 * np.eye(len(c)) for b, c in zip(np.broadcast_to(bounds, len(C)), C, strict=True)]
    return Moment(np.asarray(model.A), C, np.asarray(Q) + _TINY * np.eye(n), [np.asarray(r) for r in R])


#: estimates and inverse covariances of an agent and of those it hears -> its new ones
Fusion = Callable[[Array, Array, int], tuple[Array, Array]]


def _distributed(plant: Plant, y: Array, fuse: Fusion) -> Array:
    """Every agent corrects its prediction by its own outputs, hears its neighbours' results, and fuses them."""
    N, n = plant.agents, plant.states
    x, information = np.zeros((N, n)), np.repeat(np.eye(n)[None], N, axis=0)
    out = np.zeros((len(y) + 1, N, n))
    for t, sample in enumerate(y, start=1):
        now = plant.at(t)
        own_x, own_information = np.zeros((N, n)), np.zeros((N, n, n))
        for i, z in enumerate(now.split(sample)):
            P = now.A @ np.linalg.inv(information[i]) @ now.A.T + now.Q
            before = np.linalg.inv(P)
            here = np.isfinite(z)
            H = now.C[i][here]
            gain = H.T @ np.linalg.inv(now.R[i][np.ix_(here, here)]) if here.any() else np.zeros((n, 0))
            own_information[i] = before + gain @ H
            own_x[i] = np.linalg.solve(own_information[i], before @ now.A @ x[i] + gain @ z[here])
        for i in range(N):
            group = [i, *plant.heard[i]]
            x[i], information[i] = fuse(own_x[group], own_information[group], plant.liars)
        out[t] = x
    return out


def covariance_intersection(plant: Plant, y: Array) -> Array:
    """Equal weights (Julier, Uhlmann, ACC 1997: consistent for any): information averaged over the neighbourhood."""

    def fuse(x: Array, information: Array, _: int) -> tuple[Array, Array]:
        total = information.mean(axis=0)
        return np.linalg.solve(total, np.einsum("kij,kj->i", information, x) / len(x)), total

    return _distributed(plant, y, fuse)


def median(plant: Plant, y: Array) -> Array:
    """Entry by entry the median of the neighbourhood's estimates."""
    return _distributed(plant, y, lambda x, information, _: (np.median(x, axis=0), information.mean(axis=0)))


def trimmed_mean(plant: Plant, y: Array) -> Array:
    """Entry by entry the mean without the s largest and the s smallest, or the median where fewer are left."""

    def fuse(x: Array, information: Array, liars: int) -> tuple[Array, Array]:
        ordered = np.sort(x, axis=0)
        kept = ordered[liars : len(x) - liars]
        return (kept.mean(axis=0) if len(kept) else np.median(x, axis=0)), information.mean(axis=0)

    return _distributed(plant, y, fuse)


def w_msr(plant: Plant, y: Array) -> Array:
    """W-MSR (LeBlanc, Zhang, Koutsoukos, Sundaram, JSAC 2013), entry by entry.

    Of the values above the own one the s largest are left out, of those below the s smallest.
    """

    def fuse(x: Array, information: Array, liars: int) -> tuple[Array, Array]:
        fused = np.empty(x.shape[1])
        for k, column in enumerate(x.T):
            own, others = column[0], np.sort(column[1:])
            low, high = others[others < own][liars:], others[others > own]
            high = high[: max(len(high) - liars, 0)]
            fused[k] = np.mean([own, *low, *high, *others[others == own]])
        return fused, information.mean(axis=0)

    return _distributed(plant, y, fuse)


def _central(plant: Plant, y: Array, solve: Callable[[Array, Array], Array]) -> Array:
    """A centre that sees all measurements: solve(rows, values) with the prediction as rows of their own, last."""
    n = plant.states
    x, P = np.zeros(n), np.eye(n)
    out = np.zeros((len(y) + 1, plant.agents, n))
    for t, z in enumerate(y, start=1):
        now = plant.at(t)
        rows = np.vstack(now.C)
        scale = np.concatenate([np.sqrt(np.diag(r)) for r in now.R])
        scale = np.where(scale > 0, scale, 1e-9)
        P = now.A @ P @ now.A.T + now.Q
        root = np.linalg.inv(np.linalg.cholesky(P))
        here = np.isfinite(z)
        H = np.vstack([rows[here] / scale[here, None], root])
        x = solve(H, np.concatenate([z[here] / scale[here], root @ now.A @ x]))
        P = np.linalg.inv(H.T @ H)
        out[t] = x
    return out


def _least_squares(H: Array, z: Array) -> Array:
    return np.asarray(np.linalg.lstsq(H, z, rcond=None)[0], dtype=float)


def l1_decoder(plant: Plant, y: Array) -> Array:
    """Least sum of absolute residuals (Fawzi, Tabuada, Diggavi, IEEE TAC 2014), with the prediction as prior.

    By iteratively reweighted least squares; the prediction's rows keep their squares.
    """
    n = plant.states

    def solve(H: Array, z: Array) -> Array:
        x = _least_squares(H, z)
        for _ in range(50):
            weight = 1 / np.sqrt(np.maximum(np.abs(z - H @ x), 1e-6))
            weight[len(z) - n :] = 1.0
            x = _least_squares(H * weight[:, None], z * weight)
        return x

    return _central(plant, y, solve)


def subset_search(plant: Plant, y: Array) -> Array:
    """Least squares without the s measurements whose loss lowers the residual most, by all sets of them."""
    n = plant.states
    outputs = sum(len(c) for c in plant.constant.C)
    sets = list(combinations(range(outputs), plant.liars))
    if len(sets) > _MOST_SETS:
        raise refusal("subset search", f"{len(sets)} sets of measurements", f"at most {_MOST_SETS}", "fewer liars")

    def solve(H: Array, z: Array) -> Array:
        best: Array = np.zeros(n)
        least = np.inf
        for gone in sets:
            kept = np.ones(len(z), bool)
            kept[[k for k in gone if k < len(z) - n]] = False
            x = _least_squares(H[kept], z[kept])
            cost = float(np.sum((z[kept] - H[kept] @ x) ** 2))
            if cost < least:
                best, least = x, cost
        return best

    return _central(plant, y, solve)


BASELINES: dict[str, Callable[[Plant, Array], Array]] = {
    "covariance intersection": covariance_intersection,
    "median of estimates": median,
    "trimmed mean of estimates": trimmed_mean,
    "W-MSR": w_msr,
    "L1 decoder (central)": l1_decoder,
    "subset search (central)": subset_search,
}
#: bytes that an agent of a distributed baseline sends to each neighbour are those of its estimate and covariance
DISTRIBUTED = ("covariance intersection", "median of estimates", "trimmed mean of estimates", "W-MSR")
