"""Slips in calls of the Python layer, and files that are not what they should be: refused in our words."""

import copy
import pickle
import signal
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import garrison as gr
import numpy as np
import pandas as pd
import pytest
from garrison.tables import read_records

MODEL = gr.Model([[0.8]], [[1.0]] * 3, process_covariance=0.2, measurement_covariance=[0.1, 0.5, 2.0])
NET = gr.Network.ring(3)
FILTER = gr.filters.Structural()
PARTS = (MODEL, NET, FILTER)
PREPARED = gr.prepare(*PARTS)
RUN = PREPARED.simulate(steps=3)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: gr.simulate(MODEL, NET), "simulate: got no filter, steps, expected model, network, filter, steps"),
        (lambda: gr.replay(*PARTS, np.zeros((2, 3))), "replay: got 4 arguments without a name, expected 3 at most"),
        (lambda: gr.simulate(*PARTS, steps=2, model=MODEL), "simulate.model: got two values"),
        (lambda: gr.calibrate(*PARTS, records=np.zeros((2, 3))), "calibrate: got the unknown argument 'records'"),
        (lambda: gr.calibrate(NET, MODEL, FILTER, measurements=np.zeros((2, 3))), "calibrate: got (network, model"),
        (lambda: gr.attacks.worst_covariance(*PARTS, energy=1.0), "worst_covariance: got no agents"),
        (lambda: gr.resilience_per_byte(NET, MODEL, [0], gain=0.1, energy=1.0), "resilience_per_byte: got (Network"),
        (lambda: gr.replay_mitigated(NET), "replay_mitigated: got no A"),
        (lambda: gr.simulate(MODEL, NET, gr.filters.Dkf, steps=2), "network, the class Dkf, not made yet)"),  # type: ignore[arg-type]
        (lambda: gr.fit(3), "fit.records: got 3, expected Records"),
        (lambda: gr.simulate(*PARTS, steps=2, seed=2**64), f"seed: got {2**64}, expected a whole number in 0.."),
        (lambda: gr.simulate(*PARTS, steps=2, trials=2**31), f"trials: got {2**31}, expected a whole number in 1.."),
        (lambda: PREPARED.simulate(10), "Prepared.simulate: got 1 argument without a name, expected 0 at most; all"),
        (lambda: PREPARED.replay(np.zeros((2, 3))), "Prepared.replay: got 1 argument without a name"),
        (lambda: PREPARED.simulate(step=10), "the unknown argument 'step', expected"),
        (lambda: PREPARED.simulate(steps=2, design=PREPARED), "design: got one to a filter that is prepared"),
        (lambda: PREPARED.agent(), "Prepared.agent: got no id, expected id"),
        (lambda: PREPARED.agent(0, 1), "Prepared.agent: got 2 arguments without a name, expected 1 at most; id"),
        (lambda: gr.Prepared.load(), "Prepared.load: got no path"),
        (lambda: RUN.alarms(trail=0), "Run.alarms: got the unknown argument 'trail', expected one of trial; did you"),
        (lambda: RUN.to_pandas(1), "Run.to_pandas: got 1 argument without a name, expected 0 at most; there are none"),
        (lambda: gr.Run.load(), "Run.load: got no path"),
        (lambda: gr.expose(MODEL), "expose: got no measurements, attacked"),
        (lambda: setattr(FILTER, "window", 5), "Structural.window: got an assignment, expected none"),
        (lambda: setattr(MODEL, "A", 5), "Model.A: got an assignment, expected none"),
        (lambda: setattr(NET, "new", 5), "Network.new: got an assignment"),
        (lambda: setattr(PREPARED, "filter", FILTER), "Prepared.filter: got an assignment"),
        (lambda: setattr(gr.check(*PARTS), "conditions", []), "Check.conditions: got an assignment"),
        (lambda: gr.simulate(*PARTS, steps=2, attack=gr.attacks.Bias), "attack: got the function Bias, not called yet"),
        (lambda: gr.simulate(*PARTS, steps=2, attack=[gr.attacks.Bias]), "attack: got the function Bias, not called"),
        (lambda: gr.filters.make_filter(gr.filters.Dkf, {}), "make_filter.name: got the class Dkf, not made yet"),
        (lambda: gr.filters.make_filter("saturation", {"attacked": 2**31}), "got 2147483648, expected a whole number"),
        (lambda: gr.filters.make_filter("saturation", {"attacked": 2**40}), f"got {2**40}, expected a whole number"),
        (lambda: gr.attacks.Bias([0], value=float("nan")), "bias.value: got no value, or nan, expected a number"),
        (lambda: gr.filters.Saturation(threshold=1e308), "saturation.threshold: got 1e+308, expected a number of size"),
        (lambda: gr.filters.PartialSharing(gain=0.1, start_covariance=[1.0, 1e300]), "start_covariance: got 1e+300"),
        (lambda: gr.Model([[True, 0], [0, 1]], [[1, 0]]), "A[0][0]: got True or False"),
        (lambda: gr.Model([[1, 0], [0, 1]], [[[1, False]]]), "[0][1]: got True or False"),
        (lambda: gr.replay(*PARTS, measurements=[[1, True, 2]]), "measurements[0][1]: got true, expected a number"),
        (lambda: gr.simulate(*PARTS, steps=2, link={"delay_rounds": 2}), "link.delay_rounds: got a delay without its"),
        (lambda: gr.simulate(MODEL, gr.Network.path(3), FILTER, steps=2, link={"cuts": [(0, 2, 1, 2)]}),
         "link.cuts: got the link from 0 to 2, expected a link of the network"),
        (lambda: gr.simulate(MODEL, gr.Network.path(3), FILTER, steps=2, link={"lost": [(1, 0, 2, 0)]}),
         "link.lost: got the link from 2 to 0, expected a link of the network"),
        (lambda: gr.simulate(*PARTS, steps=2, attack="bias"), "attack: got 'bias', expected an attack"),
    ],
)  # fmt: skip
def test_wrong_arguments(call: Callable[[], object], words: str) -> None:
    with pytest.raises(gr.InvalidInput) as refused:
        call()
    assert words in str(refused.value)


@pytest.mark.parametrize(
    ("module", "name", "meant"),
    [(gr.filters, "Strctural", "Structural"), (gr.attacks, "Bis", "Bias"), (gr, "simulat", "simulate")],
)
def test_misspelt_names_get_the_nearest(module: Any, name: str, meant: str) -> None:
    with pytest.raises(AttributeError, match=f'did you mean "{meant}"'):
        getattr(module, name)


OBJECTS: list[tuple[Any, str, str]] = [
    (MODEL, "procss_covariance", "process_covariance"),
    (NET, "edgs", "edges"),
    (FILTER, "parms", "params"),
    (RUN, "estimates", "estimate"),
    (PREPARED, "simulat", "simulate"),
    (gr.check(*PARTS), "hold", "holds"),
    (gr.Verdict.CLEARED, "wrd", "word"),
    (gr.BoundKind.TABLE, "wy", "why"),
    (gr.attacks.Bias([0], value=1.0), "agnts", "agents"),
    (gr.Agent(MODEL, NET, FILTER, 0), "estimte", "estimate"),
    (gr.Model, "stats", "states"),
    (gr.Network, "cmplete", "complete"),
    (gr.filters.Saturation, "nme", "name"),
    (gr.Run, "laod", "load"),
    (gr.Prepared, "lod", "load"),
    (gr.Verdict, "CLEARD", "CLEARED"),
    (gr.Comparison, "plt", "plot"),
]


@pytest.mark.parametrize(("thing", "name", "meant"), OBJECTS)
def test_misspelt_attributes_get_the_nearest(thing: Any, name: str, meant: str) -> None:
    assert hasattr(thing, meant), meant
    with pytest.raises(AttributeError, match=f"'{name}'; did you mean \"{meant}\""):
        getattr(thing, name)
    assert not hasattr(thing, name)
    assert getattr(thing, name, 5) == 5


def test_every_public_class_and_its_objects_name_the_nearest() -> None:
    classes = [c for m in (gr, gr.filters, gr.attacks) for c in vars(m).values() if isinstance(c, type)]
    ours = [c for c in classes if c.__module__.startswith("garrison") and not issubclass(c, Exception)]
    assert len(ours) > 25
    for cls in ours:
        members = [name for name in dir(cls) if not name.startswith("_")]
        if not members:  # all that it has is in its objects
            continue
        member = members[0]
        with pytest.raises(AttributeError, match=f'did you mean "{member}"'):
            getattr(cls, f"{member}q")
        assert not hasattr(cls, "__of_a_library__")
        if "__getattr__" in vars(cls):  # of Python: an empty object will do
            with pytest.raises(AttributeError, match="did you mean"):
                getattr(cls.__new__(cls, *([0] if issubclass(cls, int) else [])), f"{member}q")


def test_a_subclass_that_forgets_its_base_is_refused_in_our_words() -> None:
    class Mine(gr.Filter):
        def __init__(self) -> None:
            self.gain = 0.5

    with pytest.raises(gr.InvalidInput, match=r"Mine.__init__: got no call .* write super\(\).__init__\(\)"):
        Mine()

    class Broken(gr.Filter):
        def __init__(self) -> None:
            super().__init__()
            raise TypeError("of the user")

    with pytest.raises(TypeError, match="of the user"):
        Broken()


@pytest.mark.parametrize("three", [3, 3.0, np.int8(3), np.float64(3.0), np.array(3), np.array(3.0)])
def test_a_whole_number_may_be_kept_as_a_float_everywhere(three: Any) -> None:
    assert gr.simulate(*PARTS, steps=three, trials=three, seed=three).estimate is not None
    assert gr.filters.Saturation(threshold=1.0, rounds=three).params["rounds"] == 3
    assert gr.Network.complete(three).agents == 3
    assert gr.filters.make_filter("saturation", {"threshold": 1.0, "attacked": three}).params["attacked"] == 3
    assert gr.attacks.Bias([0], value=1.0, start=three).start == 3
    assert RUN.shape == gr.simulate(*PARTS, steps=float(three)).shape


@pytest.mark.parametrize("wrong", [3.5, np.nan, np.inf, "3", True, [3, 3], np.bool_(True), 1e300])
def test_what_is_no_whole_number_is_refused_everywhere(wrong: Any) -> None:
    for which, call in (
        ("steps", lambda: gr.simulate(*PARTS, steps=wrong)),
        ("rounds", lambda: gr.filters.Saturation(threshold=1.0, rounds=wrong)),
        ("complete", lambda: gr.Network.complete(wrong)),
        ("start", lambda: gr.attacks.Bias([0], value=1.0, start=wrong)),
    ):
        with pytest.raises(gr.InvalidInput, match=which):
            call()


def test_flags_and_words_of_numpy() -> None:
    assert gr.simulate(*PARTS, steps=2, conditions=np.bool_(False)).shape == (1, 3, 3)
    with pytest.raises(gr.InvalidInput, match="conditions: got 1, expected True or False"):
        gr.simulate(*PARTS, steps=2, conditions=1)  # type: ignore[arg-type]
    with pytest.raises(gr.InvalidInput, match="keep: got 'estimat', expected"):
        gr.simulate(*PARTS, steps=2, keep=[np.str_("estimat")])


def test_tables_of_pandas_are_matrices() -> None:
    model = gr.Model(pd.DataFrame([[0.9, 0.1], [0.0, 0.8]]), pd.DataFrame([[1, 0], [0, 1]]))
    assert [c.tolist() for c in model.C] == [[[1.0, 0.0]], [[0.0, 1.0]]]


def test_choices_get_the_nearest() -> None:
    with pytest.raises(gr.InvalidInput, match=r'structural.test: got "inovation".*did you mean "innovation"'):
        gr.filters.Structural(test="inovation")
    with pytest.raises(gr.InvalidInput, match=r'noise: got .*"normale".*did you mean "normal"'):
        gr.simulate(*PARTS, steps=2, noise="normale")


def test_numbers_of_numpy_are_shown_as_numbers() -> None:
    with pytest.raises(gr.InvalidInput) as refused:
        gr.Network(np.array([[0, np.nan, 1], [np.nan, 0, 1], [1, 1, 0]]))
    assert "nan" in str(refused.value) and "np.float64" not in str(refused.value)
    with pytest.raises(gr.InvalidInput, match=r"got 0\.5, expected"):
        gr.Network.complete(np.float64(0.5))


@pytest.mark.parametrize(("name", "value", "absent"), [
    ("window", 50, "nothing can be tested"),
    ("settle", 20, "nothing can be tested"),
    ("window", 15, "the first 14 of 20 samples were not tested"),
    ("settle", 15, "the first 15 of 20 samples were not tested"),
])  # fmt: skip
def test_tests_that_a_run_is_too_short_for_are_said_aloud(name: str, value: int, absent: str) -> None:
    run = gr.simulate(MODEL, NET, gr.filters.Structural(**{name: value}), steps=20)
    assert any(f"{name} = {value}" in w and absent in w for w in run.warnings), run.warnings
    quiet = gr.simulate(MODEL, NET, gr.filters.Structural(**{name: 4}), steps=20).warnings
    assert not any(name in w for w in quiet)


def test_central_kalman_matches_columns_by_name() -> None:
    model = gr.Model(
        [[0.8]], [[1.0]] * 3, process_covariance=0.2, measurement_covariance=[0.1, 0.5, 2.0], outputs=["a", "b", "c"]
    )
    y = pd.DataFrame({"c": [3.0, 3.0], "b": [2.0, 2.0], "a": [1.0, 1.0]})
    right = gr.central_kalman(model, y[["a", "b", "c"]].to_numpy())
    assert np.array_equal(gr.central_kalman(model, y), right)
    with pytest.raises(gr.InvalidInput, match="matched by name"):
        gr.central_kalman(model, y.rename(columns={"c": "d"}))


def test_files_that_cannot_be_used(tmp_path: Path) -> None:
    prepared, run = gr.prepare(*PARTS), gr.simulate(*PARTS, steps=2)
    calls: list[Callable[[Path], object]] = [prepared.save, run.save, gr.Prepared.load, gr.Run.load]
    for where in (tmp_path, tmp_path / "none" / "x", Path("a\0b")):
        for call in calls:
            with pytest.raises(gr.IoError, match=r"got .*, expected"):
                call(where)


def test_a_file_of_something_else_is_no_run() -> None:
    with pytest.raises(gr.IoError, match=r"no archive of arrays, expected a run written by Run\.save"):
        gr.Run.load(__file__)


def test_an_attack_after_the_end_is_said_aloud() -> None:
    late = gr.attacks.Bias([0], value=1.0, start=7)
    for steps, told in ((6, True), (7, False)):
        runs = (
            gr.simulate(*PARTS, steps=steps, attack=late),
            gr.replay(*PARTS, measurements=np.zeros((steps, 3)), attack=late),
        )
        for run in runs:
            assert any("bias starts at sample 7, after the last one (6)" in w for w in run.warnings) == told


def test_an_attack_on_nobody_is_said_aloud() -> None:
    run = gr.simulate(*PARTS, steps=5, attack=[gr.attacks.Bias([], value=1.0), gr.attacks.Silence([])])
    assert "the attack bias names no agent: nothing is attacked" in run.warnings
    assert "the attack silence names no agent: nothing is attacked" in run.warnings


def test_a_recording_says_which_sensors_are_silent() -> None:
    y = np.zeros((5, MODEL.outputs))
    assert not any(
        "recording" in w for w in gr.replay(MODEL, NET, gr.filters.ScalarGain(rounds=2), measurements=y).warnings
    )
    y[:, 1] = np.nan
    words = "the recording holds no measurement of output 1: nothing can be said of it"
    assert words in gr.replay(MODEL, NET, gr.filters.ScalarGain(rounds=2), measurements=y).warnings
    y[:] = np.nan
    (said,) = (
        w for w in gr.replay(MODEL, NET, gr.filters.ScalarGain(rounds=2), measurements=y).warnings if "recording" in w
    )
    assert said.startswith("the recording holds no measurement at all")


def test_alarms_that_cannot_be_are_said_aloud() -> None:
    filter = gr.filters.Structural(alarm_after=6)
    words = "alarm_after = 6 tests in a row, but the run has 5 samples: no alarm is possible"
    assert words in gr.simulate(MODEL, NET, filter, steps=5).warnings
    assert not any("alarm_after" in w for w in gr.simulate(MODEL, NET, filter, steps=6).warnings)


def test_subclasses_keep_attributes_of_their_own() -> None:
    class Own(gr.Filter):
        def __init__(self) -> None:
            super().__init__()
            self.size = 3

    own = Own()
    own.size = 4
    assert own.size == 4


def test_damaged_runs_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "run.npz"
    run = gr.simulate(*PARTS, steps=20)
    run.save(path)
    assert gr.Run.load(path) == run
    whole, rng = path.read_bytes(), np.random.default_rng(0)
    for k in range(200):
        damaged = bytearray(whole)
        damaged[rng.integers(len(damaged))] ^= 1 << int(rng.integers(8))
        path.write_bytes(damaged[: rng.integers(len(damaged))] if k % 2 else damaged)
        try:
            gr.Run.load(path)  # a bit that nobody reads, such as a time stamp
        except gr.IoError as refused:
            assert "expected a run written by Run.save" in str(refused)


def test_checks_compare_after_pickling() -> None:
    found = gr.check(*PARTS)
    assert pickle.loads(pickle.dumps(found)) == found == copy.deepcopy(found)
    assert found != gr.check(MODEL, gr.Network.complete(3), gr.filters.Dkf())


def test_compact_dates_are_dates(tmp_path: Path) -> None:
    days = pd.date_range("2019-12-30", periods=70)
    path = tmp_path / "r.csv"
    rows = [f"{d:%Y%m%d},{k % 7},{k % 5}" for k, d in enumerate(days)]
    path.write_text("\n".join(["day,a,b", *rows]) + "\n")
    found = read_records(path)
    assert found.dates == [d.date() for d in days] and found.step == 86400.0 and not found.notes
    path.write_text("day,a,b\n20200227,1,2\n20200230,2,3\n20200231,3,3\n")
    with pytest.raises(gr.InvalidInput, match="line 3"):
        read_records(path)


def test_too_few_records_are_called_so(tmp_path: Path) -> None:
    path = tmp_path / "r.csv"
    path.write_text("day,a,b\n2020-02-27,1,2\n2020-02-28,2,3\n2020-02-29,3,3\n")
    with pytest.raises(gr.InvalidInput, match=r"fit.harmonics: got 2 with 3 records, expected at least 6 records"):
        gr.fit(read_records(path))


def test_two_rows_that_mean_an_edge_list_are_no_matrix() -> None:
    assert gr.Network(np.array([[0, 1], [1, 2]])).edges == [(0, 1), (1, 2)]
    for unclear in ([[1, 0], [0, 1]], pd.DataFrame([[1, 0], [0, 1]], columns=["u", "v"])):
        with pytest.raises(gr.InvalidInput, match="two edges or an adjacency matrix"):
            gr.Network(unclear)
    with pytest.raises(gr.InvalidInput, match=r"adjacency\[1, 1\]: got 2, expected 0 or 1"):
        gr.Network(pd.DataFrame({"u": [0, 1], "v": [1, 2]}))


def test_a_table_of_two_columns_is_a_list_of_edges() -> None:
    edges = pd.DataFrame({"from": [0, 1, 2], "to": [1, 2, 3]})
    assert gr.Network(edges) == gr.Network([(0, 1), (1, 2), (2, 3)])
    named = pd.DataFrame({"from": ["B"], "to": ["A"]})
    assert gr.Network(named, names=["A", "B"]).edges == [(0, 1)]


def test_rows_of_an_adjacency_table_are_matched_by_name() -> None:
    names = list("abc")
    path = pd.DataFrame([[0, 1, 0], [1, 0, 1], [0, 1, 0]], index=names, columns=names)
    assert gr.Network(path.loc[["c", "a", "b"]]) == gr.Network(path)
    with pytest.raises(gr.InvalidInput, match="matched by name"):
        gr.Network(path.rename(index={"a": "x"}))


def test_observability_of_which_one_cannot_tell_is_not_denied() -> None:
    A, C = np.diag([1.0, 1.0 + 1e-12]), np.ones((1, 2))
    for units in ([1.0, 1.0], [1e-6, 1e6], [1e6, 1e-6], [1.0, 1e5]):
        scaled = np.diag(units)
        B, D = np.linalg.inv(scaled) @ A @ scaled, C @ scaled
        assert gr.structure.visibility(B, D)["sight"] == "unclear"
        with pytest.raises(gr.InvalidInput, match=r"observable: got .*cannot tell: distance .*e-13 at the mode 1"):
            gr.observable(B, D)
        with pytest.raises(gr.InvalidInput, match=r"s_sparse_observable: got .*cannot tell"):
            gr.s_sparse_observable(B, D, 0)
    assert gr.observable(np.diag([1.0, 1.1]), C)
    assert not gr.observable(np.eye(2), C)


def long_design() -> tuple[gr.Model, gr.Network, gr.Filter]:
    """Parts whose design takes far longer than anybody waits."""
    rng = np.random.default_rng(0)
    A = 0.98 * np.linalg.qr(rng.normal(size=(12, 12)))[0]
    model = gr.Model(A, list(rng.normal(size=(40, 1, 12))), process_covariance=0.1, measurement_covariance=0.1)
    return model, gr.Network.random_geometric(40, 0.5, 1), gr.filters.Structural(design="h2")


@pytest.mark.parametrize("call", [gr.prepare, gr.check])
def test_what_takes_long_says_so_and_can_be_ended_from_there(call: Callable[..., Any]) -> None:
    class Enough(Exception):
        pass

    told: list[tuple[str, float]] = []

    def progress(what: str, seconds: float) -> None:
        told.append((what, seconds))
        if len(told) == 2:
            raise Enough

    with pytest.raises(Enough):
        call(*long_design(), progress=progress)
    assert all("structural" in what for what, _ in told) and 0 < told[0][1] < told[1][1]
    with pytest.raises(gr.InvalidInput, match=r"progress: got .*expected a function of \(what, seconds\)"):
        call(*long_design(), progress=lambda: None)
    with pytest.raises(gr.InvalidInput, match="progress: got 1, expected a function"):
        call(*long_design(), progress=1)


@pytest.mark.parametrize("call", [gr.prepare, gr.check, lambda *parts: gr.simulate(*parts, steps=3)])
def test_an_interrupt_ends_a_long_design(call: Callable[..., Any]) -> None:
    parts = long_design()
    before = signal.signal(signal.SIGALRM, signal.default_int_handler)
    signal.setitimer(signal.ITIMER_REAL, 0.5)
    started = time.monotonic()
    try:
        with pytest.raises(KeyboardInterrupt):
            call(*parts)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
    assert time.monotonic() - started < 15  # without an answer it takes far longer


def test_an_interrupt_ends_a_search_over_subsets() -> None:
    C = np.random.default_rng(0).normal(size=(400, 8))
    before = signal.signal(signal.SIGALRM, signal.default_int_handler)
    signal.setitimer(signal.ITIMER_REAL, 0.5)
    started = time.monotonic()
    try:
        with pytest.raises(KeyboardInterrupt):
            gr.lambda0(C, 40, max_seconds=120)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
    assert time.monotonic() - started < 15  # 120 without an answer


@pytest.mark.parametrize(
    ("call", "said"),
    [
        (lambda f, r: f.measurements(None), "records: got no value, expected Records"),
        (lambda f, r: f.reference([1.0]), "expected Records"),
        (lambda f, r: f.robust_reference("x"), "expected Records"),
        (lambda f, r: f.levels(3, "x"), "failure: got 'x', expected a number"),
        (lambda f, r: f.inflated(None), "factor: got no value, expected a number"),
        (lambda f, r: f.inflated("x"), "factor: got 'x', expected a number"),
        (lambda f, r: r.between("1961-01-01", None), "from: got '1961-01-01', expected a datetime.date"),
        (lambda f, r: r.between(None, pd.NA), "to: got"),
        (lambda f, r: r.of(pd.NA), "stations: got"),
        (lambda f, r: read_records(None), "path: got no value"),
        (lambda f, r: gr.Verdict("atacked"), 'did you mean "attacked"?'),
        (lambda f, r: gr.Verdict(7), "Verdict: got 7, expected 0..4 or one of cleared, suspected"),
    ],
)
def test_methods_of_fits_and_records_refuse(wind: Path, call: Callable[[Any, Any], Any], said: str) -> None:
    records = read_records(wind / "irish_wind.csv")
    fit = gr.fit(records.between(None, records.dates[2000]), factors=1)
    with pytest.raises(gr.InvalidInput) as refused:
        call(fit, records)
    assert said in str(refused.value)


def test_matrices_of_flags_and_edges_of_names() -> None:
    pair = [(0, 1)]
    assert gr.Network(np.array([[False, True], [True, False]])).edges == pair
    assert gr.Network(np.array([[0, 1, 0], [1, 0, 1], [0, 1, 0]], dtype=bool)).edges == [(0, 1), (1, 2)]
    with pytest.raises(gr.InvalidInput, match="not symmetric"):
        gr.Network(np.array([[False, True], [False, False]]))
    names = ["a", "b", "c"]
    expected = gr.Network([(0, 1), (1, 2)], names=names)
    assert gr.Network([["a", "b"], ["b", "c"]], names=names) == expected
    table = pd.DataFrame({"source": ["a", "b"], "target": ["b", "c"]})
    assert gr.Network(table, names=names) == expected
    with pytest.raises(gr.InvalidInput, match="names need names="):
        gr.Network(table)


def test_the_least_numbers_are_numbers() -> None:
    for value in (5e-324, -1e-310):
        assert gr.attacks.Constant(agents=[0], value=value).params["value"] == repr(value)
    for wrong in ("1e999", "5 m", "", " "):
        with pytest.raises(gr.InvalidInput, match="expected a number such as"):
            gr.attacks.Constant(agents=[0], value=wrong)


@pytest.mark.parametrize(("slip", "meant"), [("rnu", "run"), ("fliter", "filter"), ("attackd", "attack")])
def test_near_names_are_near(slip: str, meant: str) -> None:
    assert gr._core.nearest_name(slip, ["run", "filter", "attack", "stop", "value", "edges"]) == meant
    for far in ("factor", "chance", "names"):
        assert gr._core.nearest_name(far, ["stop", "value", "edges", "start"]) == ""


def test_verdicts_by_their_words() -> None:
    assert gr.Verdict("not tested") is gr.Verdict.NOT_TESTED is gr.Verdict("NOT_TESTED") is gr.Verdict(4)


def test_agents_of_resilience_are_named_as_agents() -> None:
    for agents, words in (([9], r"^agents: got 9, expected numbers in 0\.\."), ([0, 0], "^agents: got 0 twice")):
        with pytest.raises(gr.InvalidInput, match=words):
            gr.resilience_per_byte(MODEL, NET, agents, gain=0.1, energy=1.0)


def test_what_takes_a_constant_model_says_who_takes_others() -> None:
    varying = gr.VaryingModel(MODEL, A=[MODEL.A, MODEL.A])
    rest = "got a VaryingModel, expected a constant Model; simulate, replay and compare take a VaryingModel"
    for function in (gr.prepare, gr.check):
        with pytest.raises(gr.InvalidInput, match=f"^{function.__name__}: {rest}"):
            function(varying, NET, gr.filters.ScalarGain(rounds=1))
    with pytest.raises(gr.InvalidInput, match=f"^design: {rest}"):
        gr.design(varying, NET, attacked=0, initial_error=1.0)
    with pytest.raises(gr.InvalidInput, match=r"^size: got -1, expected a finite number > 0"):
        gr.compare(MODEL, NET, [0], size=-1)


def test_a_start_below_1_is_as_1() -> None:
    runs = [
        gr.simulate(*PARTS, steps=5, seed=1, attack=gr.attacks.Bias(agents=[0], value=3.0, start=start))
        for start in (1, 0, -1, 2)
    ]
    for run in runs[1:3]:
        np.testing.assert_array_equal(run.measurements, runs[0].measurements)
    assert not np.array_equal(runs[3].measurements, runs[0].measurements)


def test_one_number_is_one_number() -> None:
    model = gr.Model(np.eye(2) * 0.8, [np.eye(2)[:1], np.eye(2)[1:]], process_bound=0.1, measurement_bound=0.1)
    with pytest.raises(gr.InvalidInput, match="x0: got 1 number, expected 2"):
        gr.simulate(model, gr.Network.path(2), gr.filters.ScalarGain(rounds=1), steps=1, x0=[1.0])
