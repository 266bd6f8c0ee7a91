"""Vehicles in a string through the Python surface: cases, closed loop, replay, pictures."""

from pathlib import Path

import garrison as gr
import numpy as np
import pytest
from conftest import ROOT
from garrison.verify import verify

GIVEN = {
    "attacked": 1,
    "process_noise": 0.1,
    "measurement_noise": 0.1,
    "initial_error": 300.0,
    "reference": [200.0, 10.0],
    "gs": 50.0,
    "gv": 50.0,
}


def string(N: int = 5, L: int = 2) -> tuple[gr.Model, gr.Network]:
    return gr.platoon.model(N, 0.01), gr.Network.band(N, L)


def loop(inputs: bool = False, **more: object) -> gr.Run:
    model, net = gr.platoon.model(5, 0.01, inputs), gr.Network.band(5, 2)
    return gr.simulate(
        model,
        net,
        gr.filters.Platoon(**(GIVEN | more)),
        steps=60,
        start=np.column_stack([200 - 20.0 * np.arange(5), np.full(5, 10.0)]),
        attack=gr.attacks.Bias(agents=[2], value=40.0, start=5),
        keep=["estimate", "report", "signals", "details", "measurements"],
    )


def test_all_cases() -> None:
    results = verify(ROOT / "tests/cases/platoon")
    assert len(results) == 15
    assert {r.family for r in results} == {"platoon"}
    assert sum(len(r.fields) for r in results) > 200
    assert [(r.file, f.name, f.note) for r in results for f in r.fields if not f.ok] == []


def test_closed_loop_and_its_replay() -> None:
    run = loop(inputs=True)  # a column of inputs that are all nan: the vehicles did what the filter commanded
    assert run.truth is not None and run.error is not None and run.bound is not None and run.measurements is not None
    assert run.truth.shape == (1, 61, 5, 2)
    assert run.measurements.shape == (1, 61, 23)
    assert (run.error <= run.bound).all()
    assert run.first_accused() == {2: 5}
    model, net = gr.platoon.model(5, 0.01, True), gr.Network.band(5, 2)
    start = np.column_stack([200 - 20.0 * np.arange(5), np.full(5, 10.0)])
    again = gr.replay(model, net, run.filter, measurements=run.measurements[0], truth=run.truth[0], start=start)
    assert again.estimate is not None and run.estimate is not None
    assert (again.estimate == run.estimate).all()


def test_recorded_inputs_take_the_place_of_commands() -> None:
    run = loop()
    assert run.measurements is not None and run.truth is not None
    u = run.signals["control"][0]
    columns = np.split(run.measurements[0], [2, 6, 10, 14], axis=1)
    rows = np.hstack([np.column_stack([c, u[:, k]]) for k, c in enumerate(columns)])
    model, net = gr.platoon.model(5, 0.01, True), gr.Network.band(5, 2)
    start = np.column_stack([200 - 20.0 * np.arange(5), np.full(5, 10.0)])
    other = gr.filters.Platoon(**(GIVEN | {"gs": 20.0, "gv": 30.0}))  # another controller: only the log steers
    replayed = gr.replay(model, net, other, measurements=rows, truth=run.truth[0], start=start)
    assert replayed.error is not None and run.error is not None
    assert np.abs(replayed.error - run.error).max() < 1e-9


def test_cars_that_are_only_observed() -> None:
    """Five noise-free cars at constant 20 m/s, recorded without inputs (it was 294 m off under a bound of 1.3 m)."""
    model, net = gr.platoon.model(5, 0.1), gr.Network.band(5, 2)
    t, car = np.arange(61)[:, None], np.arange(5)
    truth = np.stack([2.0 * t - 20.0 * car, np.full((61, 5), 20.0)], axis=2)
    rows = []
    for k in range(5):
        rows.append(truth[:, k])
        if k > 0:
            rows.append(truth[:, k] - truth[:, k - 1])
    seen = {"attacked": 1, "process_noise": 0.01, "measurement_noise": 0.1, "initial_error": 10.0}
    recorded = {"measurements": np.hstack(rows), "truth": truth, "start": truth[0]}
    steered = gr.filters.Platoon(**seen, reference=[0.0, 20.0], gs=0.5, gv=1.0)
    with pytest.raises(gr.InvalidInput, match="recorded vehicles without their inputs"):
        gr.replay(model, net, steered, **recorded)
    with pytest.raises(gr.InvalidInput, match="input_bound"):
        gr.replay(model, net, gr.filters.Platoon(**seen), **recorded)
    run = gr.replay(model, net, gr.filters.Platoon(**seen, input_bound=1.0), **recorded)
    assert run.error is not None and run.bound is not None
    assert (run.error <= run.bound).all()
    assert run.error[0, 20:].max() < 0.1
    assert run.first_accused() == {}
    assert "Assumption 4" not in str(gr.check(model, net, gr.filters.Platoon(**seen, input_bound=1.0)))


def test_false_noise_bounds_are_named() -> None:
    model, net = gr.platoon.model(9, 0.1), gr.Network.band(9, 2)
    told = gr.filters.Platoon(
        attacked=1, process_noise=0.05, measurement_noise=0.4, initial_error=10.0, reference=[0.0, 20.0], gs=0.5, gv=1.0
    )
    rng = np.random.default_rng(1)
    noise = np.zeros((301, 9, 7))
    angle = rng.uniform(0, 2 * np.pi, (301, 9, 2))
    noise[:, :, 2:4] = 0.5 * np.stack([np.cos(angle[:, :, 0]), np.sin(angle[:, :, 0])], axis=2)
    noise[:, :, 5:7] = 0.5 * np.stack([np.cos(angle[:, :, 1]), np.sin(angle[:, :, 1])], axis=2)
    start = np.column_stack([-20.0 * np.arange(9), np.full(9, 20.0)])
    run = gr.simulate(model, net, told, steps=300, start=start, noise=noise.reshape(301, 63))
    assert any("measurement_noise" in w for w in run.warnings)
    assert run.bound is not None and np.isnan(run.bound[0, -1]).all()


def test_collision_margin_is_certified() -> None:
    run = loop()
    assert run.truth is not None
    gaps = -np.diff(run.truth[0, :, :, 0], axis=1)
    assert (run.signals["least_gap"][0, :, 1:] <= gaps).all()
    assert (np.abs(gaps - 20.0) <= run.signals["spacing_error"][0, :, 1:]).all()


def test_pictures(tmp_path: Path) -> None:
    run = loop()
    assert len(run.plot().axes) == 4
    run.animate(tmp_path / "string.gif")
    assert (tmp_path / "string.gif").read_bytes()[:3] == b"GIF"


def test_check_and_refusals() -> None:
    model, net = string()
    found = gr.check(model, net, gr.filters.Platoon(**GIVEN))
    assert found["limit of rho"] == pytest.approx(found["limit of rho"])
    assert found["beta_0"] == pytest.approx(301.90375, rel=1e-6)
    with pytest.raises(gr.InvalidInput, match="b = 3"):
        gr.check(model, net, gr.filters.Platoon(**(GIVEN | {"attacked": 3})))
    with pytest.raises(gr.InvalidInput, match="recorded disturbances"):
        gr.simulate(
            gr.Model([[1.0]], [[[1.0]]]), gr.Network.path(1), gr.filters.ScalarGain(), steps=3, noise=np.zeros((4, 2))
        )


def test_scenario(tmp_path: Path) -> None:
    from garrison.cli import main

    assert main(["run", str(ROOT / "examples/platoon/spoofed.toml"), "-o", str(tmp_path / "out")]) == 0
    assert "data:image/gif" in (tmp_path / "out/report.html").read_text()
