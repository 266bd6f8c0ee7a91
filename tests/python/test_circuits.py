"""Runs name bounds of the noise that their own measurements refute, and no others."""

import garrison as gr
import numpy as np
import pytest

TOO_SMALL = "process_bound or measurement_bound is too small"


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


@pytest.mark.parametrize("detector", [False, True])
@pytest.mark.parametrize(
    ("agents", "states", "liars", "noise"),
    [(8, 1, 0, "extreme"), (6, 2, 1, "extreme"), (6, 2, 2, "extreme"), (9, 3, 1, "extreme"), (8, 2, 1, "uniform")],
)
def test_a_process_bound_that_is_a_quarter_too_small_is_named(
    agents: int, states: int, liars: int, noise: str, *, detector: bool
) -> None:
    rng = np.random.default_rng(3)
    filt = gr.filters.Saturation(threshold=2.0, rounds=3, attacked=liars, initial_error=3.0, detector=detector)
    for seed in range(5):
        model = system(rng, states, agents, process=0.2, told=0.02)
        y = recorded(model, filt, noise, seed, liars, moving=not detector)
        assert warned(told_otherwise(model, 0.75, 1.0), filt, y, TOO_SMALL), seed


def test_one_of_two_sensors_may_lie_but_not_both() -> None:
    model = gr.Model(1.0, [1.0, 1.0], process_bound=0.1, measurement_bound=0.1)
    filt = gr.filters.Saturation(threshold=2.0, rounds=3, attacked=1)
    rng = np.random.default_rng(0)
    honest, anything = rng.uniform(-0.1, 0.1, 50), rng.normal(0, 100, (50, 2))
    for y, named in ((np.stack([honest, anything[:, 0]], axis=1), False), (anything, True)):
        run = gr.replay(model, gr.Network.complete(2), filt, measurements=y)
        assert any("too small" in line for line in run.warnings) == named


def test_a_certificate_of_any_filter_names_bounds_that_are_too_small() -> None:
    rng = np.random.default_rng(4)
    network, certified = gr.Network.complete(7), {"certificate": "flooded", "failure": 0.0, "attacked": 1}
    for seed in range(5):
        model = system(rng, 2, 7, process=0.2, told=0.02)
        true = gr.simulate(model, network, gr.filters.ScalarGain(), steps=100, noise="extreme", seed=seed)
        for share, named in ((1.0, False), (0.75, True)):
            told = told_otherwise(model, share, 1.0)
            run = gr.replay(told, network, gr.filters.ScalarGain(), measurements=true.measurements[0], **certified)
            assert any(TOO_SMALL in line for line in run.warnings) == named, run.warnings


def test_outputs_of_one_source_lie_together() -> None:
    """Three receivers with two outputs each, one of which lies in both: one source, two measurements."""
    model = gr.Model(
        np.eye(2) * 0.9,
        [np.eye(2)] * 3,
        process_bound=0.1,
        measurement_bound=0.1,
        sources=["a", "a", "b", "b", "c", "c"],
    )
    network, filt = gr.Network.complete(3), gr.filters.ScalarGain()
    y = np.random.default_rng(0).uniform(-0.05, 0.05, (50, 6))
    for attacked, named in ((1, False), (0, True)):
        lie = y + np.array([5.0, -5.0, 0, 0, 0, 0])
        run = gr.replay(model, network, filt, measurements=lie, certificate="direct", failure=0.0, attacked=attacked)
        assert any("measurement_bound is too small" in line for line in run.warnings) == named


@pytest.mark.parametrize("noise", ["uniform", "extreme"])
def test_known_inputs_are_no_noise(noise: str) -> None:
    rng = np.random.default_rng(5)
    u = rng.normal(0, 10, (100, 1))
    filt, network = gr.filters.Saturation(threshold=2.0, rounds=3, attacked=1), gr.Network.complete(6)
    plain = system(rng, 2, 6, process=0.2, told=0.02)
    for share, named in ((1.0, False), (0.75, True)):
        made = [
            gr.Model(plain.A, plain.C, process_bound=0.2 * s, measurement_bound=0.02, B=[[1.0], [2.0]])
            for s in (1.0, share)
        ]
        true = gr.simulate(made[0], network, filt, steps=100, noise=noise, inputs=u)
        told = gr.replay(made[1], network, filt, measurements=true.measurements[0], inputs=u)
        assert any(TOO_SMALL in line for line in told.warnings) == named, told.warnings


@pytest.mark.parametrize("size", [1.0, 1e8])
def test_rounding_of_large_states_is_no_contradiction(size: float) -> None:
    rng = np.random.default_rng(6)
    filt, network = gr.filters.Saturation(threshold=2.0, rounds=3, attacked=1), gr.Network.complete(6)
    for seed in range(20):
        plain = system(rng, 2, 6, process=0.0, told=0.0)
        x0 = size * rng.normal(size=2)
        true = gr.simulate(plain, network, filt, steps=100, x0=x0, seed=seed)
        assert not any("too small" in line for line in true.warnings)
