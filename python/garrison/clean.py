"""What clean measurements say of a model: what it leaves over, and levels that hold whatever the law of the noise."""

import numpy as np
from numpy.typing import NDArray

from garrison import _core

Array = NDArray[np.float64]


def clean_residuals(model: _core.Model, y: Array, inputs: Array | None = None) -> tuple[Array, Array]:
    """v (samples, outputs) and w (samples - 1, n) against the least-squares state of every complete sample.

    inputs (samples, p): of a model with B; the row of a sample led to it.
    """
    C = np.vstack(model.C)
    x = y @ np.linalg.pinv(C).T
    w = x[1:] - x[:-1] @ model.A.T
    return y - x @ C.T, w if inputs is None or not len(inputs) else w - inputs[1:] @ np.asarray(model.B).T


def clean_levels(model: _core.Model, y: Array, attacked: int, delta: float) -> tuple[float, float] | None:
    """(z1, z2) that clean samples exceed at the rate delta; None where they do not exist."""
    C = np.vstack(model.C)
    v, _ = clean_residuals(model, y)
    v = v[np.isfinite(v).all(axis=1)]
    known = model.measurement_covariance
    if C.shape != (model.agents, 1) or not np.allclose(np.abs(C), 1.0) or not len(known):
        return None
    if delta < 2.0 / (len(v) + 1.0):
        return None
    R = np.array([np.asarray(r).item() for r in known])
    return _core.certificate.calibrated_levels(v * C.T, R, attacked, delta)
