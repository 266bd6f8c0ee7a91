"""gr.design: a filter for a goal, with what the goal costs."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from garrison import _core, arguments
from garrison._core import saturation
from garrison.checks import Check, check
from garrison.drawing import drawn
from garrison.drivers import simulate
from garrison.filters import make_filter
from garrison.result import Result
from garrison.words import count, hinted, hinted_methods, near, refusal, require_plant

if TYPE_CHECKING:
    from matplotlib.figure import Figure

#: what a design can aim at
GOALS = ("error", "bytes", "liars")
_FAMILIES = ("saturation",)
#: rounds of the trade-off curve: so many, at equal factors
_CURVE = 16
#: ||A|| of a plant that keeps some direction comes out this close to 1
_ROUNDING = 1e-12


@hinted_methods
@dataclass(frozen=True, eq=False, repr=False)
class Choice(Result):
    """A number of rounds with its best threshold: the bound it certifies, and the bytes of all messages per sample."""

    rounds: int
    threshold: float
    error: float
    bytes_per_sample: int


@hinted_methods
@dataclass(frozen=True, eq=False, repr=False)
class Designed(Result):
    """A filter for a goal, and what other choices would cost and give.

    Attributes
    ----------
    goal : str
        As it was asked for.
    filter : Filter
        As designed.
    attacked : int
        Liars that it stands.
    error : float
        The asymptotic bound that it certifies (theorem 1 item 3), unit of the state.
    chosen : Choice
        Its point of the curve.
    fewest_rounds : int
        With which anything is certified at all.
    curve : list of Choice
        What fewer and more rounds cost and give, feasible ones only.
    """

    goal: str
    filter: _core.Filter
    attacked: int
    error: float
    chosen: Choice
    fewest_rounds: int
    curve: list[Choice] = field(repr=False)

    def __str__(self) -> str:
        c = self.chosen
        fewest = f"{count(self.fewest_rounds, 'round')} {'is' if self.fewest_rounds == 1 else 'are'} the fewest"
        return (
            f"{self.filter!r}\n"
            f"stands {count(self.attacked, 'liar')} with an error of at most {self.error:.4g} in the long run; "
            f"{count(c.rounds, 'round')}, {count(c.bytes_per_sample, 'byte')} per sample; {fewest}"
        )

    def plot(self) -> Figure:
        """Bytes per sample against the certified error (extra: plot)."""
        return drawn("design_figure", self)


@hinted
def design(
    model: _core.Model,
    network: _core.Network,
    family: str = "saturation",
    *,
    attacked: int | None = None,
    initial_error: float,
    goal: str = "error",
    error_at_most: float | None = None,
    chebyshev: bool = True,
    most_rounds: int = 200,
    curve: bool = True,
) -> Designed:
    """The parameters of a filter that reach a goal, from its theorems.

    Parameters
    ----------
    model : Model
        The plant and its sensors.
    network : Network
        Who hears whom.
    family : str
        "saturation", the one with a design in closed form; the minimum is global.
    attacked : int, optional
        Liars to stand, >= 0 (not with the goal "liars").
    initial_error : float
        Bound on the distance of the common start from the state, > 0.
    goal : {"error", "bytes", "liars"}
        "error": the smallest certified error (within 1e-6 of it, where the bound of a plant that contracts only
        falls with the threshold); "bytes": the fewest rounds whose certified error is at most
        `error_at_most`; "liars": the smallest certified error with the most liars s for which one exists and
        lambda_0 > s, so that it does not rest on the contraction of the plant alone.
    error_at_most : float, optional
        With "bytes"; default any.
    chebyshev : bool
        Chebyshev-filtered rounds, or plain ones.
    most_rounds : int
        Rounds 1..most_rounds are tried.
    curve : bool
        Also the trade-off of rounds against error.

    Returns
    -------
    Designed
        The filter, what it promises, and the curve.

    Raises
    ------
    InvalidInput
        Something does not fit.
    DesignInfeasible
        No parameters exist; the message says what would help.
    """
    require_plant("design", model, network)
    family, goal, curve = arguments.text("family", family), arguments.text("goal", goal), arguments.flag("curve", curve)
    if family not in _FAMILIES:
        names = [info["name"] for info in _core.filter_infos()]
        advice = near(family, _FAMILIES) or ("this family has no design by a bound" if family in names else "")
        raise refusal("family", repr(family), f"one of {', '.join(_FAMILIES)}", advice)
    if goal not in GOALS:
        raise refusal("goal", repr(goal), f"one of {', '.join(GOALS)}", near(goal, GOALS))
    if (attacked is None) != (goal == "liars"):
        raise refusal("attacked", str(attacked), 'a number, or nothing with goal = "liars"')
    most = arguments.whole("most_rounds", most_rounds, 1, 10**6)
    start = arguments.number("initial_error", initial_error)
    if not 0 < start < math.inf:
        raise refusal("initial_error", str(start), "a finite number > 0")
    job = _Saturation(model, network, start, arguments.flag("chebyshev", chebyshev), most)
    liars = job.most_liars() if attacked is None else arguments.whole("attacked", attacked, 0, model.agents)
    best = job.best(liars)
    if goal == "bytes":
        limit = math.inf if error_at_most is None else arguments.number("error_at_most", error_at_most)
        if not limit >= best["bound"] * (1 - 1e-12):
            needs = f"at least {best['bound']:.6g}, the best that {most} rounds certify"
            raise _core.DesignInfeasible(f"error_at_most: got {limit:.6g}, expected {needs}; {job.remedies(liars)}")
        best = job.best(liars, slack=min(max(limit / best["bound"] - 1, 0.0), 1e12))
    elif error_at_most is not None:
        raise refusal("error_at_most", str(error_at_most), 'nothing, or goal = "bytes"')
    chosen = job.choice(liars, best)
    rounds: Iterable[int] = sorted({round(v) for v in np.geomspace(best["fewest_rounds"], most, _CURVE)})
    points = [job.choice(liars, one) for r in rounds if (one := job.exactly(liars, r)) is not None] if curve else []
    return Designed(
        goal, job.filter(liars, best), liars, float(best["bound"]), chosen, int(best["fewest_rounds"]), points
    )


class _Saturation:
    """Designs of the saturation filter for one model and network."""

    def __init__(self, model: _core.Model, network: _core.Network, start: float, chebyshev: bool, most: int) -> None:
        self.model, self.network, self.start = model, network, start
        self.chebyshev, self.most = chebyshev, most
        self._checks: dict[int, Check] = {}
        for condition in self._check(0).failed:
            if condition["name"].startswith(("network", "one output", "noise bounds")):
                raise refusal("design", f"'{condition['name']}' not met", "it to hold", condition["meaning"])

    def _check(self, attacked: int) -> Check:
        if attacked not in self._checks:
            params = {"threshold": math.inf, "rounds": 1, "attacked": attacked, "initial_error": self.start}
            self._checks[attacked] = check(self.model, self.network, make_filter("saturation", params))
        return self._checks[attacked]

    def _setting(self, attacked: int) -> saturation.Setting:
        found = self._check(attacked)
        a = found["||A||"]
        return saturation.Setting(
            agents=self.model.agents,
            a=1.0 if 1.0 - _ROUNDING < a < 1.0 else a,  # a bound that rests on such a contraction rests on rounding
            lambda0=found["lambda_0"],
            contraction=0.0,
            attacked=attacked,
            eta0=self.start,
            b_w=self.model.process_bound,
            b_v=float(np.max(self.model.measurement_bound)),
        )

    def best(self, attacked: int, slack: float = 1e-9) -> dict[str, Any]:
        """Rounds and threshold; refused with what would help."""
        try:
            return self._design(attacked, 1, self.most, slack)
        except _core.DesignInfeasible as error:
            raise _core.DesignInfeasible(f"{error}; {self.remedies(attacked)}") from None

    def exactly(self, attacked: int, rounds: int) -> dict[str, Any] | None:
        """The best threshold for so many rounds, where there is one."""
        try:
            return self._design(attacked, rounds, rounds, 1e-9)
        except _core.DesignInfeasible:
            return None

    def _design(self, attacked: int, least: int, most: int, slack: float) -> dict[str, Any]:
        gamma = self._check(attacked)["gamma"]
        options = {"least": least, "most": most, "slack": slack}
        return dict(saturation.design(self._setting(attacked), gamma, chebyshev=self.chebyshev, **options))

    def most_liars(self) -> int:
        """The most for which a design exists that uses the sensors; more liars never make one feasible.

        With lambda_0 <= s a plant that contracts has a bound by its contraction alone: no liars are stood, all
        sensors are ignored.
        """
        last = -1
        for attacked in range(self.model.agents + 1):
            if attacked > 0 and self._check(attacked)["lambda_0"] <= attacked:
                break
            try:
                self._design(attacked, 1, self.most, 1e-9)
            except _core.DesignInfeasible:
                break
            last = attacked
        if last < 0:
            self.best(0)  # refuses, with the reason
        return last

    def remedies(self, attacked: int) -> str:
        """What would make a design feasible."""
        words = []
        for fewer in range(attacked - 1, -1, -1):
            if self._feasible(fewer, self.most):
                words.append(f"attacked = {fewer} is feasible")
                break
        more = min(100 * self.most, 10**6)
        if self._feasible(attacked, more):
            words.append(f"most_rounds = {self._design(attacked, 1, more, 1e-9)['fewest_rounds']} is enough")
        words.append("garrison.analyze says which sensors or links to add")
        return "; ".join(words)

    def _feasible(self, attacked: int, most: int) -> bool:
        try:
            self._design(attacked, 1, most, 1e-9)
        except _core.DesignInfeasible:
            return False
        return True

    def filter(self, attacked: int, found: dict[str, Any]) -> _core.Filter:
        """The filter of a design."""
        params = {"threshold": found["beta"], "rounds": found["rounds"], "attacked": attacked}
        params |= {"chebyshev": self.chebyshev, "initial_error": found["eta0"]}
        return make_filter("saturation", params)

    def choice(self, attacked: int, found: dict[str, Any]) -> Choice:
        """A point of the curve; its bytes are those of one sample that is run."""
        filter = self.filter(attacked, found)
        run = simulate(self.model, self.network, filter, steps=1, keep=(), conditions=False)
        return Choice(int(found["rounds"]), float(found["beta"]), float(found["bound"]), run.bytes_per_step)
