"""Kalman filters per agent and for nonlinear plants, against textbook recursions and FilterPy where it is installed."""

import signal
import time
from collections.abc import Callable
from typing import Any

import garrison as gr
import numpy as np
import pytest

MODEL = gr.Model(
    [[1.0, 0.1], [-0.05, 0.9]],
    [[1, 0], [0, 1], [1, 1], [1, 0]],
    process_covariance=0.01,
    measurement_covariance=0.04,
)
NETWORK = gr.Network.path(4)


def test_a_filter_per_agent_is_a_central_one_of_what_it_hears() -> None:
    y = np.random.default_rng(1).normal(size=(30, 4))
    y[5:8, 1] = np.nan
    start = np.arange(8.0).reshape(4, 2)
    for screen in ({}, {"gate": 0.01}, {"huber": 1.345}):
        found = gr.local_kalman(MODEL, NETWORK, y, start=start, **screen)
        assert found.shape == (31, 4, 2)
        for i in range(4):
            heard = sorted([i, *NETWORK.neighbours(i)])
            part = gr.Model(MODEL.A, [MODEL.C[j] for j in heard], process_covariance=0.01, measurement_covariance=0.04)
            expected = gr.central_kalman(part, y[:, heard], start=start[i], **screen)
            assert np.allclose(found[:, i], expected, atol=1e-11)


def test_screens_protect_agents_whose_neighbour_lies() -> None:
    model = gr.Model([[0.95]], [[1.0]] * 6, process_covariance=0.01, measurement_covariance=0.01)
    network, lie = gr.Network.complete(6), gr.attacks.Bias(agents=[2], value=3.0, start=20)
    run = gr.simulate(model, network, gr.filters.ScalarGain(), steps=80, attack=lie, seed=3)
    y, truth = run.measurements[0], run.truth[0][:, None]
    plain, gated, robust = (
        np.linalg.norm(gr.local_kalman(model, network, y, **screen) - truth, axis=2)[30:].mean()
        for screen in ({}, {"gate": 1e-3}, {"huber": 1.345})
    )
    assert gated < 0.3 * plain and robust < 0.5 * plain


def test_compare_has_them_as_rows() -> None:
    found = gr.compare(MODEL, NETWORK, attacked=[2], filters={}, attacks={}, steps=30, trials=2)
    assert all(r["filter"] != "x" for r in found.rows)
    labels = {
        r["filter"]
        for r in gr.compare(
            MODEL, NETWORK, attacked=[2], filters={"plain": gr.filters.ScalarGain()}, attacks={}, steps=30, trials=2
        ).rows
        if r["status"] == "ok"
    }
    assert {"Kalman filter (per agent)", "gated Kalman filter (per agent)", "Huber Kalman filter (per agent)"} <= labels


H, G, L = 0.02, 9.81, 1.0


def pendulum(x: Any, u: Any, t: int) -> Any:
    push = u[0] if len(u) else 0.0
    return np.array([x[0] + H * x[1], x[1] - H * G / L * np.sin(x[0]) + H * push])


def pendulum_jacobian(x: Any, u: Any, t: int) -> Any:
    return np.array([[1.0, H], [-H * G / L * np.cos(x[0]), 1.0]])


def bob(x: Any, t: int) -> Any:
    """Where the bob hangs: both coordinates."""
    return np.array([L * np.sin(x[0]), -L * np.cos(x[0])])


def bob_jacobian(x: Any, t: int) -> Any:
    return np.array([[L * np.cos(x[0]), 0.0], [L * np.sin(x[0]), 0.0]])


Q, R = np.diag([1e-6, 1e-4]), np.array([0.01, 0.02])


def swing(steps: int = 300, push: Any = None) -> tuple[Any, Any]:
    rng = np.random.default_rng(0)
    x, truth, y = np.array([1.2, 0.0]), [], []
    for t in range(steps):
        x = pendulum(x, [] if push is None else push[t], t) + rng.normal(size=2) * np.sqrt(np.diag(Q))
        truth.append(x)
        y.append(bob(x, t + 1) + rng.normal(size=2) * np.sqrt(R))
    return np.array(truth), np.array(y)


def textbook(y: Any, push: Any = None) -> Any:
    """The extended filter in its first form: covariances, gains, no roots (Anderson, Moore 1979, chapter 8)."""
    x, P, out = np.array([1.0, 0.0]), np.eye(2) * 0.5, [np.array([1.0, 0.0])]
    for t, z in enumerate(y):
        u = [] if push is None else push[t]
        F = pendulum_jacobian(x, u, t)
        x, P = pendulum(x, u, t), F @ P @ F.T + Q
        C = bob_jacobian(x, t + 1)
        here = np.isfinite(z)
        K = P @ C[here].T @ np.linalg.inv(C[here] @ P @ C[here].T + np.diag(R[here]))
        x = x + K @ (z - bob(x, t + 1))[here]
        P = (np.eye(2) - K @ C[here]) @ P @ (np.eye(2) - K @ C[here]).T + K @ np.diag(R[here]) @ K.T
        out.append(x)
    return np.array(out)


ARGUMENTS: dict[str, Any] = {
    "process_covariance": Q,
    "measurement_variance": R,
    "start": [1.0, 0.0],
    "start_covariance": 0.5,
}


def test_a_pendulum_is_tracked_as_the_textbook_says() -> None:
    push = np.random.default_rng(9).normal(size=(300, 1))
    truth, y = swing(push=push)
    y[40:60, 0], y[100:105] = np.nan, np.nan
    exact = {"f_jacobian": pendulum_jacobian, "h_jacobian": bob_jacobian}
    found = gr.extended_kalman(pendulum, bob, y, inputs=push, **ARGUMENTS, **exact)
    assert np.abs(found - textbook(y, push)).max() < 1e-10
    by_differences = gr.extended_kalman(pendulum, bob, y, inputs=lambda t: push[t], **ARGUMENTS)
    assert np.abs(by_differences - found).max() < 1e-7
    assert np.abs(found[150:, 0] - truth[149:, 0]).max() < 0.1


def test_noises_of_every_sample_are_weighed() -> None:
    """A constant one in every sample is the constant one; others are those of central_kalman over time."""
    _, y = swing()
    exact = {"f_jacobian": pendulum_jacobian, "h_jacobian": bob_jacobian}
    constant = gr.extended_kalman(pendulum, bob, y, **ARGUMENTS, **exact)
    repeated = ARGUMENTS | {"process_covariance": np.tile(Q, (300, 1, 1)), "measurement_variance": np.tile(R, (300, 1))}
    assert np.array_equal(gr.extended_kalman(pendulum, bob, y, **repeated, **exact), constant)
    rng = np.random.default_rng(4)
    Q_t, R_t = rng.uniform(0.1, 3.0, size=(40, 1, 1)) * np.eye(2), rng.uniform(0.1, 3.0, size=(40, 4))
    y = rng.normal(size=(40, 4))
    found = gr.extended_kalman(
        lambda x, u, t: MODEL.A @ x, lambda x, t: np.concatenate(MODEL.C) @ x, y, start=[0, 0],
        process_covariance=Q_t, measurement_variance=R_t,
    )  # fmt: skip
    plant = gr.VaryingModel(MODEL, process_covariance=Q_t, measurement_covariance=R_t)
    assert np.abs(found - gr.central_kalman(plant, y)).max() < 1e-8
    for given, words in (
        ({"process_covariance": Q_t[:30]}, "process_covariance: got 30 matrices over time, expected at least 40"),
        ({"measurement_variance": R_t[:30]}, "measurement_variance: got 30 x 4, expected 40 x 4"),
        ({"measurement_variance": -R_t}, "negative"),
        ({"measurement_variance": R_t[None]}, r"measurement_variance: got \(1, 40, 4\)"),
    ):
        asked: dict[str, Any] = {"process_covariance": Q_t, "measurement_variance": R_t, "start": [0, 0]} | given
        with pytest.raises(gr.InvalidInput, match=words):
            gr.extended_kalman(lambda x, u, t: x, lambda x, t: np.ones(4) * x[0], y, **asked)


def test_a_pendulum_against_filterpy() -> None:
    filterpy = pytest.importorskip("filterpy.kalman")
    _, y = swing()
    theirs = filterpy.ExtendedKalmanFilter(dim_x=2, dim_z=2)
    theirs.x, theirs.P, theirs.Q, theirs.R = np.array([1.0, 0.0]), np.eye(2) * 0.5, Q, np.diag(R)
    theirs.predict_x = lambda u=0: setattr(theirs, "x", pendulum(theirs.x, [], 0))
    expected = [theirs.x]
    for z in y:
        theirs.F = pendulum_jacobian(theirs.x, [], 0)
        theirs.predict()
        theirs.update(z, lambda x: bob_jacobian(x, 0), lambda x: bob(x, 0))
        expected.append(theirs.x)
    exact = {"f_jacobian": pendulum_jacobian, "h_jacobian": bob_jacobian}
    found = gr.extended_kalman(pendulum, bob, y, **ARGUMENTS, **exact)
    assert np.abs(found - np.array(expected)).max() < 1e-9


def test_a_linear_plant_is_the_central_filter() -> None:
    y = np.random.default_rng(1).normal(size=(30, 4))
    for screen in ({}, {"gate": 0.01}, {"huber": 1.345}):
        found = gr.extended_kalman(
            lambda x, u, t: MODEL.A @ x,
            lambda x, t: np.concatenate(MODEL.C) @ x,
            y,
            process_covariance=0.01,
            measurement_variance=0.04,
            start=[0, 0],
            **screen,
        )
        assert np.abs(found - gr.central_kalman(MODEL, y, **screen)).max() < 1e-8


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"f": lambda x, u, t: x[:1]}, "f: got 1 x 1, expected 2 x 1"),
        ({"h": lambda x, t: x * np.nan}, "h: got a number that is not finite"),
        ({"f": 3}, "f: got 3, expected a function"),
        ({"start": []}, "x0: got no number"),
        ({"f_jacobian": lambda x, u, t: np.eye(3)}, "f_jacobian: got 3 x 3, expected 2 x 2"),
        ({"h_jacobian": 1}, "h_jacobian: got 1"),
        ({"inputs": np.zeros((3, 1))}, "inputs: got 3 rows, expected 300"),
        ({"measurement_variance": [1, 2, 3]}, "measurement_variance: got 3 numbers, expected 2"),
        ({"process_covariance": np.eye(3)}, "process_covariance: got 3 x 3"),
        ({"gate": 2.0}, "gate: got 2"),
        ({"gate": 0.1, "huber": 1.0}, "gate and huber"),
    ],
)
def test_what_does_not_fit_is_refused(given: dict[str, Any], words: str) -> None:
    _, y = swing()
    with pytest.raises(gr.InvalidInput, match=words):
        gr.extended_kalman(**({"f": pendulum, "h": bob, "measurements": y} | ARGUMENTS | given))


def test_what_a_function_raises_is_its_owners() -> None:
    def broken(x: Any, u: Any, t: int) -> Any:
        raise ZeroDivisionError("mine")

    with pytest.raises(ZeroDivisionError, match="mine"):
        gr.extended_kalman(broken, bob, swing()[1], **ARGUMENTS)


@pytest.mark.parametrize("name", ["central_kalman", "local_kalman", "extended_kalman"])
@pytest.mark.parametrize("screen", [{}, {"huber": 1.0}])
def test_an_interrupt_ends_a_long_filter(name: str, screen: dict[str, float]) -> None:
    rng = np.random.default_rng(0)
    A, y = 0.98 * np.linalg.qr(rng.normal(size=(150, 150)))[0], rng.normal(size=(20_000, 20))
    H = np.eye(150)[:20]
    model = gr.Model(A, H, process_covariance=0.1, measurement_covariance=0.1)
    calls: dict[str, Callable[[], Any]] = {
        "central_kalman": lambda: gr.central_kalman(model, y, **screen),
        "local_kalman": lambda: gr.local_kalman(model, gr.Network.ring(20), y, **screen),
        "extended_kalman": lambda: gr.extended_kalman(
            lambda x, u, t: A @ x,
            lambda x, t: x[:20],
            y,
            process_covariance=0.1,
            measurement_variance=0.1,
            start=np.zeros(150),
            f_jacobian=lambda x, u, t: A,
            h_jacobian=lambda x, t: H,
            **screen,
        ),
    }
    before = signal.signal(signal.SIGALRM, signal.default_int_handler)
    signal.setitimer(signal.ITIMER_REAL, 0.3)
    started = time.monotonic()
    try:
        with pytest.raises(KeyboardInterrupt):
            calls[name]()
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
    assert time.monotonic() - started < 15  # the whole record takes minutes
