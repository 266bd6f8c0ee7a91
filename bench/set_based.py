"""Beside exact sets: size and time of our certificates on the example systems of secure set-based estimation.

Systems: Niazi, Alanwar, Chong, Johansson, secure set-based estimation with zonotopes (2022). Bounds: 1 on every
measurement noise, .02 on each entry of the process noise; source 0 lies, by as much as its noise hides. Exact: the
smallest box around all states that some set of all but s sources allows.
"""

import numpy as np
from garrison import certificate
from timing import Rows, Tasks, cpu

PROCESS, NOISE, TRIALS = 0.02, 1.0, 20
STEPS = (1, 5, 10, 20)
SYSTEMS = {
    "rotating target": (
        [[0.9455, -0.2426], [0.2486, 0.9455]],
        [[1, 0.4], [0.9, -1.2], [-0.8, 0.2], [0, 0.7]],
        [0, 1, 2, 2],
    ),
    "four sensors": ([[1, 0], [1, 1]], [[1, 0], [1, 1], [0, 1], [1, 2]], [0, 1, 2, 3]),
}


def window(name: str, steps: int, rng: np.random.Generator) -> tuple[certificate.Window, np.ndarray]:
    """Measurements of so many steps, and the state of the last one."""
    A, C, source = (np.array(part) for part in SYSTEMS[name])
    w = certificate.Window(2, 2, steps, 4, steps * len(C))
    w.begin(steps, PROCESS)
    x = rng.uniform(-1, 1, 2)
    for k in range(steps):
        for c, j in zip(C.astype(float), source, strict=True):
            said = c @ x + rng.uniform(-NOISE, NOISE) + (NOISE if j == 0 else 0.0)
            w.add(int(j), c, float(said), NOISE**2 / 3, NOISE, bounded=True)
        if k < steps - 1:
            w.advance(A.astype(float), np.eye(2), np.zeros(2))
            x = A @ x + rng.uniform(-PROCESS, PROCESS, 2)
    return w, x


def compare(name: str, steps: int) -> Rows:
    """Median half diagonal of the box in the name of the row, median time; ratio: of times, ours = 1."""
    rng = np.random.default_rng(20261128)
    sizes: dict[str, list[float]] = {"leverages": [], "exact": []}
    times: dict[str, list[float]] = {"leverages": [], "exact": []}
    outside = 0
    for _ in range(TRIALS):
        w, x = window(name, steps, rng)
        found: dict[str, tuple[np.ndarray, np.ndarray]] = {}

        def ours(w: certificate.Window = w, found: dict[str, tuple[np.ndarray, np.ndarray]] = found) -> None:
            region = certificate.leverage_window(w, 1, 0.0, 0.0, 0.0).region
            box = np.full(2, np.inf) if region.box is None else region.box
            center = np.zeros(2) if region.center is None else region.center
            found["leverages"] = (center - box, center + box)

        def exact(w: certificate.Window = w, found: dict[str, tuple[np.ndarray, np.ndarray]] = found) -> None:
            found["exact"] = certificate.hull_window(w, 1)

        times["leverages"].append(cpu(ours))
        times["exact"].append(cpu(exact))
        for kind, (lo, hi) in found.items():
            sizes[kind].append(float(np.linalg.norm(hi - lo) / 2))
            outside += int(((x < lo - 1e-9) | (x > hi + 1e-9)).any())
    if outside:
        raise AssertionError(f"{name}, {steps} steps: {outside} of {2 * TRIALS} boxes without the state")
    ratios = np.array(times["exact"]) / np.array(times["leverages"])
    return [
        {
            "row": f"{kind}: box of {np.median(sizes[kind]):.3g}",
            "ms": 1e3 * float(np.median(times[kind])),
            "ratio": 1.0 if kind == "leverages" else float(np.median(ratios)),
            "spread": [1.0, 1.0] if kind == "leverages" else [float(ratios.min()), float(ratios.max())],
        }
        for kind in times
    ]


def tasks(repeats: int) -> Tasks:
    """Systems and window lengths; repeats is not used: every trial is another window."""
    return {
        f"set-based peers: {name}, {k} steps": lambda name=name, k=k: compare(name, k)
        for name in SYSTEMS
        for k in STEPS
    }
