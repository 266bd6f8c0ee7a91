"""Benchmarks: us and our peers, interleaved in one run. `make bench` builds what it needs and calls this.

Correctness is checked before anything is timed; a wrong result voids its row. Single-thread rows are processor time,
rows with threads are wall clock. Medians of the repeats; ratios are medians of the pairwise ratios.
"""

import argparse
import json
import os
import platform
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import garrison as gr
import garrison_bench as peers
import numpy as np
import scipy
import scipy.sparse as sp
from montecarlo import monte_carlo
from rich.console import Console
from rich.table import Table

HERE = Path(__file__).parent


def interleaved(rows: dict[str, Callable[[], float]], repeats: int) -> dict[str, list[float]]:
    """Seconds of every row, round after round in turn, after one round of warm-up."""
    for run in rows.values():
        run()
    times: dict[str, list[float]] = {name: [] for name in rows}
    for _ in range(repeats):
        for name, run in rows.items():
            times[name].append(run())
    return times


def summary(times: dict[str, list[float]], ours: str) -> list[dict[str, Any]]:
    """Median, and how many times longer than ours, pair by pair."""
    out = []
    for name, seconds in times.items():
        ratios = np.array(seconds) / np.array(times[ours])
        spread = [float(ratios.min()), float(ratios.max())]
        out.append(
            {"row": name, "ms": 1e3 * float(np.median(seconds)), "ratio": float(np.median(ratios)), "spread": spread}
        )
    return out


def cpu(run: Callable[[], Any]) -> float:
    start = time.process_time()
    run()
    return time.process_time() - start


def limits() -> dict[str, float]:
    sizes = {"L1": 24_000, "L2": 384_000, "L3": 4_000_000, "DRAM": 400_000_000}
    return {"multiply-add GF/s": peers.multiply_add_gflops()} | {
        f"triad {name} GB/s": peers.triad_gigabytes(size) for name, size in sizes.items()
    }


def consensus(agents: int, rounds: int, repeats: int) -> list[dict[str, Any]]:
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


def lambda0(agents: int, s: int, unit: bool, repeats: int, most: int = 2_000_000) -> list[dict[str, Any]]:
    """Seeds 0..4; enumeration is timed on the first `most` sets and scaled up where there are more."""
    from math import comb

    ours, brute, nodes = [], [], []
    for seed in range(5):
        C = np.random.default_rng(seed).normal(size=(agents, 4))
        if unit:
            C /= np.linalg.norm(C, axis=1, keepdims=True)
        value, exact, count, _ = peers.lambda0_ours(C, s)
        assert exact, "no certificate"
        nodes.append(count)
        least, sets, seconds = peers.lambda0_enumerate(C, s, most)
        if sets == comb(agents, s):
            assert abs(least - value) <= 1e-9 * abs(least) + 1e-12, "lambda_0 is wrong"
        brute.append(seconds * comb(agents, s) / sets)
        ours.append(float(np.median([peers.lambda0_ours(C, s)[3] for _ in range(repeats)])))
    ratio = np.array(brute) / np.array(ours)
    spread = [float(ratio.min()), float(ratio.max())]
    return [
        {"row": "ours", "ms": 1e3 * max(ours), "ratio": 1.0, "spread": [1.0, 1.0], "nodes": max(nodes)},
        {
            "row": "enumeration in C++",
            "ms": 1e3 * float(np.median(brute)),
            "ratio": float(np.median(ratio)),
            "spread": spread,
        },
    ]


def show(console: Console, title: str, rows: list[dict[str, Any]]) -> None:
    table = Table(title=title, title_justify="left")
    for name in ("row", "median ms", "ratio to ours", "spread"):
        table.add_column(name)
    for row in rows:
        low, high = row["spread"]
        table.add_row(row["row"], f"{row['ms']:.4g}", f"{row['ratio']:.4g}", f"{low:.3g} .. {high:.3g}")
    console.print(table)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repeats", type=int, default=9)
    parser.add_argument("--only", help="run only the tasks whose name contains this")
    args = parser.parse_args()
    console = Console(width=110)
    tasks: dict[str, Callable[[], list[dict[str, Any]]]] = {
        f"consensus N={n} n=8 L=20": lambda n=n: consensus(n, 20, args.repeats) for n in (1_000, 10_000, 100_000)
    }
    tasks["monte carlo 100 x 500 x 30"] = lambda: monte_carlo(args.repeats, interleaved, summary)
    tasks["lambda0 N=30 n=4 s=5"] = lambda: lambda0(30, 5, False, args.repeats)
    tasks["lambda0 N=100 n=4 s=10 Gaussian"] = lambda: lambda0(100, 10, False, 3)
    tasks["lambda0 N=100 n=4 s=10 unit rows"] = lambda: lambda0(100, 10, True, 3)
    results: dict[str, Any] = {
        "versions": {
            "garrison": gr.__version__,
            "numpy": np.__version__,
            "scipy": scipy.__version__,
            "python": platform.python_version(),
        },
        "load": os.getloadavg(),
        "cores": os.cpu_count(),
        "limits": limits(),
    }
    console.print(results)
    for name, task in tasks.items():
        if args.only and args.only not in name:
            continue
        results[name] = task()
        show(console, name, results[name])
    results["limits at the end"] = limits()
    if not args.only:
        folder = HERE / "results"
        folder.mkdir(exist_ok=True)
        (folder / f"{time.strftime('%Y-%m-%d')}.json").write_text(json.dumps(results, indent=1) + "\n")


if __name__ == "__main__":
    main()
