"""gr.compare: baselines against what they should be, and the table as a user meets it."""

import json

import garrison as gr
import numpy as np
import pytest
from conftest import ROOT
from garrison.comparison import baselines
from garrison.comparison.job import KALMAN, Job


def plant(agents=7, attacked=(2,)):
    rng = np.random.default_rng(1)
    rows = rng.normal(size=(agents, 1, 2))
    rows /= np.linalg.norm(rows, axis=2, keepdims=True)
    A = np.array([[1.0, 0.1], [0.0, 0.9]])
    model = gr.Model(A, list(rows), process_covariance=1e-3, measurement_covariance=1e-2)
    return model, gr.Network.complete(agents), list(attacked)


def measured(model, network, attack=(), steps=40):
    filter = gr.filters.ScalarGain(rounds=3)
    return gr.simulate(model, network, filter, steps=steps, attack=attack, trials=1, seed=3, conditions=False)


def kalman(model, y):
    """Central Kalman filter in its textbook form, from a unit covariance."""
    A, C, Q = model.A, np.vstack(model.C), model.process_covariance
    R = np.diag([r[0, 0] for r in model.measurement_covariance])
    x, P, out = np.zeros(len(A)), np.eye(len(A)), [np.zeros(len(A))]
    for z in y:
        x, P = A @ x, A @ P @ A.T + Q
        K = P @ C.T @ np.linalg.inv(C @ P @ C.T + R)
        x, P = x + K @ (z - C @ x), (np.eye(len(A)) - K @ C) @ P
        out.append(x)
    return np.array(out)


def test_without_liars_subset_search_is_the_central_kalman_filter():
    model, network, _ = plant()
    y = measured(model, network).measurements[0]
    found = baselines.subset_search(baselines.plant_of(model, network, 0), y)
    assert np.allclose(found[:, 0], kalman(model, y), atol=1e-7)
    assert np.allclose(found, found[:, :1])


def test_a_lone_agent_fuses_nothing():
    model = gr.Model([[0.9]], [[[1.0]]], process_covariance=0.1, measurement_covariance=0.2)
    network = gr.Network([], agents=1)
    y = np.random.default_rng(2).normal(size=(30, 1))
    y[4] = np.nan
    alone = baselines.plant_of(model, network, 1)
    expected = baselines.covariance_intersection(alone, y)[:, 0]
    for name in baselines.DISTRIBUTED:
        assert np.allclose(baselines.BASELINES[name](alone, y)[:, 0], expected)
    y[4] = 0.9 * expected[4]  # a missing measurement moves nothing; one as predicted moves the covariance alone
    assert expected[5] == pytest.approx(0.9 * expected[4])


def test_robust_baselines_stand_a_liar_that_breaks_the_others():
    model, network, attacked = plant()
    run = measured(model, network, gr.attacks.Bias(attacked, value=50.0, start=10))
    setting = baselines.plant_of(model, network, 1)
    honest = [i for i in range(7) if i not in attacked]

    def worst(name):
        found = baselines.BASELINES[name](setting, run.measurements[0])
        return np.linalg.norm(found - run.truth[0][:, None], axis=2)[20:, honest].max()

    broken = worst("covariance intersection")
    for name in ("median of estimates", "trimmed mean of estimates", "L1 decoder (central)", "subset search (central)"):
        assert worst(name) < 0.2 * broken


def test_protected_kalman_filters_stand_a_liar_that_breaks_the_plain_one():
    model, network, attacked = plant()
    run = measured(model, network, gr.attacks.Bias(attacked, value=50.0, start=10))
    errors = [
        np.linalg.norm(gr.central_kalman(model, run.measurements[0], **screen) - run.truth[0], axis=1)[20:].max()
        for screen in KALMAN.values()
    ]
    assert errors[1] < 0.2 * errors[0] and errors[2] < 0.5 * errors[0]


def test_every_family_and_baseline_has_a_row_for_every_attack():
    model, network, attacked = plant()
    seen = []
    found = gr.compare(model, network, attacked, steps=30, start=10, trials=3, progress=lambda *what: seen.append(what))
    filters, attacks, numbers = found.table()
    assert attacks[0] == "none"
    assert set(baselines.BASELINES) | {*KALMAN, "saturation", "rdkf", "dkf"} <= set(filters)
    assert len(found.rows) == len(filters) * len(attacks)
    assert seen[-1][1] == seen[-1][2]
    for row in found.rows:
        assert (row["q95"] is None) == (row["status"] != "ok")
    assert np.isfinite(numbers[:, 0]).sum() >= len(filters) - 2
    assert [row["filter"] for row in found.summary()] == filters


def test_numbers_are_those_of_the_run():
    model, network, attacked = plant()
    attack = gr.attacks.Bias(attacked, value=3.0, start=10)
    filter = gr.filters.Structural(isolate=True, false_alarm=0.05)
    found = gr.compare(
        model, network, attacked, filters={"mine": filter}, attacks={"bias": attack}, baselines=False, steps=30,
        start=10, trials=4, seed=5,
    )  # fmt: skip
    run = gr.simulate(model, network, filter, steps=30, attack=attack, trials=4, seed=5)
    row = found.rows[1]
    honest = [i for i in range(7) if i not in attacked]
    assert row["q95"] == np.quantile(run.error[:, 10:, honest], 0.95)
    right, false = [], set()
    for trial, t, sets in run.accusations:
        for agent in {a for some in sets for a in some}:
            if agent in attacked and t >= 10:
                right.append((trial, t))
            else:
                false.add((trial, agent))
    firsts = [min(t for k, t in right if k == trial) for trial in {k for k, _ in right}]
    assert row["detection_delay"] == np.median(firsts) - 10
    assert row["false_alarms"] == len(false) / 4
    assert row["bytes_per_sample"] == run.bytes_per_step


def test_bad_input_is_refused_by_name():
    model, network, _ = plant()
    with pytest.raises(gr.InvalidInput, match="attacked: got nobody"):
        gr.compare(model, network, [])
    with pytest.raises(gr.InvalidInput, match="attacked"):
        gr.compare(model, network, [7])
    with pytest.raises(gr.InvalidInput, match="start"):
        gr.compare(model, network, [1], steps=10, start=10)


def test_the_command(tmp_path, capsys):
    from garrison.cli import main

    scenario, picture = str(ROOT / "examples/wind/rdkf.toml"), tmp_path / "all.png"
    options = ["--agents", "1,DUB", "--trials", "1", "--steps", "12", "--start", "4"]
    assert main(["compare", scenario, *options, "-o", str(picture)]) == 0
    out = capsys.readouterr().out
    assert "W-MSR" in out
    assert picture.stat().st_size > 10_000
    assert main(["compare", scenario, *options, "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["attacked"] == [1, 6]
    assert main(["compare", scenario, "--agents", "nobody"]) == 2


def changing(parts=("A", "C", "process_covariance", "measurement_covariance"), steps=30):
    """A plant of seven agents over time."""
    model, network, attacked = plant()
    rng = np.random.default_rng(4)
    angles = rng.normal(scale=0.05, size=steps)
    turns = np.array([[[np.cos(a), np.sin(a)], [-np.sin(a), np.cos(a)]] for a in angles])
    every = {
        "A": 0.98 * turns,
        "C": np.einsum("tij,mj->tmi", turns, np.vstack(model.C)),
        "process_covariance": 1e-3 * rng.uniform(0.5, 2.0, size=(steps, 1, 1)) * np.eye(2),
        "measurement_covariance": 1e-2 * rng.uniform(0.5, 2.0, size=(steps, 7)),
    }
    return gr.VaryingModel(model, **{name: every[name] for name in parts}), network, attacked


def test_a_plant_that_changes_has_rows_for_all_and_reasons_for_those_that_need_a_constant_one():
    model, network, attacked = changing()
    attacks = {"bias": gr.attacks.Bias(attacked, value=3.0, start=10)}
    found = gr.compare(model, network, attacked, attacks=attacks, steps=30, start=10, trials=2)
    status = {row["filter"]: row["status"] for row in found.summary()}
    refuse = {"lfre", "structural", "rdkf", "dkf"}
    assert {label for label, words in status.items() if words != "ok"} == refuse
    for label in refuse:
        assert f"expected a constant plant for {label}" in status[label]
    assert set(baselines.BASELINES) | {*KALMAN, "saturation", "scalar_gain", "partial_sharing"} <= set(status)
    mine = {"frozen": gr.filters.PartialSharing(gain=0.1)}
    refused = gr.compare(model, network, attacked, filters=mine, attacks=attacks, steps=30, start=10, trials=2)
    assert 'gains = "varying" takes it' in refused.rows[0]["status"]
    with pytest.raises(gr.InvalidInput, match="steps: got 31, expected at most 30"):
        gr.compare(model, network, attacked, steps=31)


@pytest.mark.parametrize("parts", [("A",), ("C",), ("process_covariance",), ("measurement_covariance", "C")])
def test_a_baseline_takes_the_matrices_of_every_sample(parts):
    model, network, _ = changing(parts)
    y = measured(model, network, steps=30).measurements[0]
    setting = baselines.plant_of(model, network, 0)
    central = gr.central_kalman(model, y)
    assert np.allclose(baselines.subset_search(setting, y)[:, 0], central, atol=1e-7)
    alone = gr.VaryingModel(model.model, **model.parts), gr.Network([], agents=7)
    found = baselines.covariance_intersection(baselines.plant_of(*alone, 0), y)
    assert np.allclose(found, gr.local_kalman(*alone, y), atol=1e-7)


def test_covariances_that_are_known_over_time_alone_are_enough():
    model, network, attacked = changing()
    bare = gr.VaryingModel(gr.Model(model.model.A, model.model.C), **model.parts)
    log = measured(model, network, steps=30)
    for name, baseline in baselines.BASELINES.items():
        found, full = (baseline(baselines.plant_of(m, network, 0), log.measurements[0]) for m in (bare, model))
        assert np.array_equal(found, full), name
    jobs = [Job(m, network, attacked, 30, 10, 1, 0, None) for m in (bare, model)]
    for label in KALMAN:
        rows = [job.baseline(label, None, log) for job in jobs]
        assert rows[0]["status"] == "ok", label
        assert rows[0]["q95"] == rows[1]["q95"]


def test_a_plant_that_does_not_change_has_the_numbers_of_the_constant_one():
    model, network, attacked = plant()
    same = gr.VaryingModel(model, A=np.repeat(model.A[None], 30, axis=0))
    filters = {"saturation": gr.filters.Saturation(threshold=0.5, rounds=3)}
    options = {"filters": filters, "attacks": {}, "steps": 30, "start": 10, "trials": 2}
    one, two = (gr.compare(m, network, attacked, **options) for m in (model, same))
    for a, b in zip(one.rows, two.rows, strict=True):
        assert {k: v for k, v in a.items() if k != "microseconds"} == {
            k: v for k, v in b.items() if k != "microseconds"
        }


def test_the_command_takes_a_scenario_over_time(tmp_path, capsys):
    from garrison.cli import main

    scenario = tmp_path / "turning.toml"
    turns = [[[np.cos(a), np.sin(a)], [-np.sin(a), np.cos(a)]] * 2 for a in np.linspace(0, 1, 20)]
    scenario.write_text(
        f"""
[model]
A = [[1.0, 0.0], [0.0, 1.0]]
C = [[1, 0], [0, 1], [1, 0], [0, 1]]
C_over_time = {np.array(turns).tolist()}
process_covariance = 1e-4
measurement_covariance = 1e-2

[network]
kind = "complete"

[filter]
name = "scalar_gain"

[run]
steps = 20

[[attack]]
kind = "bias"
agents = [1]
start = 8
value = 3.0
"""
    )
    assert main(["compare", str(scenario), "--steps", "20", "--start", "8", "--trials", "1", "--json"]) == 0
    rows = json.loads(capsys.readouterr().out)["rows"]
    status = {row["filter"]: row["status"] for row in rows if row["attack"] == "none"}
    assert status["partial_sharing"] == status["scalar_gain (scenario)"] == "ok"
    assert "expected a constant plant for rdkf" in status["rdkf"]
    assert main(["compare", str(scenario), "--steps", "21"]) == 2
    assert "expected at most 20" in capsys.readouterr().err
