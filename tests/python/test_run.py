"""Models, networks, runs and replays from Python."""

from pathlib import Path

import garrison as gr
import numpy as np
import pytest


@pytest.fixture
def system() -> tuple[gr.Model, gr.Network, gr.Filter]:
    rng = np.random.default_rng(3)
    C = rng.normal(size=(5, 1, 2))
    C /= np.linalg.norm(C, axis=2, keepdims=True)
    model = gr.Model(0.98 * np.eye(2), C, process_bound=0.02, measurement_bound=0.05)
    return model, gr.Network.ring(5), gr.filters.Saturation(threshold=0.5, rounds=8)


def test_replay_of_what_was_simulated(system: tuple[gr.Model, gr.Network, gr.Filter]) -> None:
    model, net, filt = system
    made = gr.simulate(model, net, filt, steps=30, trials=3, seed=5, x0=[1.0, -1.0])
    assert made.measurements is not None and made.truth is not None and made.estimate is not None
    assert made.estimate.shape == (3, 31, 5, 2)
    assert made.measurements.shape == (3, 30, 5)
    together = gr.replay(model, net, filt, measurements=made.measurements, truth=made.truth)
    np.testing.assert_array_equal(together.estimate, made.estimate)
    np.testing.assert_array_equal(together.error, made.error)
    alone = gr.replay(model, net, filt, measurements=made.measurements[1], truth=made.truth[1])
    assert alone.estimate is not None
    np.testing.assert_array_equal(alone.estimate[0], made.estimate[1])


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        ({"measurements": np.ones((4, 2))}, r"measurements: got \(4, 2\), expected \(samples, 5\)"),
        ({"measurements": np.ones(5)}, r"measurements: got \(5,\)"),
        ({"measurements": np.ones((0, 5))}, "measurements: got 0 samples"),
        ({"measurements": np.ones((2, 4, 5)), "trials": 3}, "trials: got 3, expected 2"),
        ({"measurements": np.ones((4, 5)), "truth": np.ones((4, 2))}, r"truth: got \(4, 2\), expected \(5, 2\)"),
        ({"measurements": np.ones((4, 5)), "start": [1.0]}, "start: got 1 x 1 numbers, expected 1 x 2 or"),
        ({"measurements": np.ones((4, 5)), "keep": ["estimates"]}, 'did you mean "estimate"'),
        ({"measurements": np.ones((4, 5)), "link": {"drops": 0.1}}, 'did you mean "drop"'),
        ({"measurements": np.ones((4, 5)), "link": {"drop": 1.5}}, "1.5"),
    ],
)
def test_replay_refuses(system: tuple[gr.Model, gr.Network, gr.Filter], wrong: dict[str, object], words: str) -> None:
    model, net, filt = system
    with pytest.raises(gr.InvalidInput, match=words):
        gr.replay(model, net, filt, **wrong)  # type: ignore[arg-type]


def test_a_run_saves_plots_and_converts(system: tuple[gr.Model, gr.Network, gr.Filter], tmp_path: Path) -> None:
    model, net, filt = system
    run = gr.simulate(model, net, filt, steps=10, keep=["estimate", "report", "signals"])
    run.save(tmp_path / "run.npz")
    with np.load(tmp_path / "run.npz") as saved:
        np.testing.assert_array_equal(saved["estimate"], run.estimate)
        assert {"error", "threshold", "verdict", "signal_innovation"} <= set(saved.files)
    assert run.to_xarray()["estimate"].dims == ("trial", "time", "agent", "state")
    assert len(run.plot().axes) >= 2
    assert repr(run).startswith("garrison.simulate(garrison.Model(A=")


def test_networks_from_other_libraries() -> None:
    import networkx as nx
    from scipy.sparse import csr_array

    ring = gr.Network.ring(6)
    assert gr.Network(nx.cycle_graph(6)).edges == ring.edges
    W = csr_array(nx.to_scipy_sparse_array(nx.cycle_graph(6)))
    assert gr.Network(W).edges == ring.edges


@pytest.mark.parametrize("keep", [(), ("estimate", "report", "measurements")])
def test_a_run_in_parts_has_the_bits_of_the_whole(keep):
    model = gr.Model(
        [[1.0, 0.1], [0.0, 0.9]], [[[1.0, 0.0]], [[0.0, 1.0]]] * 4, process_bound=0.02, measurement_bound=0.01
    )
    network = gr.Network.ring(8)
    filter = gr.filters.Saturation(threshold=1.0, rounds=4, attacked=1)
    link = {"drop": 0.1} if keep else {}
    attack = gr.attacks.Random([2], size=3.0, start=5, probability=0.5)
    options = {"steps": 20, "attack": attack, "link": link, "keep": keep, "start_error": 1.0, "seed": 7}
    whole = gr.simulate(model, network, filter, trials=23, **options)
    for first, trials in ((0, 3), (3, 9), (12, 11)):
        part = gr.simulate(model, network, filter, trials=trials, first_trial=first, **options)
        assert np.array_equal(part.error, whole.error[first : first + trials], equal_nan=True)
    with pytest.raises(gr.InvalidInput, match="first_trial"):
        gr.simulate(model, network, filter, trials=2, first_trial=2**24 - 1, **options)
    y = whole.measurements[0] if keep else np.ones((20, 8))
    log = gr.replay(model, network, filter, measurements=y, trials=6, seed=3, attack=attack)
    rest = gr.replay(model, network, filter, measurements=y, trials=2, first_trial=4, seed=3, attack=attack)
    assert np.array_equal(rest.estimate, log.estimate[4:])
