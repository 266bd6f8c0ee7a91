"""Structural analysis against SuiteSparse, SciPy and igraph; the gain design of a large network."""

from collections.abc import Callable
from typing import Any

import garrison_bench as peers
import igraph
import numpy as np
from scipy.sparse import coo_array, csc_array
from scipy.sparse.csgraph import connected_components, maximum_bipartite_matching
from timing import Rows, Tasks, cpu, interleaved, summary

RNG = np.random.default_rng


def erdos_renyi(n: int, seed: int) -> csc_array:
    """n x n, 3n random entries: many deficient parts."""
    rng = RNG(seed)
    i, j = rng.integers(0, n, (2, 3 * n))
    return _csc(i, j, n, n)


def plant_like(n: int, seed: int) -> csc_array:
    """Three entries within 50 of the diagonal, 90 % of the diagonal, then rows and columns permuted."""
    rng = RNG(seed)
    j = np.repeat(np.arange(n), 3)
    i = np.clip(j + rng.integers(-50, 51, 3 * n), 0, n - 1)
    kept = np.flatnonzero(rng.random(n) < 0.9)
    rows, columns = rng.permutation(n), rng.permutation(n)
    return _csc(rows[np.concatenate([i, kept])], columns[np.concatenate([j, kept])], n, n)


def _csc(i: np.ndarray, j: np.ndarray, rows: int, columns: int) -> csc_array:
    matrix = csc_array(coo_array((np.ones(len(i), dtype=np.int8), (i, j)), shape=(rows, columns)))
    matrix.sum_duplicates()
    matrix.data[:] = 1
    return matrix


def adversarial() -> dict[str, csc_array]:
    """Twenty patterns that are hard for one algorithm or another, about 20 000 rows each."""
    n = 20_000
    k = np.arange(n)
    rng = RNG(5)
    chain = [np.concatenate([k, k[1:]]), np.concatenate([k, k[:-1]])]  # column j: rows j, j + 1
    star = [np.concatenate([k, np.zeros(n, int)]), np.concatenate([np.zeros(n, int), k])]
    block = 100
    inside = (k // block) * block
    lower = [np.repeat(k, 5), np.repeat(inside, 5) + rng.integers(0, block, 5 * n)]
    out = {
        "chain": _csc(*chain, n, n),
        "chain backwards": _csc(n - 1 - chain[0], n - 1 - chain[1], n, n),
        "chain without its end": _csc(chain[0][:-1], chain[1][:-1], n, n),
        "chain shifted": _csc(np.concatenate([k[:-1], k[1:]]), np.concatenate([k[1:], k[1:]]), n, n),
        "star": _csc(*star, n, n),
        "star of rows": _csc(np.zeros(n, int), k, n, n),
        "star of columns": _csc(k, np.zeros(n, int), n, n),
        "blocks": _csc(*lower, n, n),
        "block triangular": _csc(
            np.concatenate([lower[0], rng.integers(0, n // 2, n)]),
            np.concatenate([lower[1], n // 2 + rng.integers(0, n // 2, n)]),
            n,
            n,
        ),
        "diagonal": _csc(k, k, n, n),
        "half of the rows empty": _csc(2 * (k // 2), rng.integers(0, n, n), n, n),
        "half of the columns empty": _csc(rng.integers(0, n, n), 2 * (k // 2), n, n),
        "nothing": _csc(k[:0], k[:0], n, n),
        "wide": _csc(rng.integers(0, n // 4, 3 * n), rng.integers(0, n, 3 * n), n // 4, n),
        "tall": _csc(rng.integers(0, n, 3 * n), rng.integers(0, n // 4, 3 * n), n, n // 4),
        "one row": _csc(k * 0, k, 1, n),
        "cycle": _csc(np.concatenate([k, (k + 1) % n]), np.concatenate([k, k]), n, n),
        "upper band": _csc(np.concatenate([np.maximum(k - s, 0) for s in range(1, 6)]), np.concatenate([k] * 5), n, n),
        "dense corner": _csc(rng.integers(0, 300, 60_000), rng.integers(0, 300, 60_000), n, n),
        "powers": _csc((n * rng.random(3 * n) ** 4).astype(int), (n * rng.random(3 * n) ** 4).astype(int), n, n),
    }
    assert len(out) == 20
    return out


#: what takes less than this is repeated within one measurement
SHORTEST = 200e-6

Timed = Callable[[int], float]


def python(run: Callable[[], Any]) -> Timed:
    """Mean processor time of a call from Python, as the peers' users make it, after one that is not counted."""

    def mean(times: int) -> float:
        run()
        return cpu(lambda: [run() for _ in range(times)]) / times

    return mean


def long_enough(run: Timed) -> Callable[[], float]:
    """`run`, repeated so often that the clock's resolution is no matter."""
    times = max(1, int(np.ceil(SHORTEST / max(min(run(1), run(1)), 1e-7))))
    return lambda: run(times)


class Peers:
    """One pattern, and a row per library that can do the task; what comes out is checked first."""

    def __init__(self, matrix: csc_array) -> None:
        self.matrix = matrix
        self.ours = peers.Structure(matrix.shape[0], matrix.indptr, matrix.indices)

    def rows(self, task: str) -> dict[str, Callable[[], float]]:
        return {name: long_enough(run) for name, run in getattr(self, task)().items()}

    def matching(self) -> dict[str, Timed]:
        m, ours = self.matrix, self.ours
        rank = ours.matching()[0]
        by_rows = m.T.tocsr()  # the same arrays as compressed rows
        i, j = m.nonzero()
        types = [False] * m.shape[0] + [True] * m.shape[1]
        graph = igraph.Graph(n=len(types), edges=np.column_stack([i, j + m.shape[0]]).tolist())
        assert (maximum_bipartite_matching(by_rows) >= 0).sum() == rank, "structural rank is wrong"
        assert ours.matching_cs()[0] == rank, "structural rank is wrong"
        return {
            "ours": lambda times: ours.matching(times)[1],
            "scipy": python(lambda: maximum_bipartite_matching(by_rows)),
            "CXSparse cs_maxtrans": lambda times: ours.matching_cs(times)[1],
            "BTF btf_maxtrans": lambda times: ours.matching_btf(times)[1],
            "igraph": python(lambda: graph.maximum_bipartite_matching(types)),
        }

    def components(self) -> dict[str, Timed]:
        ours = self.ours
        count = ours.components()[0]
        by_rows = self.matrix.T.tocsr()
        assert connected_components(by_rows, connection="strong")[0] == count, "components are wrong"
        assert ours.components_btf()[0] == count, "components are wrong"
        return {
            "ours": lambda times: ours.components(times)[1],
            "BTF btf_strongcomp": lambda times: ours.components_btf(times)[1],
            "scipy": python(lambda: connected_components(by_rows, connection="strong")),
        }

    def decomposition(self) -> dict[str, Timed]:
        ours = self.ours
        found, cs = ours.decomposition()[0], ours.decomposition_cs()[0]
        assert found == cs, f"Dulmage-Mendelsohn parts differ: {found}, CXSparse {cs}"
        return {
            "ours": lambda times: ours.decomposition(times)[1],
            "CXSparse cs_dmperm": lambda times: ours.decomposition_cs(times)[1],
        }


def on(make: Callable[[], csc_array], task: str, repeats: int) -> Rows:
    return summary(interleaved(Peers(make()).rows(task), repeats), "ours")


def worst(task: str, repeats: int) -> Rows:
    """Ours to the best peer on 200 random and 20 adversarial patterns: the largest ratios."""
    rng = RNG(9)
    instances = dict(adversarial())
    for k in range(200):
        rows, columns = (int(v) for v in rng.integers(1, 3000, 2))
        if task == "components" or k % 2:
            columns = rows
        count = int(rng.uniform(0.5, 6) * max(rows, columns))
        instances[f"random {k}"] = _csc(rng.integers(0, rows, count), rng.integers(0, columns, count), rows, columns)
    found = []
    for name, matrix in instances.items():
        if task == "components" and matrix.shape[0] != matrix.shape[1]:
            continue
        times = interleaved(Peers(matrix).rows(task), repeats)
        medians = {row: float(np.median(seconds)) for row, seconds in times.items()}
        ours = medians.pop("ours")
        best = min(medians, key=lambda row: medians[row])
        shape = f"{matrix.shape[0]} x {matrix.shape[1]}, {matrix.nnz} entries"
        found.append((ours / medians[best], f"ours on {name} ({shape}) to {best}", ours))
    found.sort(reverse=True)
    return [{"row": row, "ms": 1e3 * ours, "ratio": ratio, "spread": [ratio] * 2} for ratio, row, ours in found[:6]]


def riccati(agents: int, n: int, repeats: int) -> Rows:
    """Coupled Riccati design of a random network, N n in the thousands: seconds, not a ratio."""
    rng = RNG(0)
    A = rng.normal(size=(n, n))
    A *= 1.02 / np.abs(np.linalg.eigvals(A)).max()
    C = rng.normal(size=(agents, n))
    W = np.zeros((agents, agents))
    for i in range(agents):
        heard = np.unique(np.append(rng.integers(0, agents, 4), [i, (i + 1) % agents]))
        W[i, heard] = 1.0 / len(heard)
    seconds = []
    for _ in range(repeats):
        sweeps, settled, t = peers.coupled_riccati(A, C, W, (W > 0).astype(float))
        assert settled, "the recursion did not settle"
        seconds.append(t)
    low, high = min(seconds), max(seconds)
    name = f"ours, {sweeps} sweeps"
    return [{"row": name, "ms": 1e3 * float(np.median(seconds)), "ratio": 1.0, "spread": [low, high]}]


def tasks(repeats: int) -> Tasks:
    out: Tasks = {}
    for task in ("matching", "components", "decomposition"):
        for name, make in (("er", erdos_renyi), ("plant-like", plant_like)):
            for size, text, times in ((3_000, "3e3", repeats), (100_000, "1e5", min(repeats, 5))):
                out[f"structure {task} {name} n={text}"] = lambda make=make, size=size, task=task, times=times: on(
                    lambda: make(size, 0), task, times
                )
    for task in ("matching", "decomposition", "components"):
        out[f"structure {task}, worst of 220 patterns (ratio: ours to best peer)"] = lambda task=task: worst(task, 5)
    out["structure components plant-like n=1e6"] = lambda: on(lambda: plant_like(1_000_000, 0), "components", 3)
    out["structure decomposition plant-like n=3e5"] = lambda: on(lambda: plant_like(300_000, 0), "decomposition", 3)
    out["structural coupled Riccati N=400 n=10"] = lambda: riccati(400, 10, 3)
    out["structural coupled Riccati N=100 n=40"] = lambda: riccati(100, 40, 3)
    return out
