"""The main job: what runs of a scenario share."""

from pathlib import Path

from garrison import jobs
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
