"""He, Hashemi, Johansson (Automatica 2021), claim by claim: section 7 with Figs. 4-6, and what does not hold.

    python examples/papers/platoon.py -o out/papers/platoon

N = 5, L = 2, T = .01, mu = eps = .1, q = 300, gains 50, beta(1) = 200; varpi = 2 and b = number of attacked sensors,
which the paper does not say. Its noise is one-sided: every component uniform in (0, .1/sqrt 2). Where a claim needs
noise without a mean, both are shown.
"""

import argparse
import json
from pathlib import Path
from typing import Any

import garrison as gr
import numpy as np
from claims import Rows, claim, print_claims, print_table
from garrison.verify import platoon as cases
from matplotlib.figure import Figure

T, SPACING, GAIN, STEPS = 0.01, 20.0, 50.0, 500
X0 = np.array([[200, 10], [100, 8], [50, 6], [20, 4], [0, 2]], dtype=float)
STYLES = ["-", "--", "-.", ":", (0, (5, 1)), (0, (3, 1, 1, 1))]
ROOT = Path(__file__).resolve().parents[2]
STRONG = {
    "as published": {},
    "S6: (28) for all in range": {"neighbours": True},
    "S5: exact count of pairs": {"count": "cover"},
    "S4: all pairs in range": {"pairs": True},
    "S3: median": {"median": True},
    "all of them": {"pairs": True, "count": "cover", "neighbours": True, "median": True, "bound": "tight"},
}


class Experiment:
    """A string of vehicles under the noises and random factors of many seeds."""

    def __init__(self, runs: int, vehicles: int = 5, reach: int = 2, steps: int = STEPS) -> None:
        self.runs, self.N, self.L, self.steps = runs, vehicles, reach, steps
        self.model, self.net = gr.platoon.model(vehicles, T), gr.Network.band(vehicles, reach)
        if vehicles == 5:
            self.x0, self.start = X0, np.zeros((5, 2))
        else:  # too long a string for estimates of 0: they start where the vehicles should be
            self.start = np.column_stack([200.0 - SPACING * np.arange(vehicles), np.full(vehicles, 10.0)])
            self.x0 = self.start + np.random.default_rng(1).uniform(-50, 50, (vehicles, 2))

    def noise(self, seed: int, size: float, symmetric: bool, factor: list[int]) -> np.ndarray:
        """Disturbances of one run; sensors in `factor` show (1 + w) x with a standard normal w."""
        rng = np.random.default_rng(seed)
        rows = rng.uniform(0, size / np.sqrt(2), (self.steps + 1, self.N, gr.platoon.DISTURBANCES))
        if symmetric:
            rows = 2 * rows - size / np.sqrt(2)
        w = rng.standard_normal((self.steps + 1, self.N))
        rows[..., 4] = 0.0
        rows[:, factor, 4] = w[:, factor]
        return rows.reshape(self.steps + 1, -1)

    def run(
        self, filter: Any, attacked: list[int], kind: str = "random", size: float = 0.1, symmetric: bool = False
    ) -> list[gr.Run]:
        """One run per seed under one of the paper's attacks on sensors 0..N-1."""
        attack: Any = {
            "DoS": lambda: gr.attacks.Scale(agents=attacked, factor=0.0, start=0),
            "bias": lambda: gr.attacks.Bias(agents=attacked, value=100.0, start=0),
            "replay": lambda: gr.attacks.Replay(agents=attacked, delay=10, start=12),
        }.get(kind, lambda: ())()
        return [
            gr.simulate(
                self.model,
                self.net,
                filter,
                steps=self.steps,
                x0=self.x0,
                start=self.start,
                noise=self.noise(seed, size, symmetric, attacked if kind == "random" else []),
                attack=attack,
                keep=["estimate", "report", "signals", "details", "measurements"],
            )
            for seed in range(self.runs)
        ]

    def reference(self) -> np.ndarray:
        """x_i^*(t), (time, vehicle, 2)."""
        t = np.arange(self.steps + 1)
        lead = np.stack([200.0 + 10.0 * T * t, np.full(len(t), 10.0)], axis=1)
        return lead[:, None] - SPACING * np.arange(self.N)[None, :, None] * np.array([1.0, 0.0])

    def tracking(self, runs: list[gr.Run]) -> np.ndarray:
        """Mean platooning error of Fig. 6."""
        return np.mean([np.linalg.norm(r.truth[0] - self.reference(), axis=2).mean(axis=1) for r in runs], axis=0)

    def phi(self, runs: list[gr.Run]) -> np.ndarray:
        """(4), mean over the runs."""
        return self.tracking(runs) + np.mean([r.error[0].mean(axis=1) for r in runs], axis=0)


def platoon(b: int, size: float = 0.1, **more: Any) -> Any:
    given: dict[str, Any] = {
        "threshold": 200.0,
        "attacked": b,
        "process_noise": size,
        "measurement_noise": size,
        "initial_error": 300.0,
        "reference": [200.0, 10.0],
        "spacing": SPACING,
        "gs": GAIN,
        "gv": GAIN,
    }
    return gr.filters.make_filter("platoon", given | more)


def baseline(kind: str, b: int) -> Any:
    return gr.filters.PlatoonBaseline(kind=kind, attacked=b, reference=[200.0, 10.0], spacing=SPACING, gs=GAIN, gv=GAIN)


def plot(path: Path, title: str, curves: dict[str, np.ndarray], label: str, log: bool = True) -> None:
    figure = Figure(figsize=(7, 4), layout="constrained")
    ax = figure.add_subplot()
    for k, (name, curve) in enumerate(curves.items()):
        ax.plot(np.maximum(curve, 1e-6) if log else curve, label=name, linestyle=STYLES[k % len(STYLES)], linewidth=1.5)
    ax.set(xlabel="t", ylabel=label, title=title, yscale="log" if log else "linear")
    ax.grid(True, color="#dddddd", linewidth=0.6)
    ax.spines[["top", "right"]].set_visible(False)
    ax.legend(frameon=False, fontsize=9, ncols=2)
    figure.savefig(path, dpi=120)


def figure4(e: Experiment, folder: Path) -> Rows:
    runs = e.run(platoon(1), [2])
    eta = {i: np.max([r.error[0, :, i - 1] for r in runs], axis=0) for i in (1, 3)}
    bound = {i: np.max([r.bound[0, :, i - 1] for r in runs], axis=0) for i in (1, 3)}
    curves = {f"eta_{i}": eta[i] for i in (1, 3)} | {f"bound {i}": bound[i] for i in (1, 3)}
    plot(folder / "fig4a.png", "Fig. 4(a): sensor 3 attacked, b = 1", curves, "error (largest of all runs)")
    ends = {}
    for symmetric in (False, True):
        result = runs if not symmetric else e.run(platoon(1), [2], symmetric=True)
        x = np.mean([r.truth[0] for r in result], axis=0)
        ends[symmetric] = x[-1] - e.reference()[-1, :1]
        if not symmetric:
            lead = e.reference()[:, 0, 0]
            places = {f"vehicle {i + 1}": x[:, i, 0] - lead for i in range(5)}
            plot(folder / "fig4b.png", "Fig. 4(b): positions relative to the reference", places, "m", log=False)
    runs[0].plot().savefig(folder / "string.png", dpi=110)
    runs[0].animate(folder / "string.gif")
    gaps = -np.diff(ends[False][:, 0])
    return [
        claim(
            "4a: errors stay below their bounds",
            f"{len(runs)} runs",
            all(bool((r.error <= r.bound).all()) for r in runs),
            "with the bound that holds; the printed (17) happens to hold here too",
        ),
        claim("4a: small after 20 steps", f"eta_1 {eta[1][20]:.3g}, eta_3 {eta[3][20]:.3g}", eta[1][20] < 0.3),
        claim(
            "4a: vehicle 1 ends better than the attacked vehicle 3",
            f"mean of the last 50: {eta[1][-50:].mean():.3g} against {eta[3][-50:].mean():.3g}",
            eta[1][-50:].mean() < eta[3][-50:].mean(),
        ),
        claim("4b: gaps tend to 20", " ".join(f"{g:.4g}" for g in gaps), bool(np.abs(gaps - 20).max() < 1)),
        claim(
            "4b: velocities reach v_0 (noise as printed)",
            " ".join(f"{v:.3g}" for v in ends[False][:, 1]),
            bool(np.abs(ends[False][:, 1]).max() < 1),
            "one-sided process noise of mean .035 per step acts as an offset of 3.5 m/s",
        ),
        claim(
            "4b: velocities reach v_0 (symmetric noise)",
            " ".join(f"{v:.3g}" for v in ends[True][:, 1]),
            bool(np.abs(ends[True][:, 1]).max() < 1),
        ),
    ]


def figure5(e: Experiment, folder: Path) -> Rows:
    sizes = (0.01, 0.05, 0.1, 0.2)
    by_size = {s: e.phi(e.run(platoon(2, s), [1, 2], size=s)) for s in sizes}
    plot(folder / "fig5a.png", "Fig. 5(a): noise", {f"{s}": c for s, c in by_size.items()}, "phi(t)")
    kinds = ("random", "DoS", "bias", "replay")
    runs = {kind: e.run(platoon(2), [1, 2], kind) for kind in kinds}
    by_kind = {kind: e.phi(r) for kind, r in runs.items()}
    plot(folder / "fig5b.png", "Fig. 5(b): attacks on sensors 2 and 3", by_kind, "phi(t)")
    last = [by_size[s][-1] for s in sizes]
    final = [by_kind[k][-1] for k in kinds]
    early = [by_size[s][150] for s in sizes]
    clean = all(
        all(set(d[4]) <= {1, 2} for d in r.details if d[3] == "attacked")
        and not any({1, 2} & set(d[4]) for d in r.details if d[3] == "free")
        for rs in runs.values()
        for r in rs
    )
    return [
        claim(
            "5a: phi falls with the noise, at the end",
            " ".join(f"{v:.3g}" for v in last),
            bool(np.all(np.diff(last) > 0)),
        ),
        claim(
            "5a: phi falls with the noise, at every time",
            "t = 150: " + " ".join(f"{v:.4g}" for v in early),
            bool(np.all(np.diff(early) > 0)),
            "the drift of one-sided noise happens to shorten the transient",
        ),
        claim("5b: all four attacks are handled", "phi(500) " + " ".join(f"{v:.3g}" for v in final), max(final) < 6),
        claim("Lemma 1: nobody falsely accused or cleared", f"{4 * e.runs} runs", clean, "with the corrected (28)"),
    ]


def figure6(e: Experiment, folder: Path) -> Rows:
    filters = {
        "Algorithms 1+3": platoon(1, threshold=3.0, adaptive=False, detector=False),
        "Algorithms 1-3": platoon(1),
        "PWM": baseline("pwm", 1),
        "PBE": baseline("pbe", 1),
        "PTD": baseline("ptd", 1),
    }
    curves = {name: e.tracking(e.run(f, [2])) for name, f in filters.items()}
    plot(folder / "fig6.png", "Fig. 6: platooning error, sensor 3 attacked", curves, "phi(t) of Fig. 6")
    end = {name: c[-50:].mean() for name, c in curves.items()}
    ours = end["Algorithms 1-3"]
    return [
        claim(
            "6: Algorithms 1-3 beat PWM and PTD",
            " ".join(f"{k} {v:.3g}" for k, v in end.items()),
            ours < end["PWM"] / 10,
        ),
        claim(
            "6: PWM never settles",
            f"last 50 between {curves['PWM'][-50:].min():.3g} and {curves['PWM'][-50:].max():.3g}",
            curves["PWM"][-50:].min() > 50,
        ),
        claim(
            "6: Algorithms 1-3 beat PBE",
            f"{ours:.4g} against {end['PBE']:.4g}",
            ours < 0.98 * end["PBE"],
            "the paper does not define PBE; with our definition the two are equal within 2 %",
        ),
        claim(
            "6: Algorithms 1-3 are best at all times",
            f"t = 100: {curves['Algorithms 1-3'][100]:.4g} against {curves['Algorithms 1+3'][100]:.4g} of 1+3",
            all(curves["Algorithms 1-3"][100] <= c[100] for c in curves.values()),
            "the static threshold leads during the transient",
        ),
    ]


def delays(e: Experiment, kinds: tuple[str, ...]) -> dict[str, list[str]]:
    """First time at which some vehicle, and all, know S^a = {2, 3}; median over the runs."""
    table: dict[str, list[str]] = {}
    for name, more in STRONG.items():
        cells = []
        for kind in kinds:
            first, every = [], []
            for r in e.run(platoon(2, **more), [1, 2], kind):
                knows = {}
                for _, t, vehicle, which, ids in r.details:
                    if which == "attacked" and ids == [1, 2]:
                        knows.setdefault(vehicle, t)
                first.append(min(knows.values(), default=np.inf))
                every.append(max(knows.values()) if len(knows) == 5 else np.inf)
            cells.append(f"{np.median(first):g} / {np.median(every):g}")
        table[name] = cells
    return table


def theory() -> Rows:
    rows = []
    found = gr.check(gr.platoon.model(5, T), gr.Network.band(5, 2), platoon(1))
    rows.append(
        claim(
            "Theorem 2: asymptotic bounds, b = 1",
            f"safe limit {found['limit of rho']:.4g}, tau {found['limit of tau']:.4g}",
            abs(found["limit of rho"] - 0.8092) < 1e-3,
        )
    )
    setting = dict(vehicles=5, range=2, period=T, eps=0.1, mu=0.1, q=300.0)
    for b, beta in ((1, 3.0), (2, 3.0)):
        lo, hi = gr.platoon.beta_interval(gr.platoon.Setting(attacked=b, beta=beta, **setting))
        rows.append(
            claim(
                f"section 7: beta = 3 is admissible for b = {b}",
                f"Theorem 1 needs beta in ({lo:.4g}, {hi:.4g})",
                lo < beta < hi,
                "" if lo < beta < hi else "no omega exists; the paper does not say which b it uses",
            )
        )
    static = gr.platoon.Setting(attacked=1, beta=3.0, adaptive=False, **setting)
    printed = gr.platoon.theorem1(static, distance=2)["alpha1"]
    rows.append(
        claim(
            "Theorem 1: alpha1 tells where the error goes, static beta = 3",
            f"alpha1 {printed:.4g}, limit of the recursion {gr.platoon.safe_limit(static):.4g}",
            bool(printed < 10),
            "alpha1 freezes the least gain at t = 0",
        )
    )
    four = gr.platoon.theorem4(5, T, GAIN, GAIN, 0.1, 1.355)
    rows.append(
        claim(
            "Theorem 4: a useful bound on phi, N = 5",
            f"printed {four['bound']:.3g}, corrected {four['bound_safe']:.3g}, "
            f"sharper {four['bound_sharp']:.3g}; true .5",
            four["bound"] < 5,
            "xi is far too conservative; summed powers help, not enough",
        )
    )
    for name, text in (
        ("process_noise_counterexample", "Proposition 1: the printed (17) is a bound"),
        ("lemma1_counterexample", "Lemma 1: no false accusation with the printed (17)"),
    ):
        case = json.loads((ROOT / f"tests/cases/platoon/he_platoon_{name}.json").read_text())
        other = cases.evaluate(case["inputs"], {"other_bound_on_same_data": {"bound": "printed"}})[
            "other_bound_on_same_data"
        ]
        ours = cases.evaluate(case["inputs"], {"bound_holds_everywhere": True})
        ok = other["bound_holds_everywhere"] if name.startswith("process") else not other["false_attacked"]
        why = f"case {name}: printed bound holds {other['bound_holds_everywhere']}, accuses a clean sensor "
        why += f"{other['false_attacked']}; the valid bound: {ours['bound_holds_everywhere']}, {ours['false_attacked']}"
        rows.append(claim(text, f"N = {case['inputs']['params']['N']}", ok, why))
    return rows


def twenty(runs: int, folder: Path) -> Rows:
    """The same architecture with N = 20, L = 3, b = 3."""
    e = Experiment(runs, 20, 3, 900)
    results = e.run(platoon(3), [4, 5, 11], symmetric=True)
    phi = e.phi(results)
    plot(folder / "n20.png", "N = 20, L = 3, sensors 5, 6, 12 attacked", {"phi": phi}, "phi(t)")
    results[0].plot().savefig(folder / "string20.png", dpi=110)
    held = all(bool((r.error <= r.bound)[np.isfinite(r.bound)].all()) for r in results)
    return [
        claim(
            "N = 20: errors stay below their bounds",
            f"{runs} runs, final error {results[0].error[0, -1].mean():.3g}",
            held,
        ),
        claim(
            "N = 20: the formation converges",
            f"phi {phi[0]:.3g} -> {phi[500]:.3g} at 500, {phi[-1]:.3g} at 900",
            phi[-1] < 0.25 * phi[0],
        ),
    ]


def main() -> Rows:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", "--output", default="out/papers/platoon", help="folder for the figures")
    parser.add_argument("--runs", type=int, default=20)
    args = parser.parse_args()
    folder = Path(args.output)
    folder.mkdir(parents=True, exist_ok=True)
    e = Experiment(args.runs)
    rows = (
        figure4(e, folder)
        + figure5(e, folder)
        + figure6(e, folder)
        + theory()
        + twenty(max(1, args.runs // 10), folder)
    )
    print_claims(f"{args.runs} runs", rows)
    kinds = ("random", "DoS", "bias", "replay")
    print_table(
        "steps until S^a = {2, 3} is known: first vehicle / all five (replay starts at 12)",
        ("detector", *kinds),
        [[name, *cells] for name, cells in delays(Experiment(args.runs, steps=60), kinds).items()],
    )
    print(f"figures in {folder}")
    return rows


if __name__ == "__main__":
    main()
