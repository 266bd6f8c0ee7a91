"""Plants and networks that change in time: exact where an exact solution exists, refused by name where none holds."""

import copy
import pickle
from pathlib import Path
from typing import Any

import garrison as gr
import numpy as np
import pytest

NETWORK = gr.Network.complete(4)
T = 30
RNG = np.random.default_rng(7)
A_T = np.array([np.eye(2) + 0.1 * RNG.normal(size=(2, 2)) for _ in range(T)])
ANGLES = np.linspace(0.0, 3.0, T)
#: every agent sees along a direction that turns
C_T = np.array([[[np.cos(a + k), np.sin(a + k)] for k in range(4)] for a in ANGLES])
MODEL = gr.Model(np.eye(2), C_T[0], process_bound=0.01, measurement_bound=0.01)


def by_hand(measurements: Any, rounds: int, alpha: float) -> Any:
    """Scalar-gain consensus over the complete network, with the A and C of every sample."""
    x = np.zeros((4, 2))
    out = [x]
    for t in range(len(measurements)):
        x = x @ A_T[t].T
        x = x + np.array([C_T[t, i] * (measurements[t, i] - C_T[t, i] @ x[i]) for i in range(4)])
        for _ in range(rounds):
            x = x - alpha * (4 * x - x.sum(axis=0))
        out = [*out, x]
    return np.array(out)


@pytest.mark.parametrize("kind", ["scalar_gain", "saturation"])
def test_families_that_take_them_use_the_matrices_of_each_sample(kind: str) -> None:
    given: dict[str, Any] = {"rounds": 3, "step": 0.2}
    filt = gr.filters.ScalarGain(**given)
    if kind == "saturation":
        filt = gr.filters.Saturation(threshold=100.0, **given)
    run = gr.simulate(gr.VaryingModel(MODEL, A=A_T, C=C_T), NETWORK, filt, steps=T, x0=[1, 2], seed=1)
    assert np.allclose(run.estimate[0], by_hand(run.measurements[0], 3, 0.2), atol=1e-12)
    truth = run.truth[0]
    assert (np.linalg.norm(truth[1:] - np.einsum("tij,tj->ti", A_T, truth[:-1]), axis=1) <= 0.01).all()
    assert (np.abs(run.measurements[0] - np.einsum("tij,tj->ti", C_T, truth[1:])) <= 0.01).all()
    constant = gr.simulate(MODEL, NETWORK, filt, steps=T, x0=[1, 2], seed=1)
    assert not np.allclose(constant.estimate, run.estimate, atol=1e-3)


def test_a_plant_that_only_seems_to_change_has_the_bits_of_the_constant_one() -> None:
    filt = gr.filters.Saturation(threshold=0.5, rounds=5)
    same = gr.VaryingModel(MODEL, A=np.repeat(MODEL.A[None], T, axis=0), C=np.repeat(C_T[:1], T, axis=0))
    for trials in (1, 9):
        one = gr.simulate(MODEL, NETWORK, filt, steps=T, trials=trials, x0=[1, 2], keep=("estimate",))
        two = gr.simulate(same, NETWORK, filt, steps=T, trials=trials, x0=[1, 2], keep=("estimate",))
        assert np.array_equal(one.estimate, two.estimate) and np.array_equal(one.truth, two.truth)


def test_bounds_are_absent_with_the_reason() -> None:
    filt = gr.filters.Saturation(threshold=0.5, rounds=12, attacked=1, initial_error=1.0)
    rows = np.eye(2)[[0, 1, 0, 1]]
    model = gr.Model(0.9 * np.eye(2), rows, process_bound=0.01, measurement_bound=0.01)
    constant = gr.simulate(model, NETWORK, filt, steps=T)
    assert np.isfinite(constant.bound[0, 1:]).all()
    run = gr.simulate(gr.VaryingModel(model, C=np.repeat(rows[None], T, axis=0)), NETWORK, filt, steps=T)
    assert np.isnan(run.bound[0, 1:]).all() and (run.bound_kind[0, 1:] == gr.BoundKind.VARYING).all()
    assert "changes in time" in run.why_no_bound(0, 5)
    assert any("the plant changes in time" in w for w in run.warnings)


def test_families_for_constant_plants_refuse_by_name() -> None:
    plant = gr.VaryingModel(gr.Model(MODEL.A, C_T[0], process_covariance=1.0, measurement_covariance=1.0), C=C_T)
    for filt in (gr.filters.Structural(), gr.filters.Rdkf(), gr.filters.PartialSharing(gain=0.1)):
        with pytest.raises(gr.InvalidInput, match=f"expected a constant plant for {filt.name}"):
            gr.simulate(plant, NETWORK, filt, steps=T)
    bounded = gr.VaryingModel(MODEL, C=C_T)
    for extra in ({"detector": True}, {"adaptive": True}):
        filt = gr.filters.Saturation(threshold=0.5, rounds=30, attacked=1, initial_error=1.0, **extra)
        with pytest.raises(gr.InvalidInput, match=r"rest on theorems for constant plants|expected"):
            gr.simulate(bounded, NETWORK, filt, steps=T)
    moving = gr.VaryingModel(MODEL, A=A_T, C=C_T)
    run = gr.simulate(moving, NETWORK, gr.filters.ScalarGain(), steps=T, certificate="local", failure=0, attacked=1)
    assert (run.bound_kind == gr.BoundKind.WITNESS).any() and (run.error[0, 1:] <= run.bound[0, 1:]).all()


def test_certificates_hold_where_rows_turn() -> None:
    turning = gr.VaryingModel(MODEL, C=C_T)
    lies = gr.attacks.Bias(agents=[2], value=3.0, start=5)
    given: dict[str, Any] = {"steps": T, "attack": lies, "certificate": "flooded", "attacked": 1, "x0": [3.0, 1.0]}
    run = gr.simulate(turning, NETWORK, gr.filters.ScalarGain(rounds=3), failure=0, seed=1, **given)
    assert (run.bound_kind[0, 1:] == gr.BoundKind.WITNESS).any()
    assert np.isfinite(run.bound[0, 1:]).all() and (run.error[0, 1:] <= run.bound[0, 1:]).all()
    noisy = gr.Model(np.eye(2), C_T[0], process_covariance=1e-4, measurement_covariance=1e-2)
    given |= {"memory": True, "noise": "normal", "seed": 2}
    run = gr.simulate(gr.VaryingModel(noisy, C=C_T), NETWORK, gr.filters.ScalarGain(rounds=3), **given)
    assert (run.bound_kind[0, 5:] == gr.BoundKind.MEMORY).any()
    assert np.isfinite(run.bound[0, 2:]).all() and (run.error[0, 2:] <= run.bound[0, 2:]).all()
    assert run.proved[-1][2] == [["agent 2"]] * 4
    assert not any("memory" in line for line in run.warnings)
    assert gr.again(run) == run


def test_own_filters_get_the_matrices_of_the_sample() -> None:
    seen: list[Any] = []

    class Look(gr.Filter):
        rounds = 0

        def sense(self, agent: Any, state: Any, y: Any, t: int) -> Any:
            seen.append((t, agent.id, agent.A.copy(), agent.C.copy()))
            return {"estimate": state.estimate}

        def fuse(self, agent: Any, state: Any, inbox: Any, round: int) -> Any:
            return {"estimate": state.estimate}

    gr.simulate(gr.VaryingModel(MODEL, A=A_T, C=C_T), NETWORK, Look(), steps=T)
    assert len(seen) == 4 * T
    for t, agent, A, C in seen:
        assert np.array_equal(A, A_T[t - 1]) and np.array_equal(C[0], C_T[t - 1, agent])


def test_a_central_kalman_filter_at_irregular_times_is_exact() -> None:
    """The mean and covariance of a continuous plant do not depend on how finely it is sampled between measurements."""
    F, Q = np.array([[0.0, 1.0], [-2.0, -0.4]]), np.diag([0.02, 0.3])
    ticks = np.sort(np.random.default_rng(2).choice(np.arange(1, 400), 40, replace=False)) * 0.01
    options: dict[str, Any] = {"process_intensity": Q, "measurement_covariance": 0.05}
    coarse = gr.VaryingModel.from_continuous(F, [[1, 0]], [0.0, *ticks], B=[[0], [1]], **options)
    fine = gr.Model.from_continuous(F, [[1, 0]], 0.01, B=[[0], [1]], **options)
    places = np.rint(ticks / 0.01).astype(int)
    y = np.full((places[-1], 1), np.nan)
    y[places - 1, 0] = np.random.default_rng(3).normal(size=40)
    u = np.random.default_rng(4).normal(size=(40, 1))
    held = u[np.searchsorted(places, np.arange(1, places[-1] + 1))]
    found = gr.central_kalman(coarse, y[places - 1], inputs=u, start=[1, 0])
    expected = gr.central_kalman(fine, y, inputs=held, start=[1, 0])[places]
    assert np.allclose(found[1:], expected, atol=1e-10)


def test_an_irregular_plant_follows_the_exact_solution() -> None:
    linalg = pytest.importorskip("scipy.linalg")
    F = np.array([[0.0, 1.0], [-4.0, -0.3]])
    times = np.cumsum(np.random.default_rng(5).uniform(0.05, 0.9, size=25))
    plant = gr.VaryingModel.from_continuous(F, [[1, 0], [0, 1]], times)
    run = gr.simulate(
        plant, gr.Network.path(2), gr.filters.ScalarGain(step=0.2), steps=24, x0=[1, 0], start=[1, 0], noise="none"
    )
    exact = np.array([linalg.expm(F * (t - times[0])) @ [1, 0] for t in times])
    assert np.allclose(run.truth[0], exact, atol=1e-12) and np.allclose(run.estimate[0], exact[:, None], atol=1e-12)


def test_covariances_over_time_are_simulated() -> None:
    model = gr.Model([[0.0]], [[1.0]], process_covariance=1.0, measurement_covariance=1e-6)
    variances = np.where(np.arange(400) < 200, 1.0, 100.0)[:, None, None]
    plant = gr.VaryingModel(model, process_covariance=variances)
    run = gr.simulate(plant, gr.Network([], agents=1), gr.filters.ScalarGain(), steps=400, noise="normal")
    early, late = np.var(run.truth[0, 1:201]), np.var(run.truth[0, 201:])
    assert 60 < late / early < 160


def test_functions_of_time_are_arrays() -> None:
    arrays = gr.VaryingModel(MODEL, A=A_T, C=C_T)
    functions = gr.VaryingModel(MODEL, A=lambda t: A_T[t], C=lambda t: [c[None] for c in C_T[t - 1]], steps=T)
    lists = gr.VaryingModel(MODEL, A=A_T, C=[C_T[:, i : i + 1] for i in range(4)])
    assert arrays == functions == lists and hash(arrays) == hash(functions)
    assert pickle.loads(pickle.dumps(arrays)) == arrays == copy.deepcopy(arrays)
    assert eval(repr(arrays), {"garrison": gr}) == arrays and "over 30 steps" in str(arrays)
    assert arrays != gr.VaryingModel(MODEL, A=A_T)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({}, "nothing that changes"),
        ({"A": A_T[:, :1]}, r"A: got \(30, 1, 2\), expected \(steps, 2, 2\)"),
        ({"A": A_T, "C": C_T[:5]}, "A of 30 steps, C of 5 steps"),
        ({"A": lambda t: A_T[t]}, "a function and no steps"),
        ({"A": lambda t: np.eye(3), "steps": 2}, r"A\(0\): got \(3, 3\)"),
        ({"A": np.where(A_T > 1, np.nan, A_T)}, "not finite"),
        ({"C": [C_T[:, :2], C_T[:, 1:2], C_T[:, 2:3], C_T[:, 3:]]}, r"C\[0\]"),
        ({"B": A_T}, r"expected \(steps, 2, 0\)"),
        ({"a": A_T}, "unknown argument 'a'"),
    ],
)
def test_matrices_over_time_that_do_not_fit_are_refused(given: dict[str, Any], words: str) -> None:
    with pytest.raises(gr.InvalidInput, match=words):
        gr.VaryingModel(MODEL, **given)


def test_too_few_steps_are_refused() -> None:
    with pytest.raises(gr.InvalidInput, match="A: got 30 matrices over time, expected at least 31"):
        gr.simulate(gr.VaryingModel(MODEL, A=A_T), NETWORK, gr.filters.ScalarGain(), steps=31)
    with pytest.raises(gr.InvalidInput, match="times"):
        gr.VaryingModel.from_continuous([[0.0]], [[1.0]], [0, 2, 1])


def test_functions_for_constant_models_say_what_they_got() -> None:
    plant = gr.VaryingModel(MODEL, A=A_T)
    for call in (
        lambda: gr.check(plant, NETWORK, gr.filters.ScalarGain()),  # type: ignore[arg-type]
        lambda: gr.prepare(plant, NETWORK, gr.filters.ScalarGain()),  # type: ignore[arg-type]
        lambda: gr.analyze(plant, NETWORK),  # type: ignore[arg-type]
    ):
        with pytest.raises(gr.InvalidInput, match="VaryingModel"):
            call()


@pytest.mark.parametrize("suffix", [".npz", ".nc"])
def test_runs_keep_what_changed(tmp_path: Path, suffix: str) -> None:
    if suffix == ".nc":
        pytest.importorskip("xarray")
    run = gr.simulate(gr.VaryingModel(MODEL, A=A_T, C=C_T), NETWORK, gr.filters.ScalarGain(), steps=T)
    run.save(tmp_path / f"r{suffix}")
    again = gr.Run.load(tmp_path / f"r{suffix}")
    assert again == run == pickle.loads(pickle.dumps(run))
    assert gr.VaryingModel(again.model, **again.varying) == gr.VaryingModel(MODEL, A=A_T, C=C_T)


def test_check_says_what_it_does_not_cover(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    from garrison.cli import main

    text = f"""
[model]
A = [[1, 0], [0, 1]]
C = [[1, 0], [0, 1], [1, 0], [0, 1], [1, 0], [0, 1]]
process_covariance = 1e-4
measurement_covariance = 1e-2
A_over_time = {A_T[:9].tolist()}
[network]
kind = "complete"
[filter]
name = "scalar_gain"
[certificate]
spread = "flooded"
attacked = 1
[run]
steps = 9
"""
    path = tmp_path / "s.toml"
    path.write_text(text)
    assert main(["check", str(path)]) == 0
    told = capsys.readouterr()
    assert "the plant changes in time" in told.out + told.err and "certificate_expected" not in told.out
    assert main(["run", str(path), "-o", str(tmp_path / "out")]) == 0
    page = (tmp_path / "out" / "report.html").read_text()
    assert "quantities are those of its constant part" in page and "certificate_expected" not in page
    path.write_text("\n".join(line for line in text.splitlines() if "over_time" not in line))
    capsys.readouterr()
    assert main(["check", str(path)]) == 0
    told = capsys.readouterr()
    assert "the plant changes in time" not in told.out + told.err and "certificate_expected" in told.out


@pytest.mark.parametrize("command", ["analyze", "calibrate", "design", "structure"])
def test_commands_about_a_constant_plant_refuse_others(
    command: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    from garrison.cli import main

    path = tmp_path / "s.toml"
    path.write_text(
        f"""
[model]
A = [[1, 0], [0, 1]]
C = [[1, 0], [0, 1], [1, 0], [0, 1]]
A_over_time = {A_T[:9].tolist()}
[network]
kind = "complete"
[filter]
name = "scalar_gain"
[run]
steps = 9
"""
    )
    assert main([command, str(path)]) == 2
    told = capsys.readouterr().err
    assert f"[model]: got A_over_time, expected a constant plant for garrison {command}" in " ".join(told.split())


def test_a_network_of_every_sample_is_the_union_with_lost_messages() -> None:
    ring, path = gr.Network.ring(4), gr.Network.path(4)
    networks = [ring if t % 3 else path for t in range(1, 21)]
    varying = gr.VaryingNetwork(networks)
    assert varying.network == ring and varying.steps == 20 and pickle.loads(pickle.dumps(varying)) == varying
    assert eval(repr(varying), {"garrison": gr}) == varying
    filt = gr.filters.ScalarGain(rounds=2, step=0.2)
    run = gr.simulate(MODEL, varying, filt, steps=20, x0=[1, 2])
    lost = [(t, r, *pair) for t in range(3, 21, 3) for r in range(2) for pair in ((0, 3), (3, 0))]
    by_hand = gr.simulate(MODEL, ring, filt, steps=20, x0=[1, 2], link={"lost": lost})
    assert np.array_equal(run.estimate, by_hand.estimate) and run.counters["lost"] == len(lost)
    assert gr.VaryingNetwork(lambda t: networks[t - 1], steps=20) == varying
    assert gr.VaryingNetwork(ring, lambda t: varying.present[t - 1], steps=20) == varying


def test_directed_links_come_and_go_one_way() -> None:
    network = gr.Network([(0, 1), (1, 2)], agents=3, directed=True)
    present = np.array([[1, 1], [0, 1], [0, 1], [1, 0]])
    assert gr.VaryingNetwork(network, present).cuts == [(0, 1, 2, 4), (1, 2, 4, 5)]


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ((gr.Network.ring(4),), "present: got none"),
        ((gr.Network.ring(4), np.ones((3, 3))), r"present: got \(3, 3\), expected \(steps, 4\)"),
        ((gr.Network.ring(4), np.full((3, 4), 0.5)), "True or False"),
        (([gr.Network.ring(4), gr.Network.ring(5)],), r"network\[1\]"),
        (([],), "an empty list"),
        ((lambda t: gr.Network.ring(4),), "a function and no steps"),
        ((gr.Network.ring(4), lambda: [1, 1, 1, 1]), "a function and no steps"),
        ((["ring"],), r"network\[0\]: got 'ring'"),
    ],
)
def test_networks_over_time_that_do_not_fit_are_refused(given: Any, words: str) -> None:
    with pytest.raises(gr.InvalidInput, match=words):
        gr.VaryingNetwork(*given)
    with pytest.raises(gr.InvalidInput, match="a network over 3 samples, expected at least 4"):
        gr.simulate(MODEL, gr.VaryingNetwork(gr.Network.ring(4), np.ones((3, 4))), gr.filters.ScalarGain(), steps=4)


def test_scenarios_with_matrices_and_links_over_time(tmp_path: Path) -> None:
    from garrison.jobs import run_scenario
    from garrison.scenario import read_scenario

    np.savetxt(tmp_path / "A.csv", A_T.reshape(-1, 2), delimiter=",", fmt="%.17g")
    path = tmp_path / "s.toml"
    text = f"""
[model]
A = [[1, 0], [0, 1]]
C = {C_T[0].tolist()}
A_over_time = {{ file = "A.csv" }}
C_over_time = {C_T.tolist()}
process_bound = 0.01
measurement_bound = 0.01
[network]
edges = [[0, 1], [1, 2], [2, 3]]
present = {np.repeat([[1, 0, 1], [1, 1, 1]], 15, axis=0).tolist()}
[filter]
name = "scalar_gain"
[run]
steps = 30
seed = 2
"""
    path.write_text(text)
    run = run_scenario(read_scenario(path))[0].run
    assert run is not None
    network = gr.VaryingNetwork(gr.Network.path(4), np.repeat([[1, 0, 1], [1, 1, 1]], 15, axis=0))
    expected = gr.simulate(gr.VaryingModel(MODEL, A=A_T, C=C_T), network, gr.filters.ScalarGain(), steps=T, seed=2)
    assert np.array_equal(run.estimate, expected.estimate)
    for old, new, words in (
        ("present = [[1, 0, 1]", "present = [[1, 2, 1]", r"\[network\]"),
        ('{ file = "A.csv" }', "[[1, 0, 0]]", r"A_over_time: got shape"),
    ):
        path.write_text(text.replace(old, new, 1))
        with pytest.raises(gr.InvalidInput, match=words):
            read_scenario(path)


def test_a_snapshot_of_an_agent_that_was_told_claims_no_bound() -> None:
    filt = gr.filters.Saturation(threshold=0.5, rounds=12, attacked=1, initial_error=1.0)
    for told in (False, True):
        agents = [gr.Agent(MODEL, NETWORK, filt, i) for i in range(4)]
        if told:
            agents[0].vary(A=A_T[0])
        sent = [agent.sense(1, [0.0]) for agent in agents]
        for _ in range(12):
            sent = [agent.fuse([sent[j] for j in range(4) if j != i]) for i, agent in enumerate(agents)]
        again = gr.Agent(MODEL, NETWORK, filt, 0)
        again.load(agents[0].save())
        assert np.isfinite(again.bound) != told


def test_refusals_count_one_of_a_thing() -> None:
    with pytest.raises(gr.InvalidInput, match="got 1 step, expected 2, as"):
        gr.VaryingModel(MODEL, A=A_T[:1], steps=2)
    with pytest.raises(gr.InvalidInput, match="got 1 sample, expected 2, as"):
        gr.VaryingNetwork(NETWORK, np.ones((1, 6)), steps=2)
