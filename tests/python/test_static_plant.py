"""gr.StaticPlant: large plants that do not move, by sparse rows; against enumeration and against the dense answers."""

import json
from pathlib import Path

import garrison as gr
import numpy as np
import pytest
from garrison._core import certificate
from garrison.cli import main
from garrison.scenario.static import read_static_scenario
from test_analyze import by_enumeration, grid14


def meters_of(H, **options):
    row, column = np.nonzero(H)
    return certificate.sparse_meters(H.shape, row.tolist(), column.tolist(), H[row, column], **options)


def random_rows(rng):
    n = int(rng.integers(1, 6))
    H = rng.choice([0, 0, 1.0, -1, 2.0], size=(int(rng.integers(n, 11)), n))
    return H[np.any(H != 0, axis=1)]


def test_fewest_rows_are_those_of_enumeration() -> None:
    rng, unseen, sizes = np.random.default_rng(23), 0, set()
    for _ in range(150):
        H = random_rows(rng)
        if not len(H):
            continue
        found, n = meters_of(H), H.shape[1]
        if np.linalg.matrix_rank(H) < n:
            assert found.unseen and not found.example
            unseen += 1
            continue
        least = by_enumeration(np.eye(n), H, range(len(H)))
        assert found.fewest == found.most == least == len(found.example) and found.complete
        assert np.linalg.matrix_rank(np.delete(H, found.example, axis=0)) < n
        bounded = meters_of(H, dense=0)  # by leverages alone
        assert bounded.fewest <= least <= bounded.most
        unit = H / np.linalg.norm(H, axis=1)[:, None]
        dense = certificate.meters(unit)
        assert np.allclose(found.leverage, dense.leverage, atol=1e-8)
        assert found.critical == dense.critical
        assert 0.9 < found.least / np.linalg.eigvalsh(unit.T @ unit)[0] <= 1 + 1e-9
        sizes.add(least)
    assert unseen > 5 and {1, 2, 3} <= sizes


def test_sources_are_critical_where_the_rest_does_not_determine_the_state() -> None:
    rng, found = np.random.default_rng(5), 0
    for _ in range(100):
        H = random_rows(rng)
        if not len(H) or np.linalg.matrix_rank(H) < H.shape[1]:
            continue
        source = rng.integers(0, 3, len(H))
        needed = [s for s in range(3) if np.linalg.matrix_rank(H[source != s]) < H.shape[1]]
        assert meters_of(H, source=source.tolist()).critical == [s for s in needed if s in source]
        found += bool(needed)
    assert found > 10


def test_it_answers_as_the_dense_model_does() -> None:
    model, network = grid14()
    agent = [i for i, c in enumerate(model.C) for _ in c]
    plant = gr.StaticPlant.of(np.vstack(model.C), agent)
    dense, sparse = gr.analyze(model, network), gr.analyze(plant, network)
    for one, other in zip(dense.limits[:4], sparse.limits[:4], strict=True):
        assert (one.guarantee, one.holds, one.fails) == (other.guarantee, other.holds, other.fails)
    theirs, ours = dense.limits[4], sparse.limits[4]
    assert ours.holds <= theirs.holds < ours.fails
    assert (dense.unbounded, dense.critical_links) == (sparse.unbounded, sparse.critical_links)
    assert [(len(a.sensors), a.cheapest) for a in sparse.additions] == [(2, True)]
    assert len(dense.additions[1].sensors) == 2
    assert sparse == gr.analyze(plant, network)
    sparse.plot()


@pytest.mark.parametrize("secured", [False, True])
def test_additions_by_counting_are_the_cheapest(secured: bool) -> None:
    """Every state must be shown by 2 s + 1 sensors: here by 3."""
    rows = np.eye(3)[[0, 0, 0, 1, 1, 2]]
    exposed = {"exposed": [0 if secured and k == 5 else 1 for k in range(6)]}
    model = gr.Model(np.eye(3), [row[None] for row in rows], **exposed)
    found = gr.analyze(model, gr.Network.ring(6), costs=[1.0, 2.0, 3.0]).additions[1]
    assert found.cheapest and sorted(found.sensors) == sorted(
        ["a sensor of x2"] + ["a sensor of x3"] * (not secured) * 2
    )


def test_matrices_of_scipy_and_what_the_sensors_do_not_show() -> None:
    scipy = pytest.importorskip("scipy.sparse")
    rows = scipy.csr_matrix(np.array([[1.0, 0, 0], [1.0, -1.0, 0]]))
    plant = gr.StaticPlant.of(rows, states=["a", "b", "c"], outputs=["u", "v"])
    entries = [[0, 0, 1.0], [1, 0, 1.0], [1, 1, -1.0]]
    assert plant == gr.StaticPlant(entries, (2, 3), [0, 1], ["a", "b", "c"], ["u", "v"])
    found = gr.analyze(plant, gr.Network.path(2))
    assert found.over_time.most == 0 and "Not determined by the sensors: c." in str(found)
    assert found.additions[0].sensors == ["a sensor of c"]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"size": (0, 2)}, "size: got 0"),
        ({"entries": [[0, 2, 1.0]]}, r"entries: got an entry at \(0, 2\), expected one within 2 x 2"),
        ({"entries": [[0, 0, np.inf]]}, "entries: got a value that is not finite"),
        ({"entries": [[0, 0]]}, "triples"),
        ({"agent": [0]}, "agent: got 1 number, expected 2"),
        ({"states": ["a"]}, "states: got 1 name, expected 2"),
    ],
)
def test_what_does_not_fit_is_refused(change: dict[str, object], message: str) -> None:
    with pytest.raises(gr.InvalidInput, match=message):
        gr.StaticPlant(**{"entries": [[0, 0, 1.0], [1, 1, 1.0]], "size": (2, 2)} | change)


def test_what_a_static_plant_cannot_be_asked_is_refused() -> None:
    plant, network = gr.StaticPlant.of(np.eye(3)), gr.Network.ring(3)
    with pytest.raises(gr.InvalidInput, match="network: got 2 agents, expected at least 3"):
        gr.analyze(plant, gr.Network.path(2))
    with pytest.raises(gr.InvalidInput, match="candidates: got one, with a StaticPlant"):
        gr.analyze(plant, network, candidates=np.eye(3))
    with pytest.raises(gr.InvalidInput, match="costs"):
        gr.analyze(plant, network, costs=[1.0])


def test_scenarios_of_large_static_files_are_read_sparse(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    n = 600
    sees = [[k, (k + 1) % n, (k - 1) % n] for k in range(n)]
    model = {
        "garrison_model": 1,
        "A": {"size": [n, n], "entries": [[k, k, 1.0] for k in range(n)]},
        "C": [{"size": [3, n], "entries": [[r, k, 1.0] for r, k in enumerate(one)]} for one in sees],
    }
    (tmp_path / "model.json").write_text(json.dumps(model))
    scenario = tmp_path / "ring.toml"
    scenario.write_text(
        'title = "a ring"\n[model]\nfile = "model.json"\n[network]\nkind = "ring"\nagents = 600\n'
        '[filter]\nname = "scalar_gain"\n[run]\nsteps = 5\n'
    )
    found = read_static_scenario(scenario)
    assert found is not None and found.plant.size == (1800, n) and found.plant.agent[:4] == [0, 0, 0, 1]
    assert main(["analyze", str(scenario), "--seconds", "60", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert (told["one_sample"]["fewest"], told["one_sample"]["exact"]) == (3, True)  # every state has three sensors
    assert [limit["holds"] for limit in told["limits"][:4]] == [2, 1, 2, 1]
    assert told["additions"][0]["cost"] == 2 * n  # a fourth and a fifth sensor of every state
    model["A"]["entries"][0][2] = 0.9
    (tmp_path / "model.json").write_text(json.dumps(model))
    assert read_static_scenario(scenario) is None  # it moves


def test_files_whose_matrices_are_too_large_together_are_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    n = 300
    one = {"size": [n, n], "entries": [[k, k, 1.0] for k in range(n)]}
    (tmp_path / "model.json").write_text(json.dumps({"garrison_model": 1, "A": one, "C": [one] * 4}))
    scenario = tmp_path / "s.toml"
    scenario.write_text(
        '[model]\nfile = "model.json"\n[network]\nkind = "ring"\nagents = 4\n'
        '[filter]\nname = "scalar_gain"\n[run]\nsteps = 5\n'
    )
    monkeypatch.setenv("GARRISON_MEMORY_GB", "0.005")  # each is 0.72 MB
    assert main(["run", str(scenario)]) == 2
    assert "garrison analyze reads a plant that does not move" in capsys.readouterr().err
