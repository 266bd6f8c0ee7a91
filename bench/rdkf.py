"""The convex step and the fixed point of the resilient distributed Kalman filter against general solvers and NumPy.

`cached` is what a filter does at every sample (Q and M do not change); `fresh` factors them anew. Clarabel and Ipopt
are timed from prebuilt data, set-up included, since b and x0 change from step to step.
"""

from typing import Any

import clarabel
import garrison_bench as peers
import numpy as np
import scipy.sparse as sp
from timing import Rows, Tasks, cpu, interleaved, summary

WEIGHT = 1.0
INSTANCES = 60
EDGES = [(0, 2), (0, 3), (0, 7), (1, 8), (2, 7), (4, 5), (4, 6), (5, 7), (6, 7), (7, 9), (8, 9), (5, 6)]


def problems(n: int, q: int, seed: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """A third each with outliers, with residual zero at the optimum, and mild."""
    rng = np.random.default_rng(seed)
    M = rng.normal(size=(q, n))
    root = rng.normal(size=(n, n))
    Q = root @ root.T / n + 0.1 * np.eye(n)
    x0 = rng.normal(size=(n, INSTANCES))
    b = M @ x0
    for k in range(INSTANCES):
        kind = k % 3
        b[:, k] += (20.0 if kind == 0 else 1e-3 if kind == 1 else 1.0) * rng.normal(size=q)
    return Q, M, b, x0


def objective(Q: np.ndarray, M: np.ndarray, b: np.ndarray, x0: np.ndarray, x: np.ndarray) -> np.ndarray:
    e = x - x0
    return WEIGHT * np.linalg.norm(b - M @ x, axis=0) + np.einsum("ik,ij,jk->k", e, Q, e)


class Clarabel:
    """min t weight + (x - x0)'Q(x - x0), |b - M x| <= t, called directly with data in its own form."""

    def __init__(self, Q: np.ndarray, M: np.ndarray, b: np.ndarray, x0: np.ndarray) -> None:
        q, n = M.shape
        self.P = sp.csc_matrix(np.triu(np.block([[2 * Q, np.zeros((n, 1))], [np.zeros((1, n + 1))]])))
        self.A = sp.csc_matrix(np.block([[np.zeros((1, n)), -np.ones((1, 1))], [M, np.zeros((q, 1))]]))
        self.linear = np.vstack([-2 * Q @ x0, WEIGHT * np.ones((1, x0.shape[1]))])
        self.right = np.vstack([np.zeros((1, b.shape[1])), b])
        self.cones = [clarabel.SecondOrderConeT(q + 1)]
        self.settings = clarabel.DefaultSettings()
        self.settings.verbose = False
        self.n = n

    def solve(self) -> np.ndarray:
        out = []
        for k in range(self.linear.shape[1]):
            solver = clarabel.DefaultSolver(
                self.P, self.linear[:, k], self.A, self.right[:, k], self.cones, self.settings
            )
            out.append(solver.solve().x[: self.n])
        return np.array(out).T


def step(n: int, q: int, repeats: int) -> Rows:
    """Seeds 0..2 in turn; a solution worse than ours by less than rounding voids nothing, a better one does."""
    data = [problems(n, q, seed) for seed in range(3)]
    solvers = [Clarabel(*d) for d in data]
    failed = 0
    for d, solver in zip(data, solvers, strict=True):
        ours = objective(*d, peers.rdkf_solve_all(*d, WEIGHT, "cached", 1)[0])
        assert np.allclose(ours, objective(*d, peers.rdkf_solve_all(*d, WEIGHT, "fresh", 1)[0]), rtol=1e-12)
        theirs = objective(*d, solver.solve())
        assert (ours <= theirs * (1 + 1e-12)).all() and np.allclose(ours, theirs, rtol=1e-4), "Clarabel disagrees"
        if peers.rdkf_ipopt_available():
            nlp = objective(*d, peers.rdkf_solve_all(*d, WEIGHT, "ipopt", 1)[0])
            failed += int(np.isnan(nlp).sum())
            nlp = np.where(np.isnan(nlp), ours, nlp)
            assert (ours <= nlp * (1 + 1e-12)).all() and np.allclose(ours, nlp, rtol=1e-3), "Ipopt disagrees"

    def timed(how: str, count: int) -> Any:
        return lambda: float(np.mean([peers.rdkf_solve_all(*d, WEIGHT, how, count)[1] for d in data]))

    rows = {
        "exact, cached factors": timed("cached", 200),
        "exact, fresh factors": timed("fresh", 3),
        "Clarabel, called directly": lambda: float(np.mean([cpu(s.solve) / INSTANCES for s in solvers])),
    }
    if peers.rdkf_ipopt_available():
        rows[f"Ipopt, C++ interface, {failed} of {3 * INSTANCES} unsolved"] = timed("ipopt", 1)
    return summary(interleaved(rows, repeats), "exact, cached factors")


def paper_system(seed: int = 0) -> tuple[np.ndarray, list[np.ndarray], np.ndarray]:
    rng = np.random.default_rng(seed)
    A = np.linalg.qr(rng.normal(size=(20, 20)))[0]
    C = [rng.normal(size=(14, 20)) for _ in range(10)]
    return A, C, rng.normal(size=140)


def network_step(repeats: int) -> Rows:
    """Ten agents, 20 states, 14 sensors each, one core; half of the samples saturate."""
    A, C, y = paper_system()
    rows = {
        "whole network, saturated": lambda: peers.rdkf_network_step(A, C, EDGES, 10 * y, 2000),
        "whole network, quiet": lambda: peers.rdkf_network_step(A, C, EDGES, 0 * y, 2000),
    }
    out = summary(interleaved(rows, repeats), "whole network, saturated")
    for row in out:
        row["per second"] = 1e3 / row["ms"]
        row["row"] += f", {row['per second']:.0f} per second"
    return out


def fixed_point_numpy(A: np.ndarray, C: list[np.ndarray]) -> np.ndarray:
    n, N = len(A), len(C)
    heard = [[i] for i in range(N)]
    for a, b in EDGES:
        heard[a].append(b)
        heard[b].append(a)
    seen = np.array([c.T @ c for c in C])
    P = np.zeros((N, n, n))
    while True:
        information = np.linalg.inv(A @ P @ A.T + np.eye(n))
        new = np.linalg.inv(np.array([information[h].mean(axis=0) for h in heard]) + seen)
        change = max(np.abs(a - b).max() / np.abs(a).max() for a, b in zip(new, P, strict=True))
        P = new
        if change < 1e-14:
            return P


def fixed_point(repeats: int) -> Rows:
    A, C, _ = paper_system()
    assert np.allclose(peers.rdkf_fixed_point(A, C, EDGES)[0], fixed_point_numpy(A, C), rtol=1e-10, atol=1e-12)
    rows = {
        "ours": lambda: peers.rdkf_fixed_point(A, C, EDGES)[2],
        "NumPy, batched": lambda: cpu(lambda: fixed_point_numpy(A, C)),
    }
    return summary(interleaved(rows, repeats), "ours")


def tasks(repeats: int) -> Tasks:
    return {
        "rdkf step n=4 q=2": lambda: step(4, 2, repeats),
        "rdkf step n=20 q=14": lambda: step(20, 14, repeats),
        "rdkf step n=60 q=40": lambda: step(60, 40, max(3, repeats // 3)),
        "rdkf network of 10, n=20 q=14": lambda: network_step(repeats),
        "rdkf fixed point, 10 agents, n=20": lambda: fixed_point(repeats),
    }
