"""Filters and attacks of one's own are kept as they are: in copies, in pickles, and in files what files can hold."""

import copy
import datetime
import functools
import os
import pickle
import subprocess
import sys
from pathlib import Path
from typing import Any

import garrison as gr
import numpy as np
import pytest

MODEL, RING = gr.Model([[0.9]], [[1.0]] * 3, process_bound=0.1, measurement_bound=0.1), gr.Network.ring(3)


class Own(gr.Filter):
    """Does nothing with what it was made with."""

    def __init__(self, p: Any = 1) -> None:
        super().__init__()
        self.p = p

    def sense(self, agent: gr.AgentInfo, state: Any, y: Any, t: int) -> Any:
        return {"estimate": state.estimate}

    def fuse(self, agent: gr.AgentInfo, state: Any, inbox: Any, round: int) -> Any:
        return None


class Designed(Own):
    """Counts how often it was designed."""

    designs = 0

    def design(self, model: gr.Model, network: gr.Network) -> Any:
        Designed.designs += 1
        return {"gain": np.array([0.5])}


def lie(t: int, agent: int, y: Any, rng: Any) -> Any:
    return y + 1.0


class Liar:
    """Lies as an object, and by a method."""

    def __call__(self, t: int, agent: int, y: Any, rng: Any) -> Any:
        return y

    def lie(self, t: int, agent: int, y: Any, rng: Any) -> Any:
        return y


KEPT_IN_FILES = [
    (1, (2.5, "x")),
    np.arange(6.0).reshape(2, 3),
    np.array(["a", "bc"]),
    np.array([1 + 2j, np.nan]),
    np.array(["2020-01-01"], dtype="datetime64[D]"),
    np.zeros((0, 3)),
    np.float32(1.5),
    {1: "a", (2, 3): [4]},
    {"garrison:tuple": 1},
    {1, 2, 3},
    frozenset("ab"),
    1 - 2j,
    b"\x00\xff",
    datetime.date(2020, 1, 2),
    datetime.datetime(2020, 1, 2, 3, 4, 5, 6, tzinfo=datetime.UTC),
    Path("a") / "b",
    MODEL,
    RING,
    gr.filters.ScalarGain(rounds=3),
    Own((1, 2)),
    [float("inf"), None, True, -(10**30), {"a": (np.eye(2),)}],
]
IN_PICKLES_ALONE = [lie, np.ma.masked_array([1.0, 2.0], [False, True]), gr.Verdict.ATTACKED, [{"a": Liar}], range(3)]


def exactly(a: Any, b: Any) -> bool:
    """Also of the same types, and arrays of the same kind."""
    if isinstance(a, np.ndarray):
        return type(a) is type(b) and (a.dtype, a.shape, a.tobytes()) == (b.dtype, b.shape, b.tobytes())
    if isinstance(a, (list, tuple)):
        return type(a) is type(b) and len(a) == len(b) and all(map(exactly, a, b))
    if isinstance(a, dict):
        return type(a) is type(b) and list(a) == list(b) and all(map(exactly, a.values(), b.values()))
    return type(a) is type(b) and a == b


def equal(one: gr.Run, two: gr.Run) -> bool:
    return one == two and hash(one) == hash(two) and repr(one) == repr(two) and one.filter == two.filter


@pytest.mark.parametrize("p", KEPT_IN_FILES, ids=lambda p: type(p).__name__)
def test_attributes_of_a_filter_come_back_as_they_were(p: Any, tmp_path: Path) -> None:
    run = gr.simulate(MODEL, RING, Own(p), steps=2)
    run.save(tmp_path / "run.npz")
    copies = [copy.copy(run), copy.deepcopy(run), pickle.loads(pickle.dumps(run)), gr.Run.load(tmp_path / "run.npz")]
    for again in copies:
        assert equal(again, run) and equal(gr.again(again), run)
        assert exactly(again.filter.p, p)  # type: ignore[attr-defined]


def test_sets_are_shown_in_one_order() -> None:
    assert repr(Own({"b", "a"})).endswith("Own(p={'a', 'b'})")
    assert repr(Own(frozenset("ba"))).endswith("Own(p=frozenset({'a', 'b'}))")
    assert repr(Own(set())).endswith("Own(p=set())")


@pytest.mark.parametrize("p", IN_PICKLES_ALONE, ids=lambda p: type(p).__name__)
def test_what_no_file_holds_is_refused_by_name_and_pickled(p: Any, tmp_path: Path) -> None:
    run = gr.simulate(MODEL, RING, Own(p), steps=2)
    for again in (copy.copy(run), pickle.loads(pickle.dumps(run))):
        assert again == again and type(again.filter.p) is type(p)
    with pytest.raises(gr.InvalidInput, match=r"Own\.p(\[0\]\['a'\])?: got an object of type .*, expected numbers, .*"):
        run.save(tmp_path / "run.npz")
    assert list(tmp_path.iterdir()) == []


def test_a_list_that_holds_itself_is_refused(tmp_path: Path) -> None:
    endless: list[Any] = []
    endless.append(endless)
    run = gr.simulate(MODEL, RING, Own(endless), steps=1)
    with pytest.raises(gr.InvalidInput, match="one that holds itself"):
        run.save(tmp_path / "run.npz")
    with pytest.raises(RecursionError):
        repr(run.filter)


def test_a_pickled_run_finds_its_filter_in_another_process(tmp_path: Path) -> None:
    (tmp_path / "mine.py").write_text(
        "import garrison as gr\n"
        "class Mine(gr.Filter):\n"
        "    def sense(self, agent, state, y, t): return {'estimate': state.estimate}\n"
        "    def fuse(self, agent, state, inbox, round): return None\n"
    )
    make = (
        "import garrison as gr, mine, pickle\n"
        "run = gr.simulate(gr.Model([[0.9]], [[1.0]] * 3), gr.Network.ring(3), mine.Mine(), steps=2)\n"
        "pickle.dump(run, open('run.pickle', 'wb'))"
    )
    read = "import pickle; run = pickle.load(open('run.pickle', 'rb')); print(type(run.filter).__name__)"
    env = os.environ | {"PYTHONPATH": os.pathsep.join(map(os.path.abspath, sys.path))}
    for code in (make, read):
        done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, env=env, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
    assert done.stdout == "Mine\n"


def test_prepared_filters_of_ones_own_are_kept_with_their_gains() -> None:
    for filt in (Own((1, 2)), Designed()):
        prepared = gr.prepare(MODEL, RING, filt, certificate="local", attacked=1, failure=0)
        before = Designed.designs
        for again in (copy.copy(prepared), copy.deepcopy(prepared), pickle.loads(pickle.dumps(prepared)), prepared):
            assert again == prepared and hash(again) == hash(prepared) and repr(again) == repr(prepared)
            assert again.simulate(steps=2) == prepared.simulate(steps=2)
            assert again.certificate == prepared.certificate
        assert Designed.designs == before
        assert prepared not in {1} and prepared in {prepared}
        assert prepared != gr.prepare(MODEL, RING, gr.filters.ScalarGain()) != prepared
        assert prepared != gr.prepare(MODEL, RING, filt) != gr.prepare(MODEL, RING, Own(3))


def test_filters_compare_by_the_values_of_their_attributes() -> None:
    large = np.zeros(5000)
    for a, b in (
        ({8, 0}, {0, 8}),
        (0.0, -0.0),
        (float("nan"), float("nan")),
        ({"a": large}, {"a": large + 0.0}),
        ({"a": 1, "b": 2}, {"b": 2, "a": 1}),
        (1, 1.0),
    ):
        assert Own(a) == Own(b) and hash(Own(a)) == hash(Own(b))
    other = large.copy()
    other[2500] = 1.0
    for a, b in (({"a": large}, {"a": other}), ((1, 2), [1, 2]), (lambda: 1, lambda: 1), (np.eye(2), 3)):
        assert Own(a) != Own(b)
    pandas = pytest.importorskip("pandas")
    table = pandas.DataFrame({"a": [1, 2]})
    assert Own(table) == Own(table) and Own(table) != Own(table.copy()) and hash(Own(table)) == hash(Own(table.copy()))


@pytest.mark.parametrize(
    ("function", "code"),
    [
        (lie, "test_kept_own.lie"),
        (lambda t, agent, y, rng: y, "<function <lambda>>"),
        (Liar(), "<test_kept_own.Liar object>"),
        (Liar().lie, "<bound method Liar.lie of <test_kept_own.Liar object>>"),
    ],
)
def test_an_attack_of_ones_own_is_shown_as_code_or_without_an_address(function: Any, code: str) -> None:
    attack = gr.attacks.custom(function, agents=[1], start=3)
    assert repr(attack) == f"garrison.attacks.custom(agents=[1], function={code}, start=3)"
    assert attack == gr.attacks.custom(function, agents=[1], start=3) and attack != gr.attacks.custom(lie, agents=[1])
    assert hash(attack) == hash(gr.attacks.custom(function, agents=[1], start=3))
    run = gr.simulate(MODEL, RING, gr.filters.ScalarGain(), steps=4, attack=attack)
    assert run.made["attack"] == [{"own": repr(attack)}]
    if not code.startswith("<"):
        assert eval(repr(attack), {"garrison": gr, "test_kept_own": sys.modules[__name__]}) == attack


def test_two_functions_without_a_name_are_two_attacks() -> None:
    one, two = (gr.attacks.custom(lambda t, agent, y, rng: y, agents=[1]) for _ in range(2))
    assert repr(one) == repr(two) and one != two
    assert "0x" not in repr(gr.attacks.custom(functools.partial(lie), agents=[1]))


class Judge(Own):
    """Its verdict is what it was made with."""

    def report(self, agent: gr.AgentInfo, state: Any) -> Any:
        return {"verdict": self.p}


@pytest.mark.parametrize("verdict", list(gr.Verdict))
def test_verdicts_have_names_and_words(verdict: gr.Verdict) -> None:
    for given in (verdict, int(verdict), verdict.name, verdict.name.lower(), verdict.word):
        run = gr.simulate(MODEL, RING, Judge(given), steps=1)
        assert (run.verdict[0, 1] == verdict).all()  # type: ignore[index]
    with pytest.raises(gr.InvalidInput, match="did you mean"):
        gr.simulate(MODEL, RING, Judge(verdict.name + "X"), steps=1)


class Signals(Own):
    """One number for each of the names that it was made with."""

    def __init__(self, *names: str) -> None:
        super().__init__()
        self.signals = names

    def report(self, agent: gr.AgentInfo, state: Any) -> Any:
        return {name: float(k) for k, name in enumerate(self.signals)}


@pytest.mark.parametrize(
    ("names", "why"),
    [
        (("a/b",), "path"),
        (("a\\b",), "path"),
        ((".",), "path"),
        (("..",), "path"),
        (("",), "is empty"),
        (("x\0y",), "cannot be printed"),
        (("x\ny",), "cannot be printed"),
        (("é" * 150,), "more than 200 bytes"),
        (("e\u0301",), "two parts"),
        (("it's",), "apostrophe"),
        ((" a",), "space"),
        (("a", "b", "a"), "is there twice"),
    ],
)
def test_names_of_signals_that_no_file_can_hold_are_refused_before_the_run(names: tuple[str, ...], why: str) -> None:
    for call in (lambda f: gr.prepare(MODEL, RING, f), lambda f: gr.simulate(MODEL, RING, f, steps=1)):
        with pytest.raises(gr.InvalidInput, match=rf"Signals\.signals\[0\]: got .*{why}.*, expected a name"):
            call(Signals(*names))


@pytest.mark.parametrize("suffix", [".npz", ".nc", ".zarr"])
def test_all_other_names_of_signals_come_back(suffix: str, tmp_path: Path) -> None:
    for package in {".npz": (), ".nc": ("xarray", "scipy"), ".zarr": ("xarray", "zarr")}[suffix]:
        pytest.importorskip(package)
    inner = [chr(c) for c in range(33, 127) if chr(c) not in "/\\'"]
    names = [*(c for c in inner if c != "."), *(f"a{c}b" for c in inner), "int", "string", ".zgroup", ".zattrs", "a..b"]
    names += ["é", "ß", "a" * 200, "_FillValue", "log", "error", "zarr.json"]
    run = gr.simulate(MODEL, RING, Signals(*names), steps=1, keep=["estimate", "signals"])
    run.save(tmp_path / f"run{suffix}")
    again = gr.Run.load(tmp_path / f"run{suffix}")
    assert again == run and set(again.signals) == set(names)
