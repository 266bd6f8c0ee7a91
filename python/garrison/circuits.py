"""Groups of sensors whose measurements depend on each other: what bounded noise allows them to differ by."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from garrison import _core

Array = NDArray[np.float64]
#: ways of parting the sensors into groups, most sensors and states for that, worst condition of a group
_PARTINGS, _MANY, _STATES, _WORST = 10, 60, 8, 1e6


class Circuits:
    """Single outputs of a model, their bounds and one trial of their measurements (samples, outputs).

    The groups of one parting share no sensor, so each one that is refuted has a liar of its own, or its bounds are
    too small. Several partings are tried; the one that refutes most counts.
    """

    def __init__(self, model: _core.Model, y: Array, bounds: Array, *, attacked: int, for_good: bool) -> None:
        agents = np.flatnonzero([len(C) == 1 for C in model.C])[:_MANY]
        columns = np.cumsum([0, *(len(C) for C in model.C)])[agents]
        self.n, self.attacked, self.for_good = model.states, attacked, for_good
        self.A = np.asarray(model.A, dtype=float)
        self.rows = np.array([np.asarray(model.C[i], dtype=float)[0] for i in agents]).reshape(-1, self.n)
        self.bounds, self.y = bounds[agents], y[:, columns]

    def in_one_sample(self) -> int:
        """Groups refuted in one sample, or (for good) in any.

        n + 1 rows have weights with sum l_i c_i = 0, so sum l_i y_i = sum l_i v_i, at most sum |l_i| b_i.
        """
        most = 0
        for members in self._partings():
            weights = np.linalg.svd(np.swapaxes(self.rows[members], 1, 2))[2][:, -1, :]
            allowed = (np.abs(weights) * self.bounds[members]).sum(axis=1)
            most = max(most, self._refuted(self.y[:, members], weights, allowed))
        return most

    def over_a_step(self, process_bound: float) -> int:
        """The same of n rows and another one a sample later.

        c_j A = sum l_i c_i, so y_j(t+1) - sum l_i y_i(t) = c_j w + v_j - sum l_i v_i, |c_j w| <= |c_j| process_bound.
        """
        most = 0
        for members in self._partings():
            before = np.swapaxes(self.rows[members[:, :-1]], 1, 2)
            fine = np.linalg.cond(before) < _WORST
            members, before = members[fine], before[fine]
            if not len(members):
                continue
            last = self.rows[members[:, -1]]
            weights = np.concatenate(
                [-np.linalg.solve(before, (last @ self.A)[:, :, None])[:, :, 0], np.ones((len(last), 1))], axis=1
            )
            noise = process_bound * np.linalg.norm(last, axis=1)
            allowed = (np.abs(weights) * self.bounds[members]).sum(axis=1) + noise
            y = np.concatenate([self.y[:-1, members[:, :-1]], self.y[1:, members[:, -1:]]], axis=2)
            most = max(most, self._refuted(y, weights, allowed))
        return most

    def _partings(self) -> Iterator[NDArray[np.int_]]:
        """(groups, n + 1) sensors each."""
        size, sensors = self.n + 1, len(self.rows)
        if self.n > _STATES or sensors // size <= self.attacked:  # none, or too few to say anything
            return
        rng = np.random.default_rng(0)
        for _ in range(_PARTINGS):
            yield rng.permutation(sensors)[: sensors // size * size].reshape(-1, size)

    def _refuted(self, y: Array, weights: Array, allowed: Array) -> int:
        with np.errstate(invalid="ignore", over="ignore"):
            sums = np.abs(np.einsum("tcm,cm->tc", y, weights))
            rounding = 1e-12 * np.einsum("tcm,cm->tc", np.abs(y), np.abs(weights))
            broken = sums > allowed * (1.0 + 1e-9) + rounding  # a missing one: nothing is known
        return int(broken.any(axis=0).sum() if self.for_good else broken.sum(axis=1).max(initial=0))
