"""The subset search lambda_0 against enumeration."""

from math import comb

import garrison_bench as peers
import numpy as np
from timing import Rows, Tasks


def lambda0(agents: int, s: int, unit: bool, repeats: int, most: int = 2_000_000) -> Rows:
    """Seeds 0..4; enumeration is timed on the first `most` sets and scaled up where there are more."""
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


def tasks(repeats: int) -> Tasks:
    return {
        "lambda0 N=30 n=4 s=5": lambda: lambda0(30, 5, False, repeats),
        "lambda0 N=100 n=4 s=10 Gaussian": lambda: lambda0(100, 10, False, 3),
        "lambda0 N=100 n=4 s=10 unit rows": lambda: lambda0(100, 10, True, 3),
    }
