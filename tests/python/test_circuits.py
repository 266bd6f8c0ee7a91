"""Runs name bounds of the noise that their own measurements refute, and no others."""

import garrison as gr
import numpy as np
import pytest


def system(rng: np.random.Generator, states: int, agents: int, *, process: float = 0.05, told: float = 0.1) -> gr.Model:
    rows = [row / np.linalg.norm(row) for row in rng.normal(size=(agents, 1, states))]
    A = np.linalg.qr(rng.normal(size=(states, states)))[0] * rng.uniform(0.8, 1.0)
    return gr.Model(A, rows, process_bound=process, measurement_bound=told)


def told_otherwise(model: gr.Model, process: float, measurement: float) -> gr.Model:
    bounds = np.asarray(model.measurement_bound) * measurement
    return gr.Model(model.A, model.C, process_bound=model.process_bound * process, measurement_bound=bounds)


def warned(model: gr.Model, filter: gr.Filter, y: np.ndarray, what: str) -> bool:
    run = gr.replay(model, gr.Network.complete(model.agents), filter, measurements=y)
    return any(what in line for line in run.warnings)


def recorded(model: gr.Model, filter: gr.Filter, noise: str, seed: int, liars: int, *, moving: bool) -> np.ndarray:
    """Measurements of the plant with lies of so many sensors, other ones in every sample where they move."""
    network = gr.Network.complete(model.agents)
    run = gr.simulate(model, network, filter, steps=200, noise=noise, seed=seed, keep=["measurements"])
    y, rng = np.array(run.measurements[0]), np.random.default_rng(seed)
    same = rng.permutation(model.agents)[:liars]
    for row in y:
        row[rng.permutation(model.agents)[:liars] if moving else same] += rng.normal(0, 10)
    y[rng.uniform(size=y.shape) < 0.1] = np.nan
    return y


@pytest.mark.parametrize("noise", ["extreme", "uniform"])
@pytest.mark.parametrize("detector", [False, True])
def test_bounds_that_hold_are_never_doubted(noise: str, detector: bool) -> None:
    rng = np.random.default_rng(1)
    for seed in range(40):
        agents, states = int(rng.integers(3, 14)), int(rng.integers(1, 4))
        model, liars = system(rng, states, agents), int(rng.integers(0, 3))
        filt = gr.filters.Saturation(threshold=2.0, rounds=3, attacked=liars, initial_error=3.0, detector=detector)
        y = recorded(model, filt, noise, seed, liars, moving=not detector)
        assert not warned(model, filt, y, "_bound"), seed


@pytest.mark.parametrize(("agents", "states", "liars"), [(8, 2, 1), (12, 2, 2), (12, 3, 1), (6, 1, 1)])
def test_bounds_of_the_measurements_that_are_a_quarter_too_small_are_named(
    agents: int, states: int, liars: int
) -> None:
    rng = np.random.default_rng(2)
    filt = gr.filters.Saturation(threshold=2.0, rounds=3, attacked=liars, initial_error=3.0)
    for seed in range(5):
        model = system(rng, states, agents)
        y = recorded(model, filt, "extreme", seed, 0, moving=False)
        assert warned(told_otherwise(model, 1.0, 0.75), filt, y, "measurement_bound")


def test_a_process_bound_that_is_too_small_is_named() -> None:
    rng = np.random.default_rng(3)
    filt = gr.filters.Saturation(threshold=2.0, rounds=3, attacked=0, initial_error=3.0)
    for seed in range(5):
        model = system(rng, 1, 8, process=0.2)
        y = recorded(model, filt, "extreme", seed, 0, moving=False)
        assert warned(told_otherwise(model, 0.75, 1.0), filt, y, "process_bound")
