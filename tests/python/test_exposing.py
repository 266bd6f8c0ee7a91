"""The witness as a detector: who lies, by the measurements of a sample alone."""

import garrison as gr
import numpy as np
import pytest


def plant(n: int, sensors: int, rng: np.random.Generator) -> gr.Model:
    C = rng.normal(size=(sensors, n))
    C /= np.linalg.norm(C, axis=1)[:, None]
    R = rng.uniform(0.01, 0.1, sensors)
    return gr.Model(0.9 * np.eye(n), C, process_covariance=np.eye(n), measurement_covariance=[[[r]] for r in R])


def sample(model: gr.Model, samples: int, rng: np.random.Generator) -> np.ndarray:
    C = np.vstack(model.C)
    sigma = np.sqrt([np.asarray(r).item() for r in model.measurement_covariance])
    x = 5.0 * rng.normal(size=(samples, C.shape[1]))
    return x @ C.T + sigma * rng.normal(size=(samples, len(C)))


@pytest.mark.parametrize("failure", [0.05, 1e-6])
@pytest.mark.parametrize("limit", [0, 1000])
def test_nobody_honest_is_accused_more_often_than_promised(failure: float, limit: int) -> None:
    false, samples, proofs = 0, 0, 0
    for seed in range(60):
        rng = np.random.default_rng(seed)
        s = int(rng.integers(0, 3))
        n = int(rng.integers(1, 3))
        model = plant(n, int(rng.integers(2 * s + n + 1, 10)), rng)
        y = sample(model, 10, rng)
        liars = rng.choice(model.agents, s, replace=False)
        y[:, liars] += rng.choice([0.5, 2.0, 20.0]) * rng.normal(size=(len(y), s))
        y[rng.random(y.shape) < 0.1] = np.nan
        found = gr.expose(model, y, attacked=s, failure=failure, fixed=True, limit=limit)
        assert limit > 0 or found.sets == 0
        honest = np.setdiff1d(np.arange(model.agents), liars)
        false += int(found.proved[:, honest].any())
        proofs += int(found.proved[-1].sum())
        samples += len(y)
    print(f"seeds 0..59: {false} of 60 records with a false proof, {samples} samples at {failure:g}, {proofs} proofs")
    assert false <= failure * samples + 4 * np.sqrt(failure * samples)
    assert proofs > 20


@pytest.mark.parametrize("failure", [0.05, 1e-6])
def test_liars_that_change_are_exposed_one_sample_at_a_time(failure: float) -> None:
    false, hits, samples = 0, 0, 0
    for seed in range(40):
        rng = np.random.default_rng(1000 + seed)
        model = plant(1, 9, rng)
        y = sample(model, 20, rng)
        liars = np.array([rng.choice(9, 2, replace=False) for _ in y])
        for t, who in enumerate(liars):
            y[t, who] += rng.choice([-1.0, 1.0], 2) * rng.uniform(0.0, 6.0)
        found = gr.expose(model, y, attacked=2, failure=failure)
        lying = np.zeros_like(found.proved)
        np.put_along_axis(lying, liars, True, axis=1)
        false += int((found.proved & ~lying).any(axis=1).sum())
        hits += int((found.proved & lying).sum())
        samples += len(y)
        assert found.sets == len(y) and not found.refuted.any()
    print(f"seeds 1000..1039: {false} of {samples} samples with a false proof at {failure:g}, {hits} proofs")
    assert false <= failure * samples + 4 * np.sqrt(failure * samples)
    assert hits > 0.3 * 2 * samples


def test_it_sees_what_the_detector_of_the_saturation_filter_does_not() -> None:
    sigma, N = 0.05, 12
    model = gr.Model(
        [[0.99]],
        np.ones((N, 1)),
        process_bound=0.5,
        measurement_bound=4 * sigma,
        process_covariance=[[0.01]],
        measurement_covariance=[[[sigma**2]]] * N,
    )
    network = gr.Network([(i, (i + k) % N) for i in range(N) for k in (1, 2, 3)], agents=N)
    filt = gr.filters.Saturation(threshold=1.0, rounds=10, attacked=3, initial_error=2.0, detector=True)
    lie = gr.attacks.Bias(agents=[1, 5, 6], value=1.0, start=10)
    told = {"steps": 60, "attack": lie, "seed": 4, "conditions": False}
    run = gr.simulate(model, network, filt, keep=["report", "measurements"], **told)
    assert run.first_accused() == {}
    found = gr.expose(model, run.measurements[0], attacked=3)
    assert set(found.first()) == {1, 5, 6}
    assert max(found.first().values()) <= 12


def test_more_liars_than_allowed_are_said_to_be_that() -> None:
    model = gr.Model([[1.0]], np.ones((5, 1)), process_covariance=[[1.0]], measurement_covariance=[[[0.01]]] * 5)
    found = gr.expose(model, [[0, 0, 0, 9, 9], [0, 0, 0, 0, 9], [0, 0, 0, 0, np.nan]], attacked=1)
    assert found.refuted.tolist() == [True, False, False]
    assert found.proved.tolist() == [[False] * 5, [False] * 4 + [True], [False] * 5]
    assert found.first() == {4: 1}


def test_sources_are_named_where_the_model_names_them() -> None:
    model = gr.Model(
        [[1.0]],
        np.ones((5, 1)),
        process_covariance=[[1.0]],
        measurement_covariance=[[[0.01]]] * 5,
        sources=["a", "a", "b", "c", "d"],
    )
    found = gr.expose(model, [[9, 9, 0, 0, 0]], attacked=1)
    assert found.sources == ["a", "b", "c", "d"] and found.first() == {"a": 0}


@pytest.mark.parametrize(
    ("change", "why"),
    [
        ({"measurements": [[0.0] * 4]}, "measurements"),
        ({"failure": 0.0}, "failure"),
        ({"attacked": -1}, "attacked"),
        ({"levels": (1.0,)}, "levels"),
        ({"limit": -1}, "limit"),
    ],
)
def test_bad_input_is_refused_by_name(change: dict, why: str) -> None:
    model = gr.Model([[1.0]], np.ones((5, 1)), process_covariance=[[1.0]], measurement_covariance=[[[0.01]]] * 5)
    told = {"measurements": [[0.0] * 5], "attacked": 1} | change
    with pytest.raises(gr.InvalidInput, match=why):
        gr.expose(model, told.pop("measurements"), **told)
    bare = gr.Model([[1.0]], np.ones((5, 1)))
    with pytest.raises(gr.InvalidInput, match="measurement_covariance"):
        gr.expose(bare, [[0.0] * 5], attacked=1)
