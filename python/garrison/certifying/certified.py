"""The answer of gr.certify."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from garrison.numeric import numbers
from garrison.result import Result
from garrison.words import count, hinted_methods, refusal

Array = NDArray[np.float64]


@hinted_methods
@dataclass(frozen=True, eq=False, repr=False)
class Certified(Result):
    """What is sure of the state at every sample: |x_i - center_i| <= box_i for all i, and ||x - center|| <= radius.

    Attributes
    ----------
    center, box : (samples, n) array
        inf where the measurements so far cannot answer, nan where they refute that at most `attacked` sources lie, or
        the model: also where the region with memory and that of the sample alone have no point in common.
    radius : (samples,) array
        The same of the ball.
    proved : list of list of str
        Per sample the sources shown to lie.
    sources : list of str
        Their names.
    attacked : int
        Most sources that lie.
    failure : float
        Probability that the region of a sample is wrong.
    method : str
        "bank" (one Kalman filter per set of sources left out, over all samples so far) or "window" (one regression
        over the last `window` samples).
    rule : str
        The theorem (docs/certificates.md, sections 8 and 9) that it goes by: "B", a bank; "W3M", a window and all sets
        of sources that may lie; beyond 500 sets "A", a search among them of so many leaves, or "W2M", leverages alone,
        where windows are too large for that, and where the liars move.
    window : int
        Samples of a regression.
    steady : (n,) array or None
        Half widths that the bank never exceeds once its start has decayed (theorem B2), or a full window with all
        measurements (W3D), whatever the liars say; inf where no certificate stays bounded; None with moving liars, or
        where there are too many sets to tell.
    warnings : list of str
        What the measurements say against the model: innovations that depend on those before them (of white noise at
        most one record in 1000 is said to; not tested where the liars move), regions with and without memory that
        exclude each other.
    """

    center: Array
    box: Array
    radius: Array
    proved: list[list[str]]
    sources: list[str]
    attacked: int
    failure: float
    method: str
    rule: str
    window: int
    steady: Array | None
    warnings: list[str]

    @property
    def answered(self) -> NDArray[np.bool_]:
        """(samples,): there is a region."""
        return np.isfinite(self.radius)

    @property
    def refuted(self) -> NDArray[np.bool_]:
        """(samples,): the measurements contradict the assumptions."""
        return np.isnan(self.radius)

    def bound(self, estimate: ArrayLike) -> Array:
        """Bound on |estimate_i - x_i| per sample and state, for any estimate.

        Parameters
        ----------
        estimate : (samples, n) array
            In the units of the state; nan where there is none.

        Returns
        -------
        (samples, n) array
            inf = no answer, nan = refuted.

        Raises
        ------
        InvalidInput
            Another shape.
        """
        found = numbers("estimate", estimate)
        if found.shape != self.center.shape:
            raise refusal("estimate", f"shape {found.shape}", f"{self.center.shape}, as center")
        return np.where(self.answered[:, None], np.abs(found - self.center) + self.box, self.radius[:, None])

    def __str__(self) -> str:
        there = self.answered
        names = sorted({name for some in self.proved for name in some})
        liars = f"at most {self.attacked} of {count(len(self.sources), 'source')} lie"
        lines = [
            f"{self.method} ({self.rule}): {liars}, failure probability {self.failure:g} a sample",
            f"a region at {there.sum()} of {count(len(there), 'sample')}, refuted at {self.refuted.sum()}",
        ]
        if there.any():
            lines.append(f"half widths, median: {_listed(np.median(self.box[there], axis=0))}")
        if self.steady is not None:
            lines.append(f"half widths in the long run, whatever they say: {_listed(self.steady)}")
        lines.append(f"proved to lie: {', '.join(names) or 'nobody'}")
        return "\n".join([*lines, *(f"warning: {words}" for words in self.warnings)])


def _listed(values: Array) -> str:
    return ", ".join(f"{v:.3g}" for v in values)
