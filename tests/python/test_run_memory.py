"""Certificates with memory of runs and agents: options, arrays, words, files, scenarios."""

from pathlib import Path
from typing import Any

import garrison as gr
import numpy as np
import pytest
from garrison.scenario import read_scenario

DT = 0.1
PUSH = 0.5 * np.array([[DT * DT / 2], [DT]])
WANTED: dict[str, Any] = {"certificate": "direct", "attacked": 2, "memory": True}
LIES = [gr.attacks.Bias(agents=[1, 4], value=60.0, start=30)]


def body(**more: Any) -> gr.Model:
    return gr.Model(
        [[1, DT], [0, 1]], [[[1.0, 0.0]]] * 6, process_covariance=PUSH @ PUSH.T, measurement_covariance=1.0, **more
    )


def simulated(**more: Any) -> gr.Run:
    settings: dict[str, Any] = {"steps": 120, "attack": LIES, "seed": 3, "conditions": False} | WANTED | more
    return gr.simulate(body(), gr.Network.complete(6), gr.filters.Lfre(), **settings)


def test_positions_of_a_moving_body_have_bounds_and_both_liars_are_proved() -> None:
    run = simulated(keep=["estimate", "report", "box", "measurements"], trials=3)
    assert (run.bound_kind[:, 1] == gr.BoundKind.TOO_FEW).all()
    assert (run.bound_kind[:, 2:] == gr.BoundKind.MEMORY).all()
    assert (run.error <= run.bound)[:, 2:].all()
    assert run.box.shape == run.estimate.shape
    assert (np.abs(run.estimate - run.truth[:, :, None]) <= run.box)[:, 2:].all()
    assert (run.box[:, 2:] <= run.bound[:, 2:, :, None]).all()
    for trial in range(3):
        last = [sets for k, _, sets in run.proved if k == trial][-1]
        assert last == [["agent 1", "agent 4"]] * 6
    assert all(t == 0 or t >= 30 for _, t, _ in run.proved)
    assert {"box_x1", "box_x2"} <= set(run.to_pandas().columns)
    assert run.to_xarray()["box"].dims == ("trial", "time", "agent", "state")
    assert simulated(memory=False).bound_kind[0, -1, 0] == gr.BoundKind.TOO_FEW


def test_the_state_that_inputs_drive_is_certified_too() -> None:
    u = 3.0 * np.sin(np.arange(80.0))[:, None]
    run = gr.simulate(
        body(B=[[0.0], [1.0]]), gr.Network.complete(6), gr.filters.Lfre(), steps=80, inputs=u, attack=LIES, **WANTED
    )
    assert (run.bound_kind[:, 2:] == gr.BoundKind.MEMORY).all()
    assert (run.error <= run.bound)[:, 2:].all()


def test_liars_in_messages_leave_direct_banks_their_bounds() -> None:
    lies = gr.attacks.Forge(agents=[1], offset=50.0)
    run = simulated(attack=[lies])
    assert set(run.bound_kind[0, 3:].ravel()) == {gr.BoundKind.MEMORY}
    assert (run.error <= run.bound)[:, 3:, [0, 2, 3, 4, 5]].all()
    assert (simulated(attack=[lies], certificate="flooded").bound_kind[0, 3:] == gr.BoundKind.LIARS).all()


def test_runs_with_memory_are_kept_and_made_again(tmp_path: Path) -> None:
    run = simulated(keep=["estimate", "report", "box"])
    run.save(tmp_path / "run.npz")
    found = gr.Run.load(tmp_path / "run.npz")
    assert found == run
    assert found.proved == run.proved
    assert np.array_equal(found.box, run.box)
    assert gr.again(run) == run


def test_agents_prove_what_runs_prove_and_go_on_from_a_snapshot() -> None:
    run = simulated()
    design = gr.prepare(body(), gr.Network.complete(6), gr.filters.Lfre(), **WANTED)
    assert design.certificate == {"certificate": "direct", "failure": 1e-6, "attacked": 2, "memory": True}
    assert "memory=True" in repr(design)
    agents = [design.agent(i) for i in range(6)]
    for t in range(1, 121):
        sent = [a.sense(t, [run.measurements[0, t - 1, i]]) for i, a in enumerate(agents)]
        for _ in range(agents[0].rounds):
            sent = [a.fuse([sent[j] for j in a.neighbours]) for a in agents]
        if t == 60:
            agents = [gr.Agent.from_part(design.part(i), a.save()) for i, a in enumerate(agents)]
    for i, agent in enumerate(agents):
        assert agent.bound == run.bound[0, -1, i]
        assert agent.bound_kind == gr.BoundKind.MEMORY
        assert agent.proved == [1, 4]
        assert (agent.box <= agent.bound).all()


def test_liars_that_change_end_a_bank_which_says_so_and_starts_anew() -> None:
    moved = [
        gr.attacks.Bias(agents=[1, 4], value=60.0, start=30, stop=60),
        gr.attacks.Bias(agents=[0, 2], value=60.0, start=60),
    ]
    run = simulated(attack=moved)
    assert run.proved[-1][2] == [["agent 0", "agent 2"]] * 6
    assert any("a certificate with memory assumes, first at sample 60" in line for line in run.warnings)
    assert (run.bound_kind[0, 60] == gr.BoundKind.REFUTED).all()
    assert run.why_no_bound(0, 60).startswith("the measurements contradict")
    assert (run.error <= run.bound)[0, 65:].all()
    assert not any("memory" in line for line in simulated().warnings)


def test_check_says_what_memory_will_certify() -> None:
    with_memory = gr.check(body(), gr.Network.complete(6), gr.filters.Lfre(), **WANTED)
    assert with_memory["certificate_agents"] == 1.0 and 0.5 < with_memory["certificate_expected"] < 20.0
    without = gr.check(body(), gr.Network.complete(6), gr.filters.Lfre(), **(WANTED | {"memory": False}))
    assert without["certificate_agents"] == 0.0
    # Steady widths: of a bank in any case, of a window where memory is asked for.
    for name in ("x1", "x2"):
        assert 0.0 < with_memory[f"certify_{name}"] == without[f"certify_{name}"] < np.inf
        assert 0.0 < with_memory[f"window_{name}"] < np.inf
    assert not any(q["name"].startswith("window_") for q in without.quantities)
    assert "half width of x1" in next(q["meaning"] for q in with_memory.quantities if q["name"] == "certify_x1")
    three = gr.check(body(), gr.Network.complete(6), gr.filters.Lfre(), **(WANTED | {"attacked": 3}))
    assert three["certify_x1"] == three["window_x1"] == np.inf  # three against three


def test_steady_widths_are_never_exceeded_whatever_hides() -> None:
    rng = np.random.default_rng(12)
    checked = {"bank": 0, "window": 0}
    for k in range(24):
        method = ("bank", "window")[k % 2]
        n, agents = int(rng.integers(1, 3)), int(rng.integers(4, 7))
        model = gr.Model(
            np.eye(n) + 0.1 * rng.normal(size=(n, n)),
            rng.normal(size=(agents, n)),
            process_covariance=0.01 * np.eye(n),
            measurement_covariance=1.0,
        )
        run = gr.simulate(
            model, gr.Network.complete(agents), gr.filters.ScalarGain(), steps=80, noise="normal", seed=k,
            conditions=False,
        )  # fmt: skip
        y = run.measurements[0]
        y[20:, 0] += rng.choice([1.0, 3.0, 6.0]) * np.linspace(0, 1, 60)
        found = gr.certify(model, y, attacked=1, method=method, window=8)
        assert found.steady is not None
        late = found.box[60:]
        assert (late[np.isfinite(late).all(axis=1)] <= found.steady).all()
        checked[method] += int(np.isfinite(found.steady).all() and np.isfinite(late).all())
    assert min(checked.values()) > 8


def test_scenarios_say_memory(tmp_path: Path) -> None:
    path = tmp_path / "body.toml"
    path.write_text(
        """
[model]
A = [[1.0, 0.1], [0.0, 1.0]]
C = [[1.0, 0.0], [1.0, 0.0], [1.0, 0.0], [1.0, 0.0]]
process_covariance = [[0.000025, 0.0005], [0.0005, 0.01]]
measurement_covariance = 1.0
[network]
edges = [[0, 1], [1, 2], [2, 3], [3, 0], [0, 2], [1, 3]]
[filter]
name = "lfre"
[run]
steps = 20
[certificate]
spread = "direct"
attacked = 1
memory = true
"""
    )
    scenario = read_scenario(path)
    assert scenario.certificate["memory"] is True
    path.write_text(path.read_text().replace("memory = true", "memory = 1"))
    with pytest.raises(gr.InvalidInput, match="memory"):
        read_scenario(path)


@pytest.mark.parametrize(
    ("wanted", "words"),
    [
        ({"certificate": "none"}, 'memory: got True with certificate "none"'),
        ({"memory": "yes"}, "memory: got"),
        ({"failure": 0.0}, "failure"),
        ({"levels": (6.0, 6.0)}, "memory: got true with levels"),
    ],
)
def test_what_a_bank_cannot_do_is_refused(wanted: dict[str, Any], words: str) -> None:
    with pytest.raises(gr.InvalidInput, match=words.replace("(", r"\(")):
        simulated(**wanted)
