"""Known inputs: runs are those of a plant that was shifted or stacked by hand, for every family and bound."""

import copy
import pickle
from pathlib import Path
from typing import Any

import garrison as gr
import numpy as np
import pytest

A, B = np.array([[0.9, 0.2], [-0.1, 0.8]]), np.array([[0.5], [1.0]])
ROWS = [[1, 0], [0, 1], [1, 0], [0, 1], [1, 0], [0, 1]]
NOISE: dict[str, Any] = {
    "process_bound": 0.02,
    "measurement_bound": 0.01,
    "process_covariance": 1e-4,
    "measurement_covariance": 1e-4,
}
MODEL = gr.Model(A, ROWS, B=B, inputs=["thrust"], states=["s", "v"], units={"thrust": "N", "s": "m"}, **NOISE)
FREE = gr.Model(A, ROWS, states=["s", "v"], units={"s": "m"}, **NOISE)
NETWORK = gr.Network.ring(6)
U = np.cumsum(np.random.default_rng(3).normal(size=(40, 1)), axis=0)
FILTERS: list[gr.Filter] = [
    gr.filters.ScalarGain(rounds=4),
    gr.filters.Saturation(threshold=0.5, rounds=12, attacked=1, initial_error=1.0),
    gr.filters.Saturation(threshold=0.5, rounds=12, attacked=1, initial_error=1.0, detector=True),
    gr.filters.Structural(isolate=True),
    gr.filters.PartialSharing(gain=0.1),
    gr.filters.Rdkf(),
    gr.filters.Dkf(),
]


def response(model: gr.Model, u: Any) -> Any:
    """The states of the plant from 0 under its inputs alone, as a filter's user would compute them."""
    both = np.hstack([model.A, model.B])
    s = [np.zeros(model.states)]
    for now in u:
        s.append(gr._core.driven(model.A, s[-1], model.B, now))
        assert np.allclose(s[-1], both @ np.concatenate([s[-2], now]), rtol=1e-13)
    return np.array(s)


@pytest.mark.parametrize("filt", FILTERS, ids=lambda f: f"{f.name}{'+' if f.params.get('detector') else ''}")
@pytest.mark.parametrize("trials", [1, 9])
def test_a_run_with_inputs_is_the_shifted_run_bit_for_bit(filt: gr.Filter, trials: int) -> None:
    attack = gr.attacks.Bias(agents=[2], value=1.5, start=15)
    keep = ("estimate", "report", "measurements") if trials == 1 else ("estimate", "measurements")
    run = gr.simulate(
        MODEL, NETWORK, filt, steps=40, inputs=U, attack=attack, x0=[1, 0], start=[1, 0], trials=trials, keep=keep
    )
    s = response(MODEL, U)
    shifted = run.measurements - s[1:] @ np.array(ROWS, dtype=float).T
    again = gr.replay(
        FREE, NETWORK, filt, measurements=shifted, start=[1, 0], trials=trials, keep=("estimate", "report")
    )
    assert np.array_equal(run.estimate, again.estimate + s[:, None])
    if trials == 1:
        for name in ("bound", "verdict", "statistic", "threshold", "bound_kind"):
            assert np.array_equal(getattr(run, name), getattr(again, name), equal_nan=True), name
        assert run.accusations == again.accusations
    known = np.isfinite(again.bound[:1])
    assert (run.error[:1][known] <= again.bound[:1][known]).all()


def test_the_true_state_is_that_of_a_plant_stacked_by_hand_bit_for_bit() -> None:
    stacked = gr.Model(np.block([[A, B], [np.zeros((1, 2)), np.eye(1)]]), np.hstack([ROWS, np.zeros((6, 1))]))
    constant = np.full((40, 1), 0.37)
    plain = gr.simulate(gr.Model(A, ROWS, B=B), NETWORK, gr.filters.ScalarGain(), steps=40, inputs=constant, x0=[1, 0])
    by_hand = gr.simulate(stacked, NETWORK, gr.filters.ScalarGain(), steps=40, x0=[1, 0, 0.37])
    assert np.array_equal(plain.truth, by_hand.truth[..., :2])
    assert np.array_equal(plain.measurements, by_hand.measurements)


def test_what_the_inputs_do_is_no_error() -> None:
    """A filter that is not told of the inputs is far off; one that is, as far as without any."""
    filt = gr.filters.ScalarGain(rounds=4)
    told = gr.simulate(MODEL, NETWORK, filt, steps=40, inputs=U, seed=5)
    quiet = gr.simulate(FREE, NETWORK, filt, steps=40, seed=5)
    untold = gr.replay(FREE, NETWORK, filt, measurements=told.measurements[0], truth=told.truth[0])
    assert np.allclose(told.error, quiet.error, atol=1e-12)
    assert untold.error[0, 10:].max() > 20 * told.error[0, 10:].max()


def test_certificates_hold_with_inputs() -> None:
    filt = gr.filters.ScalarGain(rounds=4)
    attack = gr.attacks.Bias(agents=[3], value=5.0, start=10)
    run = gr.simulate(
        MODEL, NETWORK, filt, steps=40, inputs=U, attack=attack, certificate="flooded", failure=0, attacked=1
    )
    assert np.isfinite(run.bound[0, 1:]).mean() > 0.9
    known = np.isfinite(run.bound)
    assert (run.error[known] <= run.bound[known]).all()


def test_attacks_that_know_the_filter_see_the_measurement_it_expects() -> None:
    """A stealthy attack stays within the alarm level of the real measurement, not of the shifted one."""
    filt = gr.filters.Saturation(threshold=0.3, rounds=6)
    attack = gr.attacks.Stealthy(agents=[0], start=5)
    with_inputs = gr.simulate(MODEL, NETWORK, filt, steps=40, inputs=U, attack=attack, seed=2)
    without = gr.simulate(FREE, NETWORK, filt, steps=40, attack=attack, seed=2)
    assert np.allclose(with_inputs.error, without.error, atol=1e-10)


def test_central_and_local_kalman_filters_with_inputs() -> None:
    run = gr.simulate(MODEL, NETWORK, gr.filters.ScalarGain(), steps=40, inputs=U)
    y, s = run.measurements[0], response(MODEL, U)
    shifted = y - s[1:] @ np.array(ROWS, dtype=float).T
    for screen in ({}, {"gate": 1e-3}, {"huber": 1.345}):
        found = gr.central_kalman(MODEL, y, inputs=U, **screen)
        assert np.allclose(found, gr.central_kalman(FREE, shifted, **screen) + s, atol=1e-9)
        local = gr.local_kalman(MODEL, NETWORK, y, inputs=U, **screen)
        assert np.allclose(local, gr.local_kalman(FREE, NETWORK, shifted, **screen) + s[:, None], atol=1e-9)


def test_an_agent_driven_by_hand_has_the_bits_of_the_run() -> None:
    filt = gr.filters.ScalarGain(rounds=3)
    prepared = gr.prepare(MODEL, NETWORK, filt)
    run = prepared.simulate(steps=10, inputs=U[:10], start=[1, 0])
    agents, known = [prepared.agent(i) for i in range(6)], gr.Response(MODEL)
    for agent in agents:
        agent.reset([1.0, 0.0], t=0)
    for t in range(1, 11):
        known.advance(U[t - 1])
        y = run.measurements[0, t - 1]
        mail = [a.sense(t, known.without(y[i : i + 1], MODEL.C[i])) for i, a in enumerate(agents)]
        for _ in range(3):
            mail = [a.fuse([mail[j] for j in NETWORK.neighbours(i)]) for i, a in enumerate(agents)]
        estimates = np.array([a.estimate + known.state for a in agents])
        assert np.array_equal(estimates, run.estimate[0, t])


def test_own_filters_and_attacks_see_inputs_through_the_same_shift() -> None:
    class Mean(gr.Filter):
        rounds = 1

        def sense(self, agent: Any, state: Any, y: Any, t: int) -> Any:
            x = agent.A @ state.estimate
            state.estimate = x + 0.5 * agent.C.T @ (y - agent.C @ x)
            return {"estimate": state.estimate}

        def fuse(self, agent: Any, state: Any, inbox: Any, round: int) -> Any:
            state.estimate = sum((m["estimate"] for m in inbox.values()), state.estimate) / (1 + len(inbox))
            return {"estimate": state.estimate}

    lie = gr.attacks.custom(lambda t, agent, y, rng: y + 2.0, agents=[1], start=10)
    run = gr.simulate(MODEL, NETWORK, Mean(), steps=30, inputs=U[:30], attack=lie)
    quiet = gr.simulate(FREE, NETWORK, Mean(), steps=30, attack=lie)
    assert np.allclose(run.error, quiet.error, atol=1e-12)


def test_inputs_as_functions_and_tables() -> None:
    pd = pytest.importorskip("pandas")
    two = gr.Model(A, ROWS, B=np.eye(2), inputs=["a", "b"], **NOISE)
    u = np.random.default_rng(0).normal(size=(12, 2))
    filt = gr.filters.ScalarGain()
    runs = [
        gr.simulate(two, NETWORK, filt, steps=12, inputs=given)
        for given in (u, lambda t: u[t], pd.DataFrame({"b": u[:, 1], "a": u[:, 0]}))
    ]
    assert runs[0] == runs[1] == runs[2] and np.array_equal(runs[0].inputs, u)
    with pytest.raises(gr.InvalidInput, match="columns are matched by name"):
        gr.simulate(two, NETWORK, filt, steps=12, inputs=pd.DataFrame({"b": u[:, 1], "c": u[:, 0]}))


@pytest.mark.parametrize("suffix", [".npz", ".nc", ".zarr"])
def test_models_and_runs_keep_inputs(tmp_path: Path, suffix: str) -> None:
    assert pickle.loads(pickle.dumps(MODEL)) == MODEL == copy.deepcopy(MODEL) and MODEL != FREE
    assert eval(repr(MODEL), {"garrison": gr}) == MODEL
    assert MODEL.inputs == 1 and MODEL.input_names == ["thrust"] and np.array_equal(MODEL.B, B)
    run = gr.simulate(MODEL, NETWORK, gr.filters.ScalarGain(), steps=9, inputs=U[:9], trials=2)
    for needed in {".npz": [], ".nc": ["xarray"], ".zarr": ["xarray", "zarr"]}[suffix]:
        pytest.importorskip(needed)
    run.save(tmp_path / f"run{suffix}")
    again = gr.Run.load(tmp_path / f"run{suffix}")
    assert again == run == pickle.loads(pickle.dumps(run)) and np.array_equal(again.inputs, U[:9])
    if suffix != ".npz":
        data = again.to_xarray()
        assert list(data.input.values) == ["thrust"] and list(data.input_unit.values) == ["N"]
        assert data.inputs.dims == ("step", "input")


def test_continuous_plants_hold_their_inputs_between_samples() -> None:
    model = gr.Model.from_continuous([[0, 1], [0, 0]], [[1, 0]], 0.5, B=[[0], [1]])
    assert np.allclose(model.B, [[0.125], [0.5]], rtol=1e-15)


@pytest.mark.parametrize(
    ("model", "given", "words"),
    [
        (MODEL, None, "inputs: got none, expected 40 x 1, because the model has B"),
        (MODEL, U[:20], "inputs: got 20 x 1, expected 40 x 1"),
        (MODEL, np.zeros((40, 2)), "inputs: got 40 x 2, expected 40 x 1"),
        (MODEL, np.where(U > 0, np.nan, U), "inputs: got nan, expected finite numbers"),
        (FREE, U, "expected none, because the model has no B"),
        (MODEL, "fast", "inputs: got text, expected numbers"),
    ],
)
def test_inputs_that_do_not_fit_are_refused(model: gr.Model, given: Any, words: str) -> None:
    with pytest.raises(gr.InvalidInput, match=words):
        gr.simulate(model, NETWORK, gr.filters.ScalarGain(), steps=40, inputs=given)


def test_wrong_matrices_of_inputs_are_refused() -> None:
    for wrong, words in (
        ({"B": np.zeros((3, 1))}, "B: got 3 x 1, expected 2 rows, because A is 2 x 2"),
        ({"B": [[np.inf], [0]]}, "expected a finite number"),
        ({"B": B, "inputs": ["a", "b"]}, "inputs: got 2 names, expected 1"),
        ({"B": B, "inputs": ["a"], "units": {"c": "N"}}, "units"),
    ):
        with pytest.raises(gr.InvalidInput, match=words):
            gr.Model(A, ROWS, **wrong)
    platoon = gr.platoon.model(3, 0.1)
    with pytest.raises(gr.InvalidInput, match="its agents drive plants of their own"):
        gr.simulate(
            gr.Model(platoon.A, platoon.C, B=np.eye(2), measurement_bound=platoon.measurement_bound),
            gr.Network.path(3),
            gr.filters.PlatoonBaseline(kind="pwm", gs=0.4, gv=0.8, reference=[0.0, 10.0]),
            steps=5,
            inputs=np.zeros((5, 2)),
        )


def test_a_response_that_swallows_the_digits_is_said() -> None:
    unstable = gr.Model([[1.8]], [[1], [1]], B=[[1.0]])
    run = gr.simulate(unstable, gr.Network.path(2), gr.filters.ScalarGain(), steps=60, inputs=np.ones((60, 1)))
    assert any("The response to the known inputs alone reaches" in w for w in run.warnings)


SCENARIO = """
[model]
A = [[0.9, 0.2], [-0.1, 0.8]]
B = [[0.5], [1.0]]
C = [[1, 0], [0, 1], [1, 0]]
states = ["s", "v"]
outputs = ["s0", "v1", "s2"]
inputs = ["thrust"]
names = ["one", "two", "three"]
process_covariance = 1e-4
measurement_covariance = 1e-4
[network]
kind = "ring"
agents = 3
[filter]
name = "scalar_gain"
[[compare]]
name = "central_kalman"
[[compare]]
name = "local_kalman"
gate = 0.001
"""


def test_scenarios_with_inputs_run_from_lists_files_and_columns(tmp_path: Path) -> None:
    from garrison.jobs import rehearse, run_scenario
    from garrison.scenario import read_scenario

    u = U[:8]
    path = tmp_path / "s.toml"
    path.write_text(SCENARIO + f"[run]\nsteps = 8\nseed = 4\ninputs = {u.tolist()}\n")
    rows = run_scenario(read_scenario(path))
    assert rows[0].run is not None and rows[0].run.network.names == ["one", "two", "three"]
    expected = gr.simulate(rows[0].run.model, rows[0].run.network, gr.filters.ScalarGain(), steps=8, seed=4, inputs=u)
    assert np.array_equal(rows[0].run.estimate, expected.estimate)
    assert rows[2].error.shape == (1, 9, 3)  # a Kalman filter per agent

    (tmp_path / "u.csv").write_text("thrust\n" + "\n".join(str(float(v)) for v in u[:, 0]) + "\n")
    path.write_text(SCENARIO + '[run]\nsteps = 8\nseed = 4\ninputs = { file = "u.csv" }\n')
    assert np.array_equal(run_scenario(read_scenario(path))[0].run.estimate, expected.estimate)

    table = np.column_stack([expected.measurements[0], u])
    lines = ["s2,thrust,s0,v1", *(f"{r[2]!r},{r[3]!r},{r[0]!r},{r[1]!r}" for r in table.tolist())]
    (tmp_path / "y.csv").write_text("\n".join(lines) + "\n")
    path.write_text(SCENARIO + '[data]\nfile = "y.csv"\ninputs = ["thrust"]\n')
    replayed = read_scenario(path)
    rehearse(replayed)
    assert np.array_equal(run_scenario(replayed)[0].run.estimate, expected.estimate)

    for wrong, words in (
        ("[run]\nsteps = 8\n", "a model with B and no inputs"),
        ("[run]\nsteps = 8\ninputs = [[1, 2]]\n", "1 number per step"),
        ('[data]\nfile = "y.csv"\ninputs = ["thrusts"]\n', "no column thrusts"),
        ('[data]\nfile = "y.csv"\ninputs = ["thrust", "s0"]\n', "1 name of columns"),
    ):
        path.write_text(SCENARIO + wrong)
        with pytest.raises(gr.Error, match=words):
            read_scenario(path)


@pytest.mark.parametrize("certificate", ["none", "local"])
def test_a_saved_run_runs_again(tmp_path: Path, certificate: str) -> None:
    attack = [gr.attacks.Bias(agents=[2], value=1.5, start=5), gr.attacks.Random(agents=[1], size=1.0, probability=0.5)]
    more: dict[str, Any] = {} if certificate == "none" else {"certificate": certificate, "failure": 0, "attacked": 1}
    run = gr.simulate(
        MODEL,
        NETWORK,
        gr.filters.ScalarGain(rounds=2),
        steps=12,
        inputs=U[:12],
        attack=attack,
        seed=7,
        trials=3,
        x0=[1, 0],
        start=[0.5, 0],
        start_error=0.1,
        link={"drop": 0.1, "cuts": [(0, 1, 3, None)]},
        **more,
    )
    run.save(tmp_path / "run.npz")
    assert gr.again(gr.Run.load(tmp_path / "run.npz")) == run
    log = gr.replay(
        MODEL, NETWORK, gr.filters.ScalarGain(), measurements=run.measurements[0], inputs=U[:12], attack=attack, seed=3
    )
    assert gr.again(pickle.loads(pickle.dumps(log))) == log
    own = gr.attacks.custom(lambda t, agent, y, rng: y, agents=[1])
    mine = gr.simulate(MODEL, NETWORK, gr.filters.ScalarGain(), steps=3, inputs=U[:3], attack=own)
    with pytest.raises(gr.InvalidInput, match="an attack written in Python"):
        gr.again(mine)


def test_other_functions_take_models_with_inputs() -> None:
    prepared = gr.prepare(MODEL, NETWORK, gr.filters.ScalarGain())
    assert gr.Prepared.from_bytes(prepared.to_bytes()).model == MODEL
    assert "sensors may lie" in str(gr.analyze(MODEL, NETWORK))
    several = gr.Model(A, [[[1, 0], [0, 1]]], B=B, inputs=["thrust"])
    split = gr.split_outputs(several, gr.Network([], agents=1))[0]
    assert np.array_equal(split.B, B) and split.input_names == ["thrust"]
    rows = gr.compare(MODEL, NETWORK, attacked=[1], filters={"plain": gr.filters.ScalarGain()}, steps=30, trials=2).rows
    assert {row["status"] for row in rows if row["filter"] == "plain"} == {"ok"}
    check = gr.check(MODEL, NETWORK, gr.filters.ScalarGain(), certificate="flooded", failure=0, attacked=1)
    assert any(q["name"] == "certificate_expected" and np.isfinite(q["value"]) for q in check.quantities)


def test_labels_of_plots_and_tables() -> None:
    pytest.importorskip("pandas")
    model = gr.Model([[0.9]], [[1]] * 3, units="K", process_bound=0.1, measurement_bound=0.1)
    network = gr.Network([(0, 1), (1, 2)], names=["a", "b", "c"])
    run = gr.simulate(model, network, gr.filters.Saturation(threshold=1, rounds=3), steps=20)
    errors, statistics = run.plot(agents=["a", "c"]).axes
    assert errors.get_ylabel() == "error (K)"
    assert [t.get_text() for t in statistics.get_legend().get_texts()][:2] == ["statistic of a", "statistic of c"]
    assert run.to_pandas().attrs["units"]["error"] == "K"
    assert run.why_no_bound("b", 3) == run.why_no_bound(1, 3)
    with pytest.raises(gr.InvalidInput, match='did you mean "b"'):
        run.why_no_bound("bb", 3)


def test_what_is_no_function_of_time_is_told() -> None:
    model = gr.Model([[0.9]], [[1.0]] * 3, B=[[1.0]])
    for call in (
        lambda: gr.simulate(model, gr.Network.ring(3), gr.filters.ScalarGain(), steps=2, inputs=len),
        lambda: gr.VaryingModel(model, A=len, steps=3),
    ):
        with pytest.raises(gr.InvalidInput, match=r"\(0\): got a TypeError .*expected a function of t"):
            call()
