"""`garrison import pandapower`: rows, areas, links, what is refused. Cases are pandapower's own."""

import json
import sys
import warnings
from pathlib import Path

import numpy as np
import pytest
from garrison.cli import main
from garrison.importers.areas import areas_of, links_of
from garrison.importers.grid_files import Grid
from garrison.importers.grids import Assumptions, _unit
from garrison.scenario import read_scenario

with warnings.catch_warnings():
    warnings.simplefilter("ignore")
    try:
        import pandapower
        import pandapower.networks
    except ImportError:
        pandapower = None
needs = pytest.mark.skipif(pandapower is None, reason="needs the extra grid")


def path_grid(buses: int) -> Grid:
    """Buses in a row, susceptance 10."""
    names = [str(k) for k in range(buses)]
    return Grid("row", names, [(k, k + 1, 10.0) for k in range(buses - 1)], np.zeros(buses))


def test_a_unit_sees_the_far_ends_of_its_lines() -> None:
    seen, R, names = _unit(path_grid(3), 1, Assumptions(angle=0.01, flow=0.5))
    assert seen == [1, 0, 2]
    assert names == ["angle at 1", "angle at 0 from 1", "angle at 2 from 1"]
    assert np.allclose(R - np.diag(np.diag(R)), 1e-4 * (1 - np.eye(3)))  # its own error is in all of them
    assert np.allclose(np.diag(R), [1e-4, 1e-4 + 0.0025, 1e-4 + 0.0025], rtol=1e-3)


def test_parallel_lines_are_one_stronger_line() -> None:
    grid = Grid("two", ["a", "b"], [(0, 1, 10.0), (1, 0, 30.0)], np.zeros(2))
    seen, R, _ = _unit(grid, 0, Assumptions(angle=1e-9, flow=0.4))
    assert seen == [0, 1] and R[1, 1] == pytest.approx((0.4 / 40.0) ** 2)


def test_areas_are_whole_and_of_all_buses() -> None:
    grid = path_grid(30)
    areas = areas_of(grid, list(range(30)), 4)
    assert sorted(b for area in areas for b in area) == list(range(30)) and len(areas) == 4
    assert all(area == list(range(area[0], area[-1] + 1)) for area in areas)  # neighbours in the row
    assert len(links_of(grid, areas)) == 3


def test_links_reach_over_buses_without_a_unit() -> None:
    assert links_of(path_grid(7), [[0], [3], [6]]) == [(0, 1), (1, 2)]
    assert links_of(path_grid(3), [[0], [1], [2]]) == [(0, 1), (1, 2)]


@needs
@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize(("case", "agents", "outputs"), [("case14", 14, 54), ("case118", 8, 476)])
def test_cases_are_checked(tmp_path: Path, case: str, agents: int, outputs: int) -> None:
    assert main(["import", "pandapower", case, "-o", str(tmp_path / case), "--steps", "5"]) == 0
    scenario = read_scenario(tmp_path / case / "scenario.toml")
    assert (scenario.model.agents, scenario.model.outputs) == (agents, outputs)
    assert scenario.model.states == int(case.removeprefix("case"))
    assert "angle at 0" in scenario.model.output_names
    if case == "case14":
        assert main(["check", str(tmp_path / case / "scenario.toml")]) == 0
        assert main(["run", str(tmp_path / case / "scenario.toml"), "-o", str(tmp_path / "run")]) == 0


@needs
@pytest.mark.filterwarnings("ignore")
def test_1354_buses_are_read(tmp_path: Path) -> None:
    out = tmp_path / "large"
    assert main(["import", "pandapower", "case1354pegase", "--units", "300", "-o", str(out)]) == 0
    scenario = read_scenario(out / "scenario.toml")
    assert (scenario.model.states, scenario.model.agents) == (1354, 300)
    assert scenario.network.connected


@needs
@pytest.mark.filterwarnings("ignore")
def test_9241_buses_are_analysed_and_no_more(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "largest"
    assert main(["import", "pandapower", "case9241pegase", "-o", str(out)]) == 0
    assert "matrices of all states would take 8.3 GB" in capsys.readouterr().out
    assert main(["analyze", str(out / "scenario.toml"), "--seconds", "120", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert len(told["sensors"]) == 37655 and not told["unfinished"]
    assert (told["one_sample"]["fewest"], told["one_sample"]["exact"]) == (2, True)
    assert told["additions"][0]["cheapest"]
    assert main(["check", str(out / "scenario.toml")]) == 2
    assert "would take 8" in capsys.readouterr().err


@needs
@pytest.mark.filterwarnings("ignore")
def test_a_file_of_ones_own_with_switches_and_transformers(tmp_path: Path) -> None:
    net = pandapower.networks.example_multivoltage()  # three-winding transformers, open and closed switches
    pandapower.to_json(net, str(tmp_path / "own.json"))
    out = tmp_path / "own"
    assert main(["import", "pandapower", str(tmp_path / "own.json"), "-o", str(out), "--at", "5", "33", "36"]) == 0
    assert main(["import", "pandapower", str(tmp_path / "own.json"), "-o", str(tmp_path / "all")]) == 0
    assert read_scenario(out / "scenario.toml").names == ["bus 0", "bus 33", "bus 36"]  # a closed switch joins 0 and 5


@needs
@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["case119"], 'did you mean "case11'),
        (["absent.json"], "got no such file"),
        (["text.json"], "got no grid"),
        (["case14", "--units", "15"], "--units: got 15, expected 1..14"),
        (["case14", "--at", "99"], "--at: got 99, expected names of buses"),
        (["case14", "--areas", "0"], "--areas: got 0, expected 1..14"),
    ],
)
def test_grids_that_are_none_are_refused(
    tmp_path: Path,
    arguments: list[str],
    message: str,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("text.json").write_text("{}")
    assert main(["import", "pandapower", *arguments, "-o", "out"]) == 2
    assert message in capsys.readouterr().err


def test_a_missing_library_says_what_to_install(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    for name in [n for n in sys.modules if n.partition(".")[0] == "pandapower"]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, "pandapower", None)
    assert main(["import", "pandapower", "case14", "-o", "nowhere"]) == 2
    assert 'install it: pip install pandapower, or pip install "garrison[grid]"' in capsys.readouterr().err
