"""gr.analyze: how many may lie, who must not fail, who could drift without limit, unseen, what to add."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from garrison import _core, arguments
from garrison.answers.additions import Addition, Candidate
from garrison.answers.limits import Limit
from garrison.answers.questions import QUESTIONS, Questions
from garrison.answers.removals import Removal
from garrison.answers.sensors import sensors_of
from garrison.answers.static_questions import STATIC_QUESTIONS, StaticQuestions
from garrison.answers.watch import Progress, Watch
from garrison.drawing import drawn
from garrison.families import require_common_state
from garrison.result import Result
from garrison.static_plant import StaticPlant
from garrison.words import count, hinted, hinted_methods, refusal, require_plant, shown

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@hinted_methods
@dataclass(eq=False, repr=False)
class Analysis(Result):
    """Answers about a model on a network. Sensors are single measured numbers.

    Attributes
    ----------
    title : str
        For tables and pictures.
    sensors : list of str
        Names of the sensors.
    limits : list of Limit
        The most liars for each guarantee.
    over_time, one_sample : Removal
        The fewest sensors whose loss leaves a part of the state unseen, ever or in one sample.
    critical : list of str
        Sensors whose loss alone does that.
    unbounded : list of str
        Agents that can drift without limit, unseen by any detector.
    leverage : list of float or None
        Per sensor, the share of its reading that no other one checks in one sample, 0..1; None where one sample does
        not determine the state.
    harm : list of dict
        Per number of liars a certified error.
    substitutes : list of list of str
        Per sensor, the states that it could measure instead, by the zeros alone.
    critical_links, critical_agents : list
        Whose loss alone parts the network.
    additions : list of Addition
        The cheapest sensors found for one more liar.
    advice : list of str
        About links.
    unfinished : list of str
        Questions for which the time was too short.
    network : Network
        As it was given.
    agent_names : list of str
        Names of the agents.
    """

    title: str
    sensors: list[str]
    limits: list[Limit]
    over_time: Removal
    one_sample: Removal
    critical: list[str]
    unbounded: list[str]
    leverage: list[float] | None
    harm: list[dict[str, Any]]
    substitutes: list[list[str]]
    critical_links: list[tuple[str, str]]
    critical_agents: list[str]
    additions: list[Addition]
    advice: list[str]
    unfinished: list[str]
    network: _core.Network = field(repr=False)
    agent_names: list[str] = field(repr=False)

    def report(self) -> dict[str, Any]:
        """Everything, ready for JSON."""
        plain = ("title", "sensors", "critical", "unbounded", "leverage", "harm", "substitutes", "critical_agents")
        out = {key: getattr(self, key) for key in (*plain, "advice", "unfinished")}
        out["limits"] = [vars(limit) | {"exact": limit.exact} for limit in self.limits]
        for key in ("over_time", "one_sample"):
            removal: Removal = getattr(self, key)
            out[key] = {
                "fewest": removal.fewest,
                "most": removal.most,
                "exact": removal.exact,
                "example": [self.sensors[k] for k in removal.example],
            }
        out["critical_links"] = [list(pair) for pair in self.critical_links]
        out["additions"] = [vars(addition) for addition in self.additions]
        return out

    def __str__(self) -> str:
        from garrison.answers.text import sentences

        return "\n".join(sentences(self))

    def plot(self) -> Figure:
        """Limits, leverages and the network with what must not fail, as a figure (extra: plot)."""
        return drawn("analysis_figure", self)


@hinted
def analyze(
    model: _core.Model | StaticPlant,
    network: _core.Network,
    filter: _core.Filter | None = None,
    *,
    candidates: ArrayLike | None = None,
    costs: ArrayLike | None = None,
    names: Sequence[str] | None = None,
    title: str = "",
    seconds: float = 30.0,
    progress: Progress | None = None,
) -> Analysis:
    """How many sensors may lie, which must not fail, who can drift unseen and with what harm, and what to add.

    Parameters
    ----------
    model : Model or StaticPlant
        The plant and its sensors. For a StaticPlant, whose rows are sparse, no matrix of all states is made: bounds
        instead of exact numbers where a part of it has more than 4000 sensors, and no errors of filters.
    network : Network
        Who hears whom.
    filter : Filter, optional
        Asks also how many liars it stands with its own parameters; not of a StaticPlant.
    candidates : (k, n) array, optional
        Rows that a new sensor could have, default: every state by itself. Not of a StaticPlant.
    costs : (k,) array, optional
        Of the candidates, > 0, default 1; of a StaticPlant: of a sensor of each state.
    names : sequence of str, optional
        Of the agents, default the network's.
    title : str
        For tables and pictures.
    seconds : float
        For everything together, > 0; searches that do not end in time leave a certified interval. Ctrl-C ends
        them within a fraction of a second.
    progress : callable, optional
        progress(question, done, total) is called before every question.

    Returns
    -------
    Analysis
        Prints in words; `plot()` draws it.

    Raises
    ------
    InvalidInput
        Something does not fit; the message says which, and what was expected.
    """
    if isinstance(model, StaticPlant):
        _require_network(model, network)
    else:
        require_plant("analyze", model, network)
    if filter is not None and not isinstance(filter, _core.Filter):
        raise refusal("filter", shown(filter), "a filter of garrison.filters, or None")
    require_common_state(filter)
    title, progress = (
        arguments.text("title", title),
        arguments.callback("progress", progress, "(question, done, total)"),
    )
    names = None if names is None else arguments.texts("names", names)
    if names and len(names) != network.agents:
        raise refusal("names", count(len(names), "name"), f"{network.agents}, one per agent")
    seconds = arguments.number("seconds", seconds)
    if not seconds > 0:
        raise refusal("seconds", str(seconds), "a time > 0")
    called = list(names or network.names) or [f"agent {i}" for i in range(network.agents)]
    if isinstance(model, StaticPlant):
        if filter is not None or candidates is not None:
            which = "filter" if filter is not None else "candidates"
            raise refusal(which, "one, with a StaticPlant", "none", "a Model of the same rows takes it")
        watch = Watch(seconds, STATIC_QUESTIONS, progress)
        asked = StaticQuestions(model, network, _prices(model, costs), watch, called)
        return Analysis(title=title, **asked.answers())
    sensors = sensors_of(model, network, names or None)
    offered = _candidates(model, candidates, costs)
    watch = Watch(seconds, QUESTIONS, progress)
    questions = Questions(model, network, sensors, offered, watch, called)
    return Analysis(title=title, **questions.answers(filter))


def _require_network(plant: StaticPlant, network: _core.Network) -> None:
    if not isinstance(network, _core.Network):
        raise refusal("analyze", f"(StaticPlant, {type(network).__name__}, ..)", "(plant, network, ..)")
    if network.agents < plant.agents:
        words = f"at least {plant.agents}, because the plant has a sensor of agent {plant.agents - 1}"
        raise refusal("network", count(network.agents, "agent"), words)


def _prices(plant: StaticPlant, costs: ArrayLike | None) -> dict[int, float]:
    """What a sensor of each state costs."""
    n = plant.size[1]
    prices = np.ones(n) if costs is None else arguments.table("costs", costs).ravel()
    if prices.shape != (n,) or not np.all(prices > 0) or not np.all(np.isfinite(prices)):
        raise refusal("costs", shown(costs), f"{count(n, 'number')} > 0, one per state")
    return dict(enumerate(prices.tolist()))


def _candidates(model: _core.Model, rows: ArrayLike | None, costs: ArrayLike | None) -> list[Candidate]:
    n = model.states
    states = list(model.state_names)
    table = np.eye(n) if rows is None else arguments.table("candidates", rows)
    if table.ndim != 2 or table.shape[1] != n:
        raise refusal("candidates", f"shape {table.shape}", f"(k, {n}), a row per sensor that could be added")
    prices = np.ones(len(table)) if costs is None else np.asarray(arguments.table("costs", costs)).ravel()
    if prices.shape != (len(table),) or not np.all(prices > 0) or not np.all(np.isfinite(prices)):
        raise refusal("costs", f"{prices}", f"{count(len(table), 'number')} > 0, one per candidate")
    if not np.all(np.isfinite(table)) or not np.all(np.any(table != 0, axis=1)):
        raise refusal("candidates", "a row of zeros, or a number that is not finite", "rows that measure something")

    def name(k: int) -> str:
        used = np.flatnonzero(table[k])
        if len(used) == 1:
            return f"a sensor of {states[used[0]]}"
        return f"candidate {k}"

    return [Candidate(name(k), row, float(p)) for k, (row, p) in enumerate(zip(table, prices, strict=True))]
