"""gr.design against a grid search of 200 points: on how many random networks a point of the grid is better.

Each point is a check that anyone can make: rounds x thresholds of the saturation filter for one liar.
`python bench/design_grid.py 50` (minutes) prints a row per network and ends with 1 where a point is better.
"""

import argparse
import math
import time
from typing import Any

import garrison as gr
import numpy as np

Plant = tuple[gr.Model, gr.Network]
#: 8 x 25 points, spread over what a search by hand would try
ROUNDS = (1, 2, 3, 5, 8, 13, 24, 40)
THRESHOLDS = np.geomspace(0.02, 20, 25)
INITIAL_ERROR, ATTACKED = 2.0, 1


def random_network(rng: Any) -> Plant:
    """4 to 11 agents with unit rows of two states; a plant that grows by up to 3 % per sample, or decays."""
    N = int(rng.integers(4, 12))
    rows = rng.normal(size=(N, 1, 2))
    rows /= np.linalg.norm(rows, axis=2, keepdims=True)
    A = rng.normal(size=(2, 2))
    A *= rng.uniform(0.9, 1.03) / np.linalg.norm(A, 2)
    model = gr.Model(A, list(rows), process_bound=rng.uniform(0, 0.02), measurement_bound=rng.uniform(0.01, 0.1))
    edges = [(i, (i + 1) % N) for i in range(N)] + [(i, j) for i in range(N) for j in range(i) if rng.random() < 0.3]
    return model, gr.Network(edges)


def best_of_grid(model: gr.Model, network: gr.Network) -> float:
    """The smallest asymptotic bound of the points whose conditions hold; inf: none does."""
    best = math.inf
    for rounds in ROUNDS:
        for threshold in THRESHOLDS:
            filter = gr.filters.Saturation(
                threshold=threshold, rounds=rounds, attacked=ATTACKED, initial_error=INITIAL_ERROR, chebyshev=True
            )
            found = gr.check(model, network, filter)
            if found.holds:
                best = min(best, found["asymptotic bound"])
    return best


def designed(model: gr.Model, network: gr.Network) -> float:
    """The bound of the design with as many rounds at most; inf: it says that there is none."""
    try:
        found = gr.design(
            model, network, attacked=ATTACKED, initial_error=INITIAL_ERROR, most_rounds=max(ROUNDS), curve=False
        )
    except gr.DesignInfeasible:
        return math.inf
    return float(gr.check(model, network, found.filter)["asymptotic bound"])


def compare(networks: int, seed: int = 1) -> list[dict[str, float]]:
    """Per network: what the grid and the design reach, and the seconds that each took."""
    rng, out = np.random.default_rng(seed), []
    for _ in range(networks):
        model, network = random_network(rng)
        began = time.process_time()
        by_grid = best_of_grid(model, network)
        between = time.process_time()
        by_design = designed(model, network)
        spent = time.process_time() - between
        out.append({"grid": by_grid, "design": by_design, "grid s": between - began, "design s": spent})
    return out


def main() -> int:
    """Print all networks and how many of them a point of the grid did better on."""
    reader = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    reader.add_argument("networks", type=int, nargs="?", default=50)
    reader.add_argument("--seed", type=int, default=1)
    given = reader.parse_args()
    rows = compare(given.networks, given.seed)
    for k, row in enumerate(rows):
        print(k, *(f"{name} {value:.6g}" for name, value in row.items()))
    worse = sum(row["design"] > row["grid"] * (1 + 1e-9) for row in rows)
    solved = sum(math.isfinite(row["design"]) for row in rows)
    print(f"{worse} of {len(rows)} networks where a point of the grid is better; {solved} have a design at all")
    return int(worse > 0)


if __name__ == "__main__":
    raise SystemExit(main())
