"""Noise that is larger than a filter was told is named in the warnings; noise as told, and a few liars, are not."""

import garrison as gr
import numpy as np
import pytest
from scipy.linalg import solve_discrete_are

NET = gr.Network.complete(6)


def bounded(size: float) -> gr.Model:
    return gr.Model([[1.0, 0.1], [0.0, 0.9]], [[1, 0], [0, 1]] * 3, process_bound=0.02, measurement_bound=0.01 * size)


def gaussian(size: float) -> gr.Model:
    return gr.Model(
        [[1.0, 0.1], [0.0, 0.9]],
        [[1, 0], [0, 1]] * 3,
        process_covariance=0.02 * size**2,
        measurement_covariance=0.1 * size**2,
    )


@pytest.mark.parametrize("noise", ["uniform", "extreme"])
@pytest.mark.parametrize("detector", [True, False])
def test_bounds_told_a_quarter_too_small(noise: str, detector: bool) -> None:
    filt = gr.filters.Saturation(
        threshold=1.0, rounds=12, attacked=1, initial_error=2.0, chebyshev=True, detector=detector
    )
    liar = gr.attacks.Bias([1], value=3.0, start=50)
    for seed in range(3):
        for size, named in ((1.0, False), (4 / 3, True)):
            true = gr.simulate(
                bounded(size), NET, filt, steps=300, seed=seed, x0=[1, 1], start=[1, 0], noise=noise, attack=liar
            )
            assert true.measurements is not None
            told = gr.replay(bounded(1.0), NET, filt, measurements=true.measurements[0], start=[1, 0])
            assert any("measurement_bound is too small" in w for w in told.warnings) == named, told.warnings


def test_more_liars_than_told_are_named() -> None:
    filt = gr.filters.Saturation(threshold=1.0, rounds=12, attacked=1, initial_error=2.0)
    for agents, named in (([0], False), ([0, 1, 2], True)):  # 0 and 2 lie alike, and 4 measures the same
        attack = gr.attacks.Random(agents=agents, size=5.0, start=50)
        run = gr.simulate(bounded(1.0), NET, filt, steps=100, attack=attack, x0=[1, 1], start=[1, 0])
        assert any("or more of them lie" in w for w in run.warnings) == named


@pytest.mark.parametrize("detector", [True, False])
@pytest.mark.parametrize("model", ["pairs", "apart"])
def test_every_trial_of_a_run_is_looked_at(detector: bool, model: str) -> None:
    """The first trials are as told, a later one is not: its measurements are those of larger noise."""
    rows = [[1, 0], [0, 1]] * 3 if model == "pairs" else [[np.cos(k), np.sin(k)] for k in range(6)]

    def plant(size: float) -> gr.Model:
        return gr.Model([[1.0, 0.1], [0.0, 0.9]], rows, process_bound=0.02, measurement_bound=0.01 * size)

    filt = gr.filters.Saturation(
        threshold=1.0, rounds=12, attacked=1, initial_error=2.0, chebyshev=True, detector=detector
    )
    for trials in (3, 40):
        true = gr.simulate(plant(1.0), NET, filt, steps=80, trials=trials, x0=[1, 1], start=[1, 0])
        worse = gr.simulate(plant(3.0), NET, filt, steps=80, noise="extreme", x0=[1, 1], start=[1, 0])
        assert not any("is too small" in w for w in true.warnings)
        y = true.measurements.copy()  # type: ignore[union-attr]
        y[-1] = worse.measurements[0]  # type: ignore[index]
        said = [
            w for w in gr.replay(plant(1.0), NET, filt, measurements=y, start=[1, 0]).warnings if "is too small" in w
        ]
        assert len(said) == 1 and f"trial {trials - 1}; in 1 of {trials} trials" in said[0]


@pytest.mark.parametrize("options", [{}, {"window": 5}, {"test": "innovation"}, {"isolate": True}])
def test_covariances_told_too_small(options: dict[str, object]) -> None:
    filt = gr.filters.Structural(**options)
    liar = gr.attacks.Bias([3], value=50.0, start=300) if "isolate" in options else ()
    for seed in range(3):
        for size, named in ((1.0, False), (4 / 3, True)):
            true = gr.simulate(gaussian(size), NET, filt, steps=2000, seed=seed, noise="normal", attack=liar)
            assert true.measurements is not None
            told = gr.replay(gaussian(1.0), NET, filt, measurements=true.measurements[0])
            assert any("measurement_covariance is too small" in w for w in told.warnings) == named, told.warnings


@pytest.mark.parametrize("seed", range(40))
def test_singular_covariances_are_simulated(seed: int) -> None:
    """Q = G G' of any rank, as of white acceleration: rounding makes eigenvalues negative."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(2, 5))
    G = rng.normal(size=(n, rng.integers(1, n + 1))) * 10.0 ** rng.integers(-3, 3)
    model = gr.Model(0.9 * np.eye(n), list(rng.normal(size=(3, 1, n))), process_covariance=G @ G.T)
    noisy = gr.Model(model.A, model.C, process_covariance=G @ G.T, measurement_covariance=0.5)
    run = gr.simulate(noisy, gr.Network.complete(3), gr.filters.ScalarGain(), steps=200, start=np.zeros(n))
    assert np.isfinite(run.error).all() and np.isfinite(run.measurements).all()  # type: ignore[type-var]
    w = run.truth[0, 1:] - run.truth[0, :-1] @ np.asarray(model.A).T  # type: ignore[index]
    assert np.allclose(np.cov(w.T), G @ G.T, atol=0.6 * np.abs(G @ G.T).max())


@pytest.mark.parametrize(
    ("A", "Q", "mode"),
    [
        (np.diag([0.5, 1.0]), np.diag([1.0, 0.0]), "1"),
        (np.array([[1.0, 1.0], [0.0, 1.0]]), np.diag([1.0, 0.0]), "1"),  # a constant speed
        (np.array([[0.0, 1.0], [-1.0, 0.0]]), np.zeros((2, 2)), "1i"),
        (np.array([[0.6, 0.8], [-0.8, 0.6]]), np.zeros((2, 2)), "0.8i"),
        (np.diag([-1.0, 0.5]), np.diag([0.0, 1.0]), "-1"),
    ],
)
@pytest.mark.parametrize("design", ["auto", "riccati", "kalman", "h2"])
def test_a_mode_that_stays_and_that_no_noise_drives_has_no_steady_gain(
    A: np.ndarray, Q: np.ndarray, mode: str, design: str
) -> None:
    rows = [[[1.0, 0.3]]] * 3
    filt = gr.filters.Structural(design=design)
    model = gr.Model(A, rows, process_covariance=Q, measurement_covariance=1.0)
    with pytest.raises(gr.DesignInfeasible, match="drives no part of the mode") as refused:
        gr.prepare(model, gr.Network.complete(3), filt)
    assert mode in str(refused.value)
    little = gr.Model(A, rows, process_covariance=Q + 1e-4 * np.eye(2), measurement_covariance=1.0)
    run = gr.simulate(little, gr.Network.complete(3), filt, steps=4, noise="none")
    radius = next(c["value"] for c in gr.check(little, run.network, filt).conditions if "spectral" in c["name"])
    assert radius < 1.0 - 1e-3


def test_process_noise_of_low_rank_that_drives_all_modes_is_enough() -> None:
    for T in (1e-3, 1.0, 100.0):
        g = np.array([[T * T / 2], [T]])
        model = gr.Model(
            [[1.0, T], [0.0, 1.0]], [[[1.0, 0.0]]] * 2, process_covariance=g @ g.T, measurement_covariance=1.0
        )
        gr.prepare(model, gr.Network.complete(2), gr.filters.Structural())
    decays = gr.Model([[0.9, 0.1], [0.0, 0.99]], [[[1.0, 1.0]]] * 2, process_covariance=0.0, measurement_covariance=1.0)
    gr.prepare(decays, gr.Network.complete(2), gr.filters.Structural())


@pytest.mark.parametrize("q", [1e-8, 1e-10, 1e-12, 1e-14])
@pytest.mark.parametrize("A", [np.diag([0.5, 1.0]), np.array([[1.0, 1.0], [0.0, 1.0]]), np.array([[0.9, 0.1], [0, 1]])])
def test_gains_are_the_best_ones_where_one_state_has_little_noise_beside_another(A: np.ndarray, q: float) -> None:
    C, Q, R = np.array([[1.0, 1.0]]), np.diag([1.0, q]), np.array([[1.0 / 3.0]])
    P = solve_discrete_are(A.T, C.T, Q, R)
    expected = np.trace(P - P @ C.T @ np.linalg.solve(C @ P @ C.T + R, C @ P))
    model = gr.Model(A, [C] * 3, process_covariance=Q, measurement_covariance=1.0)
    check = gr.check(model, gr.Network.complete(3), gr.filters.Structural())
    found = next(c["value"] for c in check.quantities if c["name"] == "mean square error")
    assert found == pytest.approx(expected, rel=1e-6)  # of which most is that of the other state
    radius = next(c["value"] for c in check.conditions if "spectral" in c["name"])
    assert radius < 1.0 - 0.1 * np.sqrt(q)


@pytest.mark.parametrize("decay", [0.3, 0.9, 0.999])
def test_states_without_noise_that_decay_need_none(decay: float) -> None:
    model = gr.Model(
        np.diag([0.5, decay]), [[[1.0, 1.0]]] * 3, process_covariance=np.diag([1.0, 0.0]), measurement_covariance=1.0
    )
    assert gr.check(model, gr.Network.complete(3), gr.filters.Structural()).holds
    gr.prepare(model, gr.Network.complete(3), gr.filters.Structural())


def test_partial_sharing_does_not_blame_sensors_for_noise_that_is_missing() -> None:
    model = gr.Model(
        np.diag([0.5, 1.0]), [[[1.0, 1.0]]] * 3, process_covariance=np.diag([1.0, 0.0]), measurement_covariance=1.0
    )
    with pytest.raises(gr.InvalidInput, match="no process noise drives needs some"):
        gr.prepare(model, gr.Network.complete(3), gr.filters.PartialSharing(gain=0.1, gains="steady"))
    check = gr.check(model, gr.Network.complete(3), gr.filters.PartialSharing(gain=0.1))
    assert not check.holds
    assert "no noise drives a mode that stays" in check.conditions[0]["meaning"]
