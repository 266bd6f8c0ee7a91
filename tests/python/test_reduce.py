"""gr.reduce: statistics worked out while a run goes on are those of the whole arrays, whatever blocks and threads."""

import itertools
from pathlib import Path
from typing import Any

import garrison as gr
import numpy as np
import pytest
from garrison.bins import WIDTH, Bins, quantile
from test_stream import ATTACK, MODEL, RING, set_blocks

FILTER = gr.filters.Saturation(threshold=0.5, rounds=12, attacked=1, initial_error=2.0)
OPTIONS: dict[str, Any] = {"steps": 41, "trials": 5, "seed": 3, "attack": ATTACK}
AXES = ("trial", "time", "agent", "state")
STATISTICS = ("max", "min", "mean", "count", "q50", "q95")


def inverted(values: np.ndarray, axes: tuple[int, ...], share: float) -> np.ndarray:
    """Smallest number that at least this share of the others are not above; nan counts nowhere."""
    moved = np.moveaxis(values, axes, range(len(axes))).reshape(-1, *np.delete(values.shape, axes))
    out = np.full(moved.shape[1:], np.nan)
    for at in np.ndindex(out.shape):
        own = np.sort(moved[(slice(None), *at)])
        own = own[~np.isnan(own)]
        if len(own):
            out[at] = own[max(int(np.ceil(share * len(own))), 1) - 1]
    return out


@pytest.mark.parametrize("block", [3000, 16 * 2**20])
@pytest.mark.parametrize("name", ["error", "bound", "estimate"])
def test_they_are_those_of_the_whole_array(name: str, block: int, monkeypatch: pytest.MonkeyPatch) -> None:
    set_blocks(block, monkeypatch)
    whole = getattr(gr.simulate(MODEL, RING, FILTER, **OPTIONS), name)
    known = AXES[: whole.ndim]
    for many in range(1, len(known) + 1):
        for over in itertools.combinations(known, many):
            asked = gr.reduce(*STATISTICS, over=over)
            run = gr.simulate(MODEL, RING, FILTER, keep={name: asked}, **OPTIONS)
            assert run.error is None and run.estimate is None and run.bound is None
            gone = tuple(known.index(axis) for axis in over)
            found = {word: run.reduced[f"{name}_{word}_over_{'_'.join(over)}"] for word in STATISTICS}
            assert np.array_equal(found["max"], np.nanmax(whole, axis=gone))
            assert np.array_equal(found["min"], np.nanmin(whole, axis=gone))
            assert np.array_equal(found["count"], (~np.isnan(whole)).sum(axis=gone))
            assert np.allclose(found["mean"], np.nanmean(whole, axis=gone), rtol=1e-12, atol=1e-14)
            for word, share in (("q50", 0.5), ("q95", 0.95)):
                assert np.allclose(found[word], inverted(whole, gone, share), rtol=WIDTH, atol=0)


def test_bits_do_not_depend_on_threads_or_blocks(monkeypatch: pytest.MonkeyPatch) -> None:
    keep = {
        "error": gr.reduce(*STATISTICS, over="trial"),
        "estimate": gr.reduce(*STATISTICS, over=["time", "trial"]),
        "measurements": gr.reduce("mean", over="sample"),
    }
    runs = []
    for threads, block in ((1, 16 * 2**20), (2, 900), (2, 16 * 2**20)):
        set_blocks(block, monkeypatch)
        runs.append(gr.simulate(MODEL, RING, FILTER, keep=keep, threads=threads, **OPTIONS).reduced)
    for other in runs[1:]:
        assert list(other) == list(runs[0])
        assert all(other[name].tobytes() == values.tobytes() for name, values in runs[0].items())


def test_a_report_that_is_written_beside_them_is_whole(tmp_path: Path) -> None:
    run = gr.simulate(
        MODEL,
        RING,
        FILTER,
        to=tmp_path / "run.zarr",
        keep={"report": "all", "error": gr.reduce("max", over="agent")},
        **OPTIONS,
    )
    alone = gr.simulate(MODEL, RING, FILTER, to=tmp_path / "alone.zarr", keep={"report": "all"}, **OPTIONS)
    for name in ("bound", "bound_kind", "statistic", "threshold", "verdict"):
        assert np.array_equal(getattr(run, name), getattr(alone, name), equal_nan=name not in ("bound_kind", "verdict"))


def test_they_are_kept_with_the_run(tmp_path: Path) -> None:
    keep = {"error": gr.reduce("max", "q95", over="agent"), "bound": gr.reduce("min", over=("trial", "time"))}
    run = gr.simulate(MODEL, RING, FILTER, keep=keep, **OPTIONS)
    assert gr.again(run) == run and run.reduced["error_q95_over_agent"].shape == (5, 42)
    for name in ("run.npz", "run.nc", "run.zarr"):
        run.save(tmp_path / name)
        assert gr.Run.load(tmp_path / name) == run
    assert run.to_xarray()["reduced_error_max_over_agent"].dims == ("trial", "time")


def test_beside_arrays_that_are_written(tmp_path: Path) -> None:
    pytest.importorskip("zarr", minversion="3")
    keep = {"error": gr.reduce("max", over="agent"), "bound": gr.reduce("max", over="trial"), "estimate": gr.every(10)}
    run = gr.simulate(MODEL, RING, FILTER, keep=keep, to=tmp_path / "run.zarr", **OPTIONS)
    alone = gr.simulate(MODEL, RING, FILTER, keep={k: v for k, v in keep.items() if k != "estimate"}, **OPTIONS)
    assert run.reduced.keys() == alone.reduced.keys()
    assert all(np.array_equal(run.reduced[name], values) for name, values in alone.reduced.items())
    data = run.to_xarray()
    assert data["estimate"].dims[1] == "time_every_10" and "error" not in data and "bound" not in data
    assert np.array_equal(data["reduced_bound_max_over_trial"].values, alone.reduced["bound_max_over_trial"])
    gr.simulate(MODEL, RING, FILTER, keep=keep | {"estimate": "all"}, to=tmp_path / "whole.zarr", **OPTIONS)
    loaded = gr.Run.load(tmp_path / "whole.zarr")
    assert loaded.reduced.keys() == alone.reduced.keys() and loaded.error is None
    assert np.array_equal(loaded.estimate, gr.simulate(MODEL, RING, FILTER, **OPTIONS).estimate)


def test_replays_take_them_too() -> None:
    run = gr.simulate(MODEL, RING, FILTER, **OPTIONS)
    keep = {"error": gr.reduce("max", over="time")}
    again = gr.replay(MODEL, RING, FILTER, measurements=run.measurements, truth=run.truth, keep=keep)
    assert np.array_equal(again.reduced["error_max_over_time"], run.error.max(axis=1))


def test_quantiles_of_bins() -> None:
    rng = np.random.default_rng(0)
    values = np.concatenate([rng.normal(size=3000) * 10 ** rng.uniform(-300, 300, 3000), np.zeros(200), [np.inf] * 3])
    cells = rng.integers(0, 4, len(values))
    bins = Bins()
    for part in np.array_split(rng.permutation(len(values)), 17):
        bins.add(cells[part], values[part])
    counts = np.bincount(cells, minlength=6)
    for share in (0.0, 0.001, 0.3, 0.5, 0.99, 1.0):
        found = quantile(bins, counts, share)
        assert np.isnan(found[4:]).all()
        for cell in range(4):
            own = np.sort(values[cells == cell])
            exact = own[max(int(np.ceil(share * len(own))), 1) - 1]
            assert found[cell] == exact or abs(found[cell] / exact - 1) < WIDTH


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: gr.reduce("q101", over="agent"), "reduce: got 'q101'"),
        (lambda: gr.reduce("maxx", over="agent"), "did you mean"),
        (lambda: gr.reduce(over="agent"), "no statistic"),
        (lambda: gr.reduce("max", over="agents"), "over: got"),
    ],
)
def test_what_is_no_statistic_or_axis_is_refused(make: Any, message: str) -> None:
    with pytest.raises(gr.InvalidInput, match=message):
        make()


@pytest.mark.parametrize(
    ("keep", "message"),
    [
        ({"error": gr.reduce("max", over="state")}, "over: got state"),
        ({"details": gr.reduce("max", over="time")}, "with garrison.reduce"),
        ({"error": gr.reduce("max", over="time"), "estimate": "all"}, "estimate beside garrison.reduce without to"),
    ],
)
def test_what_a_run_cannot_reduce_is_refused(keep: dict[str, Any], message: str) -> None:
    with pytest.raises(gr.InvalidInput, match=message):
        gr.simulate(MODEL, RING, FILTER, steps=3, keep=keep)
