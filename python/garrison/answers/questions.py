"""The questions of gr.analyze, one after the other, each within its share of the time."""

from __future__ import annotations

from math import comb
from typing import Any

import numpy as np
from numpy.typing import NDArray

from garrison import _core
from garrison._core import certificate, saturation, structure
from garrison.answers.additions import Addition, Candidate, cheapest_for, cheapest_for_removal
from garrison.answers.graph import cuts
from garrison.answers.limits import LATE, Limit, from_removal, network_contraction, of_filter, saturation_facts
from garrison.answers.removals import Removal, smallest_removal
from garrison.answers.sensors import Sensors
from garrison.answers.watch import Watch
from garrison.words import count

Array = NDArray[np.float64]

#: how many times Questions asks for time
QUESTIONS = 10
#: level of the bank's error bound: it fails with about this probability per step
DELTA = 1e-3
#: states up to which the zero pattern's substitutes are worked out
_MOST_PATTERN = 3000
#: pairs of sets of sensors that the bank's steady error goes through, times states cubed
_MOST_BANK = 2e6


def removal_limits(over_time: Removal, one_sample: Removal, names: list[str], can_lie: int) -> list[Limit]:
    """What follows from the fewest sensors that may not be lost together."""
    seen = "any s sensors may be lost and the state stays observable"
    twice = "any 2 s sensors may be lost and the state stays observable"
    fast = "any s sensors may be lost and one sample determines the state"
    twice_fast = "any 2 s sensors may be lost and one sample determines the state"
    bounded = "witness certificate: a bounded region from one sample"
    return [
        from_removal("no lie stays unseen for ever", seen, over_time, 1, names, can_lie),
        from_removal("the state can be determined in the end", twice, over_time, 2, names, can_lie),
        from_removal("every lie shows in one sample", fast, one_sample, 1, names, can_lie),
        from_removal(bounded, twice_fast, one_sample, 2, names, can_lie),
    ]


class Questions:
    """What is asked of one network; answers become fields of Analysis."""

    def __init__(
        self,
        model: _core.Model,
        network: _core.Network,
        sensors: Sensors,
        offered: list[Candidate],
        watch: Watch,
        names: list[str],
    ) -> None:
        self.model, self.network, self.sensors = model, network, sensors
        self.offered, self.watch = offered, watch
        self.names = names or [f"agent {i}" for i in range(model.agents)]
        self.unfinished: list[str] = []
        self.A = np.asarray(model.A)
        self.identity = np.eye(model.states)

    def answers(self, filter: _core.Filter | None) -> dict[str, Any]:
        """Every field of Analysis but its title."""
        over_time = self._removal("fewest sensors without which something is never seen", self.A)
        one_sample = over_time
        if not np.array_equal(self.A, self.identity):
            one_sample = self._removal("fewest sensors without which one sample is not enough", self.identity)
        can_lie = [self.sensors.names[k] for k in self.sensors.can_lie]
        limits = removal_limits(over_time, one_sample, self.sensors.names, len(can_lie))
        gamma, of_saturation = self._saturation(len(can_lie))
        limits.append(of_saturation)
        if filter is not None:
            limits += self._of_filter(filter)
        links = cuts(self.network) if not self.network.directed else None
        result = dict(
            sensors=self.sensors.names,
            limits=limits,
            over_time=over_time,
            one_sample=one_sample,
            critical=self._critical(over_time),
            unbounded=self._unbounded(),
            leverage=self._leverage(one_sample),
            harm=self._harm(),
            substitutes=self._substitutes(),
            critical_links=[(self.names[i], self.names[j]) for i, j in links.links] if links else [],
            critical_agents=[self.names[i] for i in links.agents] if links else [],
            additions=self._additions(over_time, one_sample, of_saturation, gamma),
            advice=self._advice(of_saturation, gamma),
            unfinished=self.unfinished,
            network=self.network,
            agent_names=self.names,
        )
        self.watch.done()
        return result

    def _removal(self, words: str, A: Array) -> Removal:
        found = Removal(0, len(self.sensors.rows) + 1, [])
        with self.watch.question(words, 0.25) as budget:
            found = smallest_removal(A, self.sensors.rows, self.sensors.can_lie, budget)
        if not found.exact:
            self.unfinished.append(words)
        return found

    def _saturation(self, most: int) -> tuple[float, Limit]:
        guarantee = "saturation filter: some threshold and rounds keep its error bounded (theorem 1)"
        needs = "condition (9) for some threshold, initial error and number of rounds"
        words = "the saturation filter's conditions"
        gamma, holds, fails, why = 1.0, 0, None, LATE
        self.rounds: dict[int, int] = {}
        self.settings: dict[int, saturation.Setting] = {}
        with self.watch.question(words, 0.3) as budget:
            gamma = network_contraction(self.sensors.network)
            for s in range(most + 1):
                if budget.over:
                    break
                facts = saturation_facts(self.sensors, self.identity[:0], s, gamma, self.watch.left)
                self.settings[s] = facts.setting
                if not facts.holds:
                    fails, why = s, self._why_not(facts, gamma)
                    break
                holds, self.rounds[s] = s, facts.rounds or 1
            else:
                why = ""
                if facts.norm_A < 1:
                    needs += f"; here ||A|| = {facts.norm_A:.4g} < 1 bounds the error without any measurement"
        if fails is None and why:
            self.unfinished.append(words)
        return gamma, Limit(guarantee, holds, fails, needs, why)

    @staticmethod
    def _why_not(facts: Any, gamma: float) -> str:
        s = facts.attacked
        if gamma >= 1:
            return "the network is not connected, or directed"
        if saturation.condition11(facts.setting):
            least = saturation.normA_max_exact(facts.setting)
            needed = f"lambda_0 = {facts.lambda0:.4g} allows ||A|| < {least:.6g} for s = {s}"
            return f"{needed}, and ||A|| = {facts.norm_A:.6g}"
        return f"lambda_0 = {facts.lambda0:.4g} for s = {s}, and it must be above s (condition 11)"

    def _of_filter(self, filter: _core.Filter) -> list[Limit]:
        words = f"the filter {filter.name}"
        found: list[Limit] = []
        with self.watch.question(words, 0.3) as budget:
            limit = of_filter(self.model, self.network, filter, budget)
            found = [limit] if limit else []
        return found

    def _critical(self, over_time: Removal) -> list[str]:
        if over_time.fewest > 1 or over_time.most == 0:
            return []
        words = "sensors whose loss alone leaves something unseen"
        names: list[str] = []
        finished = False
        with self.watch.question(words, 0.4):
            for k in range(len(self.sensors.rows)):
                if not _core.surely_observable(self.A, np.delete(self.sensors.rows, k, axis=0)):
                    names.append(self.sensors.names[k])
            finished = True
        if not finished:
            self.unfinished.append(words)
        return names

    def _unbounded(self) -> list[str]:
        words = "who can drift without limit, unseen"
        found: list[int] | None = None
        with self.watch.question(words, 0.4):
            found = structure.undetectable_agents(self.model)
        if found is None:
            self.unfinished.append(words)
        return [self.names[i] for i in found or []]

    def _leverage(self, one_sample: Removal) -> list[float] | None:
        if one_sample.most == 0 or not len(self.sensors.rows):
            return None
        found: list[float] | None = None
        with self.watch.question("what each sensor holds alone", 0.4):
            try:
                found = [float(v) for v in certificate.meters(self._whitened()).leverage]
            except _core.InvalidInput:  # rows that determine the state by their rounding only
                return None
        if found is None:
            self.unfinished.append("what each sensor holds alone")
        return found

    def _whitened(self) -> Array:
        """Rows divided by the deviations of their noise, where they are known."""
        R = self.sensors.model.measurement_covariance
        rows = self.sensors.rows
        if R is None:
            return rows
        variance = np.array([np.asarray(R[i]).ravel()[0] for i in self.sensors.agent])
        return rows / np.sqrt(variance)[:, None] if np.all(variance > 0) else rows

    def _harm(self) -> list[dict[str, Any]]:
        """Bank of Kalman filters: a certified error for s = 0, 1, .. liars that never change, as long as it exists."""
        Q, R = self.model.process_covariance, self.sensors.model.measurement_covariance
        if Q is None or R is None or isinstance(Q, list) or self.sensors.secured:
            return []
        rows, n = self.sensors.rows, self.model.states
        sources = [(row[None], np.asarray(R[i]).ravel()) for row, i in zip(rows, self.sensors.agent, strict=True)]
        out: list[dict[str, Any]] = []
        words = "certified errors of a bank of filters"
        finished = False
        with self.watch.question(words, 0.4) as budget:
            for s in range(len(rows) // 2 + 1):
                members = comb(len(rows), s)
                pairs = members * comb(len(rows) - s, s)
                if pairs * n**3 > _MOST_BANK or budget.over:
                    break
                z1, _ = certificate.gaussian_levels(DELTA / 2, len(rows), n)
                _, z2 = certificate.gaussian_levels(DELTA / 2 / members, len(rows), n)
                zc = certificate.chi(DELTA / 2 / members / n, 1)
                error = certificate.bank_steady(self.A, Q, sources, s, z1, z2, zc, pairs)
                if not np.all(np.isfinite(error)):
                    finished = True
                    break
                per_state = dict(zip(self.model.state_names, map(float, error[:-1]), strict=True))
                out.append({"liars": s, "error": float(error[-1]), "per_state": per_state, "failure": DELTA})
            else:
                finished = True
        if not finished:
            self.unfinished.append(f"{words} for {count(len(out), 'liar')} or more")
        return out

    def _substitutes(self) -> list[list[str]]:
        if self.model.states > _MOST_PATTERN:
            return [[] for _ in self.sensors.rows]
        system = structure.System(structure.Pattern.of(self.A))
        states = [[int(k) for k in np.flatnonzero(row)] for row in self.sensors.rows]
        found, names = system.substitutes(states) if states else [], list(self.model.state_names)
        return [[names[k] for k in some] for some in found]

    def _additions(self, over_time: Removal, one_sample: Removal, limit: Limit, gamma: float) -> list[Addition]:
        out = []
        rows, may_go = self.sensors.rows, self.sensors.can_lie
        for words, A, removal, per_liar in (
            ("the state can be determined in the end with {}", self.A, over_time, 2),
            ("one sample bounds the state with {}", self.identity, one_sample, 2),
        ):
            liars = max(removal.spare, 0) // per_liar + (1 if removal.most else 0)
            goal = words.format(count(liars, "liar"))
            addition = Addition(goal, None, float("nan"), False)
            with self.watch.question(f"what to add: {goal}", 0.5) as budget:
                spare = per_liar * liars
                addition = cheapest_for_removal(goal, A, rows, may_go, spare, self.offered, budget)
            out.append(addition)
        if limit.fails is not None and gamma < 1:
            goal = f"the saturation filter stands {count(limit.fails, 'liar')}"
            addition = Addition(goal, None, float("nan"), False)
            with self.watch.question(f"what to add: {goal}", 0.8) as budget:

                def reached(added: Array) -> bool:
                    # A link to a new agent may slow the rounds; what is asked is whether any number of them suffices.
                    return saturation_facts(self.sensors, added, limit.fails or 0, gamma, self.watch.left).holds

                addition = cheapest_for(goal, self.offered, reached, budget)
            out.append(addition)
        return out

    def _advice(self, limit: Limit, gamma: float) -> list[str]:
        if gamma >= 1 and not self.network.directed:
            return ["Connect the network: its parts cannot help each other."]
        if limit.holds not in self.rounds:
            return []
        rounds = self.rounds[limit.holds]
        words = f"For {count(limit.holds, 'liar')} the saturation filter needs {count(rounds, 'round')} per sample"
        if rounds == 1:
            return [f"{words}; more links would not lower that."]
        best = self._best_link(limit.holds)
        if best is None and "the link that helps most" in self.unfinished:
            return [f"{words}."]
        if best is None:
            return [f"{words}; no single link more would lower that."]
        (i, j), fewer = best
        return [f"{words}; a link between {self.names[i]} and {self.names[j]} brings that down to {fewer}."]

    def _best_link(self, attacked: int) -> tuple[tuple[int, int], int] | None:
        """The link that lowers the rounds most, of those that can be tried in the time that is left."""
        there = {tuple(sorted(e)) for e in self.network.edges}
        N = self.network.agents
        rounds = self.rounds[attacked]
        best: tuple[tuple[int, int], int] | None = None
        base = self.settings[attacked]
        words, finished = "the link that helps most", False
        with self.watch.question(words, 0.9) as budget:
            pairs = ((i, j) for i in range(N) for j in range(i + 1, N) if (i, j) not in there)
            for i, j in pairs:
                if budget.over:
                    break
                more = _core.Network([*self.network.edges, (i, j)], agents=N)
                _, net, _ = _core.split_outputs(self.model, more)
                gamma = network_contraction(net)
                fewer = saturation.minimal_rounds(base, gamma)
                if fewer is not None and fewer < (best[1] if best else rounds):
                    best = (i, j), fewer
            else:
                finished = True
        if not finished:
            self.unfinished.append(words)
        return best
