"""gr.certify: regions hold whatever the liars say, and say where there is none."""

import garrison as gr
import numpy as np
import pytest
from garrison.certifying.plant import Plant

Array = np.ndarray


def double_integrator(positions: int = 6, sources: list[str] | None = None) -> gr.Model:
    """Section 11 of the tables in docs/certificates.md: period .1, acceleration .5, positions 1."""
    dt = 0.1
    push = 0.5 * np.array([[dt * dt / 2], [dt]])
    return gr.Model(
        [[1, dt], [0, 1]],
        [[[1.0, 0.0]]] * positions,
        process_covariance=push @ push.T,
        measurement_covariance=1.0,
        sources=sources,
    )


def record(model: gr.Model, samples: int, seed: int) -> tuple[Array, Array]:
    """States and measurements of a plant from a random start."""
    rng = np.random.default_rng(seed)
    Q = np.asarray(model.process_covariance)
    values, vectors = np.linalg.eigh(Q)
    root = vectors * np.sqrt(np.maximum(values, 0.0))
    x, states, rows = rng.normal(size=model.states), [], []
    for _ in range(samples):
        x = np.asarray(model.A) @ x + root @ rng.normal(size=model.states)
        states.append(x)
        noise = [np.linalg.cholesky(R) @ rng.normal(size=len(R)) for R in model.measurement_covariance]
        rows.append(np.concatenate([C @ x + v for C, v in zip(model.C, noise, strict=True)]))
    return np.array(states), np.array(rows)


def inside(found: gr.Certified, x: Array) -> bool:
    there = found.answered
    return bool((np.abs(found.center - x)[there] <= found.box[there]).all())


@pytest.mark.parametrize(("lie", "box", "proved"), [(0.0, 1.09, 0), (2.0, 1.51, 0), (60.0, 0.95, 2)])
def test_positions_of_a_moving_body_are_certified_within_the_figures_of_the_docs(
    lie: float, box: float, proved: int
) -> None:
    model = double_integrator()
    x, y = record(model, 300, 1)
    y[:, :2] += lie
    found = gr.certify(model, y, attacked=2)
    assert found.method == "bank"
    assert inside(found, x)
    assert found.answered[1:].all()
    assert not found.answered[0]  # one position is no speed
    # Levels here are for all samples together, those of the docs for one: 5 % wider.
    assert np.median(found.box[100:, 0]) == pytest.approx(box, rel=0.12)
    assert len(found.proved[-1]) == proved
    assert found.steady is not None
    assert (np.median(found.box[100:], axis=0) <= found.steady).all()


def test_no_region_where_nobody_can_tell() -> None:
    model = double_integrator(positions=4)
    _, y = record(model, 60, 2)
    found = gr.certify(model, y, attacked=2)  # two against two
    assert found.steady is not None
    assert np.isinf(found.steady).all()
    same = gr.certify(double_integrator(6, ["receiver"] * 6), record(double_integrator(), 60, 2)[1], attacked=1)
    assert not same.answered.any()  # six numbers, one source
    assert np.isinf(same.radius).all()
    assert "a region at 0 of 60 samples" in str(same)


@pytest.mark.parametrize("method", ["bank", "window"])
def test_regions_hold_on_random_plants_with_losses_and_any_lies(method: str) -> None:
    rng = np.random.default_rng(3)
    answered = violated = innocent = 0
    for k in range(60):
        n, agents = int(rng.integers(1, 4)), int(rng.integers(3, 8))
        A = np.linalg.qr(rng.normal(size=(n, n)))[0] * rng.uniform(0.8, 1.05)
        outputs = [int(rng.integers(1, 3)) for _ in range(agents)]
        roots = [rng.normal(size=(m, m)) for m in outputs]
        model = gr.Model(
            A,
            [rng.normal(size=(m, n)) for m in outputs],
            process_covariance=0.1 * np.eye(n),
            measurement_covariance=[L @ L.T + 0.1 * np.eye(len(L)) for L in roots],
            sources=[f"s{i}" for i, m in enumerate(outputs) for _ in range(m)],
        )
        x, y = record(model, 40, 100 + k)
        s = int(rng.integers(0, (agents + 1) // 2))
        first = np.concatenate([[0], np.cumsum(outputs)])
        liars = rng.choice(agents, size=s, replace=False)
        for i in liars:
            y[5:, first[i] : first[i + 1]] += rng.choice([0.5, 3.0, 100.0]) * rng.normal()
        y[rng.uniform(size=y.shape) < 0.2] = np.nan
        found = gr.certify(model, y, attacked=s, method=method, window=8)
        answered += int(found.answered.sum())
        violated += int(not inside(found, x))
        innocent += len({name for some in found.proved for name in some} - {f"s{i}" for i in liars})
        assert not found.refuted.any()
    assert answered > 1000
    assert violated == 0
    assert innocent == 0


def test_windows_search_where_there_are_too_many_sets_of_liars() -> None:
    rng = np.random.default_rng(11)
    model = gr.Model(
        np.linalg.qr(rng.normal(size=(3, 3)))[0],
        rng.normal(size=(16, 3)),
        process_covariance=0.01 * np.eye(3),
        measurement_covariance=1.0,
    )
    x, y = record(model, 30, 11)
    y[:, [2, 7, 11, 12]] += [4.0, -6.0, 50.0, 3.0]
    found = gr.certify(model, y, attacked=4, method="window", window=6)
    assert found.rule == "A, 20 leaves"  # of 1820 sets
    assert "window (A, 20 leaves)" in str(found)
    assert inside(found, x)
    assert found.answered[5:].all()
    assert {name for some in found.proved for name in some} <= {f"agent {i}" for i in (2, 7, 11, 12)}
    levels = gr.certificate.window_levels(1e-6, 6 * 16, 3)
    window = Plant(model).window(y[-6:], np.zeros((6, model.states)))
    assert found.radius[-1] < 0.7 * gr.certificate.leverage_window(window, 4, *levels).radius
    small = gr.certify(model, y, attacked=1, method="window", window=6)
    assert small.rule == "W3M"
    assert gr.certify(model, y, attacked=1, moving=True).rule == "W2M, moving liars"
    assert gr.certify(model, y, attacked=1).rule == "B"


def test_too_many_liars_are_told_and_the_bank_starts_anew() -> None:
    model = double_integrator()
    x, y = record(model, 200, 5)
    y[80:100, :3] += np.array([40.0, -60.0, 90.0])  # three of six, at most one was asked for
    found = gr.certify(model, y, attacked=1)
    assert found.refuted[80]
    assert found.answered[-50:].all()
    assert inside_from(found, x, 130)


def inside_from(found: gr.Certified, x: Array, first: int) -> bool:
    return bool((np.abs(found.center - x)[first:] <= found.box[first:]).all())


def test_liars_that_change_every_sample() -> None:
    model = double_integrator()
    x, y = record(model, 80, 6)
    rng = np.random.default_rng(6)
    for t in range(len(y)):
        y[t, rng.choice(6, size=1)] += 50.0
    found = gr.certify(model, y, attacked=1, moving=True)
    assert found.method == "window"
    assert inside(found, x)
    assert found.answered[10:].all()
    bound = found.bound(x + 1.0)
    assert (bound[10:] >= 1.0).all()


def test_a_known_start_is_used() -> None:
    model = double_integrator()
    x, y = record(model, 20, 7)
    found = gr.certify(model, y, attacked=1, start=[0.0, 0.0], start_covariance=4.0 * np.eye(2))
    assert found.answered.all()
    assert inside(found, x)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"attacked": 7}, "attacked: got 7, expected a whole number in 0..6"),
        ({"attacked": 1, "failure": 0.0}, "failure: got 0, expected a probability"),
        ({"attacked": 1, "method": "bnak"}, 'did you mean "bank"'),
        ({"attacked": 1, "method": "bank", "moving": True}, "a bank needs liars that never change"),
        ({"attacked": 1, "start": [0.0, 0.0]}, "one of them, expected both or none"),
        ({"attacked": 1, "window": 0}, "window: got 0"),
    ],
)
def test_what_does_not_fit_is_refused(given: dict, message: str) -> None:
    model = double_integrator()
    with pytest.raises(gr.InvalidInput, match=message.replace(".", r"\.")):
        gr.certify(model, record(model, 5, 8)[1], **given)


def test_models_that_certificates_cannot_use_are_refused() -> None:
    y = np.zeros((4, 2))
    with pytest.raises(gr.InvalidInput, match="no covariance of the noise"):
        gr.certify(gr.Model([[1.0]], [[[1.0]], [[1.0]]]), y, attacked=0)
    shared = gr.Model(
        [[1.0]],
        [[[1.0], [1.0]]],
        process_covariance=1.0,
        measurement_covariance=[[[1.0, 0.5], [0.5, 1.0]]],
        sources=["a", "b"],
    )
    with pytest.raises(gr.InvalidInput, match="several sources share"):
        gr.certify(shared, y, attacked=0)
    with pytest.raises(gr.InvalidInput, match="measurements"):
        gr.certify(double_integrator(), np.zeros((4, 5)), attacked=1)


def test_inputs_that_hold_an_unstable_plant_are_predicted_with() -> None:
    rng = np.random.default_rng(1)
    A, B, C = np.array([[1.2, 0.1], [0, 0.9]]), np.array([[1.0], [0.5]]), np.array([[1.0, 0], [0, 1]] * 4)
    x, X, Y, U = np.zeros(2), [], [], []
    for _ in range(600):  # the response of the plant alone would be 1e46
        u = np.array([-0.7 * x[0] - 0.1 * x[1]])
        x = A @ x + B @ u + 0.1 * rng.normal(size=2)
        X.append(x)
        U.append(u)
        Y.append(C @ x + 0.1 * rng.normal(size=8))
    model = gr.Model(A, C, B=B, process_covariance=0.01, measurement_covariance=0.01)
    for options in ({}, {"moving": True, "window": 6}, {"method": "window", "window": 6}):
        samples = 600 if not options else 200
        found = gr.certify(model, np.array(Y)[:samples], attacked=1, inputs=np.array(U)[:samples], **options)
        assert found.answered[5:].all() and inside(found, np.array(X)[:samples])
        assert found.box[5:].max() < 1.5 and found.proved[-1] == [] and found.warnings == []


@pytest.mark.parametrize("options", [{}, {"method": "window", "window": 6}])
def test_a_state_beyond_what_numbers_hold_has_no_region_and_no_proof(options: dict) -> None:
    model = gr.Model([[1.2]], [[[1.0]]] * 4, process_covariance=0.01, measurement_covariance=0.01)
    for seed in range(4):
        states, y = record(model, 260, seed)  # up to 1e20
        found = gr.certify(model, y, attacked=1, **options)
        assert inside(found, states) and not found.refuted.any() and not any(found.proved)
        assert found.answered[10:100].all() and not found.answered[-1]
        assert any("from sample" in words and "16 digits" in words for words in found.warnings)


def test_process_noise_has_a_root_without_directions_in_which_there_is_none() -> None:
    for unit in (1e-12, 1.0, 1e12):
        Q = np.diag([1.0, 0.0, unit**2])
        Q[0, 2] = Q[2, 0] = 0.5 * unit
        Gam = gr.certificate.noise_root(Q)
        assert Gam.shape == (3, 2) and np.allclose(Gam @ Gam.T, Q, rtol=1e-12, atol=0)
    assert gr.certificate.noise_root(np.zeros((2, 2))).shape == (2, 0)
    for wrong in ([[1.0, 2.0], [0.0, 1.0]], [[-1.0]], np.zeros((0, 0)), [[1.0, 0.0]]):
        with pytest.raises(gr.InvalidInput, match="Q"):
            gr.certificate.noise_root(wrong)


@pytest.mark.parametrize("unit", [1e-9, 1e-8, 1.0, 1e9])
def test_units_of_states_do_not_matter(unit: float) -> None:
    """A clock in seconds beside metres, and a chain of three with a third state in small units."""
    clock = gr.Model(
        np.eye(2),
        [[[1.0, 0.0], [0.0, 1.0]]] * 4,
        process_covariance=np.diag([1.0, 25 * unit**2]),
        measurement_covariance=[np.diag([1.0, unit**2])] * 4,
    )
    S = np.diag([1.0, 1.0, 1.0 / unit])
    chain = gr.Model(
        S @ (np.eye(3) + np.diag([0.1] * 2, 1)) @ np.linalg.inv(S),
        np.array([[1.0, 0, 0]] * 6),
        process_covariance=np.diag([0.0, 0.0, 1e-2 / unit**2]),
        measurement_covariance=1.0,
    )
    for model, options in ((clock, {"method": "window", "window": 10}), (clock, {"moving": True}), (chain, {})):
        for seed in range(3):
            states, y = record(model, 60, seed)
            found = gr.certify(model, y, attacked=1, **options)
            assert inside(found, states) and not np.isnan(found.radius).any()
            assert found.proved[-1] == [] and found.answered[20:].all()
            assert found.steady is None or np.isfinite(found.steady).all()


def test_known_inputs_are_taken_out() -> None:
    push = 0.5 * np.array([[0.005], [0.1]])
    model = gr.Model(
        [[1, 0.1], [0, 1]],
        [[[1.0, 0.0]]] * 6,
        process_covariance=push @ push.T,
        measurement_covariance=1.0,
        B=[[0.005], [0.1]],
    )
    u = 3.0 * np.sin(np.arange(120) / 5.0)[:, None]
    run = gr.simulate(model, gr.Network.complete(6), gr.filters.Lfre(), steps=120, seed=4, inputs=u)
    y = np.array(run.measurements[0])
    y[:, 0] += 30.0
    found = gr.certify(model, y, attacked=1, inputs=u)
    assert inside(found, run.truth[0, 1:])
    assert found.answered[5:].all()
    shifted = gr.certify(model, y, attacked=1)  # without them the same plant is not where it is said to be
    assert not inside(shifted, run.truth[0, 1:])
