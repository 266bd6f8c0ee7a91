"""Partial sharing: the step of all agents with its covariances, with frozen gains, and the periodic steady state.

m = 8 states, two measurements per agent, l = 4 shared entries, random geometric graph of mean degree 6. Agents measure
different things or, "sensors alike", all the same. A large network with frozen gains is as fast as memory: different
sensors and gains are 544 bytes per agent that have to be read in every step, those of like agents stay in the cache.
"""

import importlib.util
import time
from collections.abc import Callable
from typing import Any

import garrison as gr
import garrison_bench as peers
import numpy as np
from garrison import partial_sharing as ps
from timing import Rows, Tasks, cpu, interleaved, summary

STATES, OUTPUTS, SHARED, GAIN = 8, 2, 4, 0.05


class Task:
    """The same numbers for everybody."""

    def __init__(self, agents: int, steps: int, alike: bool) -> None:
        self.agents, self.steps = agents, steps
        rng = np.random.default_rng(0)
        A = np.linalg.qr(rng.normal(size=(STATES, STATES)))[0] * 0.98
        self.A, self.Q = A, 0.1 * np.eye(STATES)
        self.H = rng.normal(size=(agents, OUTPUTS, STATES))
        if alike:
            self.H[:] = self.H[0]
        self.R = np.tile(0.5 * np.eye(OUTPUTS), (agents, 1, 1))
        self.model = gr.Model(A, list(self.H), process_covariance=self.Q, measurement_covariance=list(self.R))
        self.net = gr.Network.random_geometric(agents, float(np.sqrt(6 / (np.pi * agents))), 0)
        self.y = rng.normal(size=(steps, agents, OUTPUTS))
        filt = gr.filters.PartialSharing(gain=GAIN, shared=SHARED, selection_seed=1)
        self.s0 = np.asarray(ps.Analysis(self.model, self.net, filt).selection.at(0))
        rows = self.H.reshape(-1, STATES), self.R[0]
        self.timed = {
            gains: peers.Sharing(A, rows[0], rows[1], self.Q, self.net.edges, self.s0, GAIN, gains)
            for gains in ("varying", "steady")
        }
        pairs = np.array([(i, j) for i in range(agents) for j in self.net.neighbours(i)]).reshape(-1, 2)
        self.receiver, self.sender = pairs[:, 0], pairs[:, 1]

    def ours(self, gains: str) -> tuple[float, np.ndarray]:
        """Seconds of the steps alone, and the last estimates, by one call into the library."""
        return self.timed[gains].run(self.y.reshape(self.steps, -1))

    def numpy(self, P: np.ndarray) -> np.ndarray:
        """All agents at once with batched products: (9), (10), (11) in Joseph form."""
        A, Q, H, R = self.A, self.Q, self.H, self.R
        x = np.zeros((self.agents, STATES))
        Ht = H.transpose(0, 2, 1)
        for k in range(self.steps):
            S = np.roll(self.s0, k, axis=1)
            PHt = P @ Ht
            K = (A @ PHt) @ np.linalg.inv(H @ PHt + R)
            F = A - K @ H
            FP = F @ P
            u = np.zeros_like(x)
            np.add.at(u, self.receiver, S[self.sender] * (x[self.sender] - x[self.receiver]))
            e = self.y[k] - np.einsum("nij,nj->ni", H, x)
            z = x @ A.T + np.einsum("nij,nj->ni", K, e) + GAIN * np.einsum("nij,nj->ni", FP, u)
            P = FP @ F.transpose(0, 2, 1) + K @ R @ K.transpose(0, 2, 1) + Q
            x = z
        return x


def _installed(module: str, package: str) -> bool:
    """Says so if not. Only a package that is not there: a name that it lacks is an error of ours."""
    if importlib.util.find_spec(module) is not None:
        return True
    print(f"{package} is not installed: its row is left out (pip install {package.lower().replace(' ', '')})")
    return False


def _jax(task: Task) -> Callable[[], np.ndarray] | None:
    """JAX vmap over agents, scan over samples, if it is installed."""
    if not _installed("jax", "JAX"):
        return None
    import jax

    jax.config.update("jax_enable_x64", True)
    jnp = jax.numpy
    A, Q, I2 = jnp.asarray(task.A), jnp.asarray(task.Q), OUTPUTS
    assert I2 == 2, "the inverse below is that of a 2 x 2 matrix"

    def one(P: Any, x: Any, H: Any, R: Any, y: Any, u: Any) -> Any:
        PHt = P @ H.T
        M = H @ PHt + R
        inverse = jnp.array([[M[1, 1], -M[0, 1]], [-M[1, 0], M[0, 0]]]) / (M[0, 0] * M[1, 1] - M[0, 1] * M[1, 0])
        K = A @ PHt @ inverse
        F = A - K @ H
        FP = F @ P
        return FP @ F.T + K @ R @ K.T + Q, A @ x + K @ (y - H @ x) + GAIN * (FP @ u)

    batched = jax.vmap(one)
    H, R, receiver, sender = (jnp.asarray(v) for v in (task.H, task.R, task.receiver, task.sender))
    s0 = jnp.asarray(task.s0)

    def step(carry: Any, input: Any) -> Any:
        P, x = carry
        k, y = input
        S = jnp.roll(s0, k, axis=1)
        u = jax.ops.segment_sum(S[sender] * (x[sender] - x[receiver]), receiver, task.agents)
        return batched(P, x, H, R, y, u), None

    def program(P: Any, y: Any) -> Any:
        x = jnp.zeros((task.agents, STATES))
        return jax.lax.scan(step, (P, x), (jnp.arange(task.steps), y))[0][1]

    compiled = jax.jit(program)
    P0 = jnp.tile(jnp.eye(STATES), (task.agents, 1, 1))
    y = jnp.asarray(task.y)
    return lambda: np.asarray(compiled(P0, y).block_until_ready())


def _alone(task: Task, agents: int) -> np.ndarray:
    """Estimates after one predict and update from N(0, I)."""
    P = task.A @ task.A.T + task.Q
    H, R = task.H[:agents], task.R[:agents]
    PHt = P @ H.transpose(0, 2, 1)
    K = PHt @ np.linalg.inv(H @ PHt + R)
    return np.einsum("nij,nj->ni", K, task.y[0, :agents])


def _filterpy(task: Task, agents: int) -> Callable[[], np.ndarray] | None:
    """FilterPy, agent by agent, predict and update only (it knows no consensus)."""
    if not _installed("filterpy", "FilterPy"):
        return None
    from filterpy.kalman import KalmanFilter

    filters = []
    for i in range(agents):
        f = KalmanFilter(dim_x=STATES, dim_z=OUTPUTS)
        f.F, f.Q, f.H, f.R = task.A, task.Q, task.H[i], task.R[i]
        filters.append(f)

    def run() -> np.ndarray:
        for i, f in enumerate(filters):
            f.x, f.P = np.zeros((STATES, 1)), np.eye(STATES)
            f.predict()
            f.update(task.y[0, i])
        return np.array([f.x[:, 0] for f in filters])

    return run


def _stonesoup(task: Task, agents: int) -> Callable[[], np.ndarray] | None:
    """Stone Soup, agent by agent, predict and update only."""
    if not _installed("stonesoup", "Stone Soup"):
        return None
    import datetime

    from stonesoup.models.measurement.linear import LinearGaussian
    from stonesoup.models.transition.linear import LinearGaussianTimeInvariantTransitionModel
    from stonesoup.predictor.kalman import KalmanPredictor
    from stonesoup.types.detection import Detection
    from stonesoup.types.hypothesis import SingleHypothesis
    from stonesoup.types.state import GaussianState
    from stonesoup.updater.kalman import KalmanUpdater

    start = datetime.datetime(2026, 1, 1)
    later = start + datetime.timedelta(seconds=1)
    predictor = KalmanPredictor(
        LinearGaussianTimeInvariantTransitionModel(transition_matrix=task.A, covariance_matrix=task.Q)
    )
    updaters = []
    for i in range(agents):
        H = task.H[i]

        class Rows(LinearGaussian):
            rows = H

            @property
            def ndim_meas(self) -> int:
                return OUTPUTS

            def matrix(self, **_: Any) -> np.ndarray:
                return self.rows

        model = Rows(ndim_state=STATES, mapping=tuple(range(OUTPUTS)), noise_covar=task.R[i])
        state = GaussianState(np.zeros((STATES, 1)), np.eye(STATES), timestamp=start)
        updaters.append((KalmanUpdater(model), model, state, task.y[0, i][:, None]))

    def run() -> np.ndarray:
        estimates = []
        for updater, model, state, y in updaters:
            prediction = predictor.predict(state, timestamp=later)
            detection = Detection(y, timestamp=later, measurement_model=model)
            estimates.append(updater.update(SingleHypothesis(prediction, detection)).mean)
        return np.array(estimates, dtype=float)[:, :, 0]

    return run


def steps(agents: int, count: int, repeats: int, alike: bool = False) -> Rows:
    task = Task(agents, count, alike)
    P0 = np.tile(np.eye(STATES), (agents, 1, 1))
    _, expected = task.ours("varying")
    got = task.numpy(P0)
    assert np.abs(expected @ task.A.T - got).max() < 1e-9 * np.abs(got).max(), "NumPy disagrees"
    per = 1.0 / (agents * count)  # seconds per agent-step; the tables then read ms = 1e6 ns
    rows: dict[str, Callable[[], float]] = {
        "ours, covariance step": lambda: task.ours("varying")[0] * per,
        "ours, frozen gains": lambda: task.ours("steady")[0] * per,
        "numpy batched": lambda: cpu(lambda: task.numpy(P0)) * per,
    }
    jax = _jax(task)
    if jax is not None:
        assert np.abs(jax() - got).max() < 1e-9 * np.abs(got).max(), "JAX disagrees"
        rows["JAX vmap + scan"] = lambda: cpu(jax) * per
    few = min(agents, 256)
    one_at_a_time = {"FilterPy, predict and update": _filterpy, "Stone Soup, predict and update": _stonesoup}
    for name, make in () if alike else one_at_a_time.items():  # sensors that are alike make no difference to these
        peer = make(task, few)
        if peer is not None:
            assert np.abs(peer() - _alone(task, few)).max() < 1e-9, f"{name} disagrees"
            rows[name] = lambda peer=peer: cpu(peer) / few
    table = summary(interleaved(rows, repeats), "ours, covariance step")
    for row in table:
        row["row"] += f": {1e6 * row['ms']:.0f} ns per agent-step"
    return table


def steady(repeats: int) -> Rows:
    """The paper's model: 25 agents, m = 8, l = 4, 8 phases."""
    A = np.kron([[0.6, 0.005], [0.25, 0.6]], np.eye(4))
    H = np.kron([[1, 1, 0, 0], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 1, 1]], np.eye(2))
    mu = np.random.default_rng(1).uniform(0, 1, 25)
    model = gr.Model(
        A, [H] * 25, process_covariance=0.1 * np.eye(8), measurement_covariance=[m * np.eye(8) for m in mu]
    )
    net = gr.Network.random_geometric(25, 0.33, 1)
    filt = gr.filters.PartialSharing(gain=0.1, shared=4)

    def solve() -> float:
        start = time.perf_counter()
        ps.Analysis(model, net, filt).periodic_mse()
        return time.perf_counter() - start

    analysis = ps.Analysis(model, net, filt)
    phases = analysis.periodic_covariance()
    long = analysis.error_covariance(400)["nmse"]
    assert abs(long[-1] - np.trace(phases[0])) < 1e-9 * long[-1], "the recursion settles elsewhere"

    def iterate() -> float:
        start = time.perf_counter()
        analysis.error_covariance(400)
        return time.perf_counter() - start

    rows = {"ours, monodromy and doubling": solve, "ours, 400 steps of (29)": iterate}
    return summary(interleaved(rows, repeats), "ours, monodromy and doubling")


def tasks(repeats: int) -> Tasks:
    small, large = (1024, 60, repeats), (100_000, 12, max(3, repeats // 2))
    return {
        "partial sharing N=1024 m=8 l=4": lambda: steps(*small),
        "partial sharing N=1024 m=8 l=4, sensors alike": lambda: steps(*small, alike=True),
        "partial sharing N=100000 m=8 l=4": lambda: steps(*large),
        "partial sharing N=100000 m=8 l=4, sensors alike": lambda: steps(*large, alike=True),
        "partial sharing periodic steady state": lambda: steady(repeats),
    }
