"""Agents driven by hand: time, messages, restarts, snapshots, and what they refuse."""

import copy
import pickle
import subprocess
import sys
from pathlib import Path

import garrison as gr
import numpy as np
import pytest
from garrison import _core
from garrison.cli import main

AGENTS = 5
FILTERS = [
    gr.filters.Saturation(threshold=0.5, rounds=12, attacked=1, initial_error=3.0, detector=True),
    gr.filters.ScalarGain(rounds=2),
    gr.filters.Rdkf(weight=0.5),
    gr.filters.Rdkf(weight=0.5, penalty="group"),
    gr.filters.PartialSharing(gain=0.1, shared=1),
    gr.filters.Saturation(
        threshold=0.5, rounds=12, attacked=1, initial_error=3.0, detector=True, table=True, recovery=True
    ),
]
#: vehicles: test_platoon.py; a family that is in neither list runs as it comes
VEHICLES = {"platoon", "platoon_baseline"}
FILTERS += [
    gr.filters.make_filter(info["name"], {})
    for info in _core.filter_infos()
    if info["name"] not in VEHICLES | {f.name for f in FILTERS} and not any(p["required"] for p in info["params"])
]


def problem() -> tuple[gr.Model, gr.Network]:
    turn = 0.1
    rotation = [[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]]
    rows = [[[np.cos(1.3 * i), np.sin(1.3 * i)]] for i in range(AGENTS)]
    model = gr.Model(
        rotation,
        rows,
        process_bound=0.02,
        measurement_bound=0.05,
        process_covariance=1e-4 * np.eye(2),
        measurement_covariance=[np.eye(1) * 1e-3] * AGENTS,
    )
    return model, gr.Network.ring(AGENTS)


def step(agents: list[gr.Agent], net: gr.Network, t: int, y: np.ndarray) -> None:
    sent = [agent.sense(t, [y[i]]) for i, agent in enumerate(agents)]
    for _ in range(agents[0].rounds):
        sent = [agent.fuse([sent[j] for j in agent.neighbours if sent[j] is not None]) for agent in agents]


def test_every_family_has_a_place_here() -> None:
    missing = {f["name"] for f in _core.filter_infos()} - VEHICLES - {f.name for f in FILTERS}
    assert missing == set(), "they have parameters without a default: give them above"


@pytest.mark.parametrize("filt", FILTERS, ids=lambda f: f.name)
def test_a_network_of_agents_is_the_replay_bit_for_bit_and_survives_a_new_process(
    filt: gr.Filter, tmp_path: Path
) -> None:
    model, net = problem()
    y = np.random.default_rng(1).normal(size=(40, AGENTS))
    run = gr.replay(model, net, filt, measurements=y)
    agents = [gr.Agent(model, net, filt, i) for i in range(AGENTS)]
    for t in range(1, 21):
        step(agents, net, t, y[t - 1])
    for agent in agents:
        (tmp_path / f"{agent.id}.pickle").write_bytes(pickle.dumps(agent))
    program = (
        "import pickle, sys, numpy as np\n"
        "from pathlib import Path\n"
        "agents = [pickle.loads(Path(sys.argv[1], f'{i}.pickle').read_bytes()) for i in range(5)]\n"
        "y = np.random.default_rng(1).normal(size=(40, 5))\n"
        "for t in range(21, 41):\n"
        "    sent = [a.sense(t, [y[t - 1][i]]) for i, a in enumerate(agents)]\n"
        "    for _ in range(agents[0].rounds):\n"
        "        sent = [a.fuse([sent[j] for j in a.neighbours]) for a in agents]\n"
        "sys.stdout.buffer.write(np.array([a.estimate for a in agents]).tobytes())\n"
    )
    done = subprocess.run([sys.executable, "-c", program, str(tmp_path)], capture_output=True, check=True)
    assert run.estimate is not None
    assert done.stdout == run.estimate[0, -1].tobytes()
    assert all(copy.deepcopy(a) == a for a in agents)
    assert agents[0] != agents[1]


def test_an_agent_that_starts_late_says_nothing_before_it_has_heard_the_others() -> None:
    model, net = problem()
    filt = FILTERS[0]
    y = np.random.default_rng(2).normal(size=(30, AGENTS)) * 0.02
    agents = [gr.Agent(model, net, filt, i) for i in range(AGENTS)]
    for t in range(1, 21):
        step(agents, net, t, y[t - 1])
    agents[2] = gr.Agent(model, net, filt, 2)
    agents[2].reset([7.0, 7.0], t=20)
    assert agents[2].sample == 20
    assert agents[2].sense(21, [y[20, 2]]) is None
    assert np.isnan(agents[2].bound)
    agents[2] = gr.Agent(model, net, filt, 2)
    agents[2].reset([7.0, 7.0], t=20)
    step(agents, net, 21, y[20])
    assert np.linalg.norm(agents[2].estimate) < 1.0
    joined = gr.Agent(model, net, filt, 2)
    joined.join(22, [m for m in (agents[j].sense(22, [0.0]) for j in (1, 3)) if m is not None])
    assert joined.sample == 22
    assert np.linalg.norm(joined.estimate) < 1.0


@pytest.mark.parametrize("filter", FILTERS, ids=lambda f: f.name)
def test_a_snapshot_knows_whether_the_agent_has_heard_anybody(filter: gr.Filter) -> None:
    design = gr.prepare(*problem(), filter)
    fresh = design.agent(0)
    fresh.reset([7.0, 7.0], t=100)
    settled = design.agent(0)
    settled.sense(1, [0.0])
    for _ in range(settled.rounds):
        settled.fuse([])
    for source in (fresh, settled):
        kept = design.agent(0)
        if source is settled:
            kept.reset([7.0, 7.0], t=100)  # whatever it was before
        kept.load(source.save())
        carried = pickle.loads(pickle.dumps(source))
        assert kept == source and carried == source
        t = source.sample + 1
        said = [one.sense(t, [0.0]) for one in (source, kept, carried)]
        assert said[0] == said[1] == said[2] and (said[0] is None) == (source is fresh)
    alone = design.agent(0)
    alone.join(50, [])
    kept = design.agent(0)
    kept.load(alone.save())
    assert alone.sense(51, [0.0]) is None and kept.sense(51, [0.0]) is None


def design_of(agents: int, states: int, complete: bool = False) -> gr.Prepared:
    eye = np.eye(states)
    model = gr.Model(
        0.9 * eye, [eye] * agents, process_covariance=0.1 * eye, measurement_covariance=[0.1 * eye] * agents
    )
    network = gr.Network.complete(agents) if complete else gr.Network.ring(agents)
    return gr.prepare(model, network, gr.filters.PartialSharing(gain=0.1, shared=1))


@pytest.mark.parametrize("foreign", [design_of(5, 3), design_of(9, 2), design_of(5, 2, complete=True)])
def test_messages_of_another_design_are_refused(foreign: gr.Prepared) -> None:
    """Also where their bodies have the same fields: another dimension, size or network."""
    agent, other = design_of(5, 2).agent(0), foreign.agent(1)
    agent.sense(1, [0.0, 0.0])
    said = other.sense(1, [7.0] * foreign.model.states)
    before = agent.estimate.copy()
    with pytest.raises(
        gr.InvalidInput, match="a message from agent 1 of another design, expected messages of the same"
    ):
        agent.fuse([said])
    assert np.array_equal(agent.estimate, before)


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("intact", None),
        ("intact", 0.3),
        ("estimate", [float("nan"), 0.0]),
        ("estimate", [1e308, 0.0]),
        ("estimate", np.array([1j, 0.0])),
        ("proved", [1.5]),
        ("proved", 3),
    ],
)
def test_values_of_lies_are_read_strictly(field: str, value: object) -> None:
    message = gr.Agent(*problem(), FILTERS[0], 1).sense(1, [1e9])
    assert message is not None
    with pytest.raises(gr.InvalidInput, match=f"^message field {field}: got "):
        message.replace(field, value)


def test_messages_have_fields_can_be_kept_and_be_lied_in() -> None:
    model, net = problem()
    message = gr.Agent(model, net, FILTERS[0], 1).sense(1, [1e9])
    assert message is not None
    assert (message.sender, message.sample, message.round) == (1, 1, 0)
    assert list(message.fields) == ["estimate", "intact", "proved"]
    assert message.fields["intact"] is True
    assert message.fields["proved"] == [1]
    again = gr.Message.from_bytes(message.to_bytes())
    assert again == message
    assert hash(again) == hash(message)
    assert pickle.loads(pickle.dumps(message)) == message
    assert eval(repr(message), {"garrison": gr}) == message
    lie = message.replace("proved", [0, 3]).replace("intact", False).replace("estimate", [1.0, 2.0])
    assert lie != message
    assert lie.fields["proved"] == [0, 3]
    assert len(lie.body) == len(message.body) == 2 * 8 + 1 + 1
    with pytest.raises(gr.InvalidInput, match="prooved"):
        message.replace("prooved", [1])
    with pytest.raises(gr.InvalidInput, match="agent 9"):
        message.replace("proved", [9])
    with pytest.raises(gr.InvalidInput, match="2 numbers"):
        message.replace("estimate", [1.0])


def test_what_an_agent_cannot_use_is_refused_by_name_or_counted() -> None:
    model, net = problem()
    filt = FILTERS[0]
    agent = gr.Agent(model, net, filt, 0)
    with pytest.raises(gr.InvalidInput, match="sense to be called first"):
        agent.fuse([])
    old = gr.Agent(model, net, filt, 1).sense(1, [0.0])
    agent.sense(1, [0.0])
    with pytest.raises(gr.InvalidInput, match="fuse to be called first"):
        agent.sense(2, [0.0])
    for _ in range(agent.rounds):
        agent.fuse([])
    agent.sense(2, [0.0])
    agent.fuse([old])
    assert agent.dropped == 1  # a message of the previous sample is late: it is lost
    stranger = gr.Agent(model, net, filt, 2).sense(1, [0.0])
    with pytest.raises(gr.InvalidInput, match="agent 2"):
        agent.fuse([stranger])
    other = gr.Agent(model, net, gr.filters.Dkf(), 1).sense(2, [0.0])
    with pytest.raises(gr.InvalidInput, match="a message of rdkf"):
        agent.fuse([other])
    wide = gr.Model(np.eye(9), [np.eye(9)[:1]] * AGENTS, process_bound=0.1, measurement_bound=0.1)
    nine = gr.Agent(wide, net, gr.filters.Saturation(threshold=1.0), 1).sense(2, [0.0])
    with pytest.raises(gr.InvalidInput, match="of another design"):
        agent.fuse([nine])
    many = gr.Agent(
        gr.Model(model.A, [[[1.0, 0.0]]] * 130, process_bound=0.02, measurement_bound=0.05),
        gr.Network.ring(130),
        filt,
        1,
    ).sense(2, [0.0])
    with pytest.raises(gr.InvalidInput, match="of another design"):
        agent.fuse([many])
    for junk in (b"", b"abc", bytes(300), old.to_bytes()[:-1] if old is not None else b""):
        with pytest.raises(gr.InvalidInput):
            gr.Message.from_bytes(junk)
        with pytest.raises(gr.InvalidInput):
            agent.load(junk)
    with pytest.raises(gr.InvalidInput, match="a sample after"):
        gr.Agent(model, net, filt, 0).sense(0, [0.0])


def test_designs_travel_as_files_whole_or_in_parts(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    model, net = problem()
    for filt in FILTERS:
        prepared = gr.prepare(model, net, filt)
        path = tmp_path / "x.gdesign"
        prepared.save(path)
        again = gr.Prepared.load(path)
        assert again == prepared
        assert hash(again) == hash(prepared)
        assert pickle.loads(pickle.dumps(prepared)) == prepared == copy.deepcopy(prepared)
        run, repeated = (p.simulate(steps=5, seed=3, noise="normal") for p in (prepared, again))
        assert run == repeated == gr.simulate(model, net, filt, steps=5, seed=3, noise="normal")
        assert gr.Agent.from_part(prepared.part(3)) == prepared.agent(3)
        assert main(["design-file", str(path), "--show"]) == 0
        shown = capsys.readouterr().out
        assert f"filter  {again.filter.name}, 5 agents, 2 states" in shown
        assert "gains\n" in shown
        prepared.save(path, agent=3)
        assert main(["design-file", str(path)]) == 0
        assert "agent 3 alone" in capsys.readouterr().out
        data = prepared.to_bytes()
        with pytest.raises(gr.InvalidInput, match="damaged"):
            gr.Prepared.from_bytes(data[:-1] + bytes([data[-1] ^ 1]))
    with pytest.raises(gr.InvalidInput):
        gr.Prepared.from_bytes(b"nonsense")
    (tmp_path / "bad").write_text("nonsense")
    assert main(["design-file", str(tmp_path / "bad")]) == 2
    with pytest.raises(gr.InvalidInput, match="agent in 0"):
        prepared.agent(5)


def test_links_may_fail_by_schedule_or_by_record() -> None:
    model, net = problem()
    filt = gr.filters.ScalarGain()
    run = gr.simulate(
        model, net, filt, steps=6, noise="normal", link={"cuts": [(None, 2, 3, 5)], "lost": [(6, 0, 1, 0)]}
    )
    assert run.counters["lost"] == 2 * 2 * 1 * filt.params["rounds"] + 1
    with pytest.raises(gr.InvalidInput, match="expected 4 whole numbers"):
        gr.simulate(model, net, filt, steps=6, link={"cuts": [(1, 2)]})
    with pytest.raises(gr.InvalidInput, match="agent 9"):
        gr.simulate(model, net, filt, steps=6, noise="normal", link={"lost": [(6, 0, 9, 0)]})


def test_a_run_is_the_same_for_any_number_of_threads_and_is_repeated_as_it_was_asked_for() -> None:
    model, net = problem()
    lossy = {"link": {"drop": 0.3}, "certificate": "flooded", "attacked": 1, "conditions": False}
    runs = [
        gr.simulate(model, net, gr.filters.ScalarGain(rounds=2), steps=20, trials=4, threads=k, **lossy)
        for k in (1, 2, 4)
    ]
    assert runs[0] == runs[1] == runs[2] == gr.again(runs[0])
    alone = [
        gr.simulate(model, net, gr.filters.ScalarGain(rounds=2), steps=20, first_trial=k, **lossy).bytes_per_step
        for k in range(4)
    ]
    assert len(set(alone)) > 1 and runs[0].bytes_per_step == int(np.floor(np.mean(alone) + 0.5))
    unasked = gr.simulate(model, net, FILTERS[0], steps=3, conditions=False)
    assert gr.again(unasked) == unasked


@pytest.mark.parametrize(
    ("filter", "lie", "words"),
    [
        (FILTERS[0], {"field": "proved", "members": [40]}, "falsify.members: got 40, expected ids of agents in 0..4"),
        (
            FILTERS[0],
            {"field": "estimate", "members": [1]},
            "falsify.members: got members of estimate, which is no set",
        ),
        (FILTERS[0], {"field": "proved", "value": 7.0}, "falsify.value: got 7 for proved, which is a set"),
        (FILTERS[1], {"field": "nonsense", "value": 7.0}, 'falsify.field: got unknown name "nonsense"'),
    ],
)
def test_a_lie_that_no_message_has_room_for_is_refused(filter: gr.Filter, lie: dict, words: str) -> None:  # type: ignore[type-arg]
    with pytest.raises(gr.InvalidInput) as told:
        gr.simulate(*problem(), filter, steps=3, attack=gr.attacks.Falsify(agents=[0], **lie))
    assert words in str(told.value)


def test_a_direct_certificate_is_there_also_where_the_family_has_a_bound_of_its_own() -> None:
    model, _ = problem()
    net, lie = gr.Network.complete(AGENTS), gr.attacks.Forge(agents=[0], offset=2.0)
    for start in ({}, {"initial_error": 3.0}):  # knowing more must not take the proof away
        filter = gr.filters.Saturation(threshold=0.5, rounds=3, attacked=1, **start)
        run = gr.simulate(model, net, filter, steps=20, noise="uniform", attack=lie, certificate="direct", failure=0.0)
        honest = np.arange(AGENTS) != 0
        assert np.isfinite(run.bound[:, 1:, honest]).all()  # type: ignore[index]
        assert (run.error[:, 1:, honest] <= run.bound[:, 1:, honest]).all()  # type: ignore[index]
        assert any("no bound but the direct certificate's is reported" in w for w in run.warnings)
