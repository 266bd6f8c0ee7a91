"""Covariances that change in time: simulated, weighed by Kalman filters, kept; what needs constant ones is refused."""

import pickle
from pathlib import Path
from typing import Any

import garrison as gr
import numpy as np
import pytest
from garrison.scenario import read_scenario

T = 40
NETWORK = gr.Network.complete(4)
ROWS: list[Any] = [[[1, 0]], [[0, 1], [1, 1]], np.zeros((0, 2)), [[1, -1]]]
MODEL = gr.Model(0.9 * np.eye(2), ROWS, process_covariance=0.01, measurement_covariance=0.04)
RNG = np.random.default_rng(11)
VARIANCES = 0.04 * RNG.uniform(0.1, 10.0, size=(T, 4))
Q_T = 0.01 * RNG.uniform(0.1, 10.0, size=(T, 1, 1)) * np.eye(2)


def blocks() -> list[Any]:
    """The same, one array per agent."""
    parts = [VARIANCES[:, :1], VARIANCES[:, 1:3], VARIANCES[:, :0], VARIANCES[:, 3:]]
    return [np.array([np.diag(row) for row in part]).reshape(T, part.shape[1], part.shape[1]) for part in parts]


def test_every_form_says_the_same() -> None:
    plant = gr.VaryingModel(MODEL, measurement_covariance=VARIANCES)
    below = plant.parts["measurement_covariance"]
    assert below.shape == (T, 4, 2) and np.array_equal(below[:, 2, 1], VARIANCES[:, 2]) and not below[:, 0, 1].any()
    given: list[dict[str, Any]] = [
        {"measurement_covariance": blocks()},
        {"measurement_covariance": below},
        {"measurement_covariance": lambda t: VARIANCES[t - 1], "steps": T},
        {"measurement_covariance": lambda t: [b[t - 1] for b in blocks()], "steps": T},
    ]
    for one in given:
        assert gr.VaryingModel(MODEL, **one) == plant
    assert pickle.loads(pickle.dumps(plant)) == plant
    same = gr.VaryingModel(MODEL, measurement_covariance=lambda t: 0.5, steps=T)
    assert np.array_equal(same.parts["measurement_covariance"][0], [[0.5, 0], [0.5, 0], [0, 0.5], [0.5, 0]])


def test_kalman_filters_weigh_every_sample_with_its_own() -> None:
    y = RNG.normal(size=(T, 4))
    plant = gr.VaryingModel(MODEL, process_covariance=Q_T, measurement_covariance=VARIANCES)
    x, P, expected = np.zeros(2), np.eye(2), [np.zeros(2)]
    C = np.concatenate([np.atleast_2d(c) for c in ROWS])
    for t in range(T):
        x, P = 0.9 * x, 0.81 * P + Q_T[t]
        K = P @ C.T @ np.linalg.inv(C @ P @ C.T + np.diag(VARIANCES[t]))
        x, P = x + K @ (y[t] - C @ x), (np.eye(2) - K @ C) @ P
        expected.append(x)
    found = gr.central_kalman(plant, y)
    assert np.abs(found - expected).max() < 1e-12
    assert np.abs(gr.local_kalman(plant, NETWORK, y)[:, 0] - expected).max() < 1e-12
    assert np.abs(gr.central_kalman(MODEL, y) - found).max() > 0.01
    bare = gr.Model(MODEL.A, ROWS)
    given = {"process_covariance": Q_T, "measurement_covariance": VARIANCES}
    assert np.array_equal(gr.central_kalman(gr.VaryingModel(bare, **given), y), found)


def test_noise_is_drawn_with_the_covariance_of_its_sample() -> None:
    model = gr.Model([[0.0]], [[[1.0], [1.0]], [[1.0]]], process_covariance=1e-12, measurement_covariance=1.0)
    steps = 4000
    pair = np.array([[1.0, 0.8], [0.8, 1.0]])
    late = np.arange(1, steps + 1) > 2000
    plant = gr.VaryingModel(
        model, measurement_covariance=lambda t: [pair if t > 2000 else np.eye(2), [[9.0 if t > 2000 else 1.0]]],
        steps=steps,
    )  # fmt: skip
    run = gr.simulate(plant, gr.Network.path(2), gr.filters.ScalarGain(), steps=steps, noise="normal")
    v = run.measurements[0]
    assert abs(np.corrcoef(v[late, 0], v[late, 1])[0, 1] - 0.8) < 0.05
    assert abs(np.corrcoef(v[~late, 0], v[~late, 1])[0, 1]) < 0.08
    assert 8 < np.var(v[late, 2]) < 10 and 0.9 < np.var(v[~late, 2]) < 1.1
    constant = gr.VaryingModel(model, measurement_covariance=np.ones((steps, 3)))
    again = gr.simulate(constant, gr.Network.path(2), gr.filters.ScalarGain(), steps=50, noise="normal")
    plain = gr.simulate(model, gr.Network.path(2), gr.filters.ScalarGain(), steps=50, noise="normal")
    assert np.array_equal(again.measurements, plain.measurements)


CERTIFIED: dict[str, Any] = {"steps": T, "noise": "normal", "certificate": "flooded", "attacked": 1, "x0": [2.0, 1.0]}
SEEN = gr.Model(0.9 * np.eye(2), np.tile(np.eye(2), (3, 1)), process_covariance=0.01, measurement_covariance=0.04)
RING = gr.Network.complete(6)


@pytest.mark.parametrize("memory", [False, True])
def test_certificates_hold_where_everything_changes(memory: bool) -> None:
    variances = 0.04 * RNG.uniform(0.05, 20.0, size=(T, 6))
    turns = 0.9 * np.array([[[np.cos(a), np.sin(a)], [-np.sin(a), np.cos(a)]] for a in np.linspace(0, 2, T)])
    plant = gr.VaryingModel(SEEN, A=turns, process_covariance=Q_T, measurement_covariance=variances)
    lies = gr.attacks.Bias(agents=[2], value=4.0, start=5)
    run = gr.simulate(
        plant, RING, gr.filters.ScalarGain(rounds=2), attack=lies, trials=5, memory=memory, seed=4, **CERTIFIED
    )
    assert np.isfinite(run.bound[:, 2:]).all() and (run.error[:, 1:] <= run.bound[:, 1:]).all()
    assert not (run.bound_kind == gr.BoundKind.RELAYED).any()
    assert (run.bound_kind == gr.BoundKind.MEMORY).any() == memory and gr.again(run) == run
    # The width follows the variances of the sample.
    plain = gr.VaryingModel(SEEN, measurement_covariance=np.where(np.arange(T) < 20, 1.0, 0.01)[:, None] * np.ones(6))
    run = gr.simulate(plain, RING, gr.filters.ScalarGain(rounds=2), **CERTIFIED)
    assert np.median(run.bound[0, 10:20]) > 3 * np.median(run.bound[0, 30:])


def test_filters_of_ones_own_are_told_the_noise_of_the_sample() -> None:
    told: list[Any] = []

    class Look(gr.Filter):
        rounds = 0

        def sense(self, agent: Any, state: Any, y: Any, t: int) -> Any:
            told.append((t, agent.id, agent.process_covariance, agent.measurement_variance))
            return {"estimate": state.estimate}

        def fuse(self, agent: Any, state: Any, inbox: Any, round: int) -> Any:
            return {"estimate": state.estimate}

    plant = gr.VaryingModel(MODEL, process_covariance=Q_T, measurement_covariance=VARIANCES)
    gr.simulate(plant, NETWORK, Look(), steps=T)
    own = np.split(VARIANCES, [1, 3, 3], axis=1)
    assert len(told) == 4 * T
    for t, agent, Q, R in told:
        assert np.array_equal(Q, Q_T[t - 1]) and np.array_equal(R, own[agent][t - 1])
    told.clear()
    gr.simulate(MODEL, NETWORK, Look(), steps=1)
    (Q, R) = next((Q, R) for _, agent, Q, R in told if agent == 1)
    assert np.array_equal(Q, 0.01 * np.eye(2)) and np.array_equal(R, [0.04, 0.04])
    told.clear()
    gr.simulate(gr.Model(MODEL.A, ROWS), NETWORK, Look(), steps=1)
    assert all(Q is None and (R is None or not R.size) for _, _, Q, R in told)


def test_families_for_constant_covariances_refuse_by_name() -> None:
    for changes in ({"process_covariance": Q_T}, {"measurement_covariance": np.ones((T, 6))}):
        plant = gr.VaryingModel(SEEN, **changes)
        for filt in (gr.filters.Structural(), gr.filters.Rdkf(), gr.filters.PartialSharing(gain=0.1)):
            with pytest.raises(gr.InvalidInput, match=f"covariances that change .* a constant plant for {filt.name}"):
                gr.simulate(plant, RING, filt, steps=T)
        gr.simulate(plant, RING, gr.filters.ScalarGain(), steps=T)


@pytest.mark.parametrize("suffix", [".npz", ".nc"])
def test_runs_keep_covariances(tmp_path: Path, suffix: str) -> None:
    if suffix == ".nc":
        pytest.importorskip("xarray")
    plant = gr.VaryingModel(MODEL, measurement_covariance=VARIANCES)
    run = gr.simulate(plant, NETWORK, gr.filters.ScalarGain(), steps=T, noise="normal")
    run.save(tmp_path / f"r{suffix}")
    again = gr.Run.load(tmp_path / f"r{suffix}")
    assert again == run == gr.again(again) and gr.VaryingModel(again.model, **again.varying) == plant


def test_scenarios_have_them(tmp_path: Path) -> None:
    listed = [[list(row) for row in block] for block in gr.VaryingModel(MODEL, measurement_covariance=VARIANCES).parts[
        "measurement_covariance"
    ]]  # fmt: skip
    np.savetxt(tmp_path / "below.csv", np.concatenate(listed), delimiter=",", fmt="%.17g")
    np.savetxt(tmp_path / "variances.csv", VARIANCES, delimiter=",", fmt="%.17g")
    runs = []
    for given in ('{ file = "variances.csv" }', '{ file = "below.csv" }', str(VARIANCES.tolist())):
        (tmp_path / "s.toml").write_text(
            f"""
[model]
A = [[0.9, 0.0], [0.0, 0.9]]
C = [[[1, 0]], [[0, 1], [1, 1]], [], [[1, -1]]]
process_covariance = 0.01
measurement_covariance = 0.04
measurement_covariance_over_time = {given}
[network]
kind = "complete"
[filter]
name = "scalar_gain"
[run]
steps = {T}
"""
        )
        scenario = read_scenario(tmp_path / "s.toml")
        assert scenario.plant == gr.VaryingModel(MODEL, measurement_covariance=VARIANCES)
        runs.append(scenario)
    with pytest.raises(gr.InvalidInput, match=r"model.*measurement_covariance_over_time: got shape \(2, 3\)"):
        (tmp_path / "s.toml").write_text((tmp_path / "s.toml").read_text().replace(given, "[[1, 1, 1], [1, 1, 1]]"))
        read_scenario(tmp_path / "s.toml")


@pytest.mark.parametrize(
    ("given", "words"),
    [
        (VARIANCES[:, :3], r"measurement_covariance: got \(40, 3\), expected \(steps, 4\) variances"),
        (blocks()[:3], "measurement_covariance"),
        ([*blocks()[:3], blocks()[1]], r"measurement_covariance\[3\]: got \(40, 2, 2\), expected \(40, 1, 1\)"),
        (np.ones((T, 4, 4)), r"got \(40, 4, 4\), expected \(steps, 4, 2\)"),
        (lambda t: [1.0, 2.0], r"measurement_covariance\(1\): got \(2,\)"),
        (lambda: 1.0, "a function of t"),
    ],
)
def test_covariances_that_do_not_fit_are_refused(given: Any, words: str) -> None:
    with pytest.raises(gr.InvalidInput, match=words):
        gr.VaryingModel(MODEL, measurement_covariance=given, steps=T)


@pytest.mark.parametrize(
    ("R", "words"),
    [
        (np.full((T, 4), -1.0), r"measurement_covariance\[0\] of agent 0: got least eigenvalue -1"),
        (np.ones((T, 4, 2)), r"measurement_covariance\[0\] of agent 0: got numbers right of its 1 column"),
    ],
)
def test_what_is_no_covariance_is_refused(R: Any, words: str) -> None:
    plant = gr.VaryingModel(MODEL, measurement_covariance=R)
    with pytest.raises(gr.InvalidInput, match=words):
        gr.simulate(plant, NETWORK, gr.filters.ScalarGain(), steps=T)
