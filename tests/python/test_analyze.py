"""gr.analyze against plain enumeration, and as a user meets it."""

import json
from itertools import combinations, combinations_with_replacement

import garrison as gr
import numpy as np
import pytest
from conftest import ROOT
from garrison.answers.additions import Candidate, cheapest_for, cheapest_for_removal
from garrison.answers.graph import cuts
from garrison.answers.removals import smallest_removal

#: branches of the IEEE 14-bus grid (from, to, reactance per unit)
BRANCHES = (
    (1, 2, 0.05917), (1, 5, 0.22304), (2, 3, 0.19797), (2, 4, 0.17632), (2, 5, 0.17388), (3, 4, 0.17103),
    (4, 5, 0.04211), (4, 7, 0.20912), (4, 9, 0.55618), (5, 6, 0.25202), (6, 11, 0.19890), (6, 12, 0.25581),
    (6, 13, 0.13027), (7, 8, 0.17615), (7, 9, 0.11001), (9, 10, 0.08450), (9, 14, 0.27038), (10, 11, 0.19207),
    (12, 13, 0.19988), (13, 14, 0.34802),
)  # fmt: skip


def grid14():
    """Angles of 13 buses against bus 1; a bus meters its injection and the flows of the lines that start there."""
    injection = np.zeros((14, 14))
    flows = [[] for _ in range(14)]
    for a, b, x in BRANCHES:
        row = np.zeros(14)
        row[[a - 1, b - 1]] = 1 / x, -1 / x
        injection[a - 1] += row
        injection[b - 1] -= row
        flows[a - 1].append(row)
    C = [np.vstack([injection[b], *flows[b]])[:, 1:] for b in range(14)]
    names = [f"bus {b + 1}" for b in range(14)]
    network = gr.Network([(a - 1, b - 1) for a, b, _ in BRANCHES], names=names)
    return gr.Model(np.eye(13), C), network


def seen(A, rows):
    """Rank of the observability matrix, by hand."""
    stack, power = [], np.eye(len(A))
    for _ in range(len(A)):
        stack.append(rows @ power)
        power = power @ A
    return len(rows) > 0 and np.linalg.matrix_rank(np.vstack(stack), tol=1e-8) == len(A)


def by_enumeration(A, rows, may_go):
    """Size of the smallest removal; len(may_go) + 1: none."""
    if not seen(A, rows):
        return 0
    for size in range(1, len(may_go) + 1):
        if any(not seen(A, np.delete(rows, some, axis=0)) for some in combinations(may_go, size)):
            return size
    return len(may_go) + 1


def random_system(rng):
    """Small, with repeated and sparse rows, so that removals matter."""
    n, M = int(rng.integers(1, 4)), int(rng.integers(1, 8))
    A = np.diag(rng.choice([0.5, 0.9, 1.0, 1.1], n)) if rng.random() < 0.5 else rng.normal(size=(n, n)).round(1)
    return A, rng.choice([0.0, 1.0, 1.0, 2.0], (M, n))


def test_smallest_removals_are_those_of_an_enumeration():
    rng = np.random.default_rng(1)
    sizes = set()
    for _ in range(150):
        A, rows = random_system(rng)
        secured = rng.random(len(rows)) < rng.choice([0.0, 0.3])
        may_go = [int(k) for k in np.flatnonzero(~secured)]
        if not may_go:
            continue
        for matrix in (A, np.eye(len(A))):
            with gr.budget(60) as budget:
                found = smallest_removal(matrix, rows, may_go, budget)
            assert found.exact
            assert found.fewest == by_enumeration(matrix, rows, may_go)
            if found.example:
                assert set(found.example) <= set(may_go)
                assert len(found.example) == found.fewest
                assert not seen(matrix, np.delete(rows, found.example, axis=0))
            sizes.add(found.fewest)
    assert sizes >= {0, 1, 2, 3}


def test_the_cheapest_additions_are_those_of_an_enumeration():
    rng = np.random.default_rng(2)
    compared = 0
    while compared < 25:
        A, rows = random_system(rng)
        n = len(A)
        costs = rng.integers(1, 4, n)
        offered = [Candidate(str(k), np.eye(n)[k], float(costs[k])) for k in range(n)]
        spare = int(rng.integers(1, 3))
        may_go = list(range(len(rows)))

        def enough(chosen, rows=rows, n=n, A=A, spare=spare):
            everything = np.vstack([rows, np.eye(n)[list(chosen)]])
            return by_enumeration(A, everything, range(len(everything))) > spare

        cost_of = {c: sum(costs[list(c)]) for k in range(4) for c in combinations_with_replacement(range(n), k)}
        good = [cost for chosen, cost in cost_of.items() if enough(chosen)]
        if not good or min(good) > 3:  # dearer ones may need more than three sensors
            continue
        with gr.budget(60) as budget:
            found = cheapest_for_removal("goal", A, rows, may_go, spare, offered, budget)
        assert found.cheapest
        assert found.cost == min(good)
        assert enough([int(name) for name in found.sensors])
        compared += 1


def test_links_and_agents_that_part_a_network_are_those_of_an_enumeration():
    rng = np.random.default_rng(3)
    for _ in range(60):
        N = int(rng.integers(2, 9))
        edges = [(i, j) for i in range(N) for j in range(i) if rng.random() < 0.35]
        found = cuts(gr.Network(edges, agents=N))
        assert found.links == sorted(
            (j, i) for i, j in edges if parts(edges, N) < parts([e for e in edges if e != (i, j)], N)
        )
        without = [parts([e for e in edges if k not in e], N) - 1 for k in range(N)]
        assert found.agents == [k for k in range(N) if without[k] > parts(edges, N)]


def parts(edges, N):
    """Connected parts, by joining labels."""
    label = list(range(N))
    for _ in range(N):
        for i, j in edges:
            label[i] = label[j] = min(label[i], label[j])
    return len(set(label))


def test_the_14_bus_grid():
    model, network = grid14()
    found = gr.analyze(model, network, seconds=15)
    assert len(found.sensors) == 34
    assert found.one_sample.exact
    assert found.one_sample.fewest == 3
    assert found.limits[0].holds == 2
    assert found.limits[1].holds == 1
    assert found.critical == []
    assert found.critical_links == [("bus 7", "bus 8")]
    assert found.critical_agents == ["bus 7"]
    rows = np.vstack(model.C)
    for size in (1, 2):
        for some in combinations(range(34), size):
            assert np.linalg.matrix_rank(np.delete(rows, some, axis=0)) == 13
    addition = found.additions[1]  # two liars: any four sensors may be lost
    assert addition.cheapest
    assert addition.cost == 2
    assert np.isfinite(found.leverage).all()


def test_a_critical_sensor_and_an_agent_that_drifts_unseen_are_named():
    model = gr.Model(np.diag([1.0, 0.5]), [[[1.0, 0.0]], [[0.0, 1.0]], [[0.0, 1.0]]])
    network = gr.Network([("a", "b"), ("b", "c")], names=["a", "b", "c"])
    found = gr.analyze(model, network, title="a chain")
    assert found.critical == ["a"]
    assert found.unbounded == ["a"]
    assert found.critical_agents == ["b"]
    assert found.limits[0].holds == 0
    text = str(found)
    assert "Must not fail: a;" in text
    assert "unseen by any detector, alone: a." in text
    assert json.loads(json.dumps(found.report()))["critical"] == ["a"]
    assert found.additions[0].sensors == ["a sensor of x1", "a sensor of x1", "a sensor of x2"]


def test_a_search_that_stops_at_so_many_sensors_does_not_say_that_more_would_not_help():
    with gr.budget(60) as budget:
        found = cheapest_for("goal", [Candidate("x", np.ones(1))], lambda added: len(added) > 5, budget, most=3)
        more = cheapest_for("goal", [Candidate("x", np.ones(1))], lambda added: len(added) > 5, budget)
    assert (found.sensors, found.cheapest) == (None, False)
    assert (more.sensors, more.cheapest) == (["x"] * 6, True)


def test_secured_sensors_do_not_lie():
    model = gr.Model([[1.0]], [[[1.0], [1.0]], [[1.0]]], exposed=[1, 1])
    found = gr.analyze(model, gr.Network.complete(2))
    assert found.over_time.example == []  # the secured one sees everything
    assert found.limits[0].holds == 2


@pytest.mark.parametrize("seconds", [1e-6, 0.02, 0.2])
def test_little_time_leaves_intervals_that_hold_and_says_so(seconds):
    model, network = grid14()
    hasty = gr.analyze(model, network, seconds=seconds)
    assert hasty.unfinished or seconds > 0.01  # how far it comes depends on the machine
    calm = gr.analyze(model, network, seconds=15)
    for one, two in zip(hasty.limits, calm.limits, strict=True):
        assert one.holds <= two.holds
        assert one.fails is None or two.fails is None or one.fails >= two.fails


def test_bad_input_is_refused_by_name():
    model, network = grid14()
    with pytest.raises(gr.InvalidInput, match=r"analyze: got \(Network, Model"):
        gr.analyze(network, model)
    with pytest.raises(gr.InvalidInput, match=r"candidates: got shape \(1, 2\)"):
        gr.analyze(model, network, candidates=[[1.0, 0.0]])
    with pytest.raises(gr.InvalidInput, match="costs: got"):
        gr.analyze(model, network, costs=[1.0])
    with pytest.raises(gr.InvalidInput, match="seconds: got 0"):
        gr.analyze(model, network, seconds=0)
    with pytest.raises(gr.InvalidInput, match=r'did you mean "seconds"'):
        gr.analyze(model, network, second=1)


def test_a_norm_of_one_is_not_taken_for_a_plant_that_contracts():
    model = gr.Model([[0.98, 0.02], [0.02, 0.98]], [[1, 0], [0, 1]] * 4)  # numerically 1 - 1e-16
    limit = gr.analyze(model, gr.Network.ring(8), seconds=5).limits[4]
    assert (limit.holds, limit.fails) == (1, 2) and "condition 11" in limit.why


@pytest.mark.parametrize("command", ["analyze", "structure"])
def test_vehicles_with_states_of_their_own_are_refused(command, capsys):
    """Taken for one common state, all 16 absolute sensors could lie and be found out; a common shift is not."""
    from garrison.cli import main

    assert main([command, str(ROOT / "examples/platoon/spoofed.toml")]) == 2
    assert "expected a filter of one common state; garrison check" in " ".join(capsys.readouterr().err.split())


def test_the_command_prints_words_tables_json_and_a_picture(tmp_path, capsys):
    from garrison.cli import main

    scenario = str(ROOT / "examples/wind/hijacked.toml")
    picture = tmp_path / "wind.png"
    assert main(["analyze", scenario, "-o", str(picture)]) == 0
    out = capsys.readouterr().out
    assert "the state can be determined in the end: 5" in out
    assert "CLA - BEL" in out
    assert picture.stat().st_size > 10_000
    assert main(["analyze", scenario, "--json"]) == 0
    report = json.loads(capsys.readouterr().out)
    assert report["limits"][1]["holds"] == 5
    assert len(report["leverage"]) == 12


def test_a_budget_ends_what_is_computed_inside():
    rng = np.random.default_rng(5)
    C = rng.normal(size=(300, 20))
    with gr.budget(1e-6), pytest.raises(gr.InvalidInput, match="used up"):
        gr.observable(np.eye(20), C)
    assert gr.observable(np.eye(20), C)
    with pytest.raises(gr.InvalidInput, match="seconds"):
        gr.budget(0.0)
    with gr.budget() as endless:
        assert not endless.over


def test_a_filter_that_requires_nothing_of_liars_promises_nothing_about_them() -> None:
    model = gr.Model(0.9 * np.eye(2), [[1, 0], [0, 1]] * 4, process_bound=0.02, measurement_bound=0.05)
    vague = gr.filters.Saturation(threshold=1.0, rounds=30, attacked=1)  # no initial_error: no theorem
    network, words = gr.Network.complete(8), "keeps its theorem"
    assert words not in str(gr.analyze(model, network, filter=vague))
    sure = gr.filters.Saturation(threshold=1.0, rounds=30, attacked=1, initial_error=2.0)
    assert words in str(gr.analyze(model, network, filter=sure))


def test_states_that_are_seen_by_rounding_only_are_no_refusal():
    """Rows of 1e-9 beside rows of 1: whether one sample determines the state is a matter of scale."""
    rows = np.array([[1.0, 1e-9], [1.0, 0.0], [1.0, 1e-9]])
    model = gr.Model(np.diag([1.0, 0.9]), [row[None] for row in rows])
    found = gr.analyze(model, gr.Network.path(3), seconds=5)
    assert found.one_sample.fewest <= found.one_sample.most
