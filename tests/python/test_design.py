"""gr.design against a grid of the checks that anyone can make, and as a user meets it."""

import json
import math

import garrison as gr
import numpy as np
import pytest


def random_network(rng):
    N = int(rng.integers(4, 12))
    rows = rng.normal(size=(N, 1, 2))
    rows /= np.linalg.norm(rows, axis=2, keepdims=True)
    A = rng.normal(size=(2, 2))
    A *= rng.uniform(0.9, 1.03) / np.linalg.norm(A, 2)
    model = gr.Model(A, list(rows), process_bound=rng.uniform(0, 0.02), measurement_bound=rng.uniform(0.01, 0.1))
    edges = [(i, (i + 1) % N) for i in range(N)] + [(i, j) for i in range(N) for j in range(i) if rng.random() < 0.3]
    return model, gr.Network(edges)


def test_no_point_of_a_grid_is_better():
    """200 points on each of 50 networks."""
    rng = np.random.default_rng(1)
    designed = 0
    for _ in range(50):
        model, network = random_network(rng)
        try:
            found = gr.design(model, network, attacked=1, initial_error=2.0, most_rounds=40, curve=False)
        except gr.DesignInfeasible:
            found = None
        best = math.inf
        for rounds in (1, 2, 3, 5, 8, 13, 24, 40):
            for threshold in np.geomspace(0.02, 20, 25):
                filter = gr.filters.Saturation(
                    threshold=threshold, rounds=rounds, attacked=1, initial_error=2.0, chebyshev=True
                )
                check = gr.check(model, network, filter)
                if check.holds:
                    best = min(best, check["asymptotic bound"])
        if found is None:
            assert best == math.inf
            continue
        designed += 1
        assert found.error <= best * (1 + 1e-9)
        verified = gr.check(model, network, found.filter)
        assert verified.holds
        assert verified["asymptotic bound"] == pytest.approx(found.error, rel=1e-6)
    assert designed >= 40


def test_a_plant_that_contracts_has_a_design_near_the_limit_of_its_bound():
    """||A|| < 1 and loud sensors: the bound only falls with the threshold, so that no threshold is best."""
    rows = [[[1.0, 0.0]], [[0.0, 1.0]]] * 2
    model = gr.Model(0.9 * np.eye(2), rows, process_bound=0.01, measurement_bound=0.1)
    network = gr.Network.complete(4)
    found = gr.design(model, network, attacked=1, initial_error=2.0, curve=False)
    checked = {
        threshold: gr.check(
            model,
            network,
            gr.filters.Saturation(
                threshold=threshold, rounds=found.chosen.rounds, attacked=1, initial_error=2.0, chebyshev=True
            ),
        )["asymptotic bound"]
        for threshold in (1.0, 1e-2, 1e-4, 1e-8)
    }
    assert list(checked.values()) == sorted(checked.values(), reverse=True)
    assert found.error <= checked[1e-8] * (1 + 2e-6) and gr.check(model, network, found.filter).holds
    quiet = gr.Model(0.9 * np.eye(2), rows, process_bound=0.0, measurement_bound=0.0)
    with pytest.raises(gr.DesignInfeasible, match="falls as beta -> 0"):
        gr.design(quiet, network, attacked=1, initial_error=2.0)


def plant():
    rows = [[[1.0, 0.0]], [[0.0, 1.0]]] * 5
    model = gr.Model(np.diag([1.0, 0.95]), rows, process_bound=0.01, measurement_bound=0.02)
    return model, gr.Network.ring(10)


def test_goals_and_the_curve():
    model, network = plant()
    best = gr.design(model, network, attacked=1, initial_error=2.0)
    cheap = gr.design(model, network, attacked=1, initial_error=2.0, goal="bytes", error_at_most=1.2 * best.error)
    cheapest = gr.design(model, network, attacked=1, initial_error=2.0, goal="bytes")
    assert best.error <= cheap.error <= 1.2 * best.error
    assert cheapest.chosen.rounds <= cheap.chosen.rounds <= best.chosen.rounds
    fewer = gr.design(model, network, attacked=1, initial_error=2.0, most_rounds=cheap.chosen.rounds - 1)
    assert fewer.error > 1.2 * best.error
    errors = [c.error for c in best.curve]
    assert errors == sorted(errors, reverse=True)
    assert all(a.bytes_per_sample < b.bytes_per_sample for a, b in zip(best.curve, best.curve[1:], strict=False))
    liars = gr.design(model, network, initial_error=2.0, goal="liars")
    assert liars.attacked >= 1
    with pytest.raises(gr.DesignInfeasible, match=f"attacked = {liars.attacked} is feasible"):
        gr.design(model, network, attacked=liars.attacked + 1, initial_error=2.0)
    with pytest.raises(gr.DesignInfeasible, match="error_at_most"):
        gr.design(model, network, attacked=1, initial_error=2.0, goal="bytes", error_at_most=0.5 * best.error)
    run = gr.simulate(model, network, best.filter, steps=50, attack=gr.attacks.Bias([3], value=50.0))
    assert run.error[:, -10:].max() <= best.error


def test_bad_input_is_refused_by_name():
    model, network = plant()
    for wrong, words in (
        ({"family": "rdkf"}, "this family has no design"),
        ({"goal": "errors"}, 'did you mean "error"'),
        ({"attacked": None}, "attacked"),
        ({"goal": "liars"}, "attacked"),
        ({"error_at_most": 1.0}, "error_at_most"),
        ({"most_rounds": 0}, "most_rounds"),
    ):
        with pytest.raises(gr.InvalidInput, match=words):
            gr.design(model, network, **({"attacked": 1, "initial_error": 2.0} | wrong))
    with pytest.raises(gr.InvalidInput, match="network connected"):
        gr.design(model, gr.Network([(0, 1)], agents=10), attacked=1, initial_error=2.0)


def test_the_command(tmp_path, capsys):
    from garrison.cli import main

    scenario = tmp_path / "pair.toml"
    scenario.write_text(
        """
[model]
A = [[1.0, 0.0], [0.0, 0.95]]
C = [[1.0, 0.0], [0.0, 1.0], [1.0, 0.0], [0.0, 1.0], [1.0, 0.0], [0.0, 1.0], [1.0, 0.0], [0.0, 1.0]]
process_bound = 0.01
measurement_bound = 0.02
[network]
kind = "ring"
agents = 8
[filter]
name = "saturation"
threshold = 1.0
attacked = 1
[run]
steps = 5
""",
        encoding="utf-8",
    )
    assert main(["design", str(scenario)]) == 2
    assert "--initial-error" in capsys.readouterr().err
    picture = tmp_path / "curve.png"
    assert main(["design", str(scenario), "--initial-error", "2", "-o", str(picture)]) == 0
    assert "certified error" in capsys.readouterr().out
    assert picture.stat().st_size > 10_000
    assert main(["design", str(scenario), "--initial-error", "2", "--goal", "liars", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["attacked"] >= 1
    assert main(["design", str(scenario), "--initial-error", "2", "--attacked", "8"]) == 2


def test_a_contraction_by_rounding_stands_no_liars():
    """||A|| is 1 exactly (eigenvalues 1 and 0.96) and comes out a few 1e-16 below it."""
    model = gr.Model(
        [[0.98, 0.02], [0.02, 0.98]], [[[1.0, 0.0]], [[0.0, 1.0]]] * 4, process_bound=0.01, measurement_bound=0.05
    )
    found = gr.design(model, gr.Network.complete(8), initial_error=3.0, goal="liars", curve=False)
    assert found.attacked == 1
    assert found.error < 1.0
    assert "stands 1 liar with" in str(found)
    assert "1 round," in str(found)
    with pytest.raises(gr.DesignInfeasible, match=r"lambda0 < s = 8.*attacked = 1 is feasible"):
        gr.design(model, gr.Network.complete(8), attacked=8, initial_error=3.0)


def test_most_liars_are_those_that_the_sensors_stand():
    """A plant that contracts has a bound without any sensor: these are not the liars that are stood."""
    model = gr.Model(
        [[0.9, 0.0], [0.0, 0.9]], [[[1.0, 0.0]], [[0.0, 1.0]]] * 4, process_bound=0.01, measurement_bound=0.05
    )
    assert gr.design(model, gr.Network.complete(8), attacked=3, initial_error=3.0, curve=False).error > 0
    found = gr.design(model, gr.Network.complete(8), initial_error=3.0, goal="liars", curve=False)
    assert found.attacked == 1
    assert gr.check(model, gr.Network.complete(8), found.filter)["lambda_0"] > 1
