"""The simulation section of Dutta, Zhang, Jin (2019), claim by claim, and what it leaves open.

    python examples/papers/rdkf.py -o out/papers/rdkf [--seeds 3]

The paper does not say where A comes from ("random"), nor x_0, the start, or the attack values. Here: A orthogonal (only
a spectral radius near 1 reproduces Fig. 2), x_0 and C from N(0, 1), start 0, attack values 10 N(0, 1). Graph: the
neighbour lists give 11 edges, the twelfth is 6-7. Attacked: the six agents whose lists are complete, at the listed
times. All errors are ||xhat_i - x|| / ||x||, the worst agent, the mean over seeds.
"""

import argparse
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")

import garrison as gr
import numpy as np
from claims import claim, print_claims, print_table
from garrison._core import rdkf as theory
from matplotlib.figure import Figure

N, STATES, SENSORS, STEPS = 10, 20, 14, 50
EDGES = [(1, 3), (1, 4), (1, 8), (2, 9), (3, 8), (5, 6), (5, 7), (6, 8), (7, 8), (8, 10), (9, 10), (6, 7)]
NETWORK = gr.Network([(a - 1, b - 1) for a, b in EDGES], agents=N)
ATTACKED = [i - 1 for i in (1, 2, 3, 5, 8, 10)]
TIMES = [22, 25, 32, 35, 37, 45]
SETTINGS = [(1.0, 1.0, 1.0), (0.1, 1.0, 1.0), (1.0, 10.0, 1.0), (1.0, 1.0, 10.0)]  # lambda, Sv, Sw
STYLES = ["-", "--", "-.", ":"]


def orthogonal(rng: np.random.Generator, n: int) -> np.ndarray:
    return np.linalg.qr(rng.normal(size=(n, n)))[0]


class Experiment:
    """One seed: plant, sensors, true states, attack."""

    def __init__(self, seed: int, raw: bool = False) -> None:
        rng = np.random.default_rng(seed)
        self.A = rng.normal(size=(STATES, STATES)) if raw else orthogonal(rng, STATES)
        self.C = rng.normal(size=(N, SENSORS, STATES))
        self.x = [rng.normal(size=STATES)]
        for _ in range(STEPS):
            self.x.append(self.A @ self.x[-1])
        self.x = np.array(self.x)
        self.clean = np.hstack([self.x[1:] @ c.T for c in self.C])
        self.attack = np.zeros_like(self.clean)
        for t in TIMES:
            for i in ATTACKED:
                self.attack[t - 1, i * SENSORS : (i + 1) * SENSORS] = 10 * rng.normal(size=SENSORS)

    def model(self, sv: float = 1.0, sw: float = 1.0) -> gr.Model:
        return gr.Model(
            self.A,
            self.C,
            process_covariance=sw * np.eye(STATES),
            measurement_covariance=[sv * np.eye(SENSORS)] * N,
        )

    def errors(self, filter: Any, size: float = 0.0, sv: float = 1.0, sw: float = 1.0) -> np.ndarray:
        """Relative errors (time, agent) with the attack times `size`."""
        run = gr.replay(
            self.model(sv, sw),
            NETWORK,
            filter,
            measurements=self.clean + size * self.attack,
            truth=self.x,
            keep=["report"],
        )
        assert run.error is not None
        return run.error[0] / np.linalg.norm(self.x, axis=1)[:, None]


def rdkf(weight: float = 1.0, **more: Any) -> Any:
    return gr.filters.Rdkf(weight=weight, **more)


def plot(path: Path, title: str, curves: dict[str, np.ndarray], times: bool = True, xlabel: str = "k") -> None:
    figure = Figure(figsize=(7, 4), layout="constrained")
    ax = figure.add_subplot()
    for t in TIMES if times else []:
        ax.axvline(t, color="#dddddd", linewidth=3, zorder=0)
    for k, (name, curve) in enumerate(curves.items()):
        ax.plot(np.maximum(curve, 1e-16), label=name, linestyle=STYLES[k % len(STYLES)], linewidth=1.5)
    ax.set(xlabel=xlabel, ylabel="relative error, worst agent", title=title, yscale="log")
    ax.grid(True, color="#eeeeee", linewidth=0.6)
    ax.spines[["top", "right"]].set_visible(False)
    ax.legend(frameon=False, fontsize=9)
    figure.savefig(path, dpi=120)


class Page:
    """Rows of the table: claim, what came out, verdict, why."""

    def __init__(self) -> None:
        self.rows: list[list[str]] = []

    def claim(self, text: str, found: str, holds: bool, why: str = "") -> None:
        self.rows.append(claim(text, found, holds, why))


def simulations(page: Page, seeds: int, folder: Path) -> None:
    """Figs. 2 to 5."""
    runs = [Experiment(seed) for seed in range(seeds)]

    def worst(filter: Any, size: float = 0.0, sv: float = 1.0, sw: float = 1.0) -> np.ndarray:
        return np.mean([e.errors(filter, size, sv, sw).max(axis=1) for e in runs], axis=0)

    free = worst(rdkf())
    raw = np.mean([Experiment(seed, raw=True).errors(rdkf()).max(axis=1) for seed in range(seeds)], axis=0)
    plot(
        folder / "fig2.png",
        "Fig. 2: no attack, (1, I, I)",
        {"A orthogonal": free, "A Gaussian, not scaled": raw},
        times=False,
    )
    page.claim(
        "Fig. 2: without attack the errors vanish", f"k = 1 {free[1]:.3g}, k = 10 {free[10]:.2g}", free[10] < 1e-3
    )
    page.claim(
        "Fig. 2 for any random A",
        f"Gaussian A (radius 4.5): k = 50 {raw[50]:.2g}",
        raw[50] < 1e-3,
        "a step moves by at most the deviation bound, an unstable plant by more; theorem III.3 needs a close start",
    )
    hit = worst(rdkf(), 1.0)
    loud = worst(rdkf(), 1e5)
    healthy = [i for i in range(N) if i not in ATTACKED]
    others = np.mean([e.errors(rdkf(), 1.0)[:, healthy].max(axis=1) for e in runs], axis=0)
    plot(
        folder / "fig3.png",
        "Fig. 3: attacked at the marked times, (1, I, I)",
        {"as attacked": hit, "attack 1e5 times larger": loud, "healthy agents": others},
    )
    page.claim(
        "Fig. 3: bounded, whatever the size of the attack",
        f"peak {hit[20:].max():.3g}, attack x 1e5: {loud[20:].max():.3g}",
        loud[20:].max() < 2 * hit[20:].max(),
    )
    page.claim(
        "Fig. 3: healthy agents are hardly touched",
        f"peak {others[20:].max():.3g}, first at k = 23: {others[22]:.1g} then {others[23]:.2g}",
        others[20:].max() < 0.5 * hit[20:].max(),
        "they are hit one step later, through their neighbours",
    )
    by = {s: worst(rdkf(s[0]), 1.0, s[1], s[2]) for s in SETTINGS}
    peak = [curve[20:].max() for curve in by.values()]
    names = [f"({lam:g}, {sv:g} I, {sw:g} I)" for lam, sv, sw in SETTINGS]
    plot(folder / "fig4.png", "Fig. 4: (lambda, Sv, Sw)", dict(zip(names, by.values(), strict=True)))
    settle = [int(np.argmax(curve < 1e-2)) for curve in by.values()]
    page.claim(
        "Fig. 4: a small lambda is safer and slower",
        f"peak {peak[1]:.3g} against {peak[0]:.3g}, settled after {settle[1]} against {settle[0]} steps",
        peak[1] < peak[0] and settle[1] > settle[0],
    )
    page.claim("Fig. 4: a large Sv is safer", f"peak {peak[2]:.3g} against {peak[0]:.3g}", peak[2] < peak[0])
    page.claim("Fig. 4: a large Sw is less safe", f"peak {peak[3]:.3g} against {peak[0]:.3g}", peak[3] > peak[0])
    dkf, dkf_loud = worst(gr.filters.Dkf(), 1.0), worst(gr.filters.Dkf(), 1e5)
    plot(
        folder / "fig5.png",
        "Fig. 5: the same attack on the DKF (7)",
        {"RDKF": hit, "DKF": dkf, "DKF, attack 1e5 times larger": dkf_loud},
    )
    page.claim(
        "Fig. 5: the DKF's error grows with the attack",
        f"peak {dkf[20:].max():.3g}, attack x 1e5: {dkf_loud[20:].max():.3g}",
        dkf_loud[20:].max() > 1e4 * dkf[20:].max(),
    )
    bounds(page, runs)


def bounds(page: Page, runs: list[Experiment]) -> None:
    """(10), half of which is checked at every step, and where the page's own runs start."""
    largest, start = 0.0, 0.0
    for e in runs:
        run = gr.replay(e.model(), NETWORK, rdkf(), measurements=e.clean + 1e5 * e.attack, keep=["report"])
        assert run.statistic is not None and run.threshold is not None
        largest = max(largest, float((run.statistic / run.threshold).max()))
        s = theory.Setting(e.model(), NETWORK)
        steady = s.steady_state()
        level = theory.constants(s, steady, 1.0)["level"]["refined"]
        start = max(start, theory.lyapunov(steady, np.tile(-e.x[0], (N, 1))) / level)
    page.claim(
        "(10): one step moves the estimate by a bounded amount",
        f"distance to the prediction at most {largest:.4f} of half of (10)",
        largest <= 1 + 1e-9,
    )
    page.claim(
        "the simulations start inside theorem III.3",
        f"V_0 is {start:.0f} times the (refined) level",
        start <= 1,
        "they converge all the same, since the plant does not grow",
    )


def scalar(a: float, start: float, steps: int = 400) -> tuple[Any, Any, float]:
    """One agent, one state, Sv = c = lambda = 1, Sw = 1e-4, no attack: its theory, and the error in the end."""
    model = gr.Model([[a]], [[[1.0]]], process_covariance=[[1e-4]], measurement_covariance=[[[1.0]]])
    net = gr.Network([], agents=1)
    run = gr.replay(model, net, rdkf(), measurements=np.zeros((steps, 1)), start=[start], keep=["estimate"])
    s = theory.Setting(model, net)
    assert run.estimate is not None
    return s, s.steady_state(), abs(float(run.estimate[0, -1, 0, 0]))


def convergence(page: Page) -> None:
    """Theorem III.3 as printed, and starts far away."""
    s, steady, end = scalar(1.1, 1.96)
    level = theory.constants(s, steady, 1.0)["level"]
    reach = {k: float(np.sqrt(v * steady.P[0][0, 0])) for k, v in level.items()}
    basin = theory.scalar_basin(s, steady, 1.0)
    page.claim(
        "theorem III.3 with 2 lambda, as printed",
        f"a = 1.1 admits |e_0| <= {reach['printed']:.3f}; from 1.96 the error ends at {end:.1e}",
        end < 1.0,
        f"(15) lacks a factor 2; with lambda {reach['corrected']:.3f}, refined {reach['refined']:.3f}, "
        f"true basin {basin:.3f}",
    )
    page.claim(
        "theorem III.3 as corrected and refined",
        f"from {reach['refined']:.4f}: {scalar(1.1, reach['refined'])[2]:.1e}",
        scalar(1.1, reach["refined"])[2] < 1e-6 and reach["refined"] <= basin,
    )
    far = scalar(1.1, 10 * basin)[2]
    page.claim(
        "bad initial estimates converge in practice",
        f"a = 0.95 from 20: {scalar(0.95, 20.0, 4000)[2]:.1e}; a = 1.1 from {10 * basin:.0f}: {far:.1e}",
        far < 1.0,
        "true for plants that do not grow; an unstable one has a basin",
    )


def persistent(page: Page, seeds: int, folder: Path) -> list[list[str]]:
    """Attacks that never stop, which the paper leaves open: all attackers report the same false trajectory."""
    table: list[list[str]] = []
    curves: dict[str, np.ndarray] = {}
    ends: dict[tuple[float, int], tuple[float, float]] = {}
    for radius in (0.9, 1.0, 1.05):
        for attackers in (4, 6, 10):
            errors = []
            bound = np.inf
            for seed in range(seeds):
                rng = np.random.default_rng(100 + seed)
                turn = orthogonal(rng, 4)
                A = radius * turn
                C = rng.normal(size=(N, 3, 4))
                agents = [int(i) for i in rng.choice(N, attackers, replace=False)]
                offset = 1e3 * rng.normal(size=4)
                model = gr.Model(A, C, process_covariance=np.eye(4), measurement_covariance=[np.eye(3)] * N)
                false = [offset]  # relative to the truth, which is 0; it does not fade where the plant would
                for _ in range(149):
                    false.append(max(radius, 1.0) * turn @ false[-1])
                y = np.zeros((150, 3 * N))
                for i in agents:
                    y[:, 3 * i : 3 * i + 3] = np.array(false) @ C[i].T
                run = gr.replay(model, NETWORK, rdkf(), measurements=y, truth=np.zeros((151, 4)), keep=["report"])
                assert run.error is not None
                errors.append(run.error[0].max(axis=1))
                s = theory.Setting(model, NETWORK)
                bound = min(bound, float(theory.constants(s, s.steady_state(), 1.0)["persistent_bound"].max()))
            middle = np.median(errors, axis=0)
            ends[radius, attackers] = (float(middle[75]), float(middle[150]))
            if radius >= 1:
                curves[f"radius {radius:g}, {attackers} attackers"] = middle
            shown = f"{bound:.3g}" if np.isfinite(bound) else "none"
            table.append([f"{radius:g}", str(attackers), f"{middle[75]:.3g}", f"{middle[150]:.3g}", shown])
    figure_of(curves, folder / "persistent.png")
    page.claim(
        "stable plant: bounded for ever",
        f"radius 0.9, all attacked: {ends[0.9, 10][0]:.3g} then {ends[0.9, 10][1]:.3g}",
        ends[0.9, 10][1] < 100,
    )
    page.claim(
        "the error does not depend on the number of compromised agents",
        f"radius 1, k = 75 and 150: 4 of 10 {ends[1.0, 4][0]:.3g} {ends[1.0, 4][1]:.3g}, "
        f"10 of 10 {ends[1.0, 10][0]:.3g} {ends[1.0, 10][1]:.3g}",
        ends[1.0, 10][1] < 1.5 * ends[1.0, 10][0],
        "true for one step, and for ever if the plant is stable; otherwise a majority drags the estimate away",
    )
    return table


def figure_of(curves: dict[str, np.ndarray], path: Path) -> None:
    figure = Figure(figsize=(7, 4), layout="constrained")
    ax = figure.add_subplot()
    colours = {"4": "#4477aa", "6": "#ccbb44", "10": "#cc3311"}
    for name, curve in curves.items():
        count = name.split(", ")[1].split()[0]
        ax.plot(curve, label=name, color=colours[count], linestyle="-" if "radius 1," in name else "--")
    ax.set(xlabel="k", ylabel="error, worst agent, median of the seeds", yscale="log")
    ax.set_title("A false trajectory that never stops")
    ax.grid(True, color="#eeeeee", linewidth=0.6)
    ax.spines[["top", "right"]].set_visible(False)
    ax.legend(frameon=False, fontsize=9, ncols=2)
    figure.savefig(path, dpi=120)


def main() -> list[list[str]]:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", "--output", default="out/papers/rdkf", help="folder for the figures")
    parser.add_argument("--seeds", type=int, default=3)
    args = parser.parse_args()
    folder = Path(args.output)
    folder.mkdir(parents=True, exist_ok=True)
    page = Page()
    simulations(page, args.seeds, folder)
    convergence(page)
    lasting = persistent(page, args.seeds, folder)
    print_claims("Dutta, Zhang, Jin, 2019", page.rows)
    print_table(
        "A coordinated false trajectory for ever, n = 4, 3 sensors per agent",
        ("radius of A", "attackers of 10", "error at k = 75", "at k = 150", "bound for every attack"),
        lasting,
        justify="right",
    )
    print(f"figures in {folder}")
    return page.rows


if __name__ == "__main__":
    main()
