"""The questions of gr.analyze about a large plant that does not move: from its sparse rows, without dense matrices."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from garrison import _core
from garrison._core import certificate, saturation
from garrison.answers.additions import Addition, by_counting
from garrison.answers.graph import cuts
from garrison.answers.limits import LATE, Limit, from_removal, listed, network_contraction
from garrison.answers.questions import removal_limits
from garrison.answers.removals import Removal
from garrison.answers.watch import Watch
from garrison.static_plant import StaticPlant
from garrison.words import count

Array = NDArray[np.float64]

#: how many times StaticQuestions asks for time
STATIC_QUESTIONS = 6
#: parts of the rows that are searched exactly have at most so many; with more there are bounds from leverages
_MOST_SEARCHED = 4000


class StaticQuestions:
    """What is asked of one plant; answers become fields of Analysis. In one sample everything shows that ever will."""

    def __init__(
        self,
        plant: StaticPlant,
        network: _core.Network,
        prices: dict[int, float],
        watch: Watch,
        names: list[str],
    ) -> None:
        self.plant, self.network, self.prices, self.watch = plant, network, prices, watch
        self.names = names
        self.unfinished: list[str] = []
        self.rounds: int | None = None
        order = np.lexsort((plant.entries[:, 1], plant.entries[:, 0]))
        self.entries = plant.entries[order]

    def answers(self) -> dict[str, Any]:
        """Every field of Analysis but its title."""
        found = self._meters("what each sensor holds, and the fewest that can lie unseen", [], 0.5)
        removal = self._removal(found)
        by_agent = self._meters("who can drift without limit, unseen", self.plant.agent, 0.5, search=False)
        gamma, of_saturation = self._saturation(found, removal)
        links = cuts(self.network) if not self.network.directed else None
        sensors, agents = self.plant.outputs, self.names
        result = dict(
            sensors=sensors,
            limits=[*removal_limits(removal, removal, sensors, len(sensors)), of_saturation],
            over_time=removal,
            one_sample=removal,
            critical=[sensors[k] for k in found.critical],
            unbounded=[agents[i] for i in by_agent.critical],
            leverage=[float(v) for v in found.leverage] if found.complete else None,
            harm=[],
            substitutes=[[] for _ in sensors],
            critical_links=[(agents[i], agents[j]) for i, j in links.links] if links else [],
            critical_agents=[agents[i] for i in links.agents] if links else [],
            additions=self._additions(removal),
            advice=self._advice(found, of_saturation, gamma),
            unfinished=self.unfinished,
            network=self.network,
            agent_names=agents,
        )
        self.watch.done()
        return result

    def _meters(
        self, words: str, source: Sequence[int], share: float, *, search: bool = True, more: Sequence[int] = ()
    ) -> Any:
        """What the rows withstand, and with them a sensor of each of the states `more`."""
        entries, (rows, columns) = self.entries, self.plant.size
        if more:
            entries = np.vstack([entries, [(rows + k, state, 1.0) for k, state in enumerate(more)]])
            rows += len(more)
        row, column = (entries[:, k].astype(int).tolist() for k in (0, 1))
        with self.watch.question(words, share):
            found = certificate.sparse_meters(
                (rows, columns), row, column, entries[:, 2], list(source), _MOST_SEARCHED if search else 0
            )
        if not found.complete and not found.unseen:
            self.unfinished.append(words)
        return found

    @staticmethod
    def _removal(found: Any) -> Removal:
        if found.unseen:
            return Removal(0, 0, [])
        return Removal(found.fewest, found.most, list(found.example))

    def _saturation(self, found: Any, removal: Removal) -> tuple[float, Limit]:
        """Theorem 1 with ||A|| = 1 asks for lambda_0 > s. Along a change of the state that only k sensors show, with
        rows of length 1, lambda_0 <= k - s: it fails where k <= 2 s."""
        guarantee = "saturation filter: some threshold and rounds keep its error bounded (theorem 1)"
        needs = "condition (9) for some threshold, initial error and number of rounds"
        if found.unseen:
            return 1.0, from_removal(guarantee, needs, removal, 2, [], 0)
        words, agents, gamma = "the saturation filter's conditions", 0, None
        with self.watch.question(words, 0.5):
            ground = self._one_sensor_each()
            agents, gamma = ground.agents, network_contraction(ground)
        if gamma is None:
            self.unfinished.append(words)
            return 1.0, Limit(guarantee, 0, None, needs, LATE)
        if gamma >= 1:
            return gamma, Limit(guarantee, 0, 0, needs, "the network is not connected, or directed")
        setting = saturation.Setting(agents=agents, a=1.0, lambda0=found.least, contraction=0.0, attacked=0)
        self.rounds = saturation.minimal_rounds(setting, gamma)
        if self.rounds is None:
            return gamma, Limit(guarantee, 0, 0, needs, "no number of rounds per sample suffices without liars")
        fails = -(-removal.most // 2)
        who = listed([self.plant.outputs[k] for k in removal.example])
        bound = f"lambda_0 <= {removal.most - fails} for s = {fails} because of {who}"
        return gamma, Limit(guarantee, 0, fails, needs, f"{bound}, and it must be above s (condition 11)")

    def _one_sensor_each(self) -> _core.Network:
        """The network of the sensors, each an agent of its own."""
        sensors = Counter(self.plant.agent)
        one = [np.ones((sensors[i], 1)) for i in range(self.network.agents)]
        _, network, _ = _core.split_outputs(_core.Model([[1.0]], one), self.network)
        return network

    def _additions(self, removal: Removal) -> list[Addition]:
        liars = max(removal.spare, 0) // 2 + 1
        goal = f"the state can be determined, from one sample, with {count(liars, 'liar')}"
        if removal.most == 0:
            goal = "the state can be determined, from one sample"
        spare = 0 if removal.most == 0 else 2 * liars
        nothing = Addition(goal, None, float("nan"), False)
        shown = Counter(self.entries[self.entries[:, 2] != 0, 1].astype(int).tolist())
        chosen = by_counting([shown[k] for k in range(self.plant.size[1])], spare, self.prices)
        if chosen is None:
            return [nothing]
        after = self._meters(f"what to add: {goal}", [], 0.8, more=chosen)
        if after.unseen or after.fewest <= spare:
            return [nothing]
        names = [f"a sensor of {self.plant.states[k]}" for k in chosen]
        return [Addition(goal, names, sum(self.prices[k] for k in chosen), True)]

    def _advice(self, found: Any, limit: Limit, gamma: float) -> list[str]:
        lines = []
        if found.unseen:
            lines.append(f"Not determined by the sensors: {listed([self.plant.states[k] for k in found.unseen])}.")
        elif gamma >= 1 and not self.network.directed and limit.why != LATE:
            lines.append("Connect the network: its parts cannot help each other.")
        elif limit.fails:
            lines.append(
                f"Without liars the saturation filter does with {count(self.rounds or 0, 'round')} per sample."
            )
        lines.append(
            "Not asked of sparse rows: errors of a bank of filters, what sensors could measure instead, which "
            "link helps most, and the theorem of a filter; they need dense matrices."
        )
        return lines
