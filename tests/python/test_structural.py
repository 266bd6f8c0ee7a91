"""The structural family from Python: analysis, command line, mitigation through the switch."""

import json
from pathlib import Path
from typing import Any

import garrison as gr
import numpy as np
import pytest
from garrison import structural as theory
from garrison import structure
from garrison.cli import main
from scipy.sparse import coo_array, csc_array
from scipy.sparse.csgraph import connected_components, maximum_bipartite_matching

EDGES = [(0, 1), (1, 2), (2, 0), (1, 0), (3, 6), (3, 2), (4, 5), (5, 5), (5, 3), (6, 8), (6, 9), (6, 1), (7, 3), (8, 7)]
EDGES += [(8, 4), (9, 3)]


def paper_matrix() -> np.ndarray:
    A = np.zeros((10, 10))
    for k, (j, i) in enumerate(EDGES):
        A[i, j] = 0.5 + 0.03 * k
    return A


def test_ranks_and_components_are_scipys_on_1000_patterns() -> None:
    rng = np.random.default_rng(1)
    for _ in range(1000):
        rows, columns = rng.integers(1, 60, 2)
        count = rng.integers(0, 3 * max(rows, columns))
        i, j = rng.integers(0, rows, count), rng.integers(0, columns, count)
        matrix = csc_array(coo_array((np.ones(count), (i, j)), shape=(rows, columns)))
        matrix.sum_duplicates()
        pattern = structure.Pattern.csc(rows, matrix.indptr, matrix.indices)
        matched = maximum_bipartite_matching(matrix.tocsr())
        assert structure.maximum_matching(pattern)[0] == (matched >= 0).sum()
        n = min(rows, columns)
        square = csc_array(matrix[:n, :n])
        count = connected_components(square.T, connection="strong")[0]
        assert structure.strong_components(structure.Pattern.csc(n, square.indptr, square.indices))[0] == count


def test_structure_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "A.csv"
    np.savetxt(file, paper_matrix(), delimiter=",")
    picture = tmp_path / "A.png"
    arguments = ["structure", str(file), "--measured", "0", "5", "6", "9", "-o", str(picture)]
    assert main([*arguments, "--json"]) == 0
    out = json.loads(capsys.readouterr().out)
    assert [a["class"] for a in out["agents"]] == ["beta", "alpha", "gamma", "alpha"]
    assert [a["necessary"] for a in out["agents"]] == [True, True, False, True]
    assert out["agents"][1]["substitutes"] == [4, 7]
    assert picture.stat().st_size > 10_000
    assert main(arguments) == 2  # the picture exists
    assert "exists already" in capsys.readouterr().err
    assert main(["structure", str(file), "--measured", "0"]) == 1
    assert main(["structure", str(file)]) == 0
    assert "structural rank" in capsys.readouterr().out


def test_structure_command_refuses(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "A.csv"
    for text, words in (
        ("1,2\n3", "line 2: got 1 column, expected 2"),
        ("1,x\n2,3", "line 1, column 2: got 'x', expected a finite number"),
        ("1,2", "expected a square matrix"),
        ("", "an empty file"),
    ):
        file.write_text(text)
        assert main(["structure", str(file)]) == 2
        assert words in capsys.readouterr().err
    file.write_text("1,0\n0,1")
    assert main(["structure", str(file), "--measured", "5"]) == 2
    assert "a state in 0..1" in capsys.readouterr().err
    assert main(["structure", str(tmp_path / "none.csv")]) == 2


def test_structure_of_a_scenario(wind: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["structure", str(wind / "hijacked.toml"), "--json"]) == 0
    out = json.loads(capsys.readouterr().out)
    assert len(out["agents"]) == 12
    assert not any(a["necessary"] for a in out["agents"])  # twelve stations see the one state


def test_mitigation_goes_on_through_the_switch() -> None:
    A = paper_matrix()
    A *= 0.95 / np.abs(np.linalg.eigvals(A)).max()
    rng = np.random.default_rng(2)
    steps = 400
    x = np.zeros((steps + 1, 10))
    for k in range(steps):
        x[k + 1] = A @ x[k] + 0.1 * rng.normal(size=10)
    noise = 0.1 * rng.normal(size=(steps, 4))
    attack = np.zeros((steps, 4))
    attack[100:, 1] = 5.0
    given = {
        "A": A,
        "process_covariance": 0.01 * np.eye(10),
        "measurement_variance": 0.01,
        "measured": [0, 5, 6, 9],
        "truth": x,
        "noise": noise,
        "attack": attack,
        "false_alarm": 1e-7,
    }
    done = gr.replay_mitigated(gr.Network.complete(4), **given)
    assert [(s.agent, s.before) for s in done.switches] == [(1, 5)]
    assert done.switches[0].after in (4, 7)
    assert 100 < done.switches[0].time < 110
    assert [first for first, _, _ in done.segments] == [0, done.switches[0].time]
    quiet = done.error[50:100].mean()
    assert done.error[200:].mean() < 2 * quiet  # as before the attack
    cheap = np.ones((4, 10))
    cheap[1, 4] = 9.0
    assert gr.replay_mitigated(gr.Network.complete(4), **given, cost=cheap).switches[0].after == 7
    with pytest.raises(gr.InvalidInput, match="expected"):
        gr.replay_mitigated(gr.Network.complete(4), **(given | {"noise": noise[:-1]}))


def test_an_attack_along_a_mode_that_one_agent_sees_alone() -> None:
    A = np.array([[1.1, 0.0], [0.0, 0.5]])
    model = gr.Model(A, [[[1.0, 0.0]], [[0.0, 1.0]]])
    assert structure.undetectable_agents(model) == [0]
    assert structure.undetectable_agents(gr.Model(A, [[[1.0, 0.0]], [[1.0, 1.0]]])) == []
    assert structure.unseen_modes(A, np.array([[0.0, 1.0]]), 1.0) == [1.1 + 0j]


def test_exposure_says_what_a_constant_attack_can_do() -> None:
    one = np.array([[1.0]])
    setting = theory.Setting(A=0.9 * one, C=one, W=one, U=one, E=one, R=one)
    K = theory.design_gains(setting)["K"]
    found = theory.exposure(setting, K, false_alarm=0.01, detection=0.9)[0]
    assert found["seen_by"] == 0
    assert found["largest_harm"] == pytest.approx(found["harm_per_unit"] * found["smallest_seen"])


@pytest.mark.parametrize("lonely", [[0.0, 1.0], [0.3, 1.0]])
def test_an_attack_that_no_test_ever_sees_has_no_largest_harm(lonely: list[float]) -> None:
    """Agent 3 alone shows the second of two states that stay where they are."""
    C = [[[1.0, 0.0]], [[1.0, 0.0]], [[1.0, 0.0]], [lonely]]
    model = gr.Model(np.eye(2), C, process_covariance=0.01 * np.eye(2), measurement_covariance=[[[0.1]]] * 4)
    network = gr.Network.ring(4)
    assert structure.undetectable_agents(model) == [3]
    found = gr.check(model, network, gr.filters.Structural(design="h2", false_alarm=1e-3))
    assert found["harm of an unseen constant attack"] == np.inf  # not 1e15, which is rounding
    C[2] = [[0.0, 1.0]]
    shown = gr.Model(np.eye(2), C, process_covariance=0.01 * np.eye(2), measurement_covariance=[[[0.1]]] * 4)
    assert gr.check(shown, network, gr.filters.Structural(design="h2", false_alarm=1e-3))[
        "harm of an unseen constant attack"
    ] == pytest.approx(5.5, abs=4.5)


def test_gains_of_the_lmi_are_stable_where_a_plain_choice_is_not() -> None:
    pytest.importorskip("cvxpy")
    rng = np.random.default_rng(4)
    for _ in range(3):
        A = rng.normal(size=(3, 3))
        A *= 1.05 / np.abs(np.linalg.eigvals(A)).max()
        C = rng.normal(size=(4, 3))
        W = np.eye(4) / 2 + np.roll(np.eye(4), 1, axis=1) / 2
        setting = theory.Setting(A=A, C=C, W=W, U=(W > 0).astype(float))
        assert theory.error_radius(setting, [np.zeros((3, 3))] * 4) > 1
        K = gr.lmi_gains(setting)
        assert theory.error_radius(setting, K) < 1
    hopeless = theory.Setting(A=np.eye(3) * 1.2, C=np.zeros((4, 3)), W=W, U=np.eye(4))
    with pytest.raises(gr.DesignInfeasible, match="spectral radius"):
        gr.lmi_gains(hopeless, iterations=2)
    with pytest.raises(gr.DesignInfeasible, match=r"margin 1e\+308"):
        gr.lmi_gains(setting, margin=1e308)


def test_a_residual_that_a_projection_makes_vanish_is_not_tested() -> None:
    two = gr.Model([[0.9]], [[[1.0]], [[1.0]]], process_covariance=[[0.1]], measurement_covariance=[[[0.1]], [[0.1]]])
    rng = np.random.default_rng(0)
    y = rng.normal(size=(400, 2))
    y[rng.random(y.shape) < 0.2] = np.nan
    alone = gr.filters.Structural(design="projection", share="none")
    for link in ({}, {"drop": 0.3}):
        run = gr.replay(two, gr.Network.complete(2), alone, measurements=y, link=link)
        assert np.isnan(run.threshold).all()  # type: ignore[arg-type]
        assert not np.isin(run.verdict, [gr.Verdict.CLEARED, gr.Verdict.ATTACKED, gr.Verdict.SUSPECTED]).any()  # type: ignore[arg-type]
        assert any("sensor 0 was tested in 0 %" in w for w in run.warnings)
    one = gr.Model([[0.9]], [[[1.0]]], process_covariance=[[0.1]], measurement_covariance=[[[0.1]]])
    lie = np.where(np.arange(400) < 200, 0.0, 100.0)[:, None]
    for window in (1, 4):
        filter = gr.filters.Structural(design="projection", window=window)
        run = gr.replay(one, gr.Network([], agents=1), filter, measurements=lie)
        assert (run.verdict[:, 1:] == gr.Verdict.NOT_TESTED).all()  # type: ignore[index]


@pytest.mark.parametrize(("isolate", "missing", "told"), [(False, 0.0, False), (False, 0.02, True), (True, 0.0, True)])
def test_windows_that_gaps_cut_short_are_told(isolate: bool, missing: float, told: bool) -> None:
    model = gr.Model(0.9, [1.0] * 6, process_covariance=0.1, measurement_covariance=0.3)
    network, rng = gr.Network.complete(6), np.random.default_rng(5)
    y = gr.simulate(model, network, gr.filters.Dkf(), steps=200, seed=5).measurements[0].copy()  # type: ignore[index]
    y[rng.random(y.shape) < missing] = np.nan
    filt = gr.filters.Structural(false_alarm=1e-3, window=40, isolate=isolate)
    run = gr.replay(model, network, filt, start=[0.0], measurements=y)
    assert any("uses the last sample alone" in line for line in run.warnings) == told


@pytest.mark.parametrize("share", ["neighbours", "none"])
@pytest.mark.parametrize(("window", "missing"), [(2, 0.02), (8, 0.02), (40, 0.002), (40, 0.02), (40, 0.2)])
def test_a_window_that_a_gap_cuts_short_clears_nobody(window: int, missing: float, share: str) -> None:
    """A lie of 1.2 deviations, which one sample does not show, is called "not tested" where the window is cut."""
    model = gr.Model(0.9, [1.0] * 6, process_covariance=0.1, measurement_covariance=0.3)
    network, rng = gr.Network.complete(6), np.random.default_rng(window)
    y = gr.simulate(model, network, gr.filters.Dkf(), steps=600, seed=5).measurements[0].copy()  # type: ignore[index]
    y[:, 0] += 1.2 * np.sqrt(0.3)
    gone = rng.random(y.shape) < missing
    gone[:, 1:] &= share == "neighbours"  # otherwise only the own ones are used
    y[gone] = np.nan
    filt = gr.filters.Structural(false_alarm=1e-3, window=window, share=share)
    run = gr.replay(model, network, filt, start=[0.0], measurements=y)
    cleared = run.verdict[0, 1:, 0] == gr.Verdict.CLEARED  # type: ignore[index]
    since = np.convolve(gone.any(axis=1), np.ones(window), "full")[: len(y)] > 0
    assert not cleared[since].any()
    assert window > 8 or cleared[~since].any()  # whole windows are tested


@pytest.mark.parametrize("noise", [0.0, 1e-14, 1e-4])
@pytest.mark.parametrize("test", [{"test": "residual"}, {"test": "innovation"}, {"isolate": True}])
def test_measurements_without_noise_alarm_as_rarely_as_asked(noise: float, test: dict[str, Any]) -> None:
    model = gr.Model(0.9 * np.eye(2), [[1, 0], [0, 1], [1, 1]], process_covariance=0.1, measurement_covariance=noise)
    filt = gr.filters.Structural(false_alarm=0.01, **test)
    run = gr.simulate(model, gr.Network.complete(3), filt, steps=4000)
    over = np.nan_to_num(run.statistic) > np.nan_to_num(run.threshold, nan=np.inf)
    assert over[0, 100:].mean() < 0.015
    if noise < 1e-9 and "test" in test and test["test"] == "residual":  # zero up to rounding: says nothing
        assert not (run.verdict == gr.Verdict.CLEARED).any()


@pytest.mark.parametrize("start", [0.0, 10.0, 30.0])
@pytest.mark.parametrize("options", [{"window": 20}, {"window": 5, "isolate": True}, {"window": 20, "share": "none"}])
def test_a_wrong_start_accuses_nobody(options: dict[str, Any], start: float) -> None:
    """Windows hold nothing of the start."""
    model = gr.Model(0.95, [1.0] * 4, process_covariance=0.1, measurement_covariance=0.5)
    filt = gr.filters.Structural(false_alarm=0.01, **options)
    run = gr.simulate(model, gr.Network.complete(4), filt, steps=80, trials=100, start=[start], seed=1)
    tested = np.isfinite(run.threshold) & np.isfinite(run.statistic)  # type: ignore[arg-type]
    assert tested.mean() > 0.2
    assert (run.statistic > run.threshold)[tested].mean() < 0.013  # type: ignore[operator, index]


@pytest.mark.parametrize("drop", [0.01, 0.1, 0.4])
def test_without_measurement_noise_a_false_alarm_ends_within_tens_of_samples(drop: float) -> None:
    """Where nothing is lost the residual vanishes, so hardly any sample could end it."""
    model = gr.Model(
        [[1.0, 0.1], [0.0, 0.9]], [[1, 0], [0, 1]] * 3, process_covariance=0.01, measurement_covariance=0.0
    )
    alarms = 0
    for seed in range(4):
        run = gr.simulate(
            model,
            gr.Network.complete(6),
            gr.filters.Structural(test="residual"),
            steps=2000,
            noise="normal",
            seed=seed,
            link={"drop": drop},
        )
        assert run.verdict is not None
        attacked = run.verdict[0] == gr.Verdict.ATTACKED
        alarms += int(attacked.any())
        length = np.zeros(6, dtype=int)
        for sample in attacked:
            length = np.where(sample, length + 1, 0)
            assert length.max() <= 100
    assert alarms > 0
