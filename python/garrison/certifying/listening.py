"""Whether noise remembers its past, beside windows: banks that listen and say nothing else."""

from __future__ import annotations

from collections.abc import Sequence
from math import comb

import numpy as np
from numpy.typing import NDArray

from garrison.certifying.plant import Levels, Plant

Array = NDArray[np.float64]


class Listener:
    """What innovations say against white noise while at most s sources lie, always the same ones.

    A bank where it has at most `limit` filters; else a filter for each of s + 1 disjoint groups of sources: no liar is
    in one of them, so all of them must say it (docs/certificates.md, section 9).
    """

    def __init__(self, plant: Plant, s: int, levels: Levels, limit: int) -> None:
        m = len(plant.names)
        whole = comb(m, s) <= limit
        groups: list[Sequence[int]] = [range(m)] if whole else [range(k, m, s + 1) for k in range(s + 1)]
        self._levels = levels
        self._groups = groups
        self._rows = [np.flatnonzero(np.isin(plant.source[plant.order], list(group))) for group in groups]
        self._banks = [plant.bank(s if whole else 0, limit, group) for group in groups]
        for bank in self._banks:
            bank.start_unknown()

    def hear(self, sample: Array, moved: Array) -> None:
        """One sample (outputs,), in the order of the sources; moved: what known inputs add to its state."""
        for bank, rows in zip(self._banks, self._rows, strict=True):
            if np.isnan(bank.update(sample[rows], *self._levels, u=moved).radius):
                bank.start_unknown()

    @property
    def dependence(self) -> tuple[float, int, float, float]:
        """Evidence, source, correlation, pairs: of the group that says least."""
        said = [(*bank.dependence, group) for bank, group in zip(self._banks, self._groups, strict=True)]
        evidence, source, correlation, pairs, group = min(said, key=lambda one: one[0])
        return evidence, group[source] if source >= 0 else -1, correlation, pairs
