"""The simulation section of Doostmohammadian et al. (IEEE TNSE 2021), claim by claim.

    python examples/papers/structural.py -o out/papers/structural [--runs 100]

Section V leaves open the weights of A and W, the links of Fig. 4, Table III and the gains. Two systems stand in for it
(structural_systems.json), both on a digraph with the paper's contractions and parent component, rho(A) = 1.05, agents
beta, alpha1, gamma, alpha2 in a cycle: the "hub" system, where the alpha agents send their measurements to all, and
the "plain" one with other weights. Gains: least tr Q under (18). Noise 0.01 I. States are numbered from 0 here.
"""

import argparse
import json
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")

import garrison as gr
import numpy as np
from claims import claim, print_claims, print_table
from garrison import structural as theory
from garrison import structure
from matplotlib.figure import Figure

AGENTS = ["beta", "alpha1", "gamma", "alpha2"]
MEASURED = [0, 5, 6, 9]
STYLES = ["-", "--", "-.", ":"]
COLOURS = ["#0072B2", "#D55E00", "#009E73", "#444444"]
M = 2.0  # threshold level of the paper: kappa = 95.4 %


class System:
    """One of the two systems with its filter."""

    def __init__(self, name: str, data: dict[str, Any], measured: list[int], K: Any) -> None:
        self.name = name
        self.A, self.W, self.U = (np.array(data[k]) for k in ("A", "W", "U"))
        self.C = np.eye(10)[measured]
        self.K = [np.array(k) for k in K]
        self.E, self.R = 0.01 * np.eye(10), 0.01 * np.eye(4)
        self.setting = theory.Setting(A=self.A, C=self.C, W=self.W, U=self.U, E=self.E, R=self.R)
        self.exact = theory.stationary(self.setting, self.K, lags=9)
        links = [(int(j), int(i)) for i, j in np.argwhere((self.W != 0) | (self.U != 0)) if i != j]
        self.net = gr.Network(links, agents=4, directed=True)
        self.model = gr.Model(
            self.A, self.C, process_covariance=self.E, measurement_covariance=[np.array([[0.01]])] * 4
        )
        self.filter = gr.filters.Structural(
            weights=self.W.ravel(),
            sharing=self.U.ravel(),
            gain=np.ravel(self.K),
            false_alarm=1.0 - theory.kappa(M),
            settle=0,
        )

    def plant(self, steps: int, trials: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
        """Truth (trial, steps + 1, n) and honest measurements (trial, steps, N); x(0) = 0."""
        rng = np.random.default_rng(seed)
        x = np.zeros((trials, steps + 1, 10))
        for k in range(steps):
            x[:, k + 1] = x[:, k] @ self.A.T + 0.1 * rng.normal(size=(trials, 10))
        y = x[:, 1:] @ self.C.T + 0.1 * rng.normal(size=(trials, steps, 4))
        return x, y

    def run(self, y: np.ndarray, truth: np.ndarray | None = None, start: np.ndarray | None = None) -> gr.Run:
        keep = ("estimate", "signals", "report")
        return gr.replay(self.model, self.net, self.filter, measurements=y, truth=truth, start=start, keep=keep)

    def residuals(self, y: np.ndarray) -> np.ndarray:
        """(trial, steps, N)"""
        return self.run(y).signals["residual"][:, 1:]


def systems() -> tuple[System, System, System]:
    data = json.loads(Path(__file__).with_name("structural_systems.json").read_text())
    hub = System("hub", data["hub"], MEASURED, data["hub"]["K"])
    plain = System("plain", data["plain"], MEASURED, data["plain"]["K"])
    return hub, plain, System("mitigated", data["hub"], [2, 5, 6, 7], data["hub"]["mitigated_K"])


def attacks(steps: int, trials: int, seed: int) -> np.ndarray:
    """A bias of 1 on beta from k = 30, and the growing attack on alpha2 from k = 20."""
    rng = np.random.default_rng(seed)
    tau = np.zeros((trials, steps, 4))
    tau[:, 30:, 0] = 1.0
    tau[:, 20:22, 3] = 0.3
    for k in range(22, steps):
        tau[:, k, 3] = 2 * tau[:, k - 1, 3] - tau[:, k - 2, 3] + rng.uniform(0, 0.02, trials)
    return tau


def _axes(figure: Figure, *place: int) -> Any:
    ax = figure.add_subplot(*place)
    ax.grid(True, color="#dddddd", linewidth=0.6)
    ax.spines[["top", "right"]].set_visible(False)
    return ax


def residual_figure(path: Path, both: list[tuple[System, np.ndarray]]) -> None:
    """Fig. 4: |residuals| of one run with the exact thresholds."""
    figure = Figure(figsize=(11, 4.4), layout="constrained")
    for place, (s, r) in enumerate(both, start=1):
        ax = _axes(figure, 1, 2, place)
        for i, name in enumerate(AGENTS):
            size = np.maximum(np.abs(r[:, i]) / s.exact["residual_std"][i], 1e-2)
            ax.plot(size, STYLES[i], color=COLOURS[i], linewidth=1.4, label=name)
        for m, word in ((2.0, "95.4 %"), (4.0, "99.99 %")):
            ax.axhline(m, color="#999999", linewidth=0.9)
            ax.annotate(word, (0.5, m * 1.06), fontsize=8, color="#555555")
        ax.set(
            yscale="log", ylim=(0.05, 200), xlabel="k", ylabel="|r| / its standard deviation", title=f"{s.name} system"
        )
        ax.legend(frameon=False, fontsize=9, loc="upper left", ncols=2)
    figure.suptitle("Fig. 4: attack on alpha2 from k = 20, on beta from k = 30")
    figure.savefig(path, dpi=120)


def rates(found: np.ndarray) -> str:
    return " ".join(f"{v:.3f}" for v in found)


def alarm_rates(s: System, r: np.ndarray, threshold: np.ndarray, since: int) -> np.ndarray:
    """Share of samples from `since` on with |r| >= threshold, per agent."""
    return (np.abs(r[:, since:]) >= threshold).mean(axis=(0, 1))


class Page:
    """The claims, one after the other."""

    def __init__(self, folder: Path, runs: int) -> None:
        self.folder, self.runs = folder, runs
        self.hub, self.plain, self.mitigated = systems()
        self.rows: list[list[str]] = []
        self.table: list[list[str]] = []

    def claim(self, text: str, found: str, holds: bool, why: str = "") -> None:
        self.rows.append(claim(text, found, holds, why))

    def structure(self) -> None:
        system = structure.System(structure.Pattern.of(self.hub.A))
        contractions = system.contraction_of_measured(MEASURED)
        parents = system.parent_components
        self.claim(
            "parent component {1, 2, 3}, contractions {5, 6, 8}, {8, 10} (from 1)",
            f"{[[s + 1 for s in p] for p in parents]}, {[[s + 1 for s in c] for c in contractions.values()]}",
            parents == [[0, 1, 2]] and contractions == {5: [4, 5, 7], 9: [7, 9]},
            "with the measured states matched last; as a family they depend on the matching",
        )
        types, necessary = system.classes(MEASURED), system.necessary(MEASURED)
        self.claim(
            "alpha and beta agents are necessary, gamma is redundant",
            f"{types}, {necessary}",
            necessary == [True, True, False, True],
        )
        alone = self.plain
        rank = [0, 2]  # without the alpha agents
        two = theory.Setting(
            A=alone.A, C=alone.C[rank], W=np.full((2, 2), 0.5), U=np.eye(2), E=alone.E, R=alone.R[:2, :2]
        )
        rho = theory.design_gains(two)["rho"]
        self.claim(
            "without an alpha agent the error is unstable (Remark 8)",
            f"plain system without both of them: rho = {rho:.3f}",
            rho >= 1,
            "what they restore are modes with eigenvalue 0, which are stable anyway",
        )
        weights = np.array([[0.5, 0, 0.5], [0.5, 0.5, 0], [0, 0.5, 0.5]])
        radius = theory.best_scalar_gain(3.0, weights)[1]
        self.claim(
            "the connectivity of Lemma 2 gives a Schur gain",
            f"a = 3, one observing agent, 3-cycle, self-weights 0.5: best spectral radius {radius:.3g}",
            radius < 1,
            "block-diagonal K is static output feedback; self-weights of 0.1 give 0.3",
        )

    def bounds(self) -> None:
        hub, plain = (theory.covariance_bound(s.setting, s.K, printed=True) for s in (self.hub, self.plain))
        self.claim(
            "(16) bounds the errors: Q1 = 0.068, b = 0.682",
            f"hub: Q1 = {hub['Q1']:.4f}, b = {hub['b']:.3f}; plain: b = {plain['b']:.3f}, no bound",
            np.isfinite(plain["Q1"]),
            "(10) needs |Ahat| < 1, which no gain of the plain system reaches, not rho < 1",
        )
        bound = theory.covariance_bound(self.hub.setting, self.hub.K, printed=True)["Q1"]
        variance = max(self.hub.exact["Q_agent_traces"]) / 10
        self.claim(
            "Q1 = |Q|/N bounds every agent's error",
            f"hub: Q1 {bound:.4f}; |Q|/N {self.hub.exact['Q_norm'] / 4:.4f}; largest mean variance {variance:.4f}",
            self.hub.exact["Q_norm"] / 4 >= max(np.linalg.norm(self.block(i), 2) for i in range(4)),
            "dividing by N holds only when all agents' errors are the same vector",
        )

    def block(self, i: int) -> np.ndarray:
        return np.asarray(self.hub.exact["Q"])[10 * i : 10 * i + 10, 10 * i : 10 * i + 10]

    def false_alarms(self) -> None:
        """Exact thresholds for m = 1..4 on both systems, printed ones on the hub system."""
        exact_ok = True
        printed = np.zeros(4)
        for s in (self.hub, self.plain):
            r = s.residuals(s.plant(120, 10 * self.runs, 1)[1])[:, 40:]
            samples = r.shape[0] * r.shape[1]
            for m in (1.0, 2.0, 3.0, 4.0):
                asked = 1 - theory.kappa(m)
                found = (np.abs(r) >= theory.thresholds(s.exact["residual_std"], m)).mean(axis=(0, 1))
                error = 4 * np.sqrt(asked * (1 - asked) / (samples / 10)) + 3 / samples
                exact_ok &= bool((np.abs(found - asked) < error).all())
                self.table.append([s.name, f"{m:g}", f"{asked:.5f}", *(f"{v:.5f}" for v in found), f"{error:.5f}"])
            if s is self.hub:
                Q1 = theory.covariance_bound(s.setting, s.K, printed=True)["Q1"]
                printed = (np.abs(r) >= theory.thresholds_printed(s.setting, Q1, M)).mean(axis=(0, 1))
        self.claim(
            "exact thresholds m s_i have the false-alarm rate 1 - erf(m / sqrt 2)",
            "both systems, m = 1..4, see the second table",
            exact_ok,
        )
        self.claim(
            "(17) at m = 2 has a false-alarm rate of 4.6 %",
            f"hub, real rates: {rates(printed)}",
            bool(printed.max() < 0.06),
            "a variance compared with a deviation: not scale-invariant; ten times less noise makes it 93 %",
        )

    def detection(self) -> None:
        trials = self.runs
        tau = attacks(60, trials, 2)
        shown = []
        found = {}
        for s in (self.hub, self.plain):
            r = s.residuals(s.plant(60, trials, 3)[1] + tau)
            shown.append((s, r[0]))
            found[s.name] = alarm_rates(s, r, theory.thresholds(s.exact["residual_std"], M), 30)
        residual_figure(self.folder / "fig4.png", shown)
        for name, text in (
            ("hub", "4: both attacked agents alarm"),
            ("plain", "4: both attacked agents alarm (plain)"),
        ):
            self.claim(text, f"alarm rates, k >= 30: {rates(found[name])}", bool(found[name][[0, 3]].min() > 0.8))
        ratios = theory.isolation_ratios(self.hub.setting, self.hub.K)[:, [1, 3]].max()
        self.claim("(18) with epsilon = 0.011 for both hubs", f"largest ratio {ratios:.4f}", bool(ratios <= 0.0111))
        self.claim(
            "4: the other agents stay quiet (Lemma 6 isolates attacks)",
            f"hub {rates(found['hub'])}; plain {rates(found['plain'])}",
            bool(max(found["plain"][1:3]) < 0.2),
            "(18) speaks of the first instant; later the attack spreads through W: steady ratios up to "
            + f"{self.steady_ratio(self.plain):.2f} in the plain system",
        )

    def steady_ratio(self, s: System) -> float:
        G = np.abs(s.exact["dc_gain"])
        return float(max(G[i, j] / G[j, j] for j in range(4) for i in range(4) if i != j))

    def comparison(self) -> None:
        """Fig. 5, left: saturated innovations, then 40 consensus rounds."""
        ring = gr.Network.ring(4)
        filter = gr.filters.Saturation(threshold=0.6, rounds=40)
        x, y = self.hub.plant(60, self.runs, 3)
        run = gr.replay(
            gr.Model(self.hub.A, self.hub.C),
            ring,
            filter,
            measurements=y + attacks(60, self.runs, 2),
            truth=x,
            start=np.random.default_rng(8).normal(size=(4, 10)),
            keep=("signals",),
        )
        innovation = np.abs(run.signals["innovation"][:, 1:])
        before = (innovation[:, :20] > 0.6).mean(axis=(0, 1))
        after = (innovation[:, 30:] > 0.6).mean(axis=(0, 1))
        figure = Figure(figsize=(6.4, 4.2), layout="constrained")
        ax = _axes(figure)
        for i, name in enumerate(AGENTS):
            ax.plot(np.maximum(innovation[0, :, i], 1e-3), STYLES[i], color=COLOURS[i], linewidth=1.4, label=name)
        ax.axhline(0.6, color="#999999", linewidth=0.9)
        ax.set(yscale="log", xlabel="k", ylabel="|innovation|", title="Fig. 5: 40 consensus rounds per sample")
        ax.legend(frameon=False, fontsize=9, ncols=2)
        figure.savefig(self.folder / "fig5.png", dpi=120)
        self.claim(
            "5: the double-time-scale observer finds both attacks", f"k >= 30: {rates(after)}", min(after[[0, 3]]) > 0.8
        )
        self.claim(
            "5: with false alarms at alpha1",
            f"before the attack: {rates(before)}",
            bool(before[1] > 0.05),
            "over all runs; single ones have some, depending on the start and on Table III, which is not printed",
        )

    def mitigation(self) -> None:
        system = structure.System(structure.Pattern.of(self.hub.A))
        new, _ = system.mitigate(MEASURED, [0, 3], choice="exact")
        seen = system.observability(new)
        self.claim(
            "attacked beta and alpha2 have equivalent substitutes (states 3 and 8 from 1)",
            f"substitutes {[s + 1 for s in new]}; {{3, 6, 7, 8}} observable too",
            seen["observable"] and system.observability([2, 5, 6, 7])["observable"],
        )
        s = self.mitigated
        x, y = s.plant(100, self.runs, 4)
        start = np.random.default_rng(5).normal(size=(4, 10))
        run = s.run(y, x, start)
        assert run.error is not None and run.estimate is not None
        mse = (run.error**2).mean(axis=0) / 10
        mean = (x[:, :, None] - run.estimate)[:, :, 0].mean(axis=0)
        figure = Figure(figsize=(11, 4.2), layout="constrained")
        ax = _axes(figure, 1, 2, 1)
        for i, name in enumerate(("beta'", "alpha1", "gamma", "alpha2'")):
            ax.plot(mse[:, i], STYLES[i], color=COLOURS[i], linewidth=1.4, label=name)
        ax.set(yscale="log", xlabel="k", ylabel="mean square error per state", title="Fig. 6: mean square errors")
        ax.legend(frameon=False, fontsize=9)
        ax = _axes(figure, 1, 2, 2)
        ax.plot(mean, color="#0072B2", linewidth=0.8)
        ax.set(xlabel="k", ylabel="mean error at beta'", title="Fig. 6: unbiased")
        figure.savefig(self.folder / "fig6.png", dpi=120)
        limit = s.exact["Q_agent_traces"] / 10
        self.claim(
            "6: mean square errors are bounded after mitigation",
            f"k = 100: {rates(mse[-1])}, exact limits {rates(limit)}",
            bool(np.allclose(mse[50:].mean(axis=0), limit, rtol=0.1)),
        )
        spread = np.sqrt(np.diag(np.asarray(s.exact["Q"]))[:10] / self.runs)
        self.claim(
            "6: errors are unbiased",
            f"largest mean error from k = 50 on, in its standard deviations: {np.abs(mean[50:] / spread).max():.2f}",
            bool(np.abs(mean[50:] / spread).max() < 4.5),
        )

    def windows(self) -> None:
        s, w = self.plain, 10
        r = s.residuals(s.plant(140, 3 * self.runs, 6)[1])[:, 40:]
        level = theory.chi_square_level(w, 0.01)
        naive = [theory.windows_naive(one, s.exact["residual_std"], w)[w - 1 :] > level for one in r]
        exact = [theory.windows_exact(one, s.exact["covariances"])[w - 1 :] > level for one in r]
        a, b = (np.mean(v, axis=(0, 1)) for v in (naive, exact))
        self.claim(
            "Remark 7: chi-square over T = 10 residuals at 1 %",
            f"plain, sum of squares: {rates(a)}; exact covariance: {rates(b)}",
            bool(a.max() < 0.02),
            "residuals are correlated in time; with their exact (Toeplitz) covariance the rate is met",
        )

    def stealth(self) -> None:
        s = self.plain
        values, vectors = np.linalg.eig(s.A)
        k = int(np.argmax(np.abs(values)))
        v = np.real(vectors[:, k])
        v = v / np.linalg.norm(v) * 0.05
        tau = np.zeros((1, 200, 4))
        drift = np.array([np.linalg.matrix_power(s.A, t + 1) @ v for t in range(200)])
        tau[0, :, 0] = drift @ s.C[0]
        x, y = s.plant(200, 1, 7)
        honest, hit = s.run(y, x), s.run(y + tau, x)
        change = np.abs(hit.signals["residual"] - honest.signals["residual"])[0, 1:] / s.exact["residual_std"]
        assert hit.estimate is not None and honest.estimate is not None
        moved = np.linalg.norm(hit.estimate - honest.estimate, axis=3)[0, 1:]
        figure = Figure(figsize=(11, 4.2), layout="constrained")
        ax = _axes(figure, 1, 2, 1)
        for i, name in enumerate(AGENTS):
            ax.plot(np.maximum(moved[:, i], 1e-6), STYLES[i], color=COLOURS[i], linewidth=1.4, label=name)
        ax.set(yscale="log", xlabel="k", ylabel="|change of the estimate|", title="the estimates are carried away")
        ax.legend(frameon=False, fontsize=9)
        ax = _axes(figure, 1, 2, 2)
        for i, name in enumerate(AGENTS):
            ax.plot(change[:, i], STYLES[i], color=COLOURS[i], linewidth=1.4, label=name)
        ax.set(xlabel="k", ylabel="|change of the residual| / std", title="the residuals hardly move", ylim=(0, 1))
        figure.suptitle("attack along the unstable mode that beta alone sees")
        figure.savefig(self.folder / "stealth.png", dpi=120)
        who = structure.undetectable_agents(s.model)
        self.claim(
            "every attack that harms is detected",
            f"estimates moved by {moved[-1].max():.3g}, residuals by {change.max():.2f} std; "
            f"agents that could do so: {[AGENTS[i] for i in who]}",
            bool(change.max() > 2),
            "an unstable parent component that one agent alone sees: no detector of any kind can tell; "
            "two sensors per such component are needed",
        )

    def drawing(self) -> None:
        from garrison.anatomy import Anatomy
        from garrison.figures import anatomy_figure

        states = [[m] for m in MEASURED]
        anatomy = Anatomy("Section V: system and network", self.hub.A, states, AGENTS, self.hub.net)
        anatomy_figure(anatomy).savefig(self.folder / "structure.png", dpi=120)


def main() -> list[list[str]]:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", "--output", default="out/papers/structural", help="folder for the figures")
    parser.add_argument("--runs", type=int, default=100)
    args = parser.parse_args()
    folder = Path(args.output)
    folder.mkdir(parents=True, exist_ok=True)
    page = Page(folder, args.runs)
    for part in (
        page.structure,
        page.bounds,
        page.false_alarms,
        page.detection,
        page.comparison,
        page.mitigation,
        page.windows,
        page.stealth,
        page.drawing,
    ):
        part()
    print_claims("Agents in the order beta, alpha1, gamma, alpha2", page.rows)
    print_table(
        "False-alarm rates of the exact thresholds",
        ("system", "m", "asked", *AGENTS, "Monte Carlo error"),
        page.table,
    )
    print(f"figures in {folder}")
    return page.rows


if __name__ == "__main__":
    main()
