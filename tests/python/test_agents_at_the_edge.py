"""Agents where little is heard, numbers are huge, times are far and sensors see nothing."""

from typing import Any

import garrison as gr
import numpy as np
import pytest

F = gr.filters
N = 6


def plant() -> gr.Model:
    C = [[[1, 0]], [[0, 1]]] * (N // 2)
    known: dict[str, Any] = {"process_covariance": 1e-4 * np.eye(2), "measurement_covariance": 1e-3}
    return gr.Model(0.9 * np.eye(2), C, process_bound=0.02, measurement_bound=0.05, **known)


def by_agents(design: gr.Prepared, y: np.ndarray, x0: list[float]) -> np.ndarray:
    """Estimates (samples, agents, states) of agents that hand each other all messages."""
    agents = [design.agent(i) for i in range(len(design.model.C))]
    for agent in agents:
        agent.reset(x0)
    out, width = [], y.shape[1] // len(agents)
    for t, sample in enumerate(y, 1):
        said = [a.sense(t, sample[i * width : (i + 1) * width]) for i, a in enumerate(agents)]
        for _ in range(agents[0].rounds):
            heard = [[m for j in a.neighbours if (m := said[j]) is not None] for a in agents]
            said = [a.fuse(messages) for a, messages in zip(agents, heard, strict=True)]
        out.append([a.estimate for a in agents])
    return np.array(out)


@pytest.mark.parametrize("filter", [F.Saturation(threshold=1.0, rounds=3), F.Rdkf(weight=1.0), F.Dkf()])
def test_an_agent_that_has_heard_nobody_says_nothing(filter: gr.Filter) -> None:
    design = gr.prepare(plant(), gr.Network.ring(N), filter)
    old, fresh = [design.agent(1), design.agent(5)], design.agent(0)
    for agent in old:
        agent.reset([1.0, 1.0])
    fresh.reset([1000.0, -1000.0], 9)
    for t in (10, 11):
        said = [fresh.sense(t, [1.0])] + [fresh.fuse([]) for _ in range(fresh.rounds)]
        assert said == [None] * (fresh.rounds + 1)
        again = gr.Agent.from_part(design.part(0), fresh.save())
        assert again.sense(t + 1, [1.0]) is None
    heard = [a.sense(12, [1.0]) for a in old]
    assert fresh.sense(12, [1.0]) is None
    for _ in range(fresh.rounds):
        fresh.fuse([m for m in heard if m is not None])
        heard = [a.fuse([]) for a in old]
    assert fresh.sense(13, [1.0]) is not None
    assert np.abs(fresh.estimate).max() < 100


@pytest.mark.parametrize("certificate", ["none", "flooded"])
@pytest.mark.parametrize("filter", [F.ScalarGain(rounds=0), F.Saturation(threshold=1.0, rounds=0)])
def test_joining_without_rounds(filter: gr.Filter, certificate: str) -> None:
    options: dict[str, Any] = {} if certificate == "none" else {"certificate": certificate, "attacked": 1, "failure": 0}
    agent = gr.prepare(plant(), gr.Network.ring(N), filter, **options).agent(0)
    agent.reset([0.0, 0.0], 4)
    agent.join(7, [])
    assert agent.sample == 7
    agent.sense(8, [0.5])
    assert np.isfinite(agent.estimate).all()


@pytest.mark.parametrize("t", [2**63 - 1, 2**63 - 2, 2**62, 5000])
def test_samples_that_are_too_far_ahead_are_refused(t: int) -> None:
    options: dict[str, Any] = {"process_noise": 0.01, "measurement_noise": 0.05, "reference": [0.0, 10.0]}
    filter = F.Platoon(attacked=1, initial_error=3.0, gs=1.0, gv=2.0, **options)
    design = gr.prepare(gr.platoon.model(7, 0.1), gr.Network.band(7, 3), filter)
    agent = design.agent(0)
    agent.reset([0.0, 10.0])
    with pytest.raises(gr.Error):
        agent.sense(t, [0.0] * len(design.model.C[0]))


@pytest.mark.parametrize("certificate", ["local", "flooded", "direct"])
@pytest.mark.parametrize("C", [[[[0, 1]], [[1, 0]], [[0, 0]]], [[[1, 0], [0, 0]], [[1, 0]], [[0, 1]]]])
def test_a_row_of_zeros_goes_with_a_certificate(C: list[Any], certificate: str) -> None:
    noise: dict[str, Any] = {"process_covariance": 1e-4 * np.eye(2)}
    noise["measurement_covariance"] = [1e-3 * np.eye(len(rows)) for rows in C]
    model = gr.Model(0.9 * np.eye(2), C, measurement_bound=0.05, process_bound=0.02, **noise)
    design = gr.prepare(model, gr.Network.complete(3), F.Dkf(), certificate=certificate, failure=0, attacked=0)
    assert gr.Prepared.from_bytes(design.to_bytes()) == design
    run = design.simulate(steps=5)
    assert [design.agent(i).id for i in range(3)] == [0, 1, 2]
    assert np.isfinite(run.bound[0, -1]).all()


@pytest.mark.parametrize("value", [1e99, 1e101, 1e147, 1e149])
@pytest.mark.parametrize("filter", [F.Dkf(), F.Rdkf(), F.PartialSharing(gain=0.1), F.Structural()])
def test_huge_measurements_do_the_same_in_engine_and_agents(filter: gr.Filter, value: float) -> None:
    noise: dict[str, Any] = {"process_covariance": 1e-4 * np.eye(2), "measurement_covariance": 1e-3}
    whole = gr.Model(0.99 * np.eye(2), [np.eye(2)] * N, **noise)
    model = whole if filter.name == "partial_sharing" else plant()
    design = gr.prepare(model, gr.Network.ring(N), filter)
    run = design.simulate(steps=20, seed=1, attack=gr.attacks.Constant([0], value=value, start=5), conditions=False)
    x0 = run.estimate[0, 0, 0]
    assert np.array_equal(run.estimate[0, 1:], by_agents(design, run.measurements[0], x0), equal_nan=True)


@pytest.mark.parametrize("seed", range(4))
def test_isolation_does_the_same_in_engine_and_agents(seed: int) -> None:
    """Sensors that are followed after a long jump, and left out again."""
    model = gr.Model(1.0, [1.0] * 3, process_covariance=1e-4, measurement_covariance=1e-3)
    design = gr.prepare(model, gr.Network.complete(3), F.Structural(isolate=True))
    lies = [gr.attacks.Bias([0], value=5.0, start=50, stop=300), gr.attacks.Bias([1], value=5.0, start=50, stop=300)]
    run = design.simulate(steps=400, seed=seed, attack=lies, conditions=False)
    assert np.array_equal(run.estimate[0, 1:], by_agents(design, run.measurements[0], run.estimate[0, 0, 0]))


def test_a_snapshot_with_huge_numbers_of_a_liar_is_read() -> None:
    noise: dict[str, Any] = {"process_covariance": 1e-4 * np.eye(2), "measurement_covariance": 1e-3}
    model = gr.Model(0.9 * np.eye(2), [np.eye(2)] * N, measurement_bound=0.05, process_bound=0.02, **noise)
    design = gr.prepare(model, gr.Network.ring(N), F.Dkf(), certificate="local", failure=0, attacked=1)
    agents = [design.agent(i) for i in range(N)]
    for agent in agents:
        agent.reset([0.0, 0.0])
    for t in range(1, 6):
        said = [a.sense(t, [0.0, 0.0]) for a in agents]
        if t > 2:
            assert said[2] is not None
            name = "certificate.measurements"
            said[2] = said[2].replace(name, np.full_like(said[2].fields[name], 9.9e149))
        for a in agents:
            a.fuse([m for j in a.neighbours if (m := said[j]) is not None])
        for i in (1, 3):
            assert gr.Agent.from_part(design.part(i), agents[i].save()).save() == agents[i].save()
