"""Partial sharing whose gains follow a plant that changes: the paper's recursion, written once more in NumPy."""

from typing import Any

import garrison as gr
import numpy as np
import pytest

SEED = 20261201
STEPS = 40


def covariance(rng: Any, size: int, scale: float) -> Any:
    """Random and positive definite."""
    root = rng.normal(size=(size, size))
    return scale * (root @ root.T / max(size, 1) + 0.2 * np.eye(size))


class Problem:
    """A random plant of n states whose five matrices are others in every step, and a network of N agents."""

    def __init__(self, n: int, N: int, seed: int) -> None:
        rng = np.random.default_rng([SEED, n, N, seed])
        self.n, self.N, self.rng = n, N, rng
        self.rows = [int(rng.integers(1, n + 2)) for _ in range(N)]
        self.A = rng.normal(size=(STEPS, n, n)) * 0.7 / np.sqrt(n)
        self.C = [rng.normal(size=(STEPS, m, n)) for m in self.rows]
        self.Q = np.array([covariance(rng, n, 0.2) for _ in range(STEPS)])
        self.R = [np.array([covariance(rng, m, 1.0) for _ in range(STEPS)]) for m in self.rows]
        self.base = gr.Model(
            rng.normal(size=(n, n)) * 0.1,
            [rng.normal(size=(m, n)) for m in self.rows],
            process_covariance=covariance(rng, n, 3.0),
            measurement_covariance=[covariance(rng, m, 2.0) for m in self.rows],
        )
        self.plant = gr.VaryingModel(
            self.base, A=self.A, C=self.C, process_covariance=self.Q, measurement_covariance=self.R
        )
        self.network = gr.Network.ring(N)
        self.selection = rng.integers(0, 2, size=(N, n))
        self.start = rng.normal(size=n)

    def filter(self, gains: str = "varying", **other: Any) -> gr.Filter:
        """Of gain 0.1, variance 1.7 at the start."""
        given: dict[str, Any] = {"gain": 0.1, "selection": self.selection.ravel(), "shift": 1, "start_variance": 1.7}
        return gr.filters.PartialSharing(gains=gains, **given | other)

    def recursion(self, y: Any, given: bool = False, lost: Any = lambda t, i, j: False) -> Any:
        """(9) to (11) with the A, C, Q, R of every sample, as they are printed: with inverses."""
        n, gamma = self.n, 0.1
        ends = np.cumsum([0, *self.rows])
        z, filtered = np.tile(self.start, (self.N, 1)), [1.7 * np.eye(n)] * self.N
        out = [z]
        for t in range(STEPS):
            first = given and t == 0
            x = z if first else z @ self.A[t].T
            P = [F if first else self.A[t] @ F @ self.A[t].T + self.Q[t] for F in filtered]
            shared = np.roll(self.selection, t, axis=1)
            z, filtered = np.empty_like(x), []
            for i in range(self.N):
                H, R = self.C[i][t], self.R[i][t]
                e = y[t, ends[i] : ends[i + 1]] - H @ x[i]
                information = np.linalg.inv(P[i]) + H.T @ np.linalg.inv(R) @ H
                K = P[i] @ H.T @ np.linalg.inv(H @ P[i] @ H.T + R)
                heard = [j for j in self.network.neighbours(i) if not lost(t, i, j)]
                u = sum((shared[j] * (x[j] - x[i]) for j in heard), np.zeros(n))
                filtered.append(np.linalg.inv(information))
                z[i] = x[i] + K @ np.where(np.isnan(e), 0.0, e) + gamma * filtered[i] @ u
            out.append(z)
        return np.array(out)


@pytest.mark.parametrize("n", [1, 2, 3, 4, 8, 9])
@pytest.mark.parametrize("given", [False, True])
def test_gains_follow_the_matrices_of_every_sample(n: int, given: bool) -> None:
    for seed in range(3):
        p = Problem(n, int(5 + 3 * seed), seed)
        filt = p.filter(start_is_prediction=given)
        run = gr.simulate(p.plant, p.network, filt, steps=STEPS, seed=seed, start=p.start, noise="normal")
        assert np.allclose(run.estimate[0], p.recursion(run.measurements[0], given), rtol=1e-9, atol=1e-9)
        assert np.isnan(run.bound[0]).all() and (run.bound_kind[0, 1:] == gr.BoundKind.VARYING).all()
        constant = gr.replay(p.base, p.network, filt, measurements=run.measurements[0], start=p.start)
        assert not np.allclose(constant.estimate, run.estimate, atol=1e-3)


def test_missing_numbers_correct_nothing_and_leave_the_gains() -> None:
    p = Problem(3, 6, 7)
    y = p.rng.normal(size=(STEPS, sum(p.rows)))
    y[p.rng.random(y.shape) < 0.3] = np.nan
    run = gr.replay(p.plant, p.network, p.filter(), measurements=y, start=p.start)
    assert np.allclose(run.estimate[0], p.recursion(y), rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("parts", [("A",), ("C",), ("process_covariance",), ("measurement_covariance",), ("A", "C")])
def test_whatever_does_not_change_is_the_models(parts: tuple[str, ...]) -> None:
    p = Problem(3, 6, 1)
    model = p.base
    still: dict[str, Any] = {
        "A": np.repeat(model.A[None], STEPS, axis=0),
        "C": [np.repeat(c[None], STEPS, axis=0) for c in model.C],
        "process_covariance": np.repeat(model.process_covariance[None], STEPS, axis=0),
        "measurement_covariance": [np.repeat(r[None], STEPS, axis=0) for r in model.measurement_covariance],
    }
    changing = {"A": p.A, "C": p.C, "process_covariance": p.Q, "measurement_covariance": p.R}
    options: dict[str, Any] = {
        "steps": STEPS,
        "seed": 4,
        "start": p.start,
        "noise": "normal",
        "keep": ["estimate", "signals"],
    }
    filt = p.filter()
    few = gr.simulate(gr.VaryingModel(model, **{k: changing[k] for k in parts}), p.network, filt, **options)
    all_of_them = {k: changing[k] if k in parts else still[k] for k in still}
    every = gr.simulate(gr.VaryingModel(model, **all_of_them), p.network, filt, **options)
    assert np.array_equal(few.estimate, every.estimate) and np.array_equal(few.signals["trace"], every.signals["trace"])
    same = gr.simulate(gr.VaryingModel(model, **{k: still[k] for k in parts}), p.network, filt, **options)
    constant = gr.simulate(model, p.network, filt, **options)
    assert np.array_equal(same.estimate, constant.estimate)
    assert np.array_equal(same.signals["trace"], constant.signals["trace"])


def test_a_run_is_its_replay_and_its_agents_with_losses_and_inputs() -> None:
    p = Problem(4, 9, 2)
    parts = p.plant.parts
    driven = gr.Model(**{**p.base.__getstate__(), "B": np.ones((4, 1))})
    plant = gr.VaryingModel(driven, **parts)
    u = p.rng.normal(size=(STEPS, 1))
    filt = p.filter()
    options: dict[str, Any] = {"seed": 6, "start": p.start, "link": {"drop": 0.3}, "inputs": u}
    run = gr.simulate(plant, p.network, filt, steps=STEPS, noise="normal", **options)
    again = gr.replay(plant, p.network, filt, measurements=run.measurements[0], truth=run.truth[0], **options)
    assert np.array_equal(run.estimate, again.estimate) and np.array_equal(run.error, again.error)
    assert gr.again(run) == run

    options["link"] = {}
    perfect = gr.simulate(plant, p.network, filt, steps=STEPS, noise="normal", **options)
    agents = [gr.Agent(driven, p.network, filt, i) for i in range(p.N)]
    response = gr.Response(driven)
    ends = np.cumsum([0, *p.rows])
    for agent in agents:
        agent.reset(p.start)
    for t in range(STEPS):
        response.advance(u[t], A=p.A[t])
        sent = {}
        for i, agent in enumerate(agents):
            C = p.C[i][t]
            agent.vary(A=p.A[t], C=C, process_covariance=p.Q[t], measurement_covariance=p.R[i][t])
            sent[i] = agent.sense(t + 1, perfect.measurements[0, t, ends[i] : ends[i + 1]] - C @ response.state)
        for i, agent in enumerate(agents):
            agent.fuse([sent[j] for j in p.network.neighbours(i)])
            assert np.allclose(agent.estimate + response.state, perfect.estimate[0, t + 1, i], rtol=1e-12, atol=1e-12)
            assert agent.bound_kind == gr.BoundKind.VARYING


def test_gains_that_do_not_follow_refuse_and_name_those_that_do() -> None:
    p = Problem(2, 5, 3)
    for gains in ("frozen", "steady"):
        with pytest.raises(gr.InvalidInput, match=r'expected a constant plant for partial_sharing.*gains = "varying"'):
            gr.simulate(p.plant, p.network, p.filter(gains), steps=STEPS)
        with pytest.raises(gr.InvalidInput, match="designed for one plant"):
            gr.Agent(p.base, p.network, p.filter(gains), 0).vary(A=p.A[0])
    flat = [np.zeros((STEPS, m, m)) for m in p.rows]
    with pytest.raises(gr.InvalidInput, match=r"measurement_covariance\[0\] of agent 0 \(R\).*positive definite"):
        gr.simulate(gr.VaryingModel(p.base, measurement_covariance=flat), p.network, p.filter(), steps=STEPS)
    pendulum = gr.NonlinearModel(
        lambda X, u, t: 0.9 * X, lambda X, t: X[:, 0], states=2, outputs=[1] * 5, process_covariance=np.eye(2),
        measurement_covariance=1.0,
    )  # fmt: skip
    with pytest.raises(gr.InvalidInput, match="partial_sharing"):
        gr.simulate(pendulum, p.network, gr.filters.PartialSharing(gain=0.1, gains="varying"), steps=5)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"A": np.eye(3)}, "A: got 3 x 3, expected 2 x 2"),
        ({"C": np.full((1, 2), np.inf)}, "C: got inf, expected finite numbers"),
        ({"measurement_covariance": [[0.0]]}, "measurement_covariance: got a matrix that is not positive definite"),
        ({"process_covariance": -100 * np.eye(2)}, "process_covariance: got least eigenvalue -100"),
        ({"process_covariance": [[1, 5], [-5, 1]]}, "process_covariance: got a matrix that is not symmetric"),
        ({"measurement_covariance": [[-1.0]]}, "measurement_covariance: got least eigenvalue -1"),
        ({"measurement_covariance": np.eye(2)}, "measurement_covariance: got 2 x 2, expected 1 x 1"),
    ],
)
def test_an_agent_says_what_does_not_fit(given: dict[str, Any], words: str) -> None:
    model = gr.Model(np.eye(2), [[1, 0], [0, 1]], process_covariance=1.0, measurement_covariance=1.0)
    agent = gr.Agent(model, gr.Network.path(2), gr.filters.PartialSharing(gain=0.1, gains="varying"), 1)
    with pytest.raises(gr.InvalidInput, match=words):
        agent.vary(**given)
    agent.sense(1, [0.0])
    with pytest.raises(gr.InvalidInput, match="vary: got a call in round 0 of sample 1"):
        agent.vary()


def test_gains_that_freeze_take_a_plant_of_which_b_alone_changes() -> None:
    p = Problem(2, 5, 3)
    driven = gr.Model(**{**p.base.__getstate__(), "B": np.ones((2, 1))})
    options: dict[str, Any] = {"steps": STEPS, "inputs": np.ones((STEPS, 1)), "seed": 1}
    for gains in ("frozen", "steady", "varying"):
        B = np.ones((STEPS, 2, 1))
        one = gr.simulate(gr.VaryingModel(driven, B=B), p.network, p.filter(gains), **options)
        assert np.array_equal(one.estimate, gr.simulate(driven, p.network, p.filter(gains), **options).estimate)
        other = gr.simulate(gr.VaryingModel(driven, B=-B), p.network, p.filter(gains), **options)
        assert not np.allclose(one.truth, other.truth) and np.allclose(one.error, other.error)
