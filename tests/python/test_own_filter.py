"""Filters of one's own: same engine, links, records and tables as every family, and the user's errors stay his."""

import copy
import pickle
from pathlib import Path
from typing import Any

import garrison as gr
import numpy as np
import pytest

MODEL = gr.Model([[1.0, 0.1], [-0.05, 0.9]], [[1, 0], [0, 1], [1, 1]] * 2, process_bound=0.02, measurement_bound=0.01)
NETWORK = gr.Network.ring(6)


class PlainConsensus(gr.Filter):
    """Algorithm 1 without saturation, in the order of operations of scalar_gain."""

    signals = ("innovation",)

    def __init__(self, rounds: int = 3, step: float = 0.25) -> None:
        super().__init__()
        self.rounds, self.step = rounds, step

    def start(self, agent: gr.AgentInfo, x0: Any) -> dict[str, Any]:
        return {"estimate": x0, "innovation": np.nan}

    def sense(self, agent: gr.AgentInfo, state: dict[str, Any], y: Any, t: int) -> dict[str, Any]:
        A, C, x = agent.A, agent.C, state["estimate"]
        n = len(x)
        prediction = np.zeros(n)
        for i in range(n):
            for k in range(n):
                prediction[i] += A[i, k] * x[k]
        x = prediction.copy()
        for r, row in enumerate(C):
            expected = 0.0
            for k in range(n):
                expected += row[k] * prediction[k]
            h = y[r] - expected
            state["innovation"] = h
            if not np.isnan(h):
                x = x + h * row
        state["estimate"] = x
        return {"estimate": x}

    def fuse(self, agent: gr.AgentInfo, state: dict[str, Any], inbox: dict[int, Any], round: int) -> dict[str, Any]:
        x = state["estimate"]
        total = np.zeros(len(x))
        for k, message in enumerate(inbox.values()):
            total = message["estimate"] if k == 0 else total + message["estimate"]
        state["estimate"] = x - self.step * (float(len(inbox)) * x - total)
        return {"estimate": state["estimate"]}

    def report(self, agent: gr.AgentInfo, state: dict[str, Any]) -> dict[str, Any]:
        missing = np.isnan(state["innovation"])
        return {
            "statistic": abs(state["innovation"]),
            "threshold": np.inf,
            "verdict": "silent" if missing else "not_tested",
            "innovation": state["innovation"],
        }


def same(own: gr.Run, built_in: gr.Run) -> None:
    for name in ("truth", "measurements", "estimate", "error", "statistic", "threshold"):
        assert np.array_equal(getattr(own, name), getattr(built_in, name), equal_nan=True), name
    # At time 0 nothing was measured yet: scalar_gain says "not tested", this filter cannot tell.
    assert np.array_equal(own.verdict[:, 1:], built_in.verdict[:, 1:])  # type: ignore[index]
    assert own.counters == built_in.counters
    assert np.array_equal(own.signals["innovation"], built_in.signals["innovation"], equal_nan=True)


@pytest.mark.parametrize("attack", ["none", "measurements", "messages", "informed"])
@pytest.mark.parametrize("link", [None, {"drop": 0.2, "delay": 0.1}, {"cuts": [(0, 1, 3, 9), (None, 4, 5, 6)]}])
def test_it_reproduces_scalar_gain_bit_for_bit(attack: str, link: dict[str, Any] | None) -> None:
    attacks = {
        "none": [],
        "measurements": [
            gr.attacks.Bias(agents=[1], value=3.0, start=4),
            gr.attacks.Denial(agents=[2], probability=0.5),
        ],
        "messages": [gr.attacks.Equivocate(agents=[0], size=2.0), gr.attacks.Silence(agents=[3], start=9)],
        "informed": [gr.attacks.Stealthy(agents=[5], fraction=0.0)],
    }[attack]
    arguments: dict[str, Any] = {
        "steps": 25, "trials": 3, "seed": 7, "x0": [1, 2], "start": [0.5, 0], "start_error": 0.1, "link": link,
        "attack": attacks, "keep": ["estimate", "report", "measurements", "signals"],
    }  # fmt: skip
    own = gr.simulate(MODEL, NETWORK, PlainConsensus(), **arguments)
    built_in = gr.simulate(MODEL, NETWORK, gr.filters.ScalarGain(rounds=3, step=0.25), **arguments)
    assert np.ptp(own.estimate) > 0.1  # type: ignore[arg-type]
    same(own, built_in)
    assert own.bytes_per_step == 12 * 3 * 8 * 2  # links x rounds x two numbers


def test_replay_and_prepared_are_the_same_run() -> None:
    run = gr.simulate(MODEL, NETWORK, PlainConsensus(), steps=12, seed=3, x0=[1, 0])
    log = {"measurements": run.measurements[0], "truth": run.truth[0]}  # type: ignore[index]
    again = gr.replay(MODEL, NETWORK, PlainConsensus(), **log)
    assert np.array_equal(run.estimate, again.estimate)  # type: ignore[arg-type]
    prepared = gr.prepare(MODEL, NETWORK, PlainConsensus())
    assert prepared.filter == PlainConsensus()
    assert prepared.replay(**log) == again


def test_it_is_kept_compared_and_shown(tmp_path: Path) -> None:
    filt = PlainConsensus(rounds=2)
    assert repr(filt) == "PlainConsensus(rounds=2, step=0.25)"
    assert filt.own and not gr.filters.ScalarGain().own
    assert filt.params == {"rounds": 2, "step": 0.25}
    for twin in (copy.deepcopy(filt), copy.copy(filt), pickle.loads(pickle.dumps(filt)), PlainConsensus(rounds=2)):
        assert twin == filt and hash(twin) == hash(filt) and type(twin) is PlainConsensus
    assert filt != PlainConsensus() and filt != gr.filters.ScalarGain()
    run = gr.simulate(MODEL, NETWORK, filt, steps=5)
    run.save(tmp_path / "run.npz")
    loaded = gr.Run.load(tmp_path / "run.npz")
    assert loaded == run and loaded.filter == filt
    assert np.array_equal(gr.simulate(MODEL, NETWORK, loaded.filter, steps=5).estimate, run.estimate)  # type: ignore[arg-type]
    assert pickle.loads(pickle.dumps(run)) == run
    assert len(run.to_pandas()) == 6 * 6


def test_a_run_of_a_class_that_is_not_here_says_so(tmp_path: Path) -> None:
    local = type("Gone", (PlainConsensus,), {})
    run = gr.simulate(MODEL, NETWORK, local(), steps=2)
    run.save(tmp_path / "run.npz")
    local.__qualname__ = "Renamed"
    with pytest.raises(gr.IoError, match=r"Gone, which is not defined here, .*import it first"):
        gr.Run.load(tmp_path / "run.npz")


class Accuser(PlainConsensus):
    """Accuses the neighbour that disagrees most, and sends nothing every third sample."""

    def layout(self, model: gr.Model) -> dict[str, int]:
        return {"estimate": model.states, "worst": 1}

    def design(self, model: gr.Model, network: gr.Network) -> dict[str, float]:
        return {"level": 1.0}

    def start(self, agent: gr.AgentInfo, x0: Any) -> dict[str, Any]:
        return {"estimate": x0, "innovation": np.nan, "suspect": [], "heard": []}

    def sense(self, agent: gr.AgentInfo, state: dict[str, Any], y: Any, t: int) -> dict[str, Any] | None:
        message = super().sense(agent, state, y, t) | {"worst": float(agent.id)}
        return None if t % 3 == 0 else message

    def fuse(self, agent: gr.AgentInfo, state: dict[str, Any], inbox: dict[int, Any], round: int) -> dict[str, Any]:
        assert all(int(m["worst"][0]) == j for j, m in inbox.items() if m["worst"] >= 0 and j != 2)
        state["heard"].append(sorted(inbox))
        far = [j for j, m in inbox.items() if np.abs(m["estimate"] - state["estimate"]).max() > agent.gains["level"]]
        state["suspect"] = far
        return super().fuse(agent, state, inbox, round) | {"worst": [-1.0]}

    def report(self, agent: gr.AgentInfo, state: dict[str, Any]) -> dict[str, Any]:
        return {"accused": state["suspect"], "verdict": gr.Verdict.CLEARED, "bound": 5.0}


def test_layout_design_silence_and_accusations() -> None:
    lies = gr.attacks.Forge(agents=[2], offset=50.0, start=4)
    run = gr.simulate(MODEL, NETWORK, Accuser(rounds=1), steps=6, attack=lies)
    accused = dict((t, sets) for _, t, sets in run.accusations)
    assert accused[4][1] == [2] and accused[4][3] == [2] and accused[4][0] == []
    assert accused[6] == [[]] * 6  # nobody sent anything
    assert run.counters["refused"] == 2 * 12  # samples 3 and 6; nothing plus a lie is nothing
    assert np.isnan(run.bound).all()  # type: ignore[arg-type]  # agents lie: nothing vouches for a bound
    quiet = gr.simulate(MODEL, NETWORK, Accuser(rounds=1), steps=2)
    assert (quiet.bound == 5.0).all()  # type: ignore[union-attr]
    assert run.bytes_per_step == 12 * 8 * 3


def broken(method: str, body: Any) -> gr.Filter:
    return type("Broken", (PlainConsensus,), {method: body})()  # type: ignore[no-any-return]


@pytest.mark.parametrize("method", ["start", "sense", "fuse", "report"])
def test_errors_of_the_users_code_come_back_with_traceback_agent_and_sample(method: str) -> None:
    def fails(self: Any, agent: gr.AgentInfo, state: Any, *rest: Any) -> Any:
        if agent.id == 4:
            raise ZeroDivisionError("the user's own words")
        return getattr(PlainConsensus, method)(self, agent, state, *rest)

    with pytest.raises(ZeroDivisionError, match="own words") as caught:
        gr.simulate(MODEL, NETWORK, broken(method, fails), steps=3, trials=2)
    sample = 1 if method in ("sense", "fuse") else 0
    assert caught.value.__notes__ == [f"raised in Broken.{method}, agent 4, sample {sample}"]
    assert any(entry.name == "fails" for entry in caught.traceback)


@pytest.mark.parametrize(
    ("method", "body", "words"),
    [
        ("sense", lambda *_: 3, r"Broken.sense: got 3, expected a message.*agent \d, sample 1"),
        ("sense", lambda *_: {"estimate": [1.0]}, r'Broken.sense\["estimate"\]: got 1 number, expected 2'),
        ("fuse", lambda *_: {"estimat": [1.0, 2.0]}, r"unknown field 'estimat', expected the fields estimate"),
        ("fuse", lambda *_: {}, r'no field "estimate"'),
        ("start", lambda *_: 5, r"Broken.start: got 5 as state"),
        ("report", lambda *_: {"verdct": 1}, r'did you mean "?verdict'),
        ("report", lambda *_: {"accused": [9]}, r"Broken.report.accused: got 9, expected agents in 0..5"),
        ("layout", lambda *_: {"estimate": 0}, r"at least 1"),
        ("layout", lambda *_: {}, r"got 0 fields, expected 1 to 12"),
    ],
)
def test_what_does_not_fit_is_refused_by_name(method: str, body: Any, words: str) -> None:
    with pytest.raises(gr.InvalidInput, match=words):
        gr.simulate(MODEL, NETWORK, broken(method, body), steps=2)


def test_what_only_families_can_is_refused() -> None:
    with pytest.raises(gr.InvalidInput, match="Filter without sense"):
        gr.prepare(MODEL, NETWORK, gr.Filter())
    prepared = gr.prepare(MODEL, NETWORK, PlainConsensus())
    with pytest.raises(gr.InvalidInput, match="an agent on its own"):
        prepared.agent(0)
    with pytest.raises(gr.InvalidInput, match="PlainConsensus"):
        prepared.to_bytes()


def test_an_overflow_rejoins_from_the_neighbours() -> None:
    class Explodes(PlainConsensus):
        def sense(self, agent: gr.AgentInfo, state: dict[str, Any], y: Any, t: int) -> dict[str, Any]:
            message = super().sense(agent, state, y, t)
            if agent.id == 2 and t == 4:
                state["estimate"] = message["estimate"] = np.full(2, np.nan)
            return message

    run = gr.simulate(MODEL, NETWORK, Explodes(), steps=8, x0=[1, 1], start=[1, 1])
    assert run.counters["resets"] == 1 and run.counters["overflows"] == 1
    assert np.isfinite(run.estimate).all()  # type: ignore[arg-type]


def test_ctrl_c_in_the_users_code_ends_the_run() -> None:
    def interrupted(*_: Any) -> Any:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        gr.simulate(MODEL, NETWORK, broken("sense", interrupted), steps=1000)


def test_a_function_of_other_arguments_is_refused_when_it_is_given() -> None:
    with pytest.raises(gr.InvalidInput, match=r"expected a function of \(t, agent, y, rng\)"):
        gr.attacks.custom(lambda t: t, agents=[1])
    with pytest.raises(gr.InvalidInput, match=r"expected a function of \(t, round, sender, receiver, message, rng\)"):
        gr.attacks.custom_message(lambda t, message: message, agents=[1])


class Blamer(gr.Filter):
    """Accuses agent 1 from the start, and has attributes whose names mean something in other filters."""

    def __init__(self) -> None:
        super().__init__()
        self.window, self.settle, self.attacked, self.detector, self.false_alarm = 50, 40, 1, True, 1e-9

    def sense(self, agent: gr.AgentInfo, state: Any, y: Any, t: int) -> dict[str, Any]:
        return {"estimate": state.estimate}

    def fuse(self, agent: gr.AgentInfo, state: Any, inbox: Any, round: int) -> None:
        return None

    def report(self, agent: gr.AgentInfo, state: Any) -> dict[str, Any]:
        return {"accused": [1]}


def test_accusations_of_own_filters_are_shown_and_their_attributes_are_their_own() -> None:
    model = gr.Model([[0.9]], [[1.0]] * 3, process_bound=0.1, measurement_bound=0.1)
    run = gr.simulate(model, gr.Network.ring(3), Blamer(), attack=gr.attacks.Bias([1], value=3.0), steps=5, seed=1)
    assert set(run.first_accused()) == {1}
    assert not any("window" in w or "settle" in w or "level of their test" in w for w in run.warnings), run.warnings
    found = gr.compare(
        model,
        gr.Network.ring(3),
        [1],
        filters={"mine": Blamer()},
        attacks={"bias": gr.attacks.Bias([1], value=3.0)},
        steps=8,
        start=3,
        trials=1,
    )
    (row,) = [r for r in found.rows if r["filter"] == "mine" and r["attack"] == "bias"]
    assert row["false_alarms"] == 1.0  # before there was a lie
