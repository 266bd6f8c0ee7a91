"""Names, units and alarms in what a run shows: xarray, notebooks, pictures."""

import json
from pathlib import Path
from typing import Any

import garrison as gr
import numpy as np
import pytest
from conftest import title_of
from garrison.objects import filter_of, model_of, network_of

MODEL = gr.Model(
    [[1.0, 0.1], [0.0, 0.9]],
    [[1, 0], [0, 1], [[1, 0], [0, 1]]],
    process_bound=0.02,
    measurement_bound=0.01,
    states=["height", "speed"],
    units={"height": "m", "speed": "m/s"},
)
NETWORK = gr.Network([(0, 1), (1, 2), (0, 2)], names=["A<1>", "B", "C"])
SATURATION = gr.filters.Saturation(threshold=0.5, rounds=2)
ATTACK = gr.attacks.Bias(agents=[1], value=9.0, start=4, stop=7)
KEEP = ["estimate", "report", "measurements", "signals"]


@pytest.fixture(scope="module")
def run() -> gr.Run:
    return gr.simulate(MODEL, NETWORK, SATURATION, steps=10, trials=2, seed=1, attack=ATTACK, keep=KEEP)


def test_xarray_has_coordinates_units_and_what_made_it(run: gr.Run) -> None:
    pytest.importorskip("xarray")
    data = run.to_xarray()
    assert data.agent.values.tolist() == ["A<1>", "B", "C"]
    assert data.state.values.tolist() == ["height", "speed"] and data.state_unit.values.tolist() == ["m", "m/s"]
    assert data.output.values.tolist() == ["A<1>", "B", "C.0", "C.1"]
    assert data.sample.values.tolist() == list(range(1, 11)) and data.time.values[0] == 0
    one = data.estimate.sel(trial=1, agent="B", state="speed", time=5)
    assert one == run.estimate[1, 5, 1, 1]  # type: ignore[index]
    assert np.array_equal(data.innovation.values, run.signals["innovation"], equal_nan=True)
    assert "units" not in data.error.attrs  # metres and metres per second have no common one
    made = [of(json.loads(data.attrs[name])) for name, of in (("model", model_of), ("network", network_of))]
    assert made == [MODEL, NETWORK] and filter_of(json.loads(data.attrs["filter"])) == SATURATION
    alike = gr.Model([[0.5]], [[[1.0]]] * 3, process_bound=0.1, measurement_bound=0.1, states=["level"], units="m")
    assert gr.simulate(alike, NETWORK, SATURATION, steps=3).to_xarray().error.attrs["units"] == "m"
    positions = gr.simulate(MODEL, NETWORK, SATURATION, steps=3, keep=["report"]).to_xarray()
    assert "output" not in positions.coords and "estimate" not in positions


def test_netcdf_keeps_the_whole_run(run: gr.Run, tmp_path: Path) -> None:
    xr = pytest.importorskip("xarray")
    path = tmp_path / "run.nc"
    run.save(path)
    loaded = gr.Run.load(path)
    assert loaded == run and loaded.verdict.dtype == np.uint8  # type: ignore[union-attr]
    again = gr.simulate(
        loaded.model, loaded.network, loaded.filter, steps=10, trials=2, seed=1, attack=ATTACK, keep=KEEP
    )
    assert again == loaded
    with xr.open_dataset(path) as data:  # what others read
        assert data.agent.values.tolist() == ["A<1>", "B", "C"]
        assert data.state_unit.values.tolist() == ["m", "m/s"]
    (tmp_path / "no.nc").write_text("nothing")
    xr.Dataset({"x": ("t", [1.0])}).to_netcdf(tmp_path / "other.nc")
    for wrong in ("no.nc", "other.nc", "missing.nc"):
        with pytest.raises(gr.IoError, match=wrong):
            gr.Run.load(tmp_path / wrong)


def test_alarms_are_the_verdicts_as_intervals(run: gr.Run) -> None:
    alarms = run.alarms()
    again = np.zeros(run.verdict.shape, dtype=bool)  # type: ignore[union-attr]
    for alarm in alarms:
        assert (run.verdict[alarm.trial, alarm.start : alarm.stop, alarm.agent] == alarm.verdict).all()  # type: ignore[index]
        assert not again[alarm.trial, alarm.start : alarm.stop, alarm.agent].any()
        again[alarm.trial, alarm.start : alarm.stop, alarm.agent] = True
    assert np.array_equal(again, np.isin(run.verdict, [gr.Verdict.SUSPECTED, gr.Verdict.ATTACKED]))  # type: ignore[arg-type]
    attacked = [a for a in run.alarms(trial=1) if a.agent == 1 and a.start <= 4 < a.stop]
    assert attacked and attacked[0].name == "B" and attacked[0].trial == 1
    quiet = gr.simulate(MODEL, NETWORK, SATURATION, steps=3, keep=["estimate"])
    with pytest.raises(gr.InvalidInput, match="alarms: got a run without verdicts"):
        quiet.alarms()


def test_html_is_short_and_escaped(run: gr.Run) -> None:
    check, network = gr.check(MODEL, NETWORK, SATURATION), gr.Network.ring(100)
    shown: dict[str, Any] = {"model": MODEL, "network": NETWORK, "check": check, "run": run, "ring": network}
    html = {name: thing._repr_html_() for name, thing in shown.items()}
    assert "A&lt;1&gt;" in html["network"] and "<1>" not in html["network"]
    assert "height" in html["model"] and "m/s" in html["model"] and "2 states" in html["model"]
    assert all(c["name"] in html["check"] for c in check.conditions)
    assert ("NOT MET" in html["check"]) == (not check.holds)
    assert "alarms" in html["run"] and "B" in html["run"]
    assert html["ring"].count("<tr>") < 20
    plant = gr.VaryingModel(MODEL, A=np.repeat(np.asarray(MODEL.A)[None], 7, axis=0))
    assert "A over 7 steps" in plant._repr_html_() and "height" in plant._repr_html_()
    links = gr.VaryingNetwork(network, np.arange(300).reshape(3, 100) % 4 != 0)
    assert "over 3 samples, a link is there in 75%" in links._repr_html_()
    assert all(len(text) < 20_000 for text in html.values())


def test_plot_of_some_agents_and_other_runs(run: gr.Run) -> None:
    pytest.importorskip("matplotlib")
    plain = gr.simulate(MODEL, NETWORK, gr.filters.ScalarGain(rounds=2), steps=10, trials=2, seed=1)
    figure = run.plot(1, agents=["B", 2], compare=[plain])
    lines = {line.get_label(): line for line in figure.axes[0].get_lines()}
    assert np.array_equal(lines["largest error of an agent"].get_ydata(), run.error[1][:, [1, 2]].max(axis=1))  # type: ignore[index]
    assert np.array_equal(lines["mean error of scalar_gain"].get_ydata(), plain.error[1][:, [1, 2]].mean(axis=1))  # type: ignore[index]
    looks = [(line.get_color(), line.get_linestyle()) for line in lines.values()]
    assert len(set(looks)) == len(looks)
    assert "agents B, C" in title_of(figure)
    whole = run.plot()
    assert np.array_equal(whole.axes[0].get_lines()[0].get_ydata(), run.error[0].max(axis=1))  # type: ignore[index]
    for wrong, words in (
        ({"agents": ["b"]}, "got 'b'"),
        ({"agents": [7]}, r"0\.\.2"),
        ({"agents": []}, "got nobody"),
        ({"compare": [3]}, "other runs"),
    ):
        with pytest.raises(gr.InvalidInput, match=words):
            run.plot(**wrong)  # type: ignore[arg-type]
