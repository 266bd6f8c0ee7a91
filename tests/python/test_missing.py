"""Measurements that are missing: no bound is broken and nobody honest is proved, however many sensors say nothing."""

import garrison as gr
import numpy as np


def unit(row: np.ndarray) -> np.ndarray:
    return row / np.linalg.norm(row)


def test_more_missing_sensors_than_attacked_end_bounds_and_proofs() -> None:
    rng = np.random.default_rng(2)
    with_bound = without = 0
    for seed in range(200):
        agents, n = int(rng.integers(3, 8)), int(rng.integers(1, 3))
        model = gr.Model(
            np.eye(n) * rng.uniform(0.8, 1.02),
            [unit(rng.normal(size=(1, n))) for _ in range(agents)],
            process_bound=0.02,
            measurement_bound=0.1,
        )
        filt = gr.filters.Saturation(
            threshold=float(rng.uniform(0.5, 6)),
            rounds=int(rng.integers(1, 8)),
            attacked=int(rng.integers(0, 3)),
            initial_error=3.0,
            detector=bool(rng.integers(2)),
        )
        silent = gr.attacks.Denial(agents=list(range(agents)), probability=float(rng.uniform(0.02, 0.9)))
        run = gr.simulate(
            model, gr.Network.complete(agents), filt, steps=60, attack=silent, noise="extreme", seed=seed, x0=[2.0] * n
        )
        there = np.isfinite(run.bound)
        assert (run.error[there] <= run.bound[there] * (1 + 1e-12)).all(), seed
        assert not any(found for _, _, sets in run.accusations for found in sets), seed
        with_bound, without = with_bound + int(there[:, 1:].any()), without + int(not there[:, 1:].all())
    assert with_bound > 20
    assert without > 20


def test_the_run_says_which_sample_ended_the_bound() -> None:
    model = gr.Model([[1.0]], [[1]] * 3, process_bound=0.1, measurement_bound=0.1)
    filt = gr.filters.Saturation(threshold=1.0, rounds=3, attacked=0, initial_error=2.0)
    silent = gr.attacks.Denial(agents=[0, 1, 2], start=10)
    run = gr.simulate(model, gr.Network.complete(3), filt, steps=30, attack=silent, noise="extreme", seed=1)
    assert np.isfinite(run.bound[0, 9]).all()
    assert np.isnan(run.bound[0, 10:]).all()
    assert any("no measurement at sample 10" in line for line in run.warnings)
