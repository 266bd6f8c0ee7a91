"""Values of every kind for every argument of the Python layer: accepted, or refused in our words; nothing foreign."""

from collections.abc import Callable
from typing import Any

import garrison as gr
import numpy as np
import pytest
from conftest import title_of

NASTY: list[Any] = [
    None, True, -1, 0, 1, 2, 2.5, 1e308, float("nan"), float("inf"), 10**30, "x", "", b"x", [], [[]], [1], [1, 2],
    [[1, 2], [3]], {}, {"a": 1}, {1: 2}, {"drop": 2}, object(), np.zeros(2), np.zeros((6, 2)), np.zeros((0, 2)),
    np.float32(1), np.int64(3), 1j, np.ma.masked, lambda *a: None, range(3), (1, 2), {1, 2}, "estimate", ["estimate"],
    ["x"], [None], gr.attacks.Bias(agents=[0], value=1), [gr.attacks.Bias(agents=[9], value=1)], np.array(["a"]),
    np.datetime64("2020-01-01"), np.zeros((3, 6)), np.full((3, 6), np.nan), np.array(1),
]  # fmt: skip


@pytest.fixture(scope="module")
def parts() -> tuple[gr.Model, gr.Network, gr.Filter]:
    noise = {"process_covariance": np.eye(2), "measurement_covariance": [[[1.0]]] * 6}
    model = gr.Model(0.9 * np.eye(2), [[1, 0], [0, 1]] * 3, process_bound=0.02, measurement_bound=0.01, **noise)
    return model, gr.Network.ring(6), gr.filters.Saturation(threshold=1.0)


def require_ours(call: Callable[[], object]) -> None:
    """Anything but an Error of garrison is a fault."""
    try:
        call()
    except gr.Error as error:
        assert "got " in str(error) and "expected " in str(error), str(error)


DRIVERS = ("attack", "trials", "seed", "start", "link", "keep", "threads", "progress", "conditions")


def test_arrays_are_lists_and_numbers_alone_are_none(parts: tuple[gr.Model, gr.Network, gr.Filter]) -> None:
    run = gr.simulate(*parts, steps=3, link={"cuts": np.array([[0, 1, 1, 2]])})
    assert np.array_equal(run.estimate, gr.simulate(*parts, steps=3, link={"cuts": [(0, 1, 1, 2)]}).estimate)
    for which in ([0, 1], np.arange(2)):
        assert gr.compare(*parts[:2], which, steps=4, start=2, trials=1, filters={}, baselines=False).attacked == [0, 1]
    titles = [title_of(run.plot(agents=agents)) for agents in (np.array([0, 2]), [0, 2], (0, np.int8(2)))]
    assert "agents 0, 2" in titles[0] and titles.count(titles[0]) == 3
    lone = np.array(1.5)  # iterable by its class, but not in fact
    calls: dict[str, Callable[[], object]] = {
        r"attacked\[0\]: got": lambda: gr.compare(*parts[:2], lone),
        "link.cuts: got": lambda: gr.simulate(*parts, steps=3, link={"cuts": lone}),
        "agents: got": lambda: run.plot(agents=lone),
        "plot: compare: got": lambda: run.plot(compare=lone),
        "measured: got": lambda: gr.replay_mitigated(
            parts[1],
            A=[[0.9]],
            process_covariance=[[1.0]],
            measurement_variance=1.0,
            measured=lone,
            truth=np.zeros((4, 1)),
            noise=np.zeros((3, 6)),
            attack=np.zeros((3, 6)),
        ),
        "names: got 1 name": lambda: gr.analyze(*parts[:2], names="x"),
    }
    for words, call in calls.items():
        with pytest.raises(gr.InvalidInput, match=words):
            call()


def test_what_a_progress_function_raises_is_its_own(parts: tuple[gr.Model, gr.Network, gr.Filter]) -> None:
    def fails(done: int, total: int) -> None:
        raise KeyError("mine")

    with pytest.raises(KeyError, match="mine"):
        gr.simulate(*parts, steps=3, progress=fails)
    for other in (len, lambda done: None):  # cannot be called with two arguments
        with pytest.raises(
            gr.InvalidInput, match=r"progress: got .*which fails.* expected a function of \(done, total\)"
        ):
            gr.simulate(*parts, steps=3, progress=other)  # type: ignore[arg-type]


@pytest.mark.parametrize("name", ["steps", "x0", "start_error", "noise", *DRIVERS])
def test_simulate(parts: tuple[gr.Model, gr.Network, gr.Filter], name: str) -> None:
    for value in NASTY:
        given: dict[str, Any] = {"steps": 3, "threads": 1} | {name: value}
        require_ours(lambda given=given: gr.simulate(*parts, **given))  # type: ignore[misc]


@pytest.mark.parametrize("name", ["measurements", "truth", *DRIVERS])
def test_replay(parts: tuple[gr.Model, gr.Network, gr.Filter], name: str) -> None:
    for value in NASTY:
        given: dict[str, Any] = {"measurements": np.zeros((3, 6)), "threads": 1} | {name: value}
        require_ours(lambda given=given: gr.replay(*parts, **given))  # type: ignore[misc]


@pytest.mark.parametrize("name", ["model", "measurements", "start", "start_variance", "gate", "huber"])
def test_central_kalman(parts: tuple[gr.Model, gr.Network, gr.Filter], name: str) -> None:
    for value in NASTY:
        given: dict[str, Any] = {"model": parts[0], "measurements": np.zeros((3, 6))} | {name: value}
        require_ours(lambda given=given: gr.central_kalman(**given))  # type: ignore[misc]


@pytest.mark.parametrize("kind", ["Bias", "Random", "Replay", "Constant", "FalseTrajectory", "Denial"])
def test_attacks(kind: str) -> None:
    for name in ("agents", "start", "stop", "schedule", "probability", "value", "size", "law", "delay", "offset"):
        for value in NASTY:
            given: dict[str, Any] = {name: value} if name in ("agents", "schedule") else {"agents": [0], name: value}
            require_ours(lambda given=given: getattr(gr.attacks, kind)(**given))  # type: ignore[misc]


def test_runs(parts: tuple[gr.Model, gr.Network, gr.Filter]) -> None:
    run = gr.simulate(*parts, steps=3)
    for value in NASTY:
        require_ours(lambda v=value: run.limited(v))  # type: ignore[misc]
        require_ours(lambda v=value: run.first_accused(v))  # type: ignore[misc]
        require_ours(lambda v=value: gr.Run.load(v))  # type: ignore[misc]
        require_ours(lambda v=value: run.animate("x.gif", v))  # type: ignore[misc]
        assert not np.any(run == value)
