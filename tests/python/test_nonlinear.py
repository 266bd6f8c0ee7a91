"""Nonlinear plants by functions: a linear one gives the linear run, and what cannot work is refused by name."""

import signal
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import garrison as gr
import numpy as np
import pytest

NETWORK = gr.Network.ring(6)
A = np.array([[1.0, 0.1], [-0.2, 0.95]])
ROWS = [[1, 0], [0, 1], [[0.6, 0.8], [0, 0.5]], [0.8, 0.6], np.zeros((0, 2)), [1, 0]]
LINEAR = gr.Model(A, ROWS, process_bound=0.01, measurement_bound=0.02, B=[[0.0], [0.1]])
PARTS = [np.atleast_2d(C) for C in LINEAR.C]
COUNTS = [len(C) for C in PARTS]
FILTERS = [gr.filters.ScalarGain(rounds=3), gr.filters.Saturation(threshold=0.3, rounds=3)]


def moved(X: Any, u: Any, t: int) -> Any:
    return X @ A.T + 0.1 * u * [0, 1]


def seen(X: Any, t: int) -> Any:
    return [C @ x for C, x in zip(PARTS, X, strict=True)]


def functions(**more: Any) -> gr.NonlinearModel:
    given: dict[str, Any] = {"states": 2, "outputs": COUNTS, "inputs": 1}
    return gr.NonlinearModel(moved, seen, **(given | {"process_bound": 0.01, "measurement_bound": 0.02} | more))


@pytest.mark.parametrize("filt", FILTERS)
@pytest.mark.parametrize("jacobian", [None, lambda X, t: PARTS])
def test_a_linear_plant_by_functions_gives_the_linear_run(filt: gr.Filter, jacobian: Any) -> None:
    given: dict[str, Any] = {
        "steps": 60,
        "inputs": lambda t: [np.sin(0.3 * t)],
        "x0": [1, 2],
        "start_error": 0.1,
        "trials": 3,
        "seed": 5,
        "attack": [gr.attacks.Bias(agents=[1], value=5.0, start=9), gr.attacks.Stealthy(agents=[3], fraction=0.5)],
        "link": {"drop": 0.1},
    }
    linear = gr.simulate(LINEAR, NETWORK, filt, **given)
    run = gr.simulate(functions(h_jacobian=jacobian), NETWORK, filt, **given)
    for name in ("truth", "measurements", "estimate", "error", "statistic"):
        assert np.allclose(getattr(run, name), getattr(linear, name), atol=1e-8, equal_nan=True)
    assert run.counters == linear.counters and np.array_equal(run.verdict, linear.verdict)
    log = gr.replay(
        functions(h_jacobian=jacobian), NETWORK, filt, measurements=run.measurements[0], truth=run.truth[0],
        start=run.estimate[0, 0], inputs=run.inputs, seed=5, link={"drop": 0.1},
    )  # fmt: skip
    assert np.array_equal(log.estimate[0], run.estimate[0])


G, DT, LENGTH = 9.81, 0.02, 1.0


def pendulum(X: Any, u: Any, t: int) -> Any:
    angle, rate = X.T
    return np.stack([angle + DT * rate, rate - DT * G / LENGTH * np.sin(angle)], axis=1)


ANCHORS = np.array([[1.0, 0.0], [-1.0, 0.0], [0.5, -0.5], [-1.0, -1.0], [1.5, -1.0], [0.2, 0.5]])


def ranges(X: Any, t: int) -> Any:
    """How far the bob is from the anchor of each agent: no agent alone can tell the angle."""
    bob = LENGTH * np.stack([np.sin(X[:, 0]), -np.cos(X[:, 0])], axis=1)
    return np.linalg.norm(bob - ANCHORS, axis=1)


def swinging(**more: Any) -> gr.NonlinearModel:
    given: dict[str, Any] = {"states": ["angle", "rate"], "units": {"angle": "rad"}, "outputs": [1] * 6}
    return gr.NonlinearModel(pendulum, ranges, **(given | {"process_bound": 1e-3, "measurement_bound": 0.01} | more))


SWING: dict[str, Any] = {"steps": 400, "x0": [0.8, 0.0], "start": [0.6, 0.0], "seed": 3}


def test_agents_with_ranges_alone_follow_a_pendulum() -> None:
    for filt in (gr.filters.ScalarGain(rounds=4), gr.filters.Saturation(threshold=0.1, rounds=4)):
        run = gr.simulate(swinging(), NETWORK, filt, **SWING)
        assert run.error[0, 200:].max() < 0.15 < run.error[0, 0].min()
        assert np.isnan(run.bound).all() and "nonlinear" in run.why_no_bound(0, 5)
        assert any("the plant is nonlinear" in w for w in run.warnings) and not any(
            "sees nothing" in w for w in run.warnings
        )
    assert run.model.state_names == ["angle", "rate"] and run.model.units == {"angle": "rad"}


def test_what_a_liar_can_do_is_bounded_by_the_saturation() -> None:
    """A lie of 1e6 does no more than one of a hundred, and little; unprotected it takes the estimate."""
    errors = {}
    for value in (0.0, 100.0, 1e6):
        lie = gr.attacks.Bias(agents=[2], value=value, start=100)
        guarded = gr.filters.Saturation(threshold=0.03, rounds=4)
        errors[value] = gr.simulate(swinging(), NETWORK, guarded, attack=lie, **SWING).error[0, 150:].max()
    assert errors[100.0] == errors[1e6] < 0.3 and errors[0.0] < 0.15
    bare = gr.simulate(swinging(), NETWORK, gr.filters.ScalarGain(rounds=4), attack=lie, **SWING)
    assert bare.error[0, 150:].max() > 100


def test_the_central_filter_takes_the_same_functions() -> None:
    plant = swinging(process_covariance=1e-6 * np.eye(2), measurement_covariance=3e-5)
    run = gr.simulate(plant, NETWORK, FILTERS[0], **SWING)
    found = gr.extended_kalman(
        *plant.central, run.measurements[0], process_covariance=1e-6, measurement_variance=3e-5, start=[0.6, 0.0]
    )
    error = np.linalg.norm(found - run.truth[0], axis=1)
    assert error[200:].max() < 0.05 and error[200:].max() < run.error[0, 200:].max()


def test_shapes_of_outputs_that_say_whose_they_are_are_read() -> None:
    plain = gr.simulate(swinging(), NETWORK, FILTERS[1], **SWING)
    rows: list[Any] = []

    def kept(X: Any, t: int) -> Any:
        rows.append(X)
        return ranges(X, t)

    for h in (lambda X, t: ranges(X, t)[:, None], lambda X, t: list(ranges(X, t)), kept):
        plant = gr.NonlinearModel(
            pendulum, h, states=["angle", "rate"], units={"angle": "rad"}, outputs=[1] * 6, process_bound=1e-3,
            measurement_bound=0.01,
        )  # fmt: skip
        assert gr.simulate(plant, NETWORK, FILTERS[1], **SWING) == plain
    assert {X.shape for X in rows} == {(6, 2)}
    for jacobian in (_steep, lambda X, t: _steep(X, t)[:, None], lambda X, t: list(_steep(X, t))):
        run = gr.simulate(swinging(h_jacobian=jacobian), NETWORK, FILTERS[1], **SWING)
        assert np.allclose(run.estimate, plain.estimate, atol=1e-6)


def _steep(X: Any, t: int) -> Any:
    bob = LENGTH * np.stack([np.sin(X[:, 0]), -np.cos(X[:, 0])], axis=1)
    away = (bob - ANCHORS) / np.linalg.norm(bob - ANCHORS, axis=1)[:, None]
    slope = LENGTH * np.stack([np.cos(X[:, 0]), np.sin(X[:, 0])], axis=1)
    return np.stack([(away * slope).sum(axis=1), np.zeros(len(X))], axis=1)


def test_functions_know_the_time_and_the_inputs() -> None:
    times: list[Any] = []

    def f(X: Any, u: Any, t: int) -> Any:
        times.append(("f", t, tuple(u)))
        return X + u

    def h(X: Any, t: int) -> Any:
        times.append(("h", t))
        return X[:, 0] * t

    plant = gr.NonlinearModel(
        f, h, states=1, outputs=[1, 1], inputs=["push"], h_jacobian=lambda X, t: np.full((2, 1), 0.5)
    )
    run = gr.simulate(plant, gr.Network.path(2), FILTERS[0], steps=2, inputs=[[1.0], [2.0]], noise="none")
    assert run.truth[0, :, 0].tolist() == [0, 1, 3] and run.measurements[0].tolist() == [[1, 1], [6, 6]]
    assert dict.fromkeys(times) == dict.fromkeys([("f", 0, (1.0,)), ("h", 1), ("f", 1, (2.0,)), ("h", 2)])


def test_filters_of_ones_own_get_the_prediction_and_their_rows() -> None:
    class Mine(gr.Filter):
        rounds = 0

        def sense(self, agent: Any, state: Any, y: Any, t: int) -> Any:
            assert np.array_equal(agent.A, np.eye(2))
            state.estimate = state.estimate + agent.C.T @ np.clip(y - agent.C @ state.estimate, -0.1, 0.1)
            return {"estimate": state.estimate}

        def fuse(self, agent: Any, state: Any, inbox: Any, round: int) -> Any:
            return None

    own = gr.simulate(swinging(), NETWORK, Mine(), **SWING)
    family = gr.simulate(swinging(), NETWORK, gr.filters.Saturation(threshold=0.1, rounds=0), **SWING)
    assert np.allclose(own.estimate, family.estimate, atol=1e-9)


def test_runs_are_kept_without_their_functions(tmp_path: Path) -> None:
    run = gr.simulate(swinging(), NETWORK, FILTERS[0], **(SWING | {"steps": 9}))
    run.save(tmp_path / "run.npz")
    loaded = gr.Run.load(tmp_path / "run.npz")
    assert loaded == run and repr(run).startswith("<Run of scalar_gain")
    with pytest.raises(gr.InvalidInput, match="a run of a NonlinearModel, whose functions no run keeps"):
        gr.again(loaded)
    plant = swinging()
    assert plant == swinging() != swinging(process_bound=0.5) and hash(plant) == hash(swinging())
    assert repr(plant) == "<NonlinearModel of pendulum, ranges: 2 states, 6 agents>"


def refused(plant: Any, words: str, filt: Any = FILTERS[0], **more: Any) -> None:
    with pytest.raises(gr.InvalidInput, match=words):
        gr.simulate(plant, NETWORK, filt, **(SWING | {"steps": 5} | more))


def test_what_needs_a_linear_plant_is_refused_by_name() -> None:
    plant = swinging(process_covariance=1e-6 * np.eye(2), measurement_covariance=1e-4)
    for filt in (
        gr.filters.Structural(),
        gr.filters.Rdkf(),
        gr.filters.PartialSharing(gain=0.1),
        gr.filters.Lfre(faulty=1),
    ):
        refused(
            plant,
            f"filter: got {filt.name} with a NonlinearModel, expected ScalarGain.* designed for one A and C",
            filt,
        )
    for asked in ({"initial_error": 1.0}, {"detector": True}, {"initial_error": 1.0, "adaptive": True}):
        filt = gr.filters.Saturation(threshold=0.1, attacked=1, **asked)
        refused(plant, f"{next(iter(asked))}.* rest on theorems for linear plants", filt)
    refused(plant, "certificate: got 'local' with a NonlinearModel without linear", certificate="local", attacked=1)
    story = gr.attacks.FalseTrajectory(agents=[1], offset=[1.0, 0.0])
    refused(plant, "attack: got false_trajectory with a NonlinearModel", attack=story)
    calls: list[Any] = [gr.check, gr.prepare, gr.analyze]
    for call in calls:
        with pytest.raises(gr.InvalidInput, match="NonlinearModel"):
            call(plant, NETWORK, *([] if call is gr.analyze else [FILTERS[0]]))


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"f": 3}, r"NonlinearModel.f: got 3, expected a function of \(X, u, t\)"),
        (
            {"f": lambda X, t: X},
            r"NonlinearModel.f: got a function whose call fails.*expected a function of \(X, u, t\)",
        ),
        ({"h_jacobian": 3}, "or None"),
        ({"states": 0}, "states: got 0"),
        ({"states": ["a", "a"]}, "a"),
        ({"outputs": []}, "outputs: got none"),
        ({"outputs": [1, -1]}, r"outputs\[1\]: got -1"),
        ({"inputs": -1}, "inputs: got -1"),
        ({"output": [1]}, "unknown argument 'output'"),
    ],
)
def test_models_that_do_not_fit_are_refused(given: dict[str, Any], words: str) -> None:
    with pytest.raises(gr.InvalidInput, match=words):
        gr.NonlinearModel(**({"f": pendulum, "h": ranges, "states": 2, "outputs": [1] * 6} | given))


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"f": lambda X, u, t: X[:, 0]}, r"f: got \(1,\), expected \(1, 2\); X has a row per agent"),
        ({"f": lambda X, u, t: X.T}, r"f: got \(2, 1\), expected \(1, 2\)"),
        ({"f": lambda X, u, t: X * np.nan}, "f: got a number that is not finite at time 0, for the true state"),
        ({"f": lambda X, u, t: X / (len(X) == 1)}, "f: got a number that is not finite at time 0, for the estimate of"),
        ({"f": lambda X, u, t: None}, "f: got"),
        ({"h": lambda X, t: X}, r"h: got \(6, 2\), expected \(6,\), or a list of 6 arrays"),
        ({"h": lambda X, t: X[0, 0]}, r"h: got \(\), expected \(6,\)"),
        ({"h": lambda X, t: [X[:, 0]] * 6}, r"h\[0\]: got \(6,\), expected \(1,\)"),
        ({"h": lambda X, t: ranges(X, t) * (np.nan if t > 2 else 1)}, "h: got a number that is not finite at time 3"),
        ({"h": lambda X, t: ["a"] * 6}, r"h\[0\]: got"),
        ({"h_jacobian": lambda X, t: X[0]}, r"h_jacobian: got \(2,\), expected \(6, 2\)"),
        ({"h_jacobian": lambda X, t: X * np.inf}, "h_jacobian: got a number that is not finite"),
    ],
)  # fmt: skip
def test_what_functions_return_is_checked(given: dict[str, Any], words: str) -> None:
    plant = gr.NonlinearModel(**({"f": pendulum, "h": ranges, "states": 2, "outputs": [1] * 6} | given))
    with np.errstate(all="ignore"):
        refused(plant, words)


def test_exceptions_of_the_functions_pass_with_a_note() -> None:
    def alone(x: Any, u: Any, t: int) -> Any:
        return np.array([x[0] + DT * x[1], x[1]])  # of one state: X[1] is another agent's

    plant = gr.NonlinearModel(alone, ranges, states=2, outputs=[1] * 6)
    with pytest.raises(IndexError) as told:
        gr.simulate(plant, NETWORK, FILTERS[0], **SWING)
    assert told.value.__notes__ == ["raised in f, t = 0, X of shape (1, 2), a row per agent"]

    def angry(X: Any, t: int) -> Any:
        raise RuntimeError("mine")

    with pytest.raises(RuntimeError, match="mine"):
        gr.simulate(gr.NonlinearModel(pendulum, angry, states=2, outputs=[1] * 6), NETWORK, FILTERS[0], **SWING)


@pytest.fixture
def interrupt() -> Iterator[None]:
    before = signal.signal(signal.SIGALRM, signal.getsignal(signal.SIGINT))
    yield
    signal.setitimer(signal.ITIMER_REAL, 0)
    signal.signal(signal.SIGALRM, before)


@pytest.mark.usefixtures("interrupt")
def test_an_interrupt_ends_a_run() -> None:
    signal.setitimer(signal.ITIMER_REAL, 0.2)
    with pytest.raises(KeyboardInterrupt):
        gr.simulate(swinging(), NETWORK, FILTERS[0], **(SWING | {"steps": 200_000, "keep": "estimate"}))


def test_long_rows_are_told() -> None:
    plant = gr.NonlinearModel(pendulum, lambda X, t: 3 * X[:, 0], states=2, outputs=[1] * 6)
    run = gr.simulate(plant, NETWORK, gr.filters.Saturation(threshold=0.1), **(SWING | {"steps": 5}))
    assert any("Rows of dh/dx are up to 3" in w for w in run.warnings)
    assert not any("Rows of dh/dx" in w for w in gr.simulate(swinging(), NETWORK, FILTERS[1], **SWING).warnings)
