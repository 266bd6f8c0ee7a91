"""Bounds hold to the last digit: measurements without noise, large states, plants without noise."""

from typing import Any

import garrison as gr
import numpy as np
import pytest

SIZES = [1.0, 1e4, 1e8]


def system(rng: np.random.Generator, states: int, agents: int, process: float, **noise: Any) -> gr.Model:
    A = np.linalg.qr(rng.normal(size=(states, states)))[0] * rng.uniform(0.5, 1.02)
    rows = [row / np.linalg.norm(row) for row in rng.normal(size=(agents, 1, states))]
    return gr.Model(A, rows, process_bound=process, measurement_bound=0.0, **noise)


def beyond(run: gr.Run) -> int:
    return int((run.error > np.where(np.isfinite(run.bound), run.bound, np.inf)).sum())


@pytest.mark.parametrize("process", [0.0, 0.01])
@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("certificate", ["local", "flooded", "direct"])
def test_certificates(certificate: str, size: float, process: float) -> None:
    rng = np.random.default_rng(1)
    bounds = 0
    for seed in range(12):
        attacked = int(rng.integers(0, 2))
        states, agents = int(rng.integers(1, 4)), int(rng.integers(6, 10))
        model = system(rng, states, agents, process)
        run = gr.simulate(
            model,
            gr.Network.complete(agents) if seed % 2 else gr.Network.ring(agents),
            gr.filters.ScalarGain(),
            steps=60,
            x0=size * rng.normal(size=states),
            start=size * rng.normal(size=states),
            attack=gr.attacks.Bias([0], value=1.0) if attacked else (),
            link={"drop": 0.1} if seed % 3 == 0 else None,
            seed=seed,
            certificate=certificate,
            failure=0.0,
            attacked=attacked,
        )
        bounds += int(np.isfinite(run.bound).sum())
        assert beyond(run) == 0, seed
    assert bounds > 1000


@pytest.mark.parametrize("size", SIZES)
def test_certificates_with_hardly_any_gaussian_noise(size: float) -> None:
    rng = np.random.default_rng(2)
    for seed in range(12):
        model = system(rng, 2, 8, 0.0, measurement_covariance=1e-40, process_covariance=1e-40)
        run = gr.simulate(
            model,
            gr.Network.complete(8),
            gr.filters.ScalarGain(),
            steps=60,
            x0=size * rng.normal(size=2),
            seed=seed,
            certificate="flooded",
            failure=1e-6,
            attacked=seed % 2,
        )
        assert np.isfinite(run.bound).any()
        assert beyond(run) == 0, seed


@pytest.mark.parametrize("process", [0.0, 0.01])
@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("options", [{"table": True}, {"table": True, "detector": True}, {}])
def test_saturation(options: dict[str, Any], size: float, process: float) -> None:
    rng = np.random.default_rng(3)
    bounds = 0
    for seed in range(12):
        states, agents = int(rng.integers(1, 4)), int(rng.integers(6, 10))
        model = system(rng, states, agents, process)
        x0 = size * rng.normal(size=states)
        filt = gr.filters.Saturation(
            threshold=1.0, rounds=20, chebyshev=True, attacked=0, initial_error=1e-6, **options
        )
        run = gr.simulate(model, gr.Network.complete(agents), filt, steps=150, x0=x0, start=x0, seed=seed)
        bounds += int(np.isfinite(run.bound).sum())
        assert beyond(run) == 0, seed
        assert not run.accusations or not any(any(sets) for _, _, sets in run.accusations)
    assert bounds > 1000


@pytest.mark.parametrize("size", [1e3, 1e5, 1e6, 1e7])
def test_equal_sensors_of_large_states_do_not_refute_true_bounds(size: float) -> None:
    model = gr.Model([[1.0]], [[1.0]] * 11, process_bound=0.001, measurement_bound=0.0027)
    for detector in (False, True):
        filter = gr.filters.Saturation(threshold=0.5, rounds=12, attacked=2, initial_error=2.0, detector=detector)
        for seed in range(10):
            start = {"x0": [size], "start": [size], "noise": "extreme", "seed": seed}
            run = gr.simulate(model, gr.Network.complete(11), filter, steps=60, **start)
            assert not any("measurement_bound" in line for line in run.warnings), (seed, run.warnings)
