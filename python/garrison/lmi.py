"""The paper's gain design for the structural filter, as a reference: LMI (8) with cone complementarity.

Needs the extra `lmi` (cvxpy with Clarabel). Two matrices of N n x N n are unknown, so it ends near N n = 40; use
`structural.design_gains`, which certifies stability too and scales to N n in the thousands.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from garrison._core import DesignInfeasible, Error, structural
from garrison.arguments import number, whole
from garrison.words import hinted, refusal, shown

Array = NDArray[np.float64]


def _cvxpy() -> Any:
    try:
        import cvxpy
    except ImportError as error:
        raise Error('lmi_gains needs cvxpy and clarabel: pip install "garrison[lmi]"') from error
    return cvxpy


@hinted
def lmi_gains(setting: structural.Setting, *, iterations: int = 20, margin: float = 1e-4) -> list[Array]:
    """Block-diagonal gains with rho(Ahat) < 1 by LMI (8) and iterative cone complementarity.

    (8) is bilinear in X and K. With Y for the inverse of X the iteration minimises tr(Y_k X + X_k Y) subject to
    [X, Ahat'; Ahat, Y] >= margin I and [X, I; I, Y] >= 0, from X_0 = Y_0 = I, and stops as soon as rho(Ahat) < 1: any
    stable gain, not a good one. Only K_i on the span of the rows that agent i hears matters, the rest is zero.
    Source: Doostmohammadian et al., IEEE TNSE 2021, (8).

    Parameters
    ----------
    setting : structural.Setting
        A (n, n), C (N, n), W, U (N, N), from `structural.setting` or `structural.Setting`.
    iterations : int
        Most convex programs to be solved, >= 1; each takes about (N n)^6 operations.
    margin : float
        Least eigenvalue of the first matrix, > 0.

    Returns
    -------
    list of (n, n) arrays
        One gain per agent.

    Raises
    ------
    DesignInfeasible
        No stable gain within `iterations`; says the radius reached.
    InvalidInput
        Something is no Setting, or out of its range.
    Error
        cvxpy is not installed.
    """
    if not isinstance(setting, structural.Setting):
        raise refusal("setting", shown(setting), "a structural.Setting", "make one by structural.setting(...)")
    whole("iterations", iterations, 1)
    if not 0.0 < number("margin", margin) < float("inf"):
        raise refusal("margin", shown(margin), "a finite number > 0")
    cp = _cvxpy()
    A, C, W, U = (np.asarray(M) for M in (setting.A, setting.C, setting.W, setting.U))
    n, N = len(A), len(W)
    size = N * n
    heard = [(C.T * U[i]) @ C for i in range(N)]  # sum of U_ij c_j c_j'
    bases = [np.linalg.svd(S)[0][:, : np.linalg.matrix_rank(S)] for S in heard]
    M: list[Any] = [cp.Variable((n, B.shape[1])) if B.shape[1] else None for B in bases]
    rows = []
    for i in range(N):
        row = np.kron(W[i], A)
        # K_i S_i with K_i = M_i B_i'
        rows.append(row if M[i] is None else row - M[i] @ (bases[i].T @ heard[i] @ row))
    Ahat = cp.vstack(rows)
    X, Y = cp.Variable((size, size), symmetric=True), cp.Variable((size, size), symmetric=True)
    one = np.eye(size)
    limits = [cp.bmat([[X, Ahat.T], [Ahat, Y]]) >> margin * np.eye(2 * size), cp.bmat([[X, one], [one, Y]]) >> 0]
    Xk = Yk = one
    radius = float("inf")
    for _ in range(iterations):
        problem = cp.Problem(cp.Minimize(cp.trace(Yk @ X) + cp.trace(Xk @ Y)), limits)
        try:
            problem.solve(solver=cp.CLARABEL)
        except cp.error.SolverError:
            raise DesignInfeasible(
                f"lmi_gains: got no answer of the solver with margin {margin:g}, expected one that it can use, "
                "about 1e-4; or take structural.design_gains"
            ) from None
        if X.value is None:
            break
        K = [np.zeros((n, n)) if M[i] is None else np.asarray(M[i].value) @ bases[i].T for i in range(N)]
        radius = structural.error_radius(setting, K)
        if radius < 1.0:
            return K
        Xk, Yk = X.value, Y.value
    raise DesignInfeasible(
        f"lmi_gains: got no stable gain after {iterations} programs (spectral radius {radius:.4g}), expected one below "
        "1; more iterations, smaller self-weights in W, or structural.design_gains"
    )
