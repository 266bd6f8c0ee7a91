"""Attacks of one's own: seeded functions on measurements and messages, with every filter."""

import pickle
from typing import Any

import garrison as gr
import numpy as np
import pytest

MODEL = gr.Model([[1.0, 0.1], [0.0, 0.9]], [[1, 0], [0, 1]] * 3, process_bound=0.02, measurement_bound=0.01)
NETWORK = gr.Network.ring(6)
SATURATION = gr.filters.Saturation(threshold=1.0, rounds=3)
RUN: dict[str, Any] = {"steps": 20, "trials": 3, "seed": 5, "x0": [1, 1], "start": [1, 0]}


def shifted(t: int, agent: int, y: Any, rng: np.random.Generator) -> Any:
    return y + 2.5


def forged(t: int, round: int, sender: int, receiver: int, message: dict[str, Any], rng: Any) -> Any:
    return {"estimate": message["estimate"] + 2.5}


def noise(t: int, agent: int, y: Any, rng: np.random.Generator) -> Any:
    return y + rng.normal(size=y.shape)


class Remembers:
    """Says again what it saw first."""

    def __init__(self) -> None:
        self.first: Any = None

    def __call__(self, t: int, agent: int, y: Any, rng: Any) -> Any:
        if self.first is None:
            self.first = y
        return self.first


@pytest.mark.parametrize(
    "filter", [SATURATION, gr.filters.ScalarGain(), gr.filters.Lfre(faulty=1, poles=[0.2, 0.3])], ids=str
)
def test_it_does_what_the_built_in_attack_does(filter: gr.Filter) -> None:
    when: dict[str, Any] = {"agents": [1, 4], "start": 3, "stop": 15, "probability": 0.6}
    network = gr.Network.complete(6)
    own = gr.simulate(MODEL, network, filter, **RUN, attack=gr.attacks.custom(shifted, **when))
    assert own == gr.simulate(MODEL, network, filter, **RUN, attack=gr.attacks.Bias(**when, value=2.5))
    lies = gr.simulate(MODEL, network, filter, **RUN, attack=gr.attacks.custom_message(forged, **when))
    if filter.name != "lfre":  # its messages carry more than the estimate
        assert lies == gr.simulate(MODEL, network, filter, **RUN, attack=gr.attacks.Forge(**when, offset=2.5))
    assert lies.counters["forged"] > 0


def test_it_is_seeded_and_trials_differ() -> None:
    attack = gr.attacks.custom(noise, agents=[2])
    run = gr.simulate(MODEL, NETWORK, SATURATION, **RUN, attack=attack, threads=2)
    assert run == gr.simulate(MODEL, NETWORK, SATURATION, **RUN, attack=attack)
    clean = gr.simulate(MODEL, NETWORK, SATURATION, **RUN)
    lies = (run.measurements - clean.measurements)[:, :, 2]  # type: ignore[operator]
    assert len(np.unique(lies.round(9))) == lies.size  # every trial and sample another
    other = gr.simulate(MODEL, NETWORK, SATURATION, **RUN | {"seed": 6}, attack=attack)
    assert not np.array_equal(other.measurements, run.measurements)  # type: ignore[arg-type]


def test_an_object_starts_every_trial_afresh() -> None:
    run = gr.simulate(MODEL, NETWORK, SATURATION, **RUN, attack=gr.attacks.custom(Remembers(), agents=[0], start=5))
    told = run.measurements[:, 4:, 0]  # type: ignore[index]
    assert (told == told[:, :1]).all() and len(np.unique(told[:, 0])) == 3


def test_messages_can_be_withheld_and_any_field_falsified() -> None:
    def silent(t: int, round: int, sender: int, receiver: int, message: dict[str, Any], rng: Any) -> Any:
        return None if receiver == 1 else message

    run = gr.simulate(MODEL, NETWORK, SATURATION, **RUN, attack=gr.attacks.custom_message(silent, agents=[0]))
    assert run.counters["lost"] == 3 * 20 * 3

    def accuse(t: int, round: int, sender: int, receiver: int, message: dict[str, Any], rng: Any) -> Any:
        assert message["intact"] is True
        return {"proved": [5], "intact": True}

    detector = gr.filters.Saturation(threshold=1.0, rounds=3, attacked=1, initial_error=2.0, detector=True)
    run = gr.simulate(MODEL, NETWORK, detector, **RUN, attack=gr.attacks.custom_message(accuse, agents=[0]))
    assert run.first_accused() == {5: 1}
    falsified = gr.attacks.Falsify(agents=[0], field="proved", members=[5])
    assert run == gr.simulate(MODEL, NETWORK, detector, **RUN, attack=falsified)


def test_errors_name_the_agent_and_the_sample() -> None:
    def fails(t: int, agent: int, *_: Any) -> Any:
        raise OSError("no such log")

    with pytest.raises(OSError, match="no such log") as caught:
        gr.simulate(MODEL, NETWORK, SATURATION, **RUN, attack=gr.attacks.custom(fails, agents=[3], start=7))
    assert caught.value.__notes__ == ["raised in fails, agent 3, sample 7"]
    with pytest.raises(OSError, match="no such log") as caught:
        gr.simulate(MODEL, NETWORK, SATURATION, **RUN, attack=gr.attacks.custom_message(fails, agents=[3], start=7))
    first = [f"raised in fails, from agent 3 to {receiver}, sample 7, round 0" for receiver in (2, 4)]
    assert caught.value.__notes__[0] in first
    for wrong, words in ((lambda *_: [1, 2], "got 2 numbers, expected 1"), (lambda *_: "x", "attack .*sample 1")):
        with pytest.raises(gr.InvalidInput, match=words):
            gr.simulate(MODEL, NETWORK, SATURATION, **RUN, attack=gr.attacks.custom(wrong, agents=[3]))
    with pytest.raises(gr.InvalidInput, match=r"did you mean.*estimate"):
        unknown = gr.attacks.custom_message(lambda *_: {"estimat": [1, 2]}, agents=[3])
        gr.simulate(MODEL, NETWORK, SATURATION, **RUN, attack=unknown)


def test_bad_arguments_and_copies() -> None:
    with pytest.raises(gr.InvalidInput, match="custom: got 3, expected a function"):
        gr.attacks.custom(3, agents=[1])  # type: ignore[arg-type]
    with pytest.raises(gr.InvalidInput, match="neither agents nor schedule"):
        gr.attacks.custom(shifted)
    with pytest.raises(gr.InvalidInput, match="start and schedule"):
        gr.attacks.custom(shifted, schedule=[(1, [2])], start=3)
    for schedule, which in ((True, r"schedule\[0\]"), ([(1, [2]), 3], r"schedule\[1\]"), ([(1, "DUB")], r"\[0\]\[1\]")):
        with pytest.raises(gr.InvalidInput, match=f"{which}: got .*, expected a"):
            gr.attacks.custom(shifted, schedule=schedule)  # type: ignore[arg-type]
    attack = gr.attacks.custom(shifted, 3, start=2, stop=9)
    assert pickle.loads(pickle.dumps(attack)) == attack and attack.own
    assert (attack.name, attack.target, attack.agents, attack.params) == (
        "custom",
        "measurement",
        [3],
        {"function": shifted},
    )
    assert repr(attack) == "garrison.attacks.custom(agents=[3], function=test_own_attack.shifted, start=2, stop=9)"
    phases = gr.attacks.custom_message(forged, schedule=[(1, [2]), (5, [0, 1])])
    assert phases.target == "message" and phases.schedule == [(1, [2]), (5, [0, 1])]
