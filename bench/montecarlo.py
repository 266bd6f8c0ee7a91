"""Monte Carlo: 100 trials x 500 samples x 30 agents, n = 4, L = 10, the same measurements for everybody."""

from collections.abc import Callable
from typing import Any

import garrison as gr
import numpy as np
from timing import Rows, Tasks, interleaved, summary, wall

TRIALS, STEPS, AGENTS, STATES, ROUNDS, BETA = 100, 500, 30, 4, 10, 0.5


def monte_carlo(repeats: int) -> Rows:
    rng = np.random.default_rng(0)
    net = next(n for n in (gr.Network.random_geometric(AGENTS, 0.3, s) for s in range(100)) if n.connected)
    C = rng.normal(size=(AGENTS, STATES))
    C /= np.linalg.norm(C, axis=1, keepdims=True)
    A = np.linalg.qr(rng.normal(size=(STATES, STATES)))[0] * 0.99
    model = gr.Model(A, C, process_bound=0.05, measurement_bound=0.05)
    l2, lmax = net.laplacian_spectrum()
    alpha = 2 / (l2 + lmax)
    filt = gr.filters.Saturation(threshold=BETA, rounds=ROUNDS)
    attack = gr.attacks.Scale(agents=[3, 8, 13, 21, 27], factor=3.0, start=50)
    given = gr.simulate(
        model, net, filt, steps=STEPS, trials=TRIALS, attack=attack, seed=1, keep=["estimate", "measurements"]
    )
    y = given.measurements
    W = np.eye(AGENTS) - alpha * net.laplacian()

    def ours(threads: int) -> gr.Run:
        return gr.replay(model, net, filt, measurements=y, keep=["estimate"], threads=threads, conditions=False)

    def end_to_end(threads: int) -> gr.Run:
        """Plant, noise and attack too, and the errors."""
        return gr.simulate(
            model,
            net,
            filt,
            steps=STEPS,
            trials=TRIALS,
            attack=attack,
            seed=1,
            keep=["estimate"],
            threads=threads,
            conditions=False,
        )

    def numpy_agents() -> np.ndarray:
        """Trial by trial, vectorised over agents: what a careful researcher writes first."""
        out = np.zeros((TRIALS, STEPS + 1, AGENTS, STATES))
        for k in range(TRIALS):
            x = np.zeros((AGENTS, STATES))
            for t in range(STEPS):
                x = x @ A.T
                h = y[k, t] - np.einsum("ij,ij->i", C, x)
                x = x + np.clip(h, -BETA, BETA)[:, None] * C
                for _ in range(ROUNDS):
                    x = W @ x
                out[k, t + 1] = x
        return out

    WL = np.linalg.matrix_power(W, ROUNDS)

    def numpy_batched() -> np.ndarray:
        """All trials at once, rounds as one precomputed matrix."""
        out = np.zeros((STEPS + 1, TRIALS, AGENTS, STATES))
        x = np.zeros((TRIALS, AGENTS, STATES))
        for t in range(STEPS):
            x = x @ A.T
            h = y[:, t] - np.einsum("ij,kij->ki", C, x)
            x = WL @ (x + np.clip(h, -BETA, BETA)[:, :, None] * C)
            out[t + 1] = x
        return out.transpose(1, 0, 2, 3)

    def right(estimates: np.ndarray) -> bool:
        return float(np.abs(estimates - given.estimate).max()) < 1e-9

    assert right(numpy_agents()) and right(numpy_batched()), "a NumPy peer disagrees"
    assert np.array_equal(ours(1).estimate, given.estimate), "replay and simulation disagree"
    rows: dict[str, Callable[[], float]] = {
        "ours, one thread": lambda: wall(lambda: ours(1)),
        "ours, all cores": lambda: wall(lambda: ours(0)),
        "ours, one thread, with own plant, noise and attack": lambda: wall(lambda: end_to_end(1)),
        "numpy vectorised over agents": lambda: wall(numpy_agents),
        "numpy batched over trials, W^L": lambda: wall(numpy_batched),
    }
    rows |= _jax_rows(y, A, C, W, WL, right)
    return summary(interleaved(rows, repeats), "ours, all cores")


def _jax_rows(
    y: Any, A: Any, C: Any, W: Any, WL: Any, right: Callable[[np.ndarray], bool]
) -> dict[str, Callable[[], float]]:
    """JAX vmap + scan, if it is installed (pip install jax)."""
    try:
        import jax
    except ImportError:
        print("JAX is not installed: its rows are left out (pip install jax)")
        return {}
    jax.config.update("jax_enable_x64", True)
    jnp = jax.numpy

    def program(M: Any, times: int) -> Any:
        def step(x: Any, yt: Any) -> tuple[Any, Any]:
            x = x @ A.T
            h = yt - (C * x).sum(axis=1)
            x = x + jnp.clip(h, -BETA, BETA)[:, None] * C
            for _ in range(times):
                x = M @ x
            return x, x

        def trial(yk: Any) -> Any:
            return jax.lax.scan(step, jnp.zeros((AGENTS, STATES)), yk)[1]

        return jax.jit(jax.vmap(trial))

    rows: dict[str, Callable[[], float]] = {}
    for name, M, times in (("L products", W, ROUNDS), ("W^L", WL, 1)):
        compiled = program(jnp.asarray(M), times)
        got = np.asarray(compiled(y))
        assert right(np.concatenate([np.zeros((TRIALS, 1, AGENTS, STATES)), got], axis=1)), "JAX disagrees"
        rows[f"JAX vmap + scan, {name}"] = lambda c=compiled: wall(lambda: c(y).block_until_ready())
    return rows


def tasks(repeats: int) -> Tasks:
    return {"monte carlo 100 x 500 x 30": lambda: monte_carlo(repeats)}
