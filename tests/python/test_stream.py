"""Runs that are written as they go: the bits of runs in memory, whole or not at all."""

import functools
import pickle
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import garrison as gr
import numpy as np
import pytest
from garrison import _core, growing, store
from garrison.run_file import arrays_of

pytest.importorskip("zarr", minversion="3")

N, STEPS, TRIALS = 7, 41, 5
RNG = np.random.default_rng(4)
C = RNG.normal(size=(N, 1, 2))
KNOWN: dict[str, Any] = {"process_bound": 0.02, "measurement_bound": 0.05, "states": ["height", "speed"]}
KNOWN |= {"process_covariance": 1e-4, "measurement_covariance": 1e-3, "units": {"height": "m"}}
MATRICES = [[1.0, 0.1], [0.0, 0.9]], C / np.linalg.norm(C, axis=2, keepdims=True)
MODEL, STEERED = gr.Model(*MATRICES, **KNOWN), gr.Model(*MATRICES, B=[[0.0], [1.0]], **KNOWN)
RING = gr.Network.ring(N)
INPUTS = RNG.normal(size=(STEPS, 1))
EVERYTHING = ["estimate", "report", "measurements", "signals", "details", "box"]
ATTACK = [gr.attacks.Bias([1], value=2.0, start=5), gr.attacks.Denial([3], start=20)]
FILTERS = [
    gr.filters.Saturation(threshold=0.5, rounds=4),
    gr.filters.Saturation(threshold=0.5, rounds=12, attacked=1, initial_error=2.0, detector=True),
    gr.filters.ScalarGain(),
    gr.filters.Lfre(),
    gr.filters.Rdkf(weight=0.5),
    gr.filters.Structural(),
]


DRIVERS = {"simulate": _core.simulate, "replay": _core.replay}


def set_blocks(bytes: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Runs record in blocks of so many bytes."""
    for name, driver in DRIVERS.items():
        monkeypatch.setattr(_core, name, functools.partial(driver, block_bytes=bytes))


@pytest.fixture(params=["small", "usual"])
def sizes(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """Blocks and chunks so small that every trial has many, which do not end together; and the usual ones."""
    if request.param == "small":
        set_blocks(5000, monkeypatch)
        monkeypatch.setattr(growing, "_CHUNK", 900)


def require_equal(run: gr.Run, memory: gr.Run, path: Path) -> None:
    loaded = gr.Run.load(path)
    assert type(loaded) is gr.Run and type(run) is gr.StoredRun
    assert run.warnings == loaded.warnings and set(loaded.warnings) - {store.UNSEEN} <= set(memory.warnings)
    assert store.UNSEEN in loaded.warnings
    loaded.warnings = memory.warnings
    assert list(arrays_of(loaded)) == list(arrays_of(memory))
    assert loaded == memory
    for name, values in arrays_of(memory).items():
        lazy = arrays_of(run)[name]
        assert values.dtype == lazy.dtype and values.tobytes() == np.asarray(lazy).tobytes(), name
    assert run.shape == memory.shape and gr.again(loaded) == memory


@pytest.mark.parametrize("filter", FILTERS, ids=lambda f: f.name)
@pytest.mark.parametrize("threads", [1, 3])
def test_the_bits_are_those_of_a_run_in_memory(filter: gr.Filter, threads: int, sizes: None, tmp_path: Path) -> None:
    path = tmp_path / "run.zarr"
    given: dict[str, Any] = {"steps": STEPS, "trials": TRIALS, "seed": 3, "x0": [1, -1], "attack": ATTACK}
    given |= {"link": {"drop": 0.05}, "inputs": INPUTS, "keep": EVERYTHING, "threads": threads}
    memory = gr.simulate(STEERED, RING, filter, **given)
    require_equal(gr.simulate(STEERED, RING, filter, **given, to=path), memory, path)
    assert [one.name for one in tmp_path.iterdir()] == ["run.zarr"]


@pytest.mark.parametrize("memory_of", [False, True])
def test_certificates_and_replays(memory_of: bool, sizes: None, tmp_path: Path) -> None:
    path, log = tmp_path / "run.zarr", RNG.normal(size=(2, STEPS, N))
    truth = RNG.normal(size=(2, STEPS + 1, 2))
    prepared = gr.prepare(
        STEERED, RING, gr.filters.ScalarGain(), certificate="flooded", attacked=1, failure=1e-3, memory=memory_of
    )
    given: dict[str, Any] = {"measurements": log, "truth": truth, "attack": ATTACK, "keep": EVERYTHING}
    memory = prepared.replay(**given, inputs=INPUTS)
    assert memory.published is not None and memory.log is not None
    require_equal(prepared.replay(**given, inputs=INPUTS, to=path), memory, path)
    blind = prepared.replay(measurements=log, to=path, inputs=INPUTS)  # replaces the other
    assert blind.error is None and blind.truth is None
    require_equal(blind, prepared.replay(measurements=log, inputs=INPUTS), path)


def test_agents_with_states_of_their_own(sizes: None, tmp_path: Path) -> None:
    path, model, net = tmp_path / "run.zarr", gr.platoon.model(5, 0.01), gr.Network.band(5, 2)
    filter = gr.filters.Platoon(
        process_noise=0.1, measurement_noise=0.1, initial_error=100.0, reference=[0, 1], gs=1, gv=2
    )
    given: dict[str, Any] = {"steps": 30, "trials": 2, "noise": "uniform", "keep": EVERYTHING}
    memory = gr.simulate(model, net, filter, **given)
    assert memory.measurements is not None and memory.measurements.shape[1] == 31
    require_equal(gr.simulate(model, net, filter, **given, to=path), memory, path)


def test_the_dataset_has_names_and_numbers_on_its_axes(tmp_path: Path) -> None:
    memory = gr.simulate(STEERED, RING, FILTERS[0], steps=STEPS, inputs=INPUTS, trials=2)
    run = gr.simulate(STEERED, RING, FILTERS[0], steps=STEPS, inputs=INPUTS, trials=2, to=tmp_path / "run.zarr")
    whole, lazy = memory.to_xarray(), run.to_xarray()
    assert set(lazy.variables) == set(whole.variables)
    for name in whole.variables:
        assert lazy[name].dims == whole[name].dims and lazy[name].equals(whole[name]), name
        assert lazy[name].attrs == whole[name].attrs, name
    for name in ("model", "network", "filter", "title", "garrison"):
        assert lazy.attrs[name] == whole.attrs[name]
    assert lazy.attrs["count_sent"] == str(run.counters["sent"])


def test_times_can_be_left_out(sizes: None, tmp_path: Path) -> None:
    keep = {"error": "all", "estimate": gr.every(7), "measurements": gr.every(4), "truth": "none"}
    given: dict[str, Any] = {"steps": STEPS, "inputs": INPUTS, "trials": 3}
    run = gr.simulate(STEERED, RING, FILTERS[0], **given, keep=keep, to=tmp_path / "run.zarr")
    memory = gr.simulate(STEERED, RING, FILTERS[0], **given)
    assert memory.estimate is not None and memory.measurements is not None
    data = run.to_xarray()
    np.testing.assert_array_equal(data.estimate, memory.estimate[:, ::7])
    np.testing.assert_array_equal(data.measurements, memory.measurements[:, 3::4])
    np.testing.assert_array_equal(data.error, memory.error)
    assert data.time_every_7.values.tolist() == list(range(0, STEPS + 1, 7))
    assert data.sample_every_4.values.tolist() == list(range(4, STEPS + 1, 4))
    assert run.estimate is None and run.truth is None and "truth" not in data and "bound" not in data
    with pytest.raises(gr.InvalidInput, match=r"load: got .*, whose measurements, estimate lack times"):
        gr.Run.load(tmp_path / "run.zarr")
    words = r"keep\['estimate'\]: got garrison.every\(7\) without to.*run\.estimate\[:, ::7\]"
    with pytest.raises(gr.InvalidInput, match=words):
        gr.simulate(STEERED, RING, FILTERS[0], **given, keep=keep)
    gr.simulate(STEERED, RING, FILTERS[0], **given, keep={"estimate": gr.every(7)}, to=tmp_path / "one.zarr")
    with pytest.raises(gr.InvalidInput, match=r"load: got .*, whose estimate lacks times"):
        gr.Run.load(tmp_path / "one.zarr")
    with pytest.raises(gr.InvalidInput, match=r"run\.measurements\[:, 3::4\]"):
        gr.simulate(STEERED, RING, FILTERS[0], **given, keep={"measurements": gr.every(4)})


def test_a_mapping_keeps_what_it_names_and_no_more() -> None:
    given: dict[str, Any] = {"steps": STEPS, "inputs": INPUTS, "trials": 9}
    whole = gr.simulate(STEERED, RING, FILTERS[0], **given)
    nothing = gr.simulate(STEERED, RING, FILTERS[0], **given, keep={})
    assert arrays_of(nothing).keys() == {"inputs"} and nothing.counters == whole.counters
    errors = gr.simulate(STEERED, RING, FILTERS[0], **given, keep={"error": "all", "report": "none", "truth": False})
    assert arrays_of(errors).keys() == {"inputs", "error"}
    assert errors.error is not None and whole.error is not None and np.array_equal(errors.error, whole.error)
    assert gr.again(errors) == errors and errors.made["keep"] == {"error": "all"}
    named = gr.simulate(STEERED, RING, FILTERS[0], **given, keep=[])
    assert arrays_of(named).keys() == {"inputs", "error", "truth"} and named.made["keep"] == []


@pytest.mark.parametrize(
    ("keep", "words"),
    [
        ({"erorr": "all"}, r'keep: got \'erorr\', .*did you mean "error"'),
        ({"error": "some"}, r"keep\['error'\]: got 'some', expected \"all\" or \"none\", garrison.every"),
        ({"details": gr.every(2)}, r"keep\['details'\]: got garrison.every\(2\), expected \"all\" or \"none\""),
        ({3: "all"}, "keep: got 3"),
        (["error"], "keep: got 'error'"),
    ],
)
def test_what_cannot_be_kept_is_refused(keep: Any, words: str) -> None:
    with pytest.raises(gr.InvalidInput, match=words):
        gr.simulate(MODEL, RING, FILTERS[0], steps=3, keep=keep)


@pytest.mark.parametrize("step", [0, -1, 1.5, "x"])
def test_steps_of_every(step: Any) -> None:
    with pytest.raises(gr.InvalidInput, match="every: got"):
        gr.every(step)


def test_what_is_indexed_is_read(sizes: None, tmp_path: Path) -> None:
    given: dict[str, Any] = {"steps": STEPS, "trials": TRIALS, "seed": 2}
    memory = gr.simulate(MODEL, RING, FILTERS[1], **given)
    run = gr.simulate(MODEL, RING, FILTERS[1], **given, to=tmp_path / "run.zarr")
    assert memory.estimate is not None and run.estimate is not None
    keys: list[Any] = [
        0,
        -1,
        (1, slice(3, None, 2)),
        (..., -1),
        (slice(None), -1),
        ([0, 2], slice(5), [1]),
        (0, 0, 0, 0),
    ]
    keys += [(slice(None), slice(None, None, -1)), memory.estimate > 0.1, (0, None)]
    for key in keys:
        np.testing.assert_array_equal(run.estimate[key], memory.estimate[key])
    np.testing.assert_array_equal(run.verdict == gr.Verdict.SUSPECTED, memory.verdict == gr.Verdict.SUSPECTED)
    np.testing.assert_array_equal(2.0 * run.estimate - 1.0, 2.0 * memory.estimate - 1.0)
    assert len(run.estimate) == TRIALS and run.estimate.ndim == 4
    assert repr(run.estimate) == f"<estimate: float64 ({TRIALS}, {STEPS + 1}, {N}, 2), in a store; np.asarray reads it>"
    again = pickle.loads(pickle.dumps(run))
    assert type(again) is gr.StoredRun and again.path == run.path and again == run
    assert run.alarms() == memory.alarms() and run.first_accused() == memory.first_accused()
    assert repr(run).startswith(f"<StoredRun of saturation: {TRIALS} trials, {STEPS} samples, {N} agents, in ")


@pytest.mark.parametrize("error", [KeyboardInterrupt, RuntimeError, ValueError, OSError])
def test_a_run_that_ends_early_leaves_what_was_there(error: type[BaseException], tmp_path: Path) -> None:
    path = tmp_path / "run.zarr"

    def stop(done: int, total: int) -> None:
        if done > total // 2:
            raise error

    for there in (False, True):
        if there:
            gr.simulate(MODEL, RING, FILTERS[0], steps=STEPS, to=path)
        before = sorted(tmp_path.rglob("*"))
        with pytest.raises(error):
            gr.simulate(MODEL, RING, FILTERS[0], steps=2000, to=path, progress=stop)
        assert sorted(tmp_path.rglob("*")) == before
    assert gr.Run.load(path).shape == (1, STEPS + 1, N)


def test_places_that_are_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "mine.zarr").mkdir()
    (tmp_path / "mine.zarr" / "notes.txt").write_text("mine")
    called: list[int] = []
    cases: list[tuple[Any, type[Exception], str]] = [
        (tmp_path / "mine.zarr", gr.IoError, "mine.zarr: got a folder with files of others"),
        (tmp_path / "no" / "run.zarr", gr.IoError, "No such file"),
        (tmp_path / "run.nc", gr.InvalidInput, r"to: got .*run.nc, expected a name that ends in .zarr; .*save"),
        (3, gr.InvalidInput, "to: got 3"),
    ]
    for to, kind, words in cases:
        with pytest.raises(kind, match=words):
            gr.simulate(MODEL, RING, FILTERS[0], steps=9, to=to, progress=lambda done, total: called.append(done))
    assert not called and (tmp_path / "mine.zarr" / "notes.txt").read_text() == "mine"
    monkeypatch.setitem(sys.modules, "zarr", None)
    with pytest.raises(
        gr.InvalidInput, match=r'to: got .*no zarr, expected it installed: pip install "garrison\[store'
    ):
        gr.simulate(MODEL, RING, FILTERS[0], steps=9, to=tmp_path / "run.zarr")


def test_what_is_too_large_is_refused_with_its_size(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("GARRISON_MEMORY_GB", "0.001")
    with pytest.raises(
        gr.InvalidInput, match=r'9000 samples .* would take .* GB, .*; take fewer .* keep less .*to="run.zarr"'
    ):
        gr.simulate(MODEL, RING, FILTERS[0], steps=9000)
    run = gr.simulate(MODEL, RING, FILTERS[0], steps=9000, to=tmp_path / "run.zarr")
    assert run.error is not None and np.isfinite(run.error[0, -1]).all()
    with pytest.raises(gr.InvalidInput, match=r"load: got .*run.zarr, which would take .* GB, .*xarray.open_zarr"):
        gr.Run.load(tmp_path / "run.zarr")
    with pytest.raises(gr.InvalidInput, match=r"estimate: got an array of shape .* which would take"):
        np.asarray(run.estimate)
    monkeypatch.delenv("GARRISON_MEMORY_GB")
    assert gr.Run.load(tmp_path / "run.zarr").shape == (1, 9001, N)


def test_damage_is_told(tmp_path: Path) -> None:
    path, copy = tmp_path / "run.zarr", tmp_path / "copy.zarr"
    gr.simulate(MODEL, RING, FILTERS[0], steps=STEPS, trials=2, to=path)
    pieces = [
        one for one in path.rglob("*") if one.name[0].isdigit() and one.parent.name in ("error", "estimate", "bound")
    ]
    assert len(pieces) >= 3
    for piece in pieces:
        for damage in ("missing", "changed"):
            shutil.copytree(path, copy)
            there = copy / piece.relative_to(path)
            if damage == "missing":
                there.unlink()
            else:
                data = bytearray(there.read_bytes())
                data[len(data) // 2] ^= 4
                there.write_bytes(bytes(data))
            with pytest.raises(gr.IoError, match=r"copy.zarr: got .*expected a run written by Run.save"):
                gr.Run.load(copy)
            shutil.rmtree(copy)
    about = path / ".zattrs"
    about.write_text(about.read_text().replace("sent", "seen"))
    with pytest.raises(gr.IoError, match="its digest does not match"):
        gr.Run.load(path)


LONG = """
import resource, sys
import garrison as gr, numpy as np
C = np.random.default_rng(1).normal(size=(200, 1, 2))
model = gr.Model(0.98 * np.eye(2), C, process_bound=0.02, measurement_bound=0.05)
parts = model, gr.Network.ring(200), gr.filters.ScalarGain(rounds=1)
peak = lambda: resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
gr.simulate(*parts, steps=500, to=sys.argv[1], conditions=False)
before = peak()
run = gr.simulate(*parts, steps=20_000, to=sys.argv[1], conditions=False)
whole = sum(a.shape[0] * a.shape[1] * a.shape[2] * a.dtype.itemsize * (2 if a.ndim == 4 else 1)
            for a in (run.estimate, run.error, run.bound, run.statistic, run.threshold, run.verdict, run.bound_kind))
print(peak() - before, whole)
"""


def test_memory_does_not_grow_with_the_run(tmp_path: Path) -> None:
    command = [sys.executable, "-c", LONG, str(tmp_path / "run.zarr")]
    grown, whole = map(int, subprocess.run(command, capture_output=True, check=True, text=True).stdout.split())
    assert whole > 190e6 and grown < whole / 2, (grown, whole)
