"""Certificates with memory: a double integrator whose sensors lie, number by number.

    python examples/papers/certificates_memory.py [--steps 300]

Six position sensors (deviation 1 m) and four velocity sensors (0.3 m/s), or the six positions alone; an acceleration of
deviation 0.5 m/s2 every 0.1 s; two sensors lie, at most two may. The bounds are garrison's own; what they are compared
with are the numbers of the reference implementation that they were designed with, on noise of its own. A number is
confirmed when it is within 5 % of the reference's (10 % where the liars move) and no coordinate of any state was
outside its box; delta = 1e-6.
"""

import argparse
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from claims import Rows, claim, print_claims
from garrison import certificate

S = 2
DT = 0.1
DELTA = 1e-6
A = np.array([[1.0, DT], [0.0, 1.0]])
GAM = 0.5 * np.array([[DT * DT / 2], [DT]])
Q = GAM @ GAM.T
NEAR = 0.05
FIRST = 100  # step from which boxes are averaged
EVERY = 10  # steps between two windows


@dataclass
class Answer:
    """What a certificate says at a step; no box: it cannot answer."""

    t: int
    center: np.ndarray | None
    box: np.ndarray | None
    proved: list[int]


def said(t: int, w: certificate.WindowWitness) -> Answer:
    return Answer(t, w.center, w.box, w.proved)


@dataclass
class Sensors:
    """Rows and deviations of the sensors, who lies, and by how much."""

    C: np.ndarray
    deviation: np.ndarray
    liars: tuple[int, ...]

    def sources(self) -> list[tuple[np.ndarray, np.ndarray]]:
        return [(c[None], np.array([d * d])) for c, d in zip(self.C, self.deviation, strict=True)]

    def lies(self, size: tuple[float, float]) -> np.ndarray:
        """(sensors,): the first size for positions, the second for velocities."""
        offset = np.zeros(len(self.C))
        for j in self.liars:
            offset[j] = size[0] if self.C[j, 0] else size[1]
        return offset


POSITIONS = Sensors(np.tile([1.0, 0.0], (6, 1)), np.ones(6), (1, 4))
MIXED = Sensors(np.vstack([POSITIONS.C, np.tile([0.0, 1.0], (4, 1))]), np.array([1.0] * 6 + [0.3] * 4), (1, 7))
ATTACKS = {"no attack": (0.0, 0.0), "stealthy": (2.0, 0.6), "loud": (60.0, 20.0)}


class Run:
    """A trajectory and what the sensors say of it."""

    def __init__(self, sensors: Sensors, attack: str, steps: int, seed: int = 20261128) -> None:
        rng = np.random.default_rng(seed)
        self.sensors, self.attack = sensors, attack
        self.x = np.zeros((steps, 2))
        self.x[0] = 0.0, 1.0
        for t in range(1, steps):
            self.x[t] = A @ self.x[t - 1] + GAM[:, 0] * rng.normal()
        noise = sensors.deviation * rng.normal(size=(steps, len(sensors.C)))
        self.y = self.x @ sensors.C.T + noise + sensors.lies(ATTACKS[attack])

    def window(self, end: int, steps: int) -> certificate.Window:
        w = certificate.Window(2, 1, steps, len(self.sensors.C), steps * len(self.sensors.C))
        w.begin(steps)
        for k in range(steps):
            for j, (c, d) in enumerate(zip(self.sensors.C, self.sensors.deviation, strict=True)):
                w.add(j, c, self.y[end - steps + 1 + k, j], d * d)
            if k < steps - 1:
                w.advance(A, GAM, np.zeros(2))
        return w

    def windows(self, steps: int, ask: Callable[..., certificate.WindowWitness], **options: object) -> list[Answer]:
        levels = certificate.window_levels(DELTA, steps * len(self.sensors.C), 2)
        ends = range(FIRST, len(self.x), EVERY)
        return [said(t, ask(self.window(t, steps), S, *levels, **options)) for t in ends]

    def bank(self) -> list[Answer]:
        b = certificate.Bank(A, Q, self.sensors.sources(), S)
        b.start_gaussian(np.array([0.0, 1.0]), np.eye(2))
        levels = certificate.window_levels(DELTA, len(self.sensors.C), 2)
        found = [said(t, b.update(self.y[t], *levels)) for t in range(1, len(self.x))]
        return found[FIRST:]

    def cells(self) -> list[Answer]:
        """One small bank without liars, a Kalman filter, per cell; the interval rule over their boxes."""
        n, parts = 2, [[0], [1], [2, 6], [3, 7], [4, 8], [5, 9]]  # a position each, and the velocities
        sources = self.sensors.sources()
        filters = [certificate.Bank(A, Q, [sources[j] for j in part], 0) for part in parts]
        for f in filters:
            f.start_gaussian(np.array([0.0, 1.0]), np.eye(n))
        zc = certificate.two_sided(DELTA / (len(parts) * n))
        found = []
        for t in range(1, len(self.x)):
            answers = [f.update(self.y[t, part], 1e9, zc, zc) for f, part in zip(filters, parts, strict=True)]
            lo, hi = certificate.cells([w.region for w in answers], S)
            found.append(Answer(t, (lo + hi) / 2, (hi - lo) / 2, []))
        return found[FIRST:]


def described(
    run: Run,
    name: str,
    found: list[Answer],
    reference: tuple[float, float],
    everybody: bool = False,
    near: float = NEAR,
) -> list[str]:
    """Mean box against the reference's; `everybody`: both liars must be proved at the end."""
    boxes = [a.box for a in found if a.box is not None]
    mean = np.mean(boxes, axis=0) if len(boxes) == len(found) else np.full(2, np.inf)
    inside = all((np.abs(run.x[a.t] - a.center) <= a.box).all() for a in found if a.center is not None)
    proved = sorted(set(found[-1].proved))
    innocent = set(proved) <= set(run.sensors.liars) and (run.attack != "no attack" or not proved)
    close = bool((np.abs(mean - reference) <= near * np.array(reference)).all())
    text = f"{mean[0]:.2f} m, {mean[1]:.2f} m/s ({reference[0]:g}, {reference[1]:g}), proved {proved}"
    holds = inside and innocent and close and (not everybody or proved == sorted(run.sensors.liars))
    return claim(f"{name}, {run.attack}", text if inside else text + ", OUTSIDE", holds)


def three(
    sensors: Sensors,
    steps: int,
    name: str,
    ask: Callable[[Run], list[Answer]],
    references: list[tuple[float, float]],
    everybody: bool = False,
) -> Rows:
    runs = [Run(sensors, attack, steps) for attack in ATTACKS]
    return [
        described(run, name, ask(run), reference, everybody and run.attack == "loud")
        for run, reference in zip(runs, references, strict=True)
    ]


def by(steps: int, ask: Callable[..., certificate.WindowWitness], **options: object) -> Callable[[Run], list[Answer]]:
    return lambda run: run.windows(steps, ask, **options)


def mixed(steps: int) -> Rows:
    W2M, W3M, search = certificate.leverage_window, certificate.subsets_window, certificate.anytime_window
    rows = three(MIXED, steps, "W2M, one step", by(1, W2M), [(3.57, 1.47), (3.95, 1.64), (2.34, 0.91)])
    rows += three(MIXED, steps, "W3M, one step", by(1, W3M), [(3.08, 1.27), (3.24, 1.37), (2.34, 0.91)])
    rows += three(MIXED, steps, "W2M, 10 steps", by(10, W2M), [(1.26, 0.76), (1.93, 1.01), (0.75, 0.45)])
    rows += three(MIXED, steps, "W2M, 40 steps", by(40, W2M), [(0.87, 0.88), (1.55, 1.26), (0.47, 0.45)])
    moving = [(1.84, 1.00), (2.20, 1.15), (0.75, 0.45)]
    rows += three(MIXED, steps, "W2M, moving set, 10 steps", by(10, W2M, moving=True), moving)
    moving = [(1.64, 1.12), (1.97, 1.33), (0.56, 0.45)]
    rows += three(MIXED, steps, "W2M, moving set, 20 steps", by(20, W2M, moving=True), moving)
    rows += three(MIXED, steps, "W3M, 10 steps", by(10, W3M), [(1.00, 0.58), (1.23, 0.68), (0.75, 0.45)])
    rows += three(MIXED, steps, "W3M, 40 steps", by(40, W3M), [(0.56, 0.56), (0.90, 0.65), (0.47, 0.45)])
    rows += three(
        MIXED, steps, "A, 12 leaves, 10 steps", by(10, search, leaves=12), [(1.04, 0.64), (1.28, 0.73), (0.75, 0.45)]
    )
    rows += three(MIXED, steps, "C, 6 cells", Run.cells, [(0.95, 0.64), (0.91, 0.65), (0.81, 0.63)])
    return rows + three(MIXED, steps, "B", Run.bank, [(0.53, 0.56), (0.95, 0.65), (0.45, 0.45)], everybody=True)


def positions(steps: int) -> Rows:
    W2M, W3M = certificate.leverage_window, certificate.subsets_window
    run = Run(POSITIONS, "stealthy", steps)
    z1, z2 = certificate.gaussian_levels(DELTA, 6, 2)
    one = [certificate.leverage_ball(y, POSITIONS.C, np.ones(6), S, z1, z2).radius for y in run.y[FIRST::EVERY]]
    rows = [claim("one step: no bound at all", f"smallest radius {min(one)}", bool(np.isinf(one).all()))]
    rows += three(POSITIONS, steps, "W2M, 10 steps", by(10, W2M), [(2.01, 3.82), (2.60, 4.35), (1.54, 2.92)])
    rows += three(POSITIONS, steps, "W2M, 40 steps", by(40, W2M), [(1.29, 1.30), (2.05, 1.48), (0.96, 0.97)])
    moving = [(2.97, 2.91), (3.71, 3.56), (1.14, 1.22)]
    rows += three(POSITIONS, steps, "W2M, moving set, 20 steps", by(20, W2M, moving=True), moving)
    moving = [(2.54, 2.03), (3.22, 2.51), (0.96, 0.97)]
    rows += three(POSITIONS, steps, "W2M, moving set, 40 steps", by(40, W2M, moving=True), moving)
    rows += three(POSITIONS, steps, "W3M, 10 steps", by(10, W3M), [(1.81, 3.47), (2.12, 3.47), (1.54, 2.92)])
    rows += three(POSITIONS, steps, "W3M, 40 steps", by(40, W3M), [(1.11, 1.06), (1.53, 1.06), (0.96, 0.97)])
    return rows + three(POSITIONS, steps, "B", Run.bank, [(1.09, 1.04), (1.51, 1.04), (0.95, 0.97)], everybody=True)


def movers(steps: int) -> Rows:
    """Two other liars in every step, 6 m off; and the clipped observer (O), which no such liars ever move further."""
    rng = np.random.default_rng(5)
    run = Run(POSITIONS, "no attack", steps)
    run.attack = "two others in every step"
    for y in run.y:
        y[rng.choice(len(y), 2, replace=False)] += 6.0
    rows = [
        described(
            run, f"W2M, moving set, {k} steps", run.windows(k, certificate.leverage_window, moving=True), near, near=0.1
        )
        for k, near in ((5, (6.4, 24.5)), (10, (6.6, 12.0)), (20, (6.65, 6.3)))
    ]
    for name, sensors, s, larger, reference in (
        ("6 positions", POSITIONS, 0, 1.0, (5.4, 5.3)),
        ("6 positions", POSITIONS, 1, 1.0, (10.8, 9.3)),
        ("6 + 4 sensors", MIXED, 0, 10.0, (5.4, 1.1)),
        ("6 + 4 sensors", MIXED, 1, 100.0, (8.5, 2.1)),
    ):
        gain = steady_gain(sensors, larger)
        table = certificate.observer_table(
            A, sensors.C, gain, GAM, 3 * sensors.deviation, s=s, bw=3.0, start=0.0, T=400, lags=200
        )
        half = table.d[-1]
        close = bool((np.abs(half[:2] - reference) <= NEAR * np.array(reference)).all())
        found = f"{half[0]:.2f} m, {half[1]:.2f} m/s ({reference[0]:g}, {reference[1]:g})"
        rows.append(claim(f"O, 3 deviations, {name}, s = {s}", found, close))
    return rows


def steady_gain(sensors: Sensors, larger: float) -> np.ndarray:
    """(2, sensors) gain of the Kalman filter of all sensors and so many times the process noise, settled."""
    P, R = np.eye(2), np.diag(sensors.deviation**2)
    for _ in range(2000):
        L = P @ sensors.C.T @ np.linalg.inv(sensors.C @ P @ sensors.C.T + R)
        P = A @ (P - L @ sensors.C @ P) @ A.T + larger * Q
    return L


def for_ever() -> Rows:
    """B2: no attack on a fixed set can ever make a member's error larger."""
    rows: Rows = []
    noise = Q + 1e-9 * np.eye(2)
    for name, sensors, s, reference in (
        ("6 + 4 sensors", MIXED, 1, (3.5, 1.7)),
        ("6 + 4 sensors", MIXED, 2, (9.7, 9.6)),
        ("6 positions", POSITIONS, 1, (3.8, 2.9)),
        ("6 positions", POSITIONS, 2, (9.1, 5.7)),
        ("6 positions", POSITIONS, 3, (np.inf, np.inf)),
    ):
        levels = certificate.window_levels(DELTA, len(sensors.C), 2)
        width = certificate.bank_steady(A, noise, sensors.sources(), s, *levels)[:2]
        if np.isinf(reference[0]):
            holds = bool(np.isinf(width).all())
        else:
            holds = bool((np.abs(width - reference) <= NEAR * np.array(reference)).all())
        found = f"{width[0]:.2f} m, {width[1]:.2f} m/s ({reference[0]:g}, {reference[1]:g})"
        rows.append(claim(f"B2, {name}, s = {s}", found, holds))
    return rows


def gaps() -> Rows:
    """Nothing arrives: half width of the position, from a unit ball."""
    seconds = (1, 5, 20, 60)
    unit = np.array([[DT * DT / 2], [DT]])
    start = certificate.ellipsoid(np.zeros(2), np.eye(2), 1.0)
    zc = certificate.two_sided(DELTA / 2)
    laws = {
        "|a| <= 0.6": (certificate.Propagation.bounded_entries(A, 600, unit, 0.6), (1.7, 12.6, 140, 1140)),
        "no noise": (certificate.Propagation.bounded_entries(A, 600, unit, 0.0), (1.4, 5.1, 20, 60)),
        "white, deviation 0.2": (
            certificate.Propagation.gaussian_entries(A, 600, 0.2 * unit, zc, certificate.chi(DELTA, 2)),
            (1.6, 7.1, 36, 143),
        ),
    }
    rows: Rows = []
    for name, (law, reference) in laws.items():
        half = [law.age(start, round(t / DT)).box[0] for t in seconds]
        close = bool((np.abs(np.array(half) - reference) <= 0.05 * np.array(reference)).all())
        found = ", ".join(f"{h:.1f} ({r:g})" for h, r in zip(half, reference, strict=True))
        rows.append(claim(f"gap of 1, 5, 20, 60 s, {name}", f"{found} m", close))
    return rows


def main() -> Rows:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--steps", type=int, default=300, help="steps of each run, more than 110")
    args = parser.parse_args()
    parts = {
        "Six positions and four velocities, two lying": mixed(args.steps),
        "Six positions, two lying": positions(args.steps),
        "Liars that move": movers(args.steps),
        "For ever": for_ever(),
        "Gaps": gaps(),
    }
    for title, rows in parts.items():
        print_claims(f"{title} (reference in brackets)", rows)
    return [row for rows in parts.values() for row in rows]


if __name__ == "__main__":
    main()
