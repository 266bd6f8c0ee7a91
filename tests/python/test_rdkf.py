"""The resilient distributed Kalman filter from Python: single steps, constants, warnings, refusals."""

from pathlib import Path

import garrison as gr
import numpy as np
import pytest
from garrison._core import rdkf as theory
from garrison.jobs import run_scenario, signal_size
from garrison.scenario import read_scenario
from hypothesis import given, settings
from hypothesis import strategies as st


def system(radius: float, agents: int = 5) -> tuple[gr.Model, gr.Network]:
    rng = np.random.default_rng(2)
    A = radius * np.linalg.qr(rng.normal(size=(3, 3)))[0]
    C = rng.normal(size=(agents, 2, 3))
    model = gr.Model(A, C, process_covariance=np.eye(3), measurement_covariance=[np.eye(2)] * agents)
    return model, gr.Network.ring(agents)


@settings(max_examples=60, deadline=None)
@given(
    seed=st.integers(0, 10_000),
    shape=st.tuples(st.integers(1, 6), st.integers(0, 8)),
    decade=st.floats(-6, 6),
    penalty=st.sampled_from(["norm", "huber", "l1"]),
)
def test_no_point_nearby_is_better(seed: int, shape: tuple[int, int], decade: float, penalty: str) -> None:
    rng = np.random.default_rng(seed)
    n, q = shape
    M, root = rng.normal(size=(q, n)), rng.normal(size=(n, n))
    Q = root @ root.T + 0.1 * np.eye(n)
    x0, b, weight = rng.normal(size=n), 10**decade * rng.normal(size=q), 10 ** rng.uniform(-2, 2)

    def cost(x: np.ndarray) -> float:
        r = b - M @ x
        size = float(np.linalg.norm(r))
        huber = size**2 if size <= weight / 2 else weight * size - weight**2 / 4
        price = {"norm": weight * size, "huber": huber, "l1": weight * float(np.abs(r).sum())}[penalty]
        return price + float((x - x0) @ Q @ (x - x0))

    x = theory.step(Q, M, b, x0, weight, penalty=penalty)["x"]
    best = cost(x)
    for _ in range(20):
        near = x + 10 ** rng.uniform(-6, 0) * (1 + np.linalg.norm(x)) * rng.normal(size=n)
        assert best <= cost(near) + 1e-11 * (abs(best) + weight * float(np.linalg.norm(b)))


def test_what_an_agent_reports() -> None:
    model, net = system(1.0)
    filt = gr.filters.Rdkf(weight=0.5)
    attack = gr.attacks.Bias(agents=[2], value=1e6, start=10)
    run = gr.simulate(model, net, filt, steps=30, noise="none", attack=attack, keep=["report", "signals"])
    assert run.statistic is not None and run.threshold is not None
    assert (run.statistic <= run.threshold * (1 + 1e-9) + 1e-12).all()
    assert run.limited(start=10)[2] == 1.0
    assert (run.signals["mu"][0, 10:, 2] > 0).all()
    assert run.warnings == []
    found = gr.check(model, net, filt)
    assert found.holds
    assert "no bound for persistent attacks: radius = " in str(found)


def test_a_majority_that_is_dragged_away_gives_a_warning() -> None:
    model, net = system(1.1)
    attack = gr.attacks.Bias(agents=[0, 1, 2, 3], value=1e6)
    run = gr.simulate(model, net, gr.filters.Rdkf(), steps=60, noise="none", attack=attack)
    assert len(run.warnings) == 1 and "plant is unstable" in run.warnings[0]


def test_every_agent_may_assume_its_own_process_noise() -> None:
    model, net = system(0.9)
    same = gr.Model(model.A, model.C, process_covariance=[np.eye(3)] * 5, measurement_covariance=[np.eye(2)] * 5)
    one = theory.Setting(model, net).steady_state()
    other = theory.Setting(same, net).steady_state()
    np.testing.assert_allclose(one.P, other.P, rtol=1e-12)


@pytest.mark.parametrize(
    ("params", "words"),
    [
        ({"weight": -1.0}, "lambda"),
        ({"weight": float("inf")}, "lambda"),
        ({"penalty": "l2"}, "norm, huber, l1, group"),
        ({"solver": "newton"}, "exact, ipopt"),
    ],
)
def test_refusals(params: dict[str, object], words: str) -> None:
    with pytest.raises(gr.InvalidInput, match=words):
        gr.filters.make_filter("rdkf", params)


def test_ipopt_is_refused_with_what_to_do_or_agrees() -> None:
    Q, M, b, x0 = np.eye(2), np.eye(2), np.array([5.0, 1.0]), np.zeros(2)
    if not theory.ipopt_available():
        with pytest.raises(gr.InvalidInput, match="coinor-libipopt-dev"):
            theory.step(Q, M, b, x0, 1.0, solver="ipopt")
        return
    exact = theory.step(Q, M, b, x0, 1.0)["x"]
    np.testing.assert_allclose(theory.step(Q, M, b, x0, 1.0, solver="ipopt")["x"], exact, atol=1e-6)


def test_wind_scenario(wind: Path) -> None:
    scenario = read_scenario(wind / "rdkf.toml")
    rows = {(r.label, r.attacked): r.summary for r in run_scenario(scenario)}
    signal = signal_size(scenario)
    assert signal is not None
    assert rows["rdkf, huber", True]["mean_error"] < 0.5 * rows["distributed Kalman, unprotected", True]["mean_error"]
    assert rows["central Kalman filter", True]["mean_error"] > 4 * signal
    pulled = rows["rdkf, huber", True]["limited"]
    assert set(sorted(pulled, key=lambda k: -pulled[k])[:3]) == {"DUB", "CLO", "ROS"}


def test_clarabel_finds_the_same_minimum() -> None:
    """Second-order cone form of (8) on 200 random problems from seed 20261125; needs the extra `lmi` or `bench`."""
    clarabel = pytest.importorskip("clarabel")
    sparse = pytest.importorskip("scipy.sparse")
    rng = np.random.default_rng(20261125)
    quiet = clarabel.DefaultSettings()
    quiet.verbose = False
    worst = 0.0
    for instance in range(200):
        n, q = (int(v) for v in rng.integers(1, 21, 2))
        M, root, x0 = rng.normal(size=(q, n)), rng.normal(size=(n, n)), rng.normal(size=n)
        Q = root @ root.T / n + 0.1 * np.eye(n)
        b = M @ x0 + (20.0, 1e-3, 1.0)[instance % 3] * rng.normal(size=q)
        weight = float(rng.uniform(0.1, 5.0))
        # min weight t + (x - x0)'Q(x - x0), |b - M x| <= t
        P = sparse.csc_matrix(np.triu(np.block([[2 * Q, np.zeros((n, 1))], [np.zeros((1, n + 1))]])))
        rows = sparse.csc_matrix(np.block([[np.zeros((1, n)), -np.ones((1, 1))], [M, np.zeros((q, 1))]]))
        cones = [clarabel.SecondOrderConeT(q + 1)]
        linear, right = np.append(-2 * Q @ x0, weight), np.append(0.0, b)
        found = np.array(clarabel.DefaultSolver(P, linear, rows, right, cones, quiet).solve().x[:n])
        theirs = weight * np.linalg.norm(b - M @ found) + (found - x0) @ Q @ (found - x0)
        ours = theory.step(Q, M, b, x0, weight)["objective"]
        assert ours <= theirs * (1 + 1e-12) + 1e-15
        worst = max(worst, (theirs - ours) / (1e-3 + ours))
    print(f"Clarabel's objective above ours by {worst:.1e} at most")
    assert worst < 1e-5
