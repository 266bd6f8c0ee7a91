"""Every public class is kept, or is on the list of those that are not (docs/adr/0018); what is damaged is refused."""

import copy
import pickle
import random
from pathlib import Path
from typing import Any

import garrison as gr
import numpy as np
import pytest
from conftest import ROOT
from fuzz_samples import samples
from garrison.tables import read_records
from test_objects import keeps

#: objects that are worked with, and `Design`, which only Prepared holds
NOT_KEPT = {
    *("Window", "WindowWitness", "Witness", "Region", "Bank", "Propagation", "Recovery", "TwoNumbers", "ErrorSystem"),
    *(
        "Kernels",
        "Table",
        "GaussianTable",
        "ObserverTable",
        "Meters",
        "SparseMeters",
        "SmallestAttack",
        "Response",
        "AgentInfo",
    ),
    *("rdkf.Setting", "Analysis", "Design", "NonlinearModel"),
}
COVARIANCES = {"process_covariance": 1e-4, "measurement_covariance": 1e-4}
MODEL = gr.Model(
    [[0.9, 0.1], [0.0, 0.9]], [[1, 0], [0, 1]] * 3, process_bound=0.02, measurement_bound=0.01, **COVARIANCES
)
RING = gr.Network.ring(6)


@pytest.mark.parametrize("name", [name for name in samples() if name != "weights"])
def test_a_public_class_is_kept_or_says_that_it_is_not(name: str) -> None:
    for x in samples()[name]:
        if name not in NOT_KEPT:
            keeps(x)
            continue
        for keep in (pickle.dumps, copy.copy, copy.deepcopy):
            with pytest.raises(gr.InvalidInput, match="got pickle or copy, expected none"):
                keep(x)


def test_the_decision_names_what_is_not_kept() -> None:
    text = (ROOT / "docs/adr/0018-what-can-be-kept.md").read_text()
    assert [name for name in NOT_KEPT - {"Design"} if f"`{name.split('.')[-1]}`" not in text] == []


def test_answers_of_functions_are_kept(tmp_path: Path) -> None:
    clean = gr.simulate(MODEL, RING, gr.filters.Structural(), steps=100, noise="normal")
    lies = gr.simulate(
        MODEL, RING, gr.filters.Saturation(threshold=0.5), steps=8, attack=gr.attacks.Bias([1], value=9.0, start=3)
    )
    quiet = np.zeros((30, 4))
    answers: list[Any] = [
        gr.analyze(MODEL, RING, candidates=np.eye(2)),
        gr.calibrate(MODEL, RING, gr.filters.Structural(), measurements=clean.measurements[0]),  # type: ignore[index]
        gr.compare(MODEL, RING, [1], trials=1, steps=10, start=5),
        gr.design(MODEL, RING, initial_error=1.0, attacked=1),
        gr.resilience_per_byte(MODEL, RING, [1], gain=0.1, energy=1.0)[0],
        gr.replay_mitigated(
            gr.Network.complete(4),
            A=[[0.9, 0.1], [0.0, 0.9]],
            process_covariance=0.01 * np.eye(2),
            measurement_variance=0.01,
            measured=[0, 1, 0, 1],
            truth=np.zeros((31, 2)),
            noise=quiet,
            attack=quiet + 9.0 * (np.arange(4) == 1) * (np.arange(30) > 9)[:, None],
        ),
        gr.sweep(
            ROOT / "examples/platoon/spoofed.toml", set={"filter.attacked": [1]}, trials=1, out=tmp_path / "sweep"
        ),
        *lies.alarms(),
        *gr.Verdict,
        *gr.BoundKind,
    ]
    assert lies.alarms()
    for answer in answers:
        keeps(answer)


def test_records_and_their_fit_are_kept(tmp_path: Path) -> None:
    days = np.datetime64("2020-01-01") + np.arange(1100)
    waves = np.random.default_rng(0).normal(size=(1100, 4))
    for k in range(1, 1100):
        waves[k] += 0.7 * waves[k - 1]
    rows = [
        "date,a,b,c,d",
        *(f"{day},{','.join(map(str, row))}" for day, row in zip(days, waves.tolist(), strict=True)),
    ]
    (tmp_path / "records.csv").write_text("\n".join(rows))
    records = read_records(tmp_path / "records.csv")
    keeps(records.between(None, records.dates[100]))
    for x in (records, gr.fit(records)):  # too large to be shown
        assert pickle.loads(pickle.dumps(x)) == x == copy.deepcopy(x) and hash(copy.deepcopy(x)) == hash(x)
        assert len(repr(x)) < 5_000


class Named(gr.Filter):
    """Signals whose names other arrays and coordinates of a run have, too."""

    signals = ("threshold", "time", "agent", "varying_A", "signal_x", "output_unit", "plain")

    def sense(self, agent: gr.AgentInfo, state: Any, y: Any, t: int) -> Any:
        return {"estimate": state.estimate}

    def fuse(self, agent: gr.AgentInfo, state: Any, inbox: Any, round: int) -> Any:
        return None

    def report(self, agent: gr.AgentInfo, state: Any) -> Any:
        return {"threshold": 1.0, **{name: float(k + 2) for k, name in enumerate(self.signals)}}


def same_fields(one: gr.Run, two: gr.Run) -> None:
    assert one == two and vars(one).keys() == vars(two).keys()
    for name, value in vars(one).items():
        again = getattr(two, name)
        arrays = value if isinstance(value, dict) else {name: value}
        for key, array in arrays.items():
            if isinstance(array, np.ndarray):
                found = again[key] if isinstance(value, dict) else again
                assert (array.dtype, array.shape, array.tobytes()) == (found.dtype, found.shape, found.tobytes()), key
            else:
                assert repr(value) == repr(again), name


@pytest.mark.parametrize("suffix", [".npz", ".nc", ".zarr"])
def test_every_field_of_a_run_comes_back_in_all_bits(suffix: str, tmp_path: Path) -> None:
    for package in {".npz": (), ".nc": ("xarray", "scipy"), ".zarr": ("xarray", "zarr")}[suffix]:
        pytest.importorskip(package)
    everything = ["estimate", "report", "measurements", "signals", "details"]
    string = {"reference": [120.0, 10.0], "spacing": 20.0, "gs": 2.0, "gv": 4.0}
    vehicles = gr.filters.Platoon(
        attacked=1, process_noise=0.01, measurement_noise=0.01, initial_error=1000.0, **string
    )
    runs = [
        gr.simulate(gr.platoon.model(7, 0.05), gr.Network.band(7, 2), vehicles, steps=5, keep=everything),
        gr.simulate(MODEL, RING, Named(), steps=3, keep=everything),
        gr.simulate(
            MODEL,
            RING,
            gr.filters.Saturation(threshold=0.5, rounds=12, attacked=2, initial_error=2.0, detector=True),
            steps=6,
            trials=2,
            keep=everything,
            attack=[gr.attacks.Bias([1], value=50.0, start=2), gr.attacks.Constant([2], value="nan")],
            link={"drop": 0.2},
        ),
    ]
    assert "threshold" in runs[0].signals and runs[0].details and runs[2].accusations
    for run in runs:
        run.save(tmp_path / f"run{suffix}")
        same_fields(gr.Run.load(tmp_path / f"run{suffix}"), run)


def test_no_signal_is_left_out_of_tables() -> None:
    pytest.importorskip("pandas")
    run = gr.simulate(MODEL, RING, Named(), steps=2, keep=["report", "signals"])
    table = run.to_pandas()
    assert table["time"].max() == 2 and set(table["signal_time"][table["time"] > 0]) == {3.0}
    assert [f"signal_{name}" in table or name in table for name in Named.signals] == [True] * len(Named.signals)
    model = gr.Model([[0.5]], [[1.0]] * 3, states=["time"], units="s")
    table = gr.simulate(model, gr.Network.ring(3), gr.filters.ScalarGain(), steps=2).to_pandas()
    assert table["time"].tolist() == [0] * 3 + [1] * 3 + [2] * 3 and table.attrs["units"]["state_time"] == "s"


@pytest.mark.parametrize("suffix", [".npz", ".nc", ".gdesign"])
def test_damaged_files_are_refused_by_name_or_read_as_they_were(suffix: str, tmp_path: Path) -> None:
    if suffix == ".nc":
        pytest.importorskip("xarray")
        pytest.importorskip("scipy")
    filt = gr.filters.Saturation(threshold=0.5, rounds=3)
    whole: Any = gr.prepare(MODEL, RING, filt)
    whole = whole if suffix == ".gdesign" else whole.simulate(steps=3)
    path = tmp_path / f"damaged{suffix}"
    whole.save(path)
    data, rng = path.read_bytes(), random.Random(1)
    mutants = [data[:cut] for cut in (0, 3, 50, len(data) // 2, len(data) - 1)]
    for _ in range(150):
        mutant = bytearray(data)
        mutant[rng.randrange(len(data))] ^= 1 << rng.randrange(8)
        mutants.append(bytes(mutant))
    refused = 0
    for mutant in mutants:
        path.write_bytes(mutant)
        try:
            assert type(whole).load(path) == whole
        except gr.Error as error:
            assert path.name in str(error) and "expected" in str(error)
            refused += 1
    assert refused > 20, "HDF5 leaves much of a small file empty, but not all"
