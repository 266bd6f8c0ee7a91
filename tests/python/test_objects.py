"""What is public can be kept: pickled, copied, compared, printed as code; bad arguments are refused in our words."""

import copy
import datetime
import pickle
import types
from collections.abc import Callable, Iterator
from math import inf, nan
from pathlib import Path
from typing import Any

import garrison as gr
import networkx as nx
import numpy as np
import pytest
from garrison import _core

CODE = {"garrison": gr, "nan": nan, "inf": inf, "array": np.array, "datetime": datetime, "Path": Path}


def keeps(x: Any) -> None:
    """Every way of keeping x gives an equal object."""
    for again in (pickle.loads(pickle.dumps(x)), copy.copy(x), copy.deepcopy(x), eval(repr(x), dict(CODE))):
        assert again == x
        assert hash(again) == hash(x)
        assert repr(again) == repr(x)
    assert x != repr(x)
    assert x in {x}


def camel(name: str) -> str:
    return "".join(part.capitalize() for part in name.split("_"))


#: what must fit together, and lists with a fixed length
SPECIAL: dict[str, Any] = {
    "coordinated.covariance": [2.0, 0.5, 0.5, 2.0],
    "perturb.width": 2,
    "perturb.deltas": [0.1, 0.2, 0.3, 0.4],
    "constant.value": "-inf",
    "falsify.field": "estimate",
    "falsify.members": [2.0, 3.0],
}


def another(owner: str, info: dict[str, Any]) -> Any:
    """A value within the range of a parameter that is not its default."""
    special = SPECIAL.get(f"{owner}.{info['name']}")
    if special is not None:
        return special
    if info["choices"]:
        return next(c for c in reversed(info["choices"]) if c != info["default"])
    if isinstance(info["default"], bool):
        return not info["default"]
    least = info["least"] if np.isfinite(info["least"]) else -1.0
    most = info["most"] if np.isfinite(info["most"]) else least + 4.0
    if isinstance(info["default"], list):
        return [1.0 / 3.0 * (most - least) + least] * 2
    if isinstance(info["default"], int):
        return int(least) + 2
    return least + (most - least) / 3.0 if most > least else most


def made(infos: list[dict[str, Any]], make: Callable[..., Any]) -> Iterator[tuple[Any, Any]]:
    """(default, changed) objects for every entry and every one of its parameters."""
    for info in infos:
        required = {p["name"]: another(info["name"], p) for p in info["params"] if p["required"]}
        required |= {k.split(".")[1]: v for k, v in SPECIAL.items() if k.startswith(info["name"] + ".")}
        plain = make(info["name"], required)
        yield plain, plain
        for p in info["params"]:
            yield plain, make(info["name"], required | {p["name"]: another(info["name"], p)})


FILTERS = list(made(_core.filter_infos(), gr.filters.make_filter))
ATTACKS = list(made(_core.attack_infos(), lambda name, params: gr.attacks.make(name, [0, 3], start=7, **params)))


@pytest.mark.parametrize(("plain", "changed"), FILTERS, ids=lambda f: repr(f)[17:60])
def test_filters_are_kept(plain: Any, changed: Any) -> None:
    keeps(changed)
    assert type(changed) is getattr(gr.filters, camel(changed.name))
    assert (plain == changed) == (repr(plain.params) == repr(changed.params))  # nan is nan


@pytest.mark.parametrize(("plain", "changed"), ATTACKS, ids=lambda a: repr(a)[17:60])
def test_attacks_are_kept(plain: Any, changed: Any) -> None:
    keeps(changed)
    assert changed.agents == [0, 3]
    assert changed.start == 7
    assert (plain == changed) == (plain.params == changed.params)


def test_families_and_attacks_are_all_there() -> None:
    assert list(gr.filters.FAMILIES) == [camel(info["name"]) for info in _core.filter_infos()]
    assert list(gr.attacks.ATTACKS) == [camel(info["name"]) for info in _core.attack_infos()]
    for name in gr.attacks.ATTACKS:
        assert name in dir(gr.attacks)
        assert getattr(gr.attacks, name).__doc__.startswith(name + "(agents: ")


def test_attacks_remember_their_schedule() -> None:
    phases = [(10, [3]), (20, [5, 7])]
    attack = gr.attacks.Bias(schedule=phases, value=0.1 + 0.2, stop=30, probability=1 / 3)
    keeps(attack)
    assert attack.schedule == phases
    assert (attack.start, attack.stop, attack.probability) == (10, 30, 1 / 3)
    assert attack.params == {"value": 0.1 + 0.2}
    assert attack != gr.attacks.Bias(schedule=phases, value=0.1 + 0.2, stop=31, probability=1 / 3)
    assert gr.attacks.Constant(agents=3, value=5) == gr.attacks.Constant(agents=[3], value="5")


def rows(n: int, agents: int) -> list[np.ndarray]:
    return [np.eye(n)[[i % n]] for i in range(agents)]


def full_model() -> gr.Model:
    return gr.Model(
        [[0.9, 0.1 + 0.2], [0.0, 1 / 3]],
        [[[1.0, 0.0], [0.0, 1.0]], [[0.5, 0.5]], []],
        process_bound=0.1,
        measurement_bound=[0.1, 0.2, 0.3],
        process_covariance=[[0.2, 0.1], [0.1, 0.3]],
        measurement_covariance=[[[0.2, 0.1], [0.1, 0.2]], 0.4, []],
        states=["height", "speed"],
        outputs=["gauge", "log", "sum"],
        sources=["box", "box", "ship"],
        units={"height": "m", "gauge": "mm"},
        exposed=[1, 1, 0],
    )


def full_network() -> gr.Network:
    return gr.Network([("DUB", "SHA"), ("SHA", "VAL")], names=["DUB", "SHA", "VAL"])


def test_models_and_networks_are_kept() -> None:
    small = gr.Model([[0.9]], [[1.0], [1.0]])
    per_agent = gr.Model(np.eye(2), rows(2, 3), process_covariance=[np.eye(2) * k for k in (1.0, 2.0, 3.0)])
    for model in (small, full_model(), per_agent, gr.platoon.model(4, 0.1)):
        keeps(model)
    assert full_model() == full_model()
    assert full_model() != small
    for network in (full_network(), gr.Network.ring(5), gr.Network([(0, 1)], agents=3, directed=True)):
        keeps(network)
    assert gr.Network.ring(5) != gr.Network.path(5)
    assert full_network() != gr.Network([(0, 1), (1, 2)])
    assert str(gr.Network.ring(5)) == "Network of 5 agents, 5 edges"


def test_a_worst_attack_is_kept() -> None:
    model = gr.Model(0.9 * np.eye(2), rows(2, 3), process_covariance=0.1, measurement_covariance=0.2)
    filt = gr.filters.PartialSharing(gain=0.1, shared=1)
    worst = gr.attacks.worst_covariance(model, gr.Network.ring(3), filt, 1, energy=2.0)
    again = pickle.loads(pickle.dumps(worst))
    assert again == worst == eval(repr(worst), dict(CODE))
    assert type(again) is type(worst)
    assert np.array_equal(again.covariance, worst.covariance)
    assert np.array_equal(again.direction, worst.direction)
    assert again.gain == worst.gain


def test_settings_and_results_are_kept() -> None:
    model = gr.Model(0.9 * np.eye(2), rows(2, 3), process_covariance=0.1, measurement_covariance=0.2)
    ring = gr.Network.ring(3)
    pattern = gr.structure.Pattern(2, 3, [(0, 1), (2, 0)])
    with_constructor = [
        gr.saturation.Setting(agents=3, a=0.9, lambda0=1 / 3, contraction=0.1, attacked=1),
        gr.platoon.Setting(vehicles=6, range=2, period=0.1, attacked=1, eps=0.1, mu=0.1, q=1.0, beta=2.0),
        gr.structural.setting(model, ring, gr.filters.Structural()),
        gr.structural.Setting(A=np.eye(2), C=np.eye(2), W=np.eye(2), U=np.eye(2)),
        pattern,
        gr.structure.System(gr.structure.Pattern.of(np.eye(3))),
        gr.partial_sharing.Selection([[1, 0, 0], [0, 1, 1]], 2),
        gr.partial_sharing.SelectionProblem(np.eye(4) / 3, 2, 1),
    ]
    for x in with_constructor:
        keeps(x)
    assert pattern != gr.structure.Pattern(2, 3, [(0, 1)])
    results = [
        gr.lambda0(np.eye(2), 0),
        _core.rdkf.Setting(model, ring).steady_state(),
        _core.identify(np.random.default_rng(0).normal(size=(900, 3)), 1, factors=1),
    ]
    for x in results:
        keeps(x)


def small_run(**more: Any) -> gr.Run:
    model = gr.Model(0.9, [1.0, 1.0, 1.0], process_covariance=0.2, measurement_covariance=0.3)
    return gr.simulate(model, gr.Network.complete(3), gr.filters.Dkf(), steps=5, noise="normal", **more)


def test_runs_are_the_call_that_makes_them() -> None:
    lies = [gr.attacks.Bias([0], value=2.0), gr.attacks.Forge([1], offset=1.0)]
    run = small_run(attack=lies, link={"drop": 0.2}, trials=2, seed=3, certificate="local", attacked=1)
    keeps(run)
    assert repr(run).startswith("garrison.simulate(garrison.Model(")
    y = run.measurements
    replayed = gr.replay(run.model, run.network, run.filter, measurements=y[0], truth=run.truth[0])
    keeps(replayed)
    long = gr.replay(run.model, run.network, run.filter, measurements=np.zeros((400, 3)))
    assert repr(long) == "<Run of dkf: 1 trial, 400 samples, 3 agents>"
    assert long == copy.deepcopy(long)


def test_agents_are_their_part_and_a_snapshot() -> None:
    run = small_run()
    agents = [gr.Agent(run.model, run.network, run.filter, i) for i in range(3)]
    keeps(agents[1])
    said = [agent.sense(1, [0.5]) for agent in agents]
    assert repr(agents[1]) == "<Agent 1 of rdkf, sample 1>"
    agents[1].fuse([said[0], said[2]])
    keeps(agents[1])
    assert str(agents[1]) == "<Agent 1 of rdkf, sample 1>"


def test_answers_are_kept() -> None:
    run = small_run()
    check = gr.check(run.model, run.network, run.filter)
    keeps(check)
    keeps(gr.certify(run.model, run.measurements[0], attacked=1))
    keeps(gr.expose(run.model, run.measurements[0], attacked=1))


@pytest.mark.parametrize("protocol", range(pickle.HIGHEST_PROTOCOL + 1))
def test_every_protocol_of_pickle(protocol: int) -> None:
    for x in (full_model(), full_network(), FILTERS[0][0], ATTACKS[0][0]):
        assert pickle.loads(pickle.dumps(x, protocol)) == x


def test_objects_without_content_are_refused() -> None:
    for kind in {value for value in bound(_core) if isinstance(value, type)}:
        empty = kind.__new__(kind)
        for name in dir(kind):
            if name.startswith("__") and name not in ("__repr__", "__eq__", "__hash__", "__reduce__", "__getstate__"):
                continue
            try:
                found = getattr(empty, name)
                if name.startswith("__"):
                    found(*[empty] * (name == "__eq__"))
            except gr.InvalidInput as error:
                assert ": got " in str(error)


def test_objects_without_content_are_refused_as_arguments() -> None:
    model, network = full_model(), full_network()
    for whole in (model, network, FILTERS[0][0], ATTACKS[0][0], small_agent()):
        empty = type(whole).__new__(type(whole))
        for call in (lambda: whole == empty, lambda: empty == whole, lambda: whole in [empty]):
            with pytest.raises(gr.InvalidInput, match="an object without its content"):
                call()


def small_agent() -> gr.Agent:
    run = small_run()
    return gr.Agent(run.model, run.network, run.filter, 0)


def test_what_is_worked_with_says_that_it_is_not_kept() -> None:
    window = gr.certificate.Window(2, 2, 3, 3, 9)
    for keep in (pickle.dumps, copy.copy, copy.deepcopy):
        with pytest.raises(gr.InvalidInput, match="Window: got pickle or copy, expected none"):
            keep(window)


def test_numbers_that_are_not_ambiguous_are_accepted() -> None:
    broad = gr.Model(0.9 * np.eye(2), rows(2, 3), process_covariance=0.2, measurement_covariance=0.3)
    assert broad == gr.Model(
        0.9 * np.eye(2), rows(2, 3), process_covariance=0.2 * np.eye(2), measurement_covariance=[[[0.3]]] * 3
    )
    two = gr.Model(np.eye(2), [np.eye(2)], measurement_covariance=0.3)
    assert np.array_equal(two.measurement_covariance[0], 0.3 * np.eye(2))
    assert gr.Model(0.9, [1.0, 2.0]) == gr.Model([[0.9]], [[[1.0]], [[2.0]]])
    assert gr.Network.ring(5.0) == gr.Network.ring(5)
    assert gr.filters.Saturation(threshold=np.float32(0.5)) == gr.filters.Saturation(threshold=0.5)


def test_names_go_through_split_outputs() -> None:
    model, network, owner = gr.split_outputs(full_model(), full_network())
    assert owner == [0, 0, 1, 2]
    assert network.names == ["DUB:gauge", "DUB:log", "SHA", "VAL"]
    assert model.state_names == ["height", "speed"]
    assert model.output_names == ["gauge", "log", "sum"]
    assert model.sources == ["box", "box", "ship"]
    assert model.units == {"height": "m", "gauge": "mm"}
    assert gr.Model(np.eye(2), rows(2, 1)).state_names == ["x1", "x2"]
    assert gr.Model(np.eye(2), rows(2, 1), units="m").units == {"x1": "m", "x2": "m"}


def test_graphs_keep_their_numbers_or_their_names() -> None:
    pairs = [(3, 1), (1, 0), (0, 2)]
    assert gr.Network(nx.Graph(pairs)) == gr.Network(pairs)  # 0..N-1 are the numbers
    shifted = gr.Network(nx.Graph([(30, 10), (10, 20)]))
    assert shifted.names == ["10", "20", "30"]
    assert shifted.edges == [(0, 1), (0, 2)]
    cities = gr.Network(nx.Graph([("SHA", "DUB"), ("DUB", "VAL")]))
    assert cities.names == ["SHA", "DUB", "VAL"]  # in the order of the graph
    assert cities.neighbours("DUB") == [0, 2]
    assert cities.index("VAL") == 2
    ordered = gr.Network(nx.Graph([("SHA", "DUB"), ("DUB", "VAL")]), names=["DUB", "SHA", "VAL"])
    assert ordered == gr.Network([(0, 1), (0, 2)], names=["DUB", "SHA", "VAL"])


def test_adjacency_matrices() -> None:
    sparse = pytest.importorskip("scipy.sparse")
    pandas = pytest.importorskip("pandas")
    W = sparse.csr_array(np.array([[1.0, 1.0, 0.0], [1.0, 1.0, 1.0], [0.0, 1.0, 1.0]]))
    path = gr.Network.path(3)
    assert gr.Network(W) == gr.Network(W.toarray()) == gr.Network.from_adjacency(W) == path
    # explicit zeros are no links
    cut = sparse.coo_array((np.array([0.0, 0.0]), ([0, 1], [1, 0])), shape=(3, 3))
    assert gr.Network(cut).edges == []
    one_way = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]])  # 1 hears 0, 2 hears 1
    assert gr.Network.from_adjacency(one_way, directed=True).edges == [(0, 1), (1, 2)]
    assert gr.Network.from_adjacency(np.array([[0, 1], [1, 0]], dtype=bool)) == gr.Network([(0, 1)])
    named = pandas.DataFrame([[0, 1], [1, 0]], index=["a", "b"], columns=["a", "b"])
    assert gr.Network(named).names == ["a", "b"]


def test_masked_entries_are_missing() -> None:
    model = gr.Model(0.8, [1.0, 1.0], process_covariance=0.2, measurement_covariance=0.5)
    y = np.ma.masked_array([[2.0, 1.0], [1.0, 9.0], [0.0, 1.0]], [[0, 0], [0, 1], [0, 0]])
    estimate = _core.central_kalman(model, y, [0.0], 1.0)
    assert estimate[1:, 0] == pytest.approx([1.155963303, 0.954312, 0.614412], abs=1e-6)
    pandas = pytest.importorskip("pandas")
    table = pandas.DataFrame({"a": [2.0, 1.0, 0.0], "b": pandas.array([1.0, pandas.NA, 1.0], dtype="Float64")})
    assert np.array_equal(_core.central_kalman(model, table, [0.0], 1.0), estimate)


MODEL, RING = full_model(), gr.Network.ring(3)
REFUSED: list[tuple[Callable[[], Any], str]] = [
    (lambda: gr.Model(1j, [1.0]), r"A: got complex numbers, expected real ones"),
    (lambda: gr.Model([[1.0], [1.0, 2.0]], [1.0]), r"A: got .*different lengths.* expected a matrix"),
    (lambda: gr.Model([["1", "2"]], [1.0]), r"A: got entries of type <U1, expected a matrix"),
    (lambda: gr.Model(np.ma.masked_array([[1.0]], [[True]]), [1.0]), r"A\[0, 0\]: got nan, expected a finite"),
    (lambda: gr.Model([[0.9]], 1.0), r"C: got 1.0, expected one matrix"),
    (lambda: gr.Model([[0.9]], [1.0], states=["a", "b"]), r"states: got 2 names, expected 1"),
    (lambda: gr.Model(np.eye(2), rows(2, 2), outputs=["a", "a"]), r'outputs\[1\]: got "a" once more'),
    (lambda: gr.Model(np.eye(2), rows(2, 2), units={"x3": "m"}), r'units: got unknown name "x3".*did you mean'),
    (lambda: gr.Model([[0.9]], [1.0], proces_bound=1), r'unknown argument "proces_bound".*mean "process_bound"'),
    (lambda: gr.Network([(0, 1, 0.5)]), r"edges\[0\]: got 3 values, expected a pair.*no weights"),
    (lambda: gr.Network([[0.9, 1.9]]), r"edges\[0\]\[0\]: got 0.9, expected a whole number"),
    (lambda: gr.Network([(True, False)]), r"edges\[0\]\[0\]: got True, expected a whole number"),
    (lambda: gr.Network([("a", "b")]), r'got "a", expected a number; names need names='),
    (lambda: gr.Network([("a", "c")], names=["a", "b"]), r'edges\[0\]\[1\]: got unknown name "c"'),
    (lambda: gr.Network(np.array([[0, 5], [5, 0]])), r"edges: got two rows that may be .*from_adjacency"),
    (lambda: gr.Network({0: [1]}), r"edges: got .*expected .*pairs"),
    (lambda: gr.Network.from_adjacency([[0, 1], [0, 0]]), r"not symmetric.*directed=True"),
    (lambda: gr.Network.from_adjacency(np.zeros((3, 5))), r"adjacency: got 3 x 5, expected a square"),
    (lambda: gr.Network.from_adjacency([[0, 0.5], [0.5, 0]]), r"got 0.5, expected 0 or 1"),
    (lambda: gr.Network.from_adjacency([[0, nan], [nan, 0]]), r"got nan, expected 0 or 1"),
    (lambda: gr.Network.ring(2**31 - 1), r"agents: got 2147483647 agents .*which takes .* GB, expected at most"),
    (lambda: gr.Network.ring(2**40), r"Network.ring.agents: got 1099511627776, expected .* at most 2147483647"),
    (lambda: gr.Network.erdos_renyi(3, 0.5, -1), r"seed: got -1, expected a whole number >= 0"),
    (lambda: gr.attacks.Bias(agents=[True], value=1.0), r"Bias.agents\[0\]: got True, expected a whole number"),
    (lambda: gr.attacks.Bias([0], valu=1.0), r'unknown argument "valu".*did you mean "value"'),
    (lambda: gr.attacks.Bias([0]), r"Bias.value: got no value, expected a number"),
    (lambda: gr.attacks.Bias(value=1.0), r"attack bias: got neither agents nor schedule"),
    (lambda: gr.attacks.make("bais", [0]), r'attack: got unknown name "bais".*mean "bias"'),
    (lambda: gr.filters.Saturation(threshold=1j), r"Saturation.threshold: got 1j, expected a real number"),
    (lambda: gr.filters.Saturation(3.0), r"Saturation: got 1 arguments without a name"),
    (lambda: gr.lambda0([1e308] * 4, 1), r"lambda0.C: got 1e\+308, expected finite numbers"),
    (lambda: gr.observable([[1, 2]], "x"), r"observable.C: got 'x', expected a matrix"),
    (lambda: gr.structural.setting(MODEL, RING, gr.filters.Dkf()), r"filter: got dkf, expected structural"),
    (
        lambda: gr.structural.setting(MODEL, gr.Network.ring(4), gr.filters.Structural()),
        r"network: got 4 agents, expected 3",
    ),
    (lambda: _core.rdkf.Setting(MODEL, gr.Network.ring(4)), r"network: got 4 agents, expected 3"),
    (
        lambda: _core.check(RING, MODEL, gr.filters.Dkf()),
        r"check.model: got a Network, expected a Model; the order is model, net",
    ),
    (lambda: gr.structural.best_scalar_gain(0.9, np.zeros((0, 0))), r"W: got 0 x 0"),
    (lambda: gr.partial_sharing.Selection(np.zeros((0, 0)), 1), r"start: got 0 x 0"),
    (lambda: gr.partial_sharing.SelectionProblem(np.eye(4), 2, 1).objective([]), r"s: got 0 numbers"),
    (lambda: gr.saturation.whiten(np.zeros((0, 0)), np.zeros((0, 0)), 1.0, []), r"A: got 0 rows"),
    (
        lambda: _core.identify(np.random.default_rng(0).normal(size=(900, 3)), 1, factors=1).reference_states(
            np.eye(7)
        ),
        r"measured: got 7 x 7, expected samples x 3",
    ),
    (lambda: gr.structural.chi_square_level(2**31 - 1, 0.01), r"degrees .*got 2147483647"),
    (lambda: gr.platoon.grounded_eigenvalues(2**31 - 1), r"vehicles .*GB"),
    (lambda: gr.SubsetBound(), r"SubsetBound.lower: got no value, expected a number"),
    (lambda: gr.Response.__new__(gr.Response).state, r"Response.state.self: got an object without its content"),
    (lambda: gr.Agent(gr.filters.Dkf(), MODEL, RING, 0), r"the order is model, network, filter, id"),
    (lambda: gr.Model.A.fget(3), r"Model.A.self: got 3, expected a Model"),
]


@pytest.mark.parametrize(("call", "words"), REFUSED, ids=lambda x: x if isinstance(x, str) else "")
def test_refusals_say_which_got_expected(call: Callable[[], Any], words: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("GARRISON_MEMORY_GB", "0.1")
    with pytest.raises(gr.InvalidInput, match=words):
        call()


def bound(module: types.ModuleType) -> Iterator[Callable[..., Any]]:
    """All functions and classes of the core."""
    for key, value in vars(module).items():
        if isinstance(value, types.ModuleType) and value.__name__.startswith("garrison._core"):
            yield from bound(value)
        error = isinstance(value, type) and issubclass(value, Exception)
        here = getattr(value, "__module__", "") == module.__name__
        if callable(value) and here and not error and not key.startswith("_"):
            yield value


def test_the_layer_is_in_front_of_everything() -> None:
    """A function that is bound tomorrow is in, too."""
    count = 0
    for function in bound(_core):
        with pytest.raises(gr.InvalidInput, match=r'unknown argument "no_such_argument"|results'):
            function(no_such_argument=1)
        count += 1
    assert count > 140
