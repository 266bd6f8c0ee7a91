"""Measurements that are missing: no bound is broken and nobody honest is proved, however many sensors say nothing."""

import garrison as gr
import numpy as np
import pytest


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


def test_all_that_is_left_out_is_let_in_again_within_sixty_samples() -> None:
    """A jam, then a lie of all sensors, then the truth: with nobody honest left, nothing speaks for the estimate."""
    for agents, jump in ((1, 100.0), (1, 2000.0), (3, 2000.0)):
        model = gr.Model(
            [[1.0, 1.0], [0.0, 1.0]],
            [[[1.0, 0.0]]] * agents,
            process_covariance=[[1 / 3, 1 / 2], [1 / 2, 1.0]],
            measurement_covariance=100.0,
        )
        network = gr.Network.complete(agents) if agents > 1 else gr.Network([], agents=1)
        filt = gr.filters.Structural(false_alarm=1e-4, test="innovation", isolate=True)
        for seed in range(3):
            y = np.asarray(gr.simulate(model, network, filt, steps=700, seed=seed, keep=["measurements"]).measurements)[
                0
            ]
            y[300:340] = np.nan
            y[340:500] += (jump + 5.0 * np.arange(160))[:, None]
            verdict = gr.replay(model, network, filt, measurements=y).verdict[0, 1:]
            accused = (verdict == gr.Verdict.ATTACKED).any(axis=1)
            assert jump < 1000 or accused[340], (agents, jump, seed)
            assert accused[500:].any()
            assert not accused[560:600].any(), (agents, jump, seed)


@pytest.mark.parametrize("jump", [300.0, 3e3, 3e4])
@pytest.mark.parametrize(("positions", "speeds"), [(1, 1), (1, 3), (3, 1)])
def test_a_necessary_sensor_is_back_within_sixty_samples_of_a_jump(positions: int, speeds: int, jump: float) -> None:
    """Nobody else sees where it is: a lie that lasts is followed after a while, but the way back is short."""
    A = np.array([[1.0, 1.0], [0.0, 1.0]])
    C = np.array([[1.0, 0.0]] * positions + [[0.0, 1.0]] * speeds)
    deviations = np.array([1.0] * positions + [0.5] * speeds)
    model = gr.Model(
        A, C, process_covariance=[[1e-4, 0.0], [0.0, 1e-2]], measurement_covariance=(deviations**2).tolist()
    )
    filt = gr.filters.Structural(false_alarm=1e-4, isolate=True)
    rng = np.random.default_rng(1)
    x, states, y = np.zeros(2), [], []
    for t in range(700):
        x = A @ x + rng.normal(size=2) * [1e-2, 1e-1]
        states.append(x)
        y.append(C @ x + rng.normal(size=len(C)) * deviations)
        if 200 <= t < 500:
            y[-1][:positions] += jump
    run = gr.replay(model, gr.Network.complete(len(C)), filt, measurements=np.array(y))
    accused = (run.verdict[0, 1:, :positions] == gr.Verdict.ATTACKED).any(axis=1)
    error = np.abs(run.estimate[0, 1:, :, 0] - np.array(states)[:, None, 0]).max(axis=1)
    assert not accused[50:200].any()
    assert accused[200]
    assert error[200:230].max() < 10.0  # not followed at once
    assert error[499] > jump / 2.0  # but in the end
    assert accused[500]
    assert not accused[530:].any()
    assert error[560:].max() < 10.0
    assert any("alone sees a mode" in w for w in run.warnings) == (positions == 1)


@pytest.mark.parametrize(
    ("link", "told"), [({}, False), ({"delay": 0.3, "delay_rounds": 4}, True), ({"drop": 0.5}, True)]
)
def test_bounds_and_tests_that_end_with_a_lost_message_are_told(link: dict[str, float], told: bool) -> None:
    C = [np.eye(2)[[i % 2]] for i in range(8)]
    model = gr.Model(0.95 * np.eye(2), C, process_bound=0.01, measurement_bound=0.01)
    filt = gr.filters.Saturation(threshold=1.0, rounds=12, attacked=1, initial_error=2.0, detector=True)
    run = gr.simulate(model, gr.Network.complete(8), filt, steps=60, link=link)
    assert any("no sensor is tested after sample" in line for line in run.warnings) == told


@pytest.mark.parametrize("positions", [1, 2])
@pytest.mark.parametrize("jump", [300.0, 3e4, 3e6])
def test_the_first_way_back_is_short_where_nobody_else_tells(positions: int, jump: float) -> None:
    """One jump that nothing comes back from: it is not followed at once, but within sixty samples, however far.

    With a second position sensor that stays right it is never followed.
    """
    A = np.array([[1.0, 1.0], [0.0, 1.0]])
    C = np.array([[1.0, 0.0]] * positions + [[0.0, 1.0]])
    deviations = np.array([1.0] * positions + [0.5])
    model = gr.Model(
        A, C, process_covariance=[[1e-4, 0.0], [0.0, 1e-2]], measurement_covariance=(deviations**2).tolist()
    )
    rng = np.random.default_rng(3)
    x, y = np.zeros(2), []
    for t in range(400):
        x = A @ x + rng.normal(size=2) * [1e-2, 1e-1]
        y.append(C @ x + rng.normal(size=len(C)) * deviations)
        y[-1][0] += jump if t >= 200 else 0.0
    filt = gr.filters.Structural(false_alarm=1e-6, isolate=True)
    run = gr.replay(model, gr.Network.complete(len(C)), filt, measurements=np.array(y))
    accused = run.verdict[0, 1:, 0] == gr.Verdict.ATTACKED
    assert not accused[:200].any()
    assert accused[200:230].all()
    assert accused[260:].any() == (positions == 2)
    assert accused[260:].all() == (positions == 2)
