"""The main job: what runs of a scenario share."""

from pathlib import Path

import matplotlib
from garrison import jobs
from garrison.report import table_rows
from garrison.report.page import write_report
from garrison.run_file import arrays_of
from garrison.scenario import read_scenario

_WIND = Path(__file__).parents[2] / "examples" / "wind" / "hijacked.toml"


def test_a_filter_is_designed_once_for_its_run_under_attack_and_the_one_without(monkeypatch):
    made = []

    def counted(model, network, filter, **wanted):
        made.append(filter.name)
        tell = wanted["progress"]
        tell("bounds", 1.5)
        return real(model, network, filter, **wanted)

    real = jobs.prepare
    monkeypatch.setattr(jobs, "prepare", counted)
    said = []
    scenario = read_scenario(_WIND)
    rows = jobs.run_scenario(scenario, working=lambda what, seconds: said.append((what, seconds)))
    filters = [label for label, filter in scenario.filters if filter is not None]
    assert len(made) == len(filters)
    assert said == [(f"{label}: bounds", 1.5) for label in filters]
    assert sum(row.run is not None for row in rows) == 2 * len(filters)


def test_one_run_at_a_time_gives_the_same_tables_and_pictures(tmp_path, monkeypatch):
    scenario = read_scenario(_WIND)
    whole, few = jobs.run_scenario(scenario), jobs.run_scenario(scenario, whole=False)
    assert [row.summary for row in few] == [row.summary for row in whole]
    assert table_rows(scenario, few) == table_rows(scenario, whole)
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "0")  # pictures have dates and names
    pages = []
    with matplotlib.rc_context({"svg.hashsalt": "garrison"}):
        for rows in (whole, few):
            write_report(tmp_path / "report.html", scenario, rows)
            pages.append((tmp_path / "report.html").read_text())
    assert pages[0] == pages[1]
    assert few[0].run == whole[0].run
    for row in few[1:]:
        held = {} if row.run is None else arrays_of(row.run)
        assert held.keys() <= ({"bound", "published"} if row.attacked else set())
