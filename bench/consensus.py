"""Consensus rounds and a whole filter step against sparse products."""

from collections.abc import Callable

import garrison_bench as peers
import numpy as np
import scipy.sparse as sp
from timing import Rows, Tasks, cpu, interleaved, summary


def consensus(agents: int, rounds: int, repeats: int) -> Rows:
    task = peers.Consensus(agents, rounds, 0)
    W, given, x0 = sp.csr_matrix(task.ordered()), sp.csr_matrix(task.as_given()), task.start()

    def scipy_rounds(matrix: sp.csr_matrix) -> np.ndarray:
        x = x0
        for _ in range(rounds):
            x = matrix @ x
        return x

    expected = scipy_rounds(W)
    for name, (_, got) in {
        "ours": task.ours(),
        "eigen": task.eigen_fixed(),
        "eigen dynamic": task.eigen_dynamic(),
    }.items():
        assert np.abs(got - expected).max() < 1e-12, f"{name} is wrong"
    inner = max(4, 20_000 // agents)  # steps follow each other, as they do in a run
    rows: dict[str, Callable[[], float]] = {
        "ours": lambda: sum(task.ours()[0] for _ in range(inner)) / inner,
        "ours, whole filter step": lambda: sum(task.filter_step() for _ in range(inner)) / inner,
        "Eigen row-major, 8 columns fixed": lambda: sum(task.eigen_fixed()[0] for _ in range(inner)) / inner,
        "Eigen row-major, dynamic": lambda: sum(task.eigen_dynamic()[0] for _ in range(inner)) / inner,
        "scipy CSR, same ordering": lambda: cpu(lambda: [scipy_rounds(W) for _ in range(inner)]) / inner,
        "scipy CSR, labels as given": lambda: cpu(lambda: scipy_rounds(given)),
    }
    return summary(interleaved(rows, repeats), "ours")


def tasks(repeats: int) -> Tasks:
    return {f"consensus N={n} n=8 L=20": lambda n=n: consensus(n, 20, repeats) for n in (1_000, 10_000, 100_000)}
