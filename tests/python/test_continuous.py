"""Model.from_continuous against closed forms and quadrature."""

import pickle
from typing import Any

import garrison as gr
import numpy as np
import pytest
from scipy import integrate, linalg


def test_constant_velocity_has_the_textbook_matrices() -> None:
    T, q = 0.7, 0.3
    model = gr.Model.from_continuous([[0, 1], [0, 0]], [[1, 0]], T, process_intensity=[[0, 0], [0, q]])
    assert np.allclose(model.A, [[1, T], [0, 1]], rtol=1e-14, atol=1e-15)
    expected = q * np.array([[T**3 / 3, T**2 / 2], [T**2 / 2, T]])
    assert np.allclose(model.process_covariance, expected, rtol=1e-13)


def test_a_decaying_state_has_its_stationary_variance() -> None:
    model = gr.Model.from_continuous([[-2.0]], [[1.0]], 1.5, process_intensity=3.0)
    assert model.A[0, 0] == pytest.approx(np.exp(-3.0), rel=1e-14)
    assert model.process_covariance[0, 0] == pytest.approx(3.0 * (1 - np.exp(-6.0)) / 4.0, rel=1e-13)  # type: ignore[index]


@pytest.mark.parametrize("seed", range(5))
def test_random_plants_against_quadrature(seed: int) -> None:
    rng = np.random.default_rng(seed)
    n = int(rng.integers(1, 6))
    F, root, T = rng.normal(size=(n, n)), rng.normal(size=(n, max(n - 1, 1))), float(rng.uniform(0.05, 1.5))
    Q = root @ root.T
    model = gr.Model.from_continuous(F, np.eye(n), T, process_intensity=Q)

    def rate(s: float) -> Any:
        e = linalg.expm(F * s)
        return e @ Q @ e.T

    expected, _ = integrate.quad_vec(rate, 0.0, T, epsabs=1e-13, epsrel=1e-13)
    assert np.allclose(model.A, linalg.expm(F * T), rtol=1e-12, atol=1e-13)
    assert np.allclose(model.process_covariance, expected, rtol=1e-10, atol=1e-12 * np.abs(expected).max())


def test_two_short_periods_make_a_long_one() -> None:
    F, Q = np.array([[0.0, 1.0], [-4.0, -0.3]]), np.diag([0.1, 0.4])
    short, whole = (gr.Model.from_continuous(F, [[1, 0]], T, process_intensity=Q) for T in (0.4, 0.8))
    covariance = short.A @ short.process_covariance @ short.A.T + short.process_covariance  # type: ignore[operator]
    assert np.allclose(short.A @ short.A, whole.A, rtol=1e-13)
    assert np.allclose(covariance, whole.process_covariance, rtol=1e-12)


def test_the_rest_is_as_in_model_and_it_simulates() -> None:
    names: dict[str, Any] = {"states": ["s", "v"], "units": {"s": "m", "v": "m/s"}}
    model = gr.Model.from_continuous(
        [[0, 1], [0, -1]], [[1, 0], [0, 1]], 0.1, process_bound=0.01, measurement_bound=0.02, **names
    )
    assert model.process_covariance is None and model.state_names == ["s", "v"] and model.units["v"] == "m/s"
    assert model == gr.Model(model.A, [[1, 0], [0, 1]], process_bound=0.01, measurement_bound=0.02, **names)
    assert pickle.loads(pickle.dumps(model)) == model
    run = gr.simulate(model, gr.Network.ring(2), gr.filters.ScalarGain(step=0.2), steps=30, x0=[0, 2], noise="none")
    exact = 2.0 * (1.0 - np.exp(-0.1 * np.arange(31)))
    assert np.allclose(run.truth[0, :, 0], exact, rtol=0, atol=1e-13)  # type: ignore[index]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"period": 0.0}, r"period: got 0, expected a finite number > 0"),
        ({"period": np.inf}, "period"),
        ({"A": [[1.0, 2.0]]}, "A: got 1 x 2, expected a square matrix"),
        ({"A": [[800.0]], "C": [[1.0]], "period": 9.0}, "take a shorter one"),
        ({"process_intensity": [[1.0]]}, r"process_intensity: got 1 x 1, expected 2 x 2"),
        ({"process_intensity": [[1.0, 2.0], [0.0, 1.0]]}, "symmetric"),
        ({"process_intensity": [[-1.0, 0.0], [0.0, 1.0]]}, "positive semidefinite"),
        ({"process_intensity": "x"}, "process_intensity"),
        ({"perod": 1.0}, "perod"),
    ],
)
def test_bad_input_is_refused_by_name(arguments: dict[str, Any], words: str) -> None:
    good: dict[str, Any] = {"A": [[0, 1], [0, 0]], "C": [[1, 0]], "period": 0.1}
    with pytest.raises(gr.InvalidInput, match=words):
        gr.Model.from_continuous(**good | arguments)
