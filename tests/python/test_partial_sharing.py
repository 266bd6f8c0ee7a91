"""The partial-sharing filter from Python: attacks in simulate, bytes, resilience, the optimum against a solver."""

import garrison as gr
import numpy as np
import pytest
from garrison import partial_sharing as ps


def problem(seed: int = 0, agents: int = 6, states: int = 4) -> tuple[gr.Model, gr.Network]:
    rng = np.random.default_rng(seed)
    A = rng.normal(size=(states, states))
    A *= 0.9 / np.abs(np.linalg.eigvals(A)).max()
    C = [rng.normal(size=(states, states)) for _ in range(agents)]
    model = gr.Model(A, C, process_covariance=0.1 * np.eye(states), measurement_covariance=[np.eye(states)] * agents)
    return model, gr.Network.ring(agents)


def test_the_worst_attack_costs_what_the_analysis_says() -> None:
    model, net = problem()
    filt = gr.filters.PartialSharing(gain=0.3, shared=2, gains="steady")
    attack = gr.attacks.worst_covariance(model, net, filt, [1, 4], energy=40.0)
    assert attack.target == "message" and attack.agents == [1, 4]
    analysis = ps.Analysis(model, net, filt)
    honest = np.mean(analysis.periodic_mse())
    expected = honest + attack.gain / 6
    Sigma = analysis.spread([1, 4], attack.covariance)
    assert np.isclose(np.mean(analysis.periodic_mse(Sigma)), expected, rtol=1e-10)
    run = gr.simulate(model, net, filt, steps=2000, attack=attack, trials=8, seed=1)
    assert run.estimate is not None and run.truth is not None
    # The paper's errors are those of the predictions A z(t) of x(t + 1).
    error = run.estimate[:, 50:-1] @ model.A.T - run.truth[:, 51:, None, :]
    sampled = float((error**2).sum(axis=-1).mean())
    print(f"MSE sampled {sampled:.4f}, exact {expected:.4f}, without attack {honest:.4f}")
    assert abs(sampled - expected) < 0.05 * expected
    assert sampled > honest + 0.5 * (expected - honest)


def test_bytes_are_counted_and_half_the_entries_are_half_the_bytes() -> None:
    model, net = problem()
    for shared, payload in ((4, 12 * 4 * 8), (2, 12 * 2 * 8), (0, 12 * 4 * 8)):
        run = gr.simulate(model, net, gr.filters.PartialSharing(gain=0.1, shared=shared), steps=3)
        assert run.bytes_per_step == payload
    plain = gr.simulate(model, net, gr.filters.PartialSharing(gain=0.1, shared=1), steps=3, trials=9, keep=["estimate"])
    assert plain.bytes_per_step == 12 * 8
    message = gr.Agent(model, net, gr.filters.PartialSharing(gain=0.1, shared=3), 0).sense(1, [0.0] * 4)
    assert message is not None
    assert len(message.fields["shared"]) == 3
    assert len(message.body) == 3 * 8


def test_a_coordinated_attack_does_not_touch_honest_agents() -> None:
    model, net = problem()
    filt = gr.filters.PartialSharing(gain=0.3)
    v = np.ones(8) / np.sqrt(8)
    lie = gr.attacks.Coordinated(agents=[0, 3], covariance=(5.0 * np.outer(v, v)).ravel().tolist())
    honest = gr.simulate(model, net, filt, steps=1, seed=4)
    lied_to = gr.simulate(model, net, filt, steps=1, seed=4, attack=lie)
    assert honest.estimate is not None and lied_to.estimate is not None
    changed = np.abs(honest.estimate - lied_to.estimate)[0, 1].max(axis=1) > 0
    assert changed.tolist() == [False, True, True, False, True, True]  # the liars' neighbours on the ring


def test_resilience_per_byte() -> None:
    model, net = problem(3)
    rows = gr.resilience_per_byte(model, net, [0, 2], gain=0.3, energy=20.0)
    assert [r.shared for r in rows] == [1, 2, 3, 4]
    assert [r.bytes_per_step for r in rows] == [96, 192, 288, 384]
    assert all(r.mse < r.mse_attacked and r.radius < 1 for r in rows)
    unstable = gr.resilience_per_byte(model, net, [0], gain=500.0, energy=1.0, shared=[4])
    assert unstable[0].radius > 1 and unstable[0].mse == float("inf")


def test_optimal_covariance_against_a_semidefinite_solver() -> None:
    cvxpy = pytest.importorskip("cvxpy")
    for seed in range(3):
        model, net = problem(seed, agents=5, states=2)
        analysis = ps.Analysis(model, net, gr.filters.PartialSharing(gain=0.4, shared=1))
        for k in (None, 3):
            worst = analysis.worst([1, 3], 2.0, k)
            Sigma = cvxpy.Variable((4, 4), PSD=True)
            scale = 1.0 / np.abs(worst["form"]).max()
            task = cvxpy.Problem(
                cvxpy.Maximize(cvxpy.trace(Sigma @ (scale * worst["form"]))), [cvxpy.trace(Sigma) <= 2.0]
            )
            task.solve(solver=cvxpy.CLARABEL, tol_gap_abs=1e-11, tol_gap_rel=1e-11, tol_feas=1e-11, max_iter=200)
            assert abs(task.value / scale - worst["gain"]) <= 1e-8 * worst["gain"]


@pytest.mark.parametrize(
    ("params", "words"),
    [
        ({"gain": -1.0}, "gain"),
        ({"gain": float("nan")}, "gain"),
        ({"gain": 0.1, "shared": 5}, r"shared \(l\)"),
        ({"gain": 0.1, "shared_each": [1.0, 2.0]}, "one per agent"),
        ({"gain": 0.1, "selection": [0.5] * 24}, "0 or 1"),
        ({"gain": 0.1, "selection": [1.0] * 23}, "24: 4 zeros and ones for each agent"),
        ({"gain": 0.1, "start_covariance": [-1.0] + [0.0] * 15}, "semidefinite"),
        ({"gain": 0.1, "start_covariance": [1.0]}, "16, row by row"),
    ],
)
def test_bad_parameters(params: dict, words: str) -> None:
    model, net = problem()
    with pytest.raises(gr.InvalidInput, match=words):
        gr.simulate(model, net, gr.filters.PartialSharing(**params), steps=2)


def test_models_that_do_not_fit() -> None:
    _, net = problem()
    with pytest.raises(gr.InvalidInput, match="process_covariance"):
        gr.simulate(gr.Model(np.eye(2), [[[1.0, 0.0]]] * 6), net, gr.filters.PartialSharing(gain=0.1), steps=2)
    blind = gr.Model(
        np.diag([1.2, 0.5]),
        [[[0.0, 1.0]]] * 6,
        process_covariance=np.eye(2),
        measurement_covariance=[np.eye(1)] * 6,
    )
    filt = gr.filters.PartialSharing(gain=0.1)
    assert np.isfinite(gr.simulate(blind, net, filt, steps=30).estimate).all()  # a finite run is possible
    assert not gr.check(blind, net, filt).holds
    with pytest.raises(gr.InvalidInput, match="not detectable"):
        gr.attacks.worst_covariance(blind, net, filt, [0], energy=1.0)
    with pytest.raises(gr.InvalidInput, match="expected partial_sharing"):
        gr.attacks.worst_covariance(blind, net, gr.filters.ScalarGain(), [0], energy=1.0)
    model, _ = problem()
    with pytest.raises(gr.InvalidInput, match="another plant"):
        lie = gr.attacks.Coordinated(agents=[0], covariance=np.eye(3).ravel().tolist())
        gr.simulate(model, net, filt, steps=2, attack=lie)


def test_no_sensor_is_called_cleared() -> None:
    """It tests nothing, also before the first sample."""
    model = gr.Model(0.9, [1.0, 1.0, 1.0], process_covariance=0.1, measurement_covariance=0.2)
    run = gr.simulate(model, gr.Network.ring(3), gr.filters.PartialSharing(gain=0.1), steps=3)
    assert run.verdict is not None and not (run.verdict == gr.Verdict.CLEARED).any()
