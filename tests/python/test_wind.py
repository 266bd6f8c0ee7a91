"""The main job on real data, and the identification behind it."""

import datetime as dt
from pathlib import Path

import garrison as gr
import numpy as np
import pytest
from garrison.jobs import run_scenario, signal_size
from garrison.scenario import read_scenario
from garrison.tables import read_records


def test_hijacked_wind_is_as_the_readme_says(wind: Path) -> None:
    scenario = read_scenario(wind / "hijacked.toml")
    rows = {(r.label, r.attacked): r.summary for r in run_scenario(scenario)}
    signal = signal_size(scenario)
    assert signal is not None
    detector = rows["saturation with detector", True]
    assert set(detector["detected"]) == {"DUB", "CLO", "ROS"}
    assert detector["false_alarms"] == 0
    assert rows["saturation with detector", False]["detected"] == {}
    assert rows["saturation", True]["mean_error"] < signal
    assert rows["structural, isolating", True]["mean_error"] < signal
    assert rows["central Kalman filter", True]["mean_error"] > 4 * signal
    assert rows["consensus, unprotected", True]["mean_error"] > 4 * signal
    assert detector["share_with_bound"] >= 0.999
    assert detector["median_bound"] <= 0.6
    for row in rows.values():
        assert row.get("inside_bound") in (None, 1.0)


def test_bounds_of_the_clean_years_hold_in_the_later_years(wind: Path) -> None:
    records = read_records(wind / "irish_wind.csv")
    found = gr.fit(records.between(None, dt.date(1970, 12, 31)), factors=1, root=True, factor=0.514444)
    later = records.between(dt.date(1971, 1, 1), None)
    x = found.reference(later)
    w = x[1:] - x[:-1] @ found.model.A.T
    v = found.measurements(later) - x @ np.asarray(found.identified.C).T
    assert np.linalg.norm(w, axis=1).max() <= found.model.process_bound
    assert np.abs(v).max() <= max(found.model.measurement_bound)


def test_gaps_are_missing_records(wind: Path) -> None:
    records = read_records(wind / "irish_wind.csv")
    gappy = records.values.copy()
    gappy[np.random.default_rng(1).random(gappy.shape) < 0.05] = np.nan
    full = gr.fit(records, factors=2, root=True)
    some = gr.fit(type(records)(records.dates, records.stations, gappy), factors=2, root=True)
    assert np.allclose(full.model.A, some.model.A, atol=0.05)


def test_fit_refuses_what_it_cannot_use(wind: Path) -> None:
    records = read_records(wind / "irish_wind.csv")
    with pytest.raises(gr.InvalidInput, match=r"fit.factors: got 13, expected a number in 1..12"):
        gr.fit(records, factors=13)
    with pytest.raises(gr.InvalidInput, match="expected at least 2"):
        records.between(dt.date(1990, 1, 1), None)
