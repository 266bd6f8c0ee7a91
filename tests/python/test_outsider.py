"""Inputs that somebody who did not know the code has tried: read as they are meant, or refused with advice."""

import datetime as dt
import json
from pathlib import Path
from typing import Any

import garrison as gr
import numpy as np
import pytest
from conftest import RING
from garrison.cli import main
from garrison.scenario import read_scenario
from garrison.tables import read_records

RECORDED = """
[model]
A = [[0.9]]
C = [[1], [1], [1]]
names = ["east", "west", "mid"]
process_covariance = 0.1
measurement_covariance = 0.1
[network]
kind = "complete"
[data]
file = "log.csv"
[filter]
name = "structural"
"""


def lines(count: int = 300) -> list[tuple[dt.datetime, str]]:
    rng = np.random.default_rng(0)
    x = np.cumsum(rng.normal(size=count))
    values = x[:, None] + 0.3 * rng.normal(size=(count, 3))
    start = dt.datetime(2020, 1, 30)
    return [(start + dt.timedelta(days=k), ",".join(map(str, row.round(3)))) for k, row in enumerate(values)]


def refused(tmp_path: Path, text: str, capsys: pytest.CaptureFixture[str], *options: str) -> str:
    """What `fit` says of a file that it refuses."""
    (tmp_path / "records.csv").write_text(text)
    assert main(["fit", str(tmp_path / "records.csv"), "--factors", "1", "--harmonics", "0", *options]) == 2
    return capsys.readouterr().err


def test_dates_in_three_columns(tmp_path: Path) -> None:
    path = tmp_path / "r.csv"
    path.write_text("Year,Month,Day,A,B,C\n" + "".join(f"{d.year},{d.month},{d.day},{v}\n" for d, v in lines()))
    found = read_records(path)
    assert found.dates[0] == dt.date(2020, 1, 30) and found.stations == ["A", "B", "C"] and found.step == 86400.0
    hourly = [(dt.datetime(2020, 1, 30) + dt.timedelta(hours=k), v) for k, (_, v) in enumerate(lines())]
    path.write_text(
        "year,month,day,hour,A,B,C\n" + "".join(f"{d.year},{d.month},{d.day},{d.hour},{v}\n" for d, v in hourly)
    )
    found = read_records(path)
    assert found.dates[1] == dt.datetime(2020, 1, 30, 1) and found.step == 3600.0


def test_what_stands_where_no_data_is(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    body = [f"{d.date()},{v}" for d, v in lines()]
    units = refused(tmp_path, "\n".join(["date,A,B,C", ",m/s,m/s,m/s", *body]), capsys)
    assert "line 2: got no time" in units and "units belong into the header: A [unit]" in units
    index = refused(tmp_path, "\n".join([",date,A,B,C", *(f"{k},{row}" for k, row in enumerate(body))]), capsys)
    assert "leave the column out if it numbers the rows" in index
    empty = refused(tmp_path, "\n".join(["date,A,B,C,D", *(f"{row}," for row in body)]), capsys)
    assert "station D: got 0 records" in empty and "leave it out" in empty
    period = refused(tmp_path, "\n".join(["date,A,B,C", *body]), capsys, "--period", "0")
    assert "fit.period: got 0, expected a number of samples > 0" in period


def test_levels_that_records_are_too_few_for_are_said_aloud(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "r.csv"
    path.write_text("date,A,B,C\n" + "".join(f"{d.date()},{v}\n" for d, v in lines()))
    command = ["fit", str(path), "--factors", "1", "--harmonics", "0", "--attacked", "1"]
    assert main([*command, "--failure", "1e-9"]) == 0
    assert "300 complete records, and a rate of 1e-09 takes 1999999999: raise --failure" in capsys.readouterr().err
    assert main([*command, "--failure", "0.01"]) == 0
    said = capsys.readouterr()
    assert "no levels" not in said.err and json.loads(said.out)["levels"]["z1"] > 0


@pytest.mark.parametrize("head", ["mid,east,west", "Mid,East,West", "MID,EAST,WEST"])
def test_columns_are_matched_by_name_whatever_their_capitals(tmp_path: Path, head: str) -> None:
    (tmp_path / "s.toml").write_text(RECORDED)
    (tmp_path / "log.csv").write_text(f"{head}\n" + "1,2,3\n" * 30)
    found = read_scenario(tmp_path / "s.toml")
    assert found.measurements is not None and found.measurements[0].tolist() == [2, 3, 1] and not found.notes


def test_columns_of_other_names_are_taken_in_order_and_said_so(tmp_path: Path) -> None:
    (tmp_path / "s.toml").write_text(RECORDED)
    (tmp_path / "log.csv").write_text("x,y,z\n" + "1,2,3\n" * 30)
    found = read_scenario(tmp_path / "s.toml")
    assert found.measurements is not None and found.measurements[0].tolist() == [1, 2, 3]
    assert found.notes == ["log.csv: columns x, y, z are taken in this order for east, west, mid"]
    (tmp_path / "s.toml").write_text(RECORDED.replace('names = ["east", "west", "mid"]\n', ""))
    assert not read_scenario(tmp_path / "s.toml").notes


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"states": "all", "factors": 1}, "fit.factors: got 1 with states = 'all', expected none"),
        ({"states": "all", "standardise": True}, "fit.standardise: got true with states = 'all', expected none"),
        ({"order": 2}, "fit.order: got 2 with states = 'factors', expected states = \"all\" beside it"),
    ],
)
def test_options_of_the_other_kind_of_fit(tmp_path: Path, options: dict[str, Any], said: str) -> None:
    path = tmp_path / "r.csv"
    path.write_text("date,A,B,C\n" + "".join(f"{d.date()},{v}\n" for d, v in lines()))
    with pytest.raises(gr.InvalidInput) as found:
        gr.fit(read_records(path), harmonics=0, **options)
    assert said in str(found.value)


def test_orders_and_shapes_are_told_as_they_are_given(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(gr.InvalidInput, match=r"the order is Network\(edges, agents\)"):
        gr.Network(4, [(0, 1)])  # type: ignore[arg-type]
    scenario = RING + '[filter]\nname = "scalar_gain"\n[run]\nsteps = 5\nstart = [[1, 0], [1, 0]]\n'
    (tmp_path / "s.toml").write_text(scenario)
    assert main(["check", str(tmp_path / "s.toml")]) == 2
    assert "start: got 2 x 2 numbers, expected 1 x 2 or 5 x 2; agents x states" in capsys.readouterr().err
    (tmp_path / "s.toml").write_text(scenario.replace("[[1, 0], [1, 0]]", "[" + "[1, 0]," * 5 + "]"))
    assert main(["check", str(tmp_path / "s.toml")]) == 0


def test_names_in_other_capitals_are_hinted_at(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = RECORDED.replace(
        '"complete"', '"complete"\n[[attack]]\nkind = "bias"\nagents = ["WEST"]\nvalue = 1.0\nstart = 2'
    )
    (tmp_path / "s.toml").write_text(text)
    (tmp_path / "log.csv").write_text("1,2,3\n" * 30)
    assert main(["check", str(tmp_path / "s.toml")]) == 2
    assert 'did you mean "west"?' in capsys.readouterr().err


def test_nothing_to_verify_is_no_answer(tmp_path: Path) -> None:
    assert main(["verify", str(tmp_path)]) == 2


def test_a_network_without_sensors_is_called_so() -> None:
    model = gr.Model([[0.9]], [[], []], process_bound=0.1, measurement_bound=0.1)
    run = gr.simulate(model, gr.Network.complete(2), gr.filters.ScalarGain(), steps=5)
    assert any("no agent has a sensor" in w for w in run.warnings)
