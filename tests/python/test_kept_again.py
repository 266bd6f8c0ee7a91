"""What made a run is kept with it, equal values are equal, and crafted files and states are refused."""

import copy
import json
import pickle
from pathlib import Path
from typing import Any

import garrison as gr
import numpy as np
import pytest
from garrison.storage import digest
from test_objects import ATTACKS, CODE, FILTERS, keeps

MODEL = gr.Model(
    [[0.9]],
    [[1.0]] * 3,
    process_bound=0.1,
    measurement_bound=0.1,
    process_covariance=0.01,
    measurement_covariance=0.01,
)
RING, GAIN = gr.Network.ring(3), gr.filters.ScalarGain()
LIES = [
    [gr.attacks.Denial([1])],
    [gr.attacks.Constant([1], value="nan")],
    [gr.attacks.Bias([1], value=2.0, start=3), gr.attacks.Bias([1], value=3.0)],
    [gr.attacks.Bias([2], value=2.0, start=99)],
    [gr.attacks.Random([0], size=1.0, probability=0.5), gr.attacks.Forge([1], offset=1.0, probability=0.5)],
    [gr.attacks.Forge([1], offset=1.0, probability=0.5)],
]


@pytest.mark.parametrize("attack", LIES, ids=lambda a: "+".join(one.name for one in a))
@pytest.mark.parametrize("logs", [1, 2])
def test_a_replay_with_attacks_is_the_call_that_made_it(attack: list[gr.attacks.Attack], logs: int) -> None:
    log = np.random.default_rng(1).normal(size=(5, 3) if logs == 1 else (2, 5, 3))
    for more in ({}, {"certificate": "local", "attacked": 1, "failure": 0}):
        given: dict[str, Any] = {"measurements": log, "attack": attack, "seed": 4, "trials": 2, "link": {"drop": 0.1}}
        run = gr.replay(MODEL, RING, GAIN, **given | more)
        again = gr.again(run)
        assert again == run and repr(again) == repr(run) and hash(again) == hash(run)
        keeps(run)
    without = gr.replay(MODEL, RING, GAIN, measurements=log, attack=attack, keep=["estimate"])
    assert without.log is None


@pytest.mark.parametrize("suffix", [".npz", ".nc", ".zarr"])
def test_the_log_is_saved(suffix: str, tmp_path: Path) -> None:
    for package in {".npz": (), ".nc": ("xarray", "scipy"), ".zarr": ("xarray", "zarr")}[suffix]:
        pytest.importorskip(package)
    log = np.arange(15.0).reshape(5, 3)
    run = gr.replay(MODEL, RING, GAIN, measurements=log, attack=LIES[0], trials=2)
    log[0] = 7.0  # the caller's own
    run.save(tmp_path / f"run{suffix}")
    again = gr.Run.load(tmp_path / f"run{suffix}")
    assert again == run == gr.again(again) and repr(again) == repr(run)
    assert np.array_equal(again.log, np.arange(15.0).reshape(1, 5, 3))  # type: ignore[arg-type]


def test_what_made_a_run_is_the_same_wherever_it_is_kept(tmp_path: Path) -> None:
    flags = np.ones((9, 3), dtype=bool)
    flags[3:5, 1] = False
    runs = [
        gr.simulate(MODEL, gr.VaryingNetwork(RING, flags), GAIN, steps=9),
        gr.simulate(MODEL, RING, GAIN, steps=3, certificate="local", attacked=1, levels=(3.0, 3.5)),
        gr.simulate(MODEL, RING, GAIN, steps=3, link={"cuts": ((0, 1, 2, None),), "lost": [(1, 0, 0, 1)]}),
    ]
    for run in runs:
        keeps(run)
        run.save(tmp_path / "run.npz")
        loaded = gr.Run.load(tmp_path / "run.npz")
        assert loaded == run and repr(loaded) == repr(run) and loaded.made == run.made
        assert gr.again(loaded) == run


def test_zeros_are_equal_whatever_their_sign() -> None:
    def model(zero: float) -> gr.Model:
        return gr.Model([[0.9, zero], [0.0, 0.8]], [[1.0, zero], [zero, 1.0], [1.0, 1.0]])

    platoon = {"vehicles": 6, "range": 2, "period": 0.1, "attacked": 1, "mu": 0.1, "q": 1.0, "beta": 2.0}
    makers: list[Any] = [
        lambda z: gr.attacks.Bias([1], value=z),
        lambda z: gr.filters.Platoon(
            process_noise=0.1, measurement_noise=0.1, initial_error=1.0, reference=[z, 1.0], gs=1.0, gv=2.0
        ),
        model,
        lambda z: gr.prepare(model(z), RING, gr.filters.ScalarGain(step=0.2)),
        lambda z: gr.platoon.Setting(**platoon, eps=z),
        lambda z: gr.partial_sharing.SelectionProblem(np.array([[1.0, z], [z, 1.0]]), 1, 1),
        lambda z: gr.VaryingModel(model(z), A=np.full((2, 2, 2), z)),
    ]
    for make in makers:
        one, two = make(0.0), make(-0.0)
        assert one == two and hash(one) == hash(two)


def crafted(path: Path, change: Any) -> None:
    """A file with another content and a digest that fits."""
    with np.load(path) as archive:
        found = {key: archive[key] for key in archive.files}
    document, _ = json.loads(str(found.pop("run_json"))), found.pop("run_digest")
    document = change(document, found) or document
    text = json.dumps(document)
    np.savez(path, run_json=np.array(text), run_digest=np.array(digest(text, found)), **found)  # type: ignore[arg-type]


def put(**arrays: Any) -> Any:
    return lambda document, found: found.update(arrays)


def say(**lists: Any) -> Any:
    return lambda document, found: document.update(lists)


@pytest.mark.parametrize(
    "change",
    [
        lambda document, found: [1],
        lambda document, found: "words",
        put(error=np.zeros(3)),
        put(error=np.zeros((1, 4, 2))),
        put(error=np.array([[["a"] * 3] * 4])),
        put(estimate=np.zeros((1, 4, 3))),
        put(verdict=np.zeros((1, 4, 3))),
        put(measurements=np.zeros(3)),
        put(signal_x=np.zeros((1, 4))),
        put(varying_A=np.zeros(3)),
        say(counters=[1]),
        say(counters={"lost": "x"}),
        say(warnings="no"),
        say(warnings=[1]),
        say(accusations=[[0, 1, 3]]),
        say(accusations=[["x", 1, []]]),
        say(details=3),
        say(made=[]),
        say(bytes_per_step=None),
        say(objects=3),
        say(objects={"model": {}, "network": {}, "filter": {}}),
    ],
)
def test_crafted_files_are_refused(change: Any, tmp_path: Path) -> None:
    gr.simulate(MODEL, RING, GAIN, steps=3).save(tmp_path / "run.npz")
    crafted(tmp_path / "run.npz", change)
    with pytest.raises(gr.Error, match=r"run\.npz: got .*, expected a run written by Run\.save"):
        gr.Run.load(tmp_path / "run.npz")


def test_crafted_states_are_refused() -> None:
    objects = [
        MODEL,
        RING,
        *(plain for plain, _ in (FILTERS[0], ATTACKS[0])),
        gr.Agent(MODEL, RING, gr.filters.Dkf(), 0),
    ]
    for whole in objects:
        state = whole.__getstate__()
        states: list[Any] = [{}, {"edges": 3}, {"name": 3}, b"", b"x", None, 3]
        if isinstance(state, dict):
            states += [{k: v for k, v in state.items() if k != key} for key in state]
            states += [state | {key: wrong} for key in state for wrong in (None, 3, "x", {"a": 1}, [["x"]])]
        for one in states:
            made = type(whole).__new__(type(whole))
            try:
                made.__setstate__(one)
            except gr.Error as error:
                assert ": got " in str(error) and "bug" not in str(error), (whole, one)
            else:
                assert eval(repr(made), dict(CODE)) == made == copy.deepcopy(made) == pickle.loads(pickle.dumps(made))
