"""Runs are kept whole: saved, loaded, pickled, compared, as tables; their doubts are said."""

import copy
import inspect
import pickle
from pathlib import Path

import garrison as gr
import numpy as np
import pytest
from conftest import title_of
from garrison.longform import state_names


def system() -> tuple[gr.Model, gr.Network, gr.Filter]:
    model = gr.Model(0.9 * np.eye(2), [[1, 0], [0, 1]] * 3, process_bound=0.02, measurement_bound=0.01)
    filt = gr.filters.Saturation(threshold=1.0, rounds=12, attacked=1, initial_error=2.0, detector=True)
    return model, gr.Network.ring(6), filt


@pytest.fixture(scope="module")
def run() -> gr.Run:
    return gr.simulate(
        *system(),
        steps=40,
        trials=3,
        x0=[1, 1],
        start=[1, 0],
        attack=gr.attacks.Scale(agents=3, factor=30.0, start=20),
        link={"drop": 0.1},
        keep=["estimate", "report", "signals", "details", "measurements"],
    )


def test_save_and_load_keep_everything(run: gr.Run, tmp_path: Path) -> None:
    run.save(tmp_path / "run.npz")
    again = gr.Run.load(tmp_path / "run.npz")
    assert run.accusations and run.counters["lost"] > 0
    assert again == run
    for name in ("accusations", "details", "counters", "warnings", "bytes_per_step"):
        assert getattr(again, name) == getattr(run, name)
    assert again.filter.name == "saturation" and again.filter.params["attacked"] == 1
    np.testing.assert_array_equal(again.model.A, run.model.A)
    assert [c.tolist() for c in again.model.C] == [c.tolist() for c in run.model.C]
    assert again.model.process_bound == 0.02 and again.model.measurement_bound.tolist() == [0.01] * 6
    assert again.network.edges == run.network.edges
    assert again.signals.keys() == run.signals.keys()
    # What was loaded still runs.
    more = gr.replay(again.model, again.network, again.filter, measurements=again.measurements)
    assert more.estimate is not None and more.estimate.shape == again.estimate.shape  # type: ignore[union-attr]


def test_runs_of_all_families_are_kept(tmp_path: Path) -> None:
    covariances = {"process_covariance": 0.1 * np.eye(2), "measurement_covariance": [[[0.2]]] * 6}
    model = gr.Model(0.9 * np.eye(2), [[1, 0], [0, 1]] * 3, **covariances)
    for filt in (gr.filters.Rdkf(), gr.filters.Structural(), gr.filters.PartialSharing(gain=0.05), gr.filters.Dkf()):
        made = gr.simulate(model, gr.Network.complete(6), filt, steps=5)
        made.save(tmp_path / f"{filt.name}.npz")
        assert gr.Run.load(tmp_path / f"{filt.name}.npz") == made


@pytest.mark.skipif(not hasattr(gr.Model, "process_covariance"), reason="this core does not tell covariances")
def test_covariances_and_secured_outputs_are_kept(tmp_path: Path) -> None:
    covariances = {"process_covariance": 0.1 * np.eye(2), "measurement_covariance": [[[0.2]]] * 6}
    model = gr.Model(0.9 * np.eye(2), [[1, 0], [0, 1]] * 3, **covariances)
    made = gr.simulate(model, gr.Network.complete(6), gr.filters.Rdkf(), steps=5)
    made.save(tmp_path / "run.npz")
    again = gr.Run.load(tmp_path / "run.npz")
    assert again.model == model
    same = gr.replay(again.model, again.network, again.filter, measurements=made.measurements)
    np.testing.assert_array_equal(same.estimate, made.estimate)


def test_pickle_copy_and_equality(run: gr.Run) -> None:
    assert pickle.loads(pickle.dumps(run)) == run
    twin = copy.deepcopy(run)
    assert twin == run and twin.estimate is not run.estimate
    twin.estimate[0, 3, 2, 1] += 1e-12  # type: ignore[index]
    assert twin != run
    twin = copy.copy(run)
    twin.accusations = run.accusations[:-1]
    assert twin != run
    assert run != "run"
    assert hash(pickle.loads(pickle.dumps(run))) == hash(run)


@pytest.mark.parametrize("content", [b"", b"PK", b"words", b"PK\x03\x04" + bytes(200)])
def test_load_refuses_other_files(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "x.npz").write_bytes(content)
    with pytest.raises(gr.IoError, match=r"x\.npz"):
        gr.Run.load(tmp_path / "x.npz")
    with pytest.raises(gr.IoError, match="none"):
        gr.Run.load(tmp_path / "none.npz")
    np.savez(tmp_path / "other.npz", a=np.zeros(3))
    with pytest.raises(gr.IoError, match=r"Run\.save"):
        gr.Run.load(tmp_path / "other.npz")


def test_pandas_in_long_form(run: gr.Run) -> None:
    table = run.to_pandas()
    assert len(table) == 3 * 41 * 6
    assert list(table.columns[:3]) == ["trial", "time", "agent"]
    row = table[(table.trial == 1) & (table.time == 30) & (table.agent == 3)].iloc[0]
    assert run.estimate is not None and run.bound is not None and run.truth is not None and run.verdict is not None
    x0 = state_names(run)[0]
    assert row[x0] == run.estimate[1, 30, 3, 0]
    assert row[f"true_{x0}"] == run.truth[1, 30, 0]
    assert row["verdict"] == gr.Verdict(int(run.verdict[1, 30, 3])).word
    np.testing.assert_array_equal(table["bound"].to_numpy().reshape(3, 41, 6), run.bound)


def test_platoon_in_long_form() -> None:
    given = {"attacked": 1, "process_noise": 0.1, "measurement_noise": 0.1, "initial_error": 300.0}
    filt = gr.filters.Platoon(**given, reference=[200.0, 10.0], gs=50.0, gv=50.0)
    made = gr.simulate(gr.platoon.model(5, 0.01), gr.Network.band(5, 2), filt, steps=4)
    table = made.to_pandas()
    assert made.truth is not None
    names = state_names(made)
    row = table[(table.time == 4) & (table.agent == 2)].iloc[0]
    assert [row[f"true_{n}"] for n in names] == made.truth[0, 4, 2].tolist()


def test_verdict_is_an_enum() -> None:
    assert [v.name for v in gr.Verdict] == ["CLEARED", "SUSPECTED", "ATTACKED", "SILENT", "NOT_TESTED"]
    assert gr.Verdict(4).word == "not tested"
    assert gr.Verdict.ATTACKED == 2


def test_a_plot_says_which_trial(run: gr.Run) -> None:
    assert title_of(run.plot(2)) == "saturation: trial 2 of 3 (numbered from 0)"
    with pytest.raises(gr.InvalidInput, match=r"trial: got 3, expected a whole number in 0\.\.2"):
        run.plot(3)


def test_plots_leave_the_backend_alone(run: gr.Run) -> None:
    import subprocess
    import sys

    code = (
        "import matplotlib; matplotlib.use('svg'); import garrison.figures, garrison.report.page;"
        "print(matplotlib.get_backend().lower(), 'matplotlib.pyplot' in __import__('sys').modules)"
    )
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert found.stdout.split() == ["svg", "False"]


@pytest.mark.parametrize("function", ["check", "simulate", "replay"])
def test_one_order_of_arguments(function: str) -> None:
    model, net, filt = system()
    more: dict[str, object] = {"simulate": {"steps": 2}, "replay": {"measurements": np.zeros((2, 6))}}.get(function, {})
    call = getattr(gr, function)
    call(model, net, filt, **more)
    for wrong in ((filt, model, net), (net, model, filt), (model, filt, net)):
        with pytest.raises(gr.InvalidInput, match=r"expected \(model, network, filter\); the order changed"):
            call(*wrong, **more)
    with pytest.raises(gr.InvalidInput, match=r"got \(model, network, a str\), expected \(model, network, filter\)$"):
        call(model, net, "saturation", **more)
    assert list(inspect.signature(call).parameters)[:3] == ["model", "network", "filter"]


def test_required_conditions_that_fail_are_said() -> None:
    model, net, _ = system()
    filt = gr.filters.Saturation(threshold=1.0, rounds=1, attacked=5, initial_error=2.0)
    failed = [c["name"] for c in gr.check(model, net, filt).failed]
    assert failed
    made = gr.simulate(model, net, filt, steps=5)
    for name in failed:
        assert any(f"condition not met: {name}" in w for w in made.warnings)
    assert not any("condition" in w for w in gr.simulate(model, net, filt, steps=5, conditions=False).warnings)
    rows = gr.replay(model, net, filt, measurements=np.zeros((5, 6)))
    assert any("condition not met" in w for w in rows.warnings)


def test_conditions_that_take_long_are_not_evaluated_in_silence() -> None:
    N = 300
    model = gr.Model(0.9 * np.eye(2), [[1, 0], [0, 1]] * (N // 2), process_bound=0.1, measurement_bound=0.1)
    made = gr.simulate(model, gr.Network.ring(N), gr.filters.Saturation(threshold=1.0), steps=2)
    assert made.warnings[0].startswith("conditions were not checked")


def test_divergence_is_called_so() -> None:
    """Partial sharing with far too large a gain: the errors grow without end (1e107 was printed without a word)."""
    covariances = {"process_covariance": 0.1 * np.eye(2), "measurement_covariance": [[[0.2]]] * 6}
    model = gr.Model(0.9 * np.eye(2), [[1, 0], [0, 1]] * 3, **covariances)
    wild = gr.simulate(model, gr.Network.complete(6), gr.filters.PartialSharing(gain=5.0), steps=200)
    assert any("the filter diverges" in w or "diverged" in w for w in wild.warnings)
    calm = gr.simulate(model, gr.Network.complete(6), gr.filters.PartialSharing(gain=0.01), steps=200)
    assert calm.warnings == []
    unstable = gr.Model(1.2 * np.eye(2), [[1, 0], [0, 1]] * 3, process_bound=0.1, measurement_bound=0.1)
    grows = gr.simulate(unstable, gr.Network.complete(6), gr.filters.Saturation(threshold=1e9, rounds=3), steps=100)
    assert not any("diverge" in w for w in grows.warnings)


def test_masked_and_missing_values_are_nan() -> None:
    """A = .8, Q = .2, two sensors R = .5, y = [[2,1],[1,masked],[0,1]]: 1.155963, .954312, .614412."""
    import pandas as pd

    model = gr.Model([[0.8]], [[[1.0]], [[1.0]]], process_covariance=[[0.2]], measurement_covariance=[[[0.5]]] * 2)
    rows = [[2.0, 1.0], [1.0, np.nan], [0.0, 1.0]]
    masked = np.ma.masked_invalid(rows)
    masked.data[1, 1] = 1e6  # what is under the mask must not be seen
    frame = pd.DataFrame(rows).convert_dtypes()
    assert frame.iloc[1, 1] is pd.NA
    forms = [rows, masked, [list(r) for r in masked], list(masked), [[2, 1], [1, None], [0, 1]], frame]
    for form in forms:
        found = gr.central_kalman(model, form, start=[0.0], start_variance=1.0)
        np.testing.assert_allclose(found[1:, 0], [1.155963, 0.954312, 0.614412], atol=5e-7)
    net, filt = gr.Network.complete(2), gr.filters.Rdkf()
    plain = gr.replay(model, net, filt, measurements=np.array(rows))
    for form in forms:
        assert gr.replay(model, net, filt, measurements=form) == plain


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"measurements": np.zeros((3, 6)) * 1j}, "complex numbers"),
        ({"measurements": [[1.0] * 6, [1.0] * 5]}, "rows of different lengths"),
        ({"measurements": [["a"] * 6]}, "numbers"),
        ({"measurements": np.zeros((3, 6)), "seed": -1}, "seed: got -1"),
        ({"measurements": np.zeros((3, 6)), "threads": 1.5}, "threads: got 1.5"),
        ({"measurements": np.zeros((3, 6)), "trials": 0}, "trials: got 0"),
        ({"measurements": np.zeros((3, 6)), "trials": 2**31 - 1}, "GARRISON_MEMORY_GB"),
        ({"measurements": np.zeros((3, 6)), "attack": ["bias"]}, "an attack of garrison.attacks"),
        ({"measurements": np.zeros((3, 6)), "link": {"drop": "10%"}}, "link.drop: got '10%'"),
        ({"measurements": np.zeros((3, 6)), "start": ["a", "b"]}, "start"),
    ],
)
def test_replay_refuses_in_words(given: dict[str, object], words: str) -> None:
    with pytest.raises(gr.InvalidInput, match=words):
        gr.replay(*system(), **given)  # type: ignore[arg-type]


def test_sizes_without_sense_are_refused_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(gr.InvalidInput, match=r"which would take .* GB, expected at most 8 GB"):
        gr.simulate(*system(), steps=2_000_000_000)
    monkeypatch.setenv("GARRISON_MEMORY_GB", "0.0000001")
    with pytest.raises(gr.InvalidInput, match="at most 1e-07 GB"):
        gr.simulate(*system(), steps=100)
    monkeypatch.setenv("GARRISON_MEMORY_GB", "much")
    with pytest.raises(gr.InvalidInput, match="GARRISON_MEMORY_GB"):
        gr.simulate(*system(), steps=100)


def test_tables_of_pandas_are_matched_by_name(monkeypatch: pytest.MonkeyPatch) -> None:
    import pandas as pd
    from garrison.numeric import matched

    frame = pd.DataFrame({"B": [1.0], "A": [2.0]})
    assert matched("y", frame, ["A", "B"]).to_numpy().tolist() == [[2.0, 1.0]]
    assert matched("y", frame, None) is frame
    assert matched("y", pd.DataFrame([[1.0, 2.0]]), ["A", "B"]).to_numpy().tolist() == [[1.0, 2.0]]
    with pytest.raises(gr.InvalidInput, match=r"y: columns: got B, A, expected A, C"):
        matched("y", frame, ["A", "C"])


@pytest.mark.skipif(not hasattr(gr.Network, "names"), reason="networks of this core have no names")
def test_replay_matches_columns_by_the_names_of_the_network() -> None:
    import pandas as pd

    net = gr.Network([("A", "B"), ("B", "C")], names=["A", "B", "C"])  # type: ignore[call-arg, list-item]
    model = gr.Model([[0.9]], [[[1.0]]] * 3)
    filt = gr.filters.Saturation(threshold=1.0)
    y = np.random.default_rng(0).normal(size=(5, 3))
    frame = pd.DataFrame(y[:, ::-1], columns=["C", "B", "A"])
    assert gr.replay(model, net, filt, measurements=frame) == gr.replay(model, net, filt, measurements=y)
    assert set(gr.replay(model, net, filt, measurements=y).to_pandas()["agent"]) == {"A", "B", "C"}
