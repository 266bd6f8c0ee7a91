"""Tables and reports say what a run holds, and nothing that nobody knows."""

import datetime as dt
import json
import re
from pathlib import Path

import garrison as gr
import numpy as np
import pytest
from conftest import ROOT
from garrison.cli import main
from garrison.figures import error_figure
from garrison.figures.style import dot_alone
from garrison.jobs import Row, run_scenario
from garrison.report import table_rows
from garrison.report.page import write_report
from garrison.report.table import at_time, detections, warnings_of
from garrison.scenario import Scenario, read_scenario
from matplotlib.figure import Figure
from scipy.optimize import linprog

FAULTY = """
[model]
fit = "wind.csv"
to = "1962-12-31"
factors = 1
root = true
[network]
stations = "stations.csv"
[data]
file = "wind.csv"
from = "1963-01-01"
to = "1963-12-31"
[filter]
name = "saturation"
threshold = 0.7
rounds = 10
attacked = 3
initial_error = 9.0
detector = true
detector_index = "t+1"
[[compare]]
name = "structural"
false_alarm = 1e-6
[[compare]]
name = "central_kalman"
"""
LOG = """
[model]
A = [[1.0]]
C = [[1], [1], [1]]
process_bound = 0.02
measurement_bound = 0.01
[network]
kind = "ring"
[filter]
name = "saturation"
threshold = 2.0
rounds = 4
attacked = 1
initial_error = 2.0
[data]
file = "y.csv"
"""


@pytest.fixture
def faulty(tmp_path: Path, wind: Path) -> Path:
    """Three years of wind; from mid 1963 on Dublin really reports 1000 knots too much, which nobody declares."""
    lines = (wind / "irish_wind.csv").read_text().splitlines()[: 1 + 365 * 3]
    at = lines[0].split(",").index("DUB")
    for k, line in enumerate(lines[1:], start=1):
        cells = line.split(",")
        if cells[0] >= "1963-07-01":
            cells[at] = f"{float(cells[at]) + 1000:.2f}"
        lines[k] = ",".join(cells)
    (tmp_path / "wind.csv").write_text("\n".join(lines) + "\n")
    (tmp_path / "stations.csv").write_text((wind / "stations.csv").read_text())
    (tmp_path / "x.toml").write_text(FAULTY)
    return tmp_path


def cell(scenario: Scenario, rows: list[Row], row: int, column: str) -> str:
    head, cells = table_rows(scenario, rows)
    return cells[row][head.index(column)]


def test_without_a_declared_attack_there_are_no_false_alarms(faulty: Path, capsys: pytest.CaptureFixture[str]) -> None:
    scenario = read_scenario(faulty / "x.toml")
    rows = run_scenario(scenario)
    head, _ = table_rows(scenario, rows)
    assert "false alarms" not in head
    assert "DUB on 1963-07" in cell(scenario, rows, 0, "accused")
    assert all("false_alarms" not in row.summary for row in rows)
    # The reference is pulled by the wrong sensor, the robust one is not.
    pulled, robust = (float(cell(scenario, rows, 0, c)) for c in ("mean error", "mean error to robust reference"))
    assert robust < 0.5 * pulled
    assert main(["run", str(faulty / "x.toml"), "-o", str(faulty / "out")]) == 0
    page = (faulty / "out/report.html").read_text()
    text = re.sub(r"<svg.*?</svg>", "", page, flags=re.DOTALL)
    assert "No attack was declared on these records" in text
    for word in ("clean", "since then", "hijacked", "false alarms</th>"):
        assert word not in text, word
    out = capsys.readouterr().out
    assert "false alarms" not in out
    assert "Errors are distances to a reference" in out and "Errors are distances to a reference" in text


def test_a_median_of_sensors_is_not_pulled() -> None:
    from garrison.fitting import _least_absolute

    C = np.array([[1.0], [1.0], [1.0], [1.0], [1.0]])
    y = np.array([[1.0, 2.0, 3.0, 4.0, 1e6], [0.0, np.nan, 5.0, 6.0, np.nan], [np.nan] * 5])
    found = _least_absolute(C, y)
    np.testing.assert_allclose(found[:2, 0], [3.0, 5.0], atol=1e-6)
    assert np.isnan(found[2, 0])
    # Two states: the linear programme min sum(t), -t <= y - C x <= t, solved by SciPy.
    rng = np.random.default_rng(1)
    C, y = rng.normal(size=(9, 2)), rng.normal(size=(1, 9))
    eye = np.eye(9)
    limits = np.block([[C, -eye], [-C, -eye]])
    free = [(None, None)] * 2 + [(0, None)] * 9
    best = linprog([0.0, 0.0, *np.ones(9)], A_ub=limits, b_ub=np.concatenate([y[0], -y[0]]), bounds=free)
    np.testing.assert_allclose(_least_absolute(C, y)[0], best.x[:2], atol=1e-6)


def test_accusations_of_every_family_are_shown(faulty: Path) -> None:
    scenario = read_scenario(faulty / "x.toml")
    rows = run_scenario(scenario)
    structural = cell(scenario, rows, 1, "accused")
    assert "DUB" in structural and "on 1963-07-01" in structural
    run = rows[1].run
    assert run is not None and scenario.names.index("DUB") in run.first_accused()


def test_bounds_are_shown_without_truth(tmp_path: Path) -> None:
    y = 1.0 + 0.01 * np.random.default_rng(0).uniform(-1, 1, size=(30, 3))
    np.savetxt(tmp_path / "y.csv", y, delimiter=",")
    (tmp_path / "x.toml").write_text(LOG)
    scenario = read_scenario(tmp_path / "x.toml")
    rows = run_scenario(scenario)
    bound = rows[0].run.bound  # type: ignore[union-attr]
    assert bound is not None and np.isfinite(bound[:, 1:]).all()
    assert cell(scenario, rows, 0, "samples with a bound") == "100%"
    head, _ = table_rows(scenario, rows)
    assert "mean error" not in head and "error within bound" not in head


def test_a_log_with_header_times_and_names_in_another_order(tmp_path: Path) -> None:
    y = np.random.default_rng(0).uniform(size=(5, 3))
    lines = [f"{10 + k}:00,{c:.6f},{a:.6f},{b:.6f}" for k, (a, b, c) in enumerate(y)]
    (tmp_path / "y.csv").write_text("time,2,0,1\n" + "\n".join(f"2024-05-01 {line}" for line in lines))
    (tmp_path / "x.toml").write_text(LOG + 'from = "2024-05-01T11:00"\n')
    scenario = read_scenario(tmp_path / "x.toml")
    np.testing.assert_allclose(scenario.measurements, y[1:], atol=1e-6)
    assert scenario.dates[0] == dt.datetime(2024, 5, 1, 11)
    assert at_time(scenario, 1) == "at 2024-05-01 11:00:00"
    (tmp_path / "x.toml").write_text(LOG.replace('"y.csv"', '"y.csv"\nfrom = 3'))
    with pytest.raises(gr.InvalidInput, match=r"\[data\] from: got the number 3, expected a date"):
        read_scenario(tmp_path / "x.toml")


def test_warnings_are_at_the_head_of_report_and_in_the_output(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = LOG.replace("attacked = 1", "attacked = 2").replace('[data]\nfile = "y.csv"', "[run]\nsteps = 10")
    (tmp_path / "x.toml").write_text(text)
    assert main(["run", str(tmp_path / "x.toml"), "-o", str(tmp_path / "out")]) == 0
    out = capsys.readouterr().out
    page = (tmp_path / "out/report.html").read_text()
    warnings = json.loads((tmp_path / "out/summary.json").read_text())["rows"][0]["warnings"]
    assert any("condition not met" in w for w in warnings)
    assert "warning: saturation: condition not met" in out
    assert page.index("condition not met") < page.index("<h2>")
    assert main(["run", str(tmp_path / "x.toml"), "-o", str(tmp_path / "o2"), "--no-conditions"]) == 0
    assert "condition not met" not in capsys.readouterr().out


def test_summary_is_worked_out_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    calls = []
    real = gr.Run.first_accused
    monkeypatch.setattr(gr.Run, "first_accused", lambda self, trial=0: calls.append(trial) or real(self, trial))
    (tmp_path / "x.toml").write_text(
        LOG.replace("initial_error = 2.0", "initial_error = 2.0\ndetector = true").replace(
            '[data]\nfile = "y.csv"', "[run]\nsteps = 10\ntrials = 4"
        )
    )
    scenario = read_scenario(tmp_path / "x.toml")
    rows = run_scenario(scenario)
    for _ in range(3):
        table_rows(scenario, rows)
        warnings_of(scenario, rows)
    assert calls == [0, 1, 2, 3]


def test_a_page_fits_a_phone(faulty: Path) -> None:
    assert main(["run", str(faulty / "x.toml"), "-o", str(faulty / "out")]) == 0
    page = (faulty / "out/report.html").read_text()
    assert "width=device-width" in page and "overflow-x:auto" in page
    for start in (m.start() for m in re.finditer("<table", page)):
        assert page[:start].endswith('<div class="wide">')


def test_words_for_times_and_names(tmp_path: Path) -> None:
    (tmp_path / "x.toml").write_text(LOG.replace('[data]\nfile = "y.csv"', "[run]\nsteps = 100"))
    scenario = read_scenario(tmp_path / "x.toml")
    assert detections(scenario, {"2": 41, "5": 80}) == "agent 2 at t = 41; agent 5 at t = 80"
    many = {str(k): 7 for k in range(14)}
    assert detections(scenario, many).endswith("; 2 others")


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        (lambda m, n, f: gr.simulate(m, n, f, step=5), "unknown argument 'step'.*did you mean \"steps\""),
        (lambda m, n, f: gr.replay(m, n, f, measurement=[[1]]), 'did you mean "measurements"'),
        (lambda m, n, f: gr.central_kalman(m, [[1]], star=1), 'did you mean "start"'),
        (lambda m, n, f: gr.attacks.Bias(agents=[0], vlaue=3), 'did you mean "value"'),
        (lambda m, n, f: gr.attacks.Bias(agents=[0.5], value=3), "agent"),
    ],
)
def test_misspelt_arguments_get_a_hint(wrong: object, words: str) -> None:
    model = gr.Model([[0.9]], [[[1.0]]] * 2)
    with pytest.raises(gr.InvalidInput, match=words):
        wrong(model, gr.Network.path(2), gr.filters.ScalarGain())  # type: ignore[operator]


def test_what_is_unambiguous_in_attacks_is_accepted() -> None:
    assert gr.attacks.Bias(agents=3, value=5).agents == [3]
    assert gr.attacks.Constant(agents=3, value=5).agents == [3]
    assert gr.attacks.Bias(agents=np.array([3, 1]), value=np.float64(5)).agents == [1, 3]


def test_every_panel_of_a_figure_says_what_it_shows(tmp_path: Path) -> None:
    from garrison.figures import error_figure, innovation_figure, map_figure

    (tmp_path / "x.toml").write_text(
        LOG.replace('[data]\nfile = "y.csv"', '[[attack]]\nkind = "bias"\nagents = 1\nvalue = 3\n[run]\nsteps = 40')
    )
    scenario = read_scenario(tmp_path / "x.toml")
    rows = run_scenario(scenario)
    run = rows[0].run
    assert run is not None
    for figure in (run.plot(), error_figure(scenario, rows, 1.0)):
        for ax in figure.axes:
            assert ax.get_ylabel() and ax.get_xlabel()
            legend = ax.get_legend().get_texts() if ax.get_legend() else ax.texts  # or beside the lines
            shown = {text.get_text() for text in legend}
            assert shown == {line.get_label() for line in ax.get_lines() if not line.get_label().startswith("_")}
    few = innovation_figure(scenario, run)
    assert few._supylabel.get_text() and few._supxlabel.get_text()  # get_supylabel: matplotlib 3.8
    assert "actually attacked" in [t.get_text() for t in map_figure(scenario, run).axes[0].get_legend().get_texts()]


def test_estimates_of_all_filters_have_names_and_dates(faulty: Path) -> None:
    assert main(["run", str(faulty / "x.toml"), "-o", str(faulty / "out"), "--all-estimates"]) == 0
    files = sorted(p.name for p in (faulty / "out").glob("estimates*"))
    assert files == ["estimates.csv", "estimates_2_structural.csv"]
    for name in files:
        lines = (faulty / "out" / name).read_text().splitlines()
        assert lines[0].startswith("trial,time,date,agent,x0")
        assert lines[1].startswith("0,0,,RPT,") and lines[13].startswith("0,1,1963-01-01,RPT,")
        assert len(lines) == 1 + 366 * 12


def test_the_unit_of_the_states_is_said(tmp_path: Path) -> None:
    text = """title = "tank"
    [model]
    A = [[0.9]]
    C = [[1], [1], [1]]
    states = ["depth"]
    units = {depth = "m"}
    process_covariance = 0.1
    measurement_covariance = 0.2
    [network]
    kind = "complete"
    agents = 3
    [filter]
    name = "structural"
    [run]
    steps = 30
    """
    path = tmp_path / "tank.toml"
    path.write_text(text)
    scenario = read_scenario(path)
    rows = run_scenario(scenario)
    assert error_figure(scenario, rows, None).axes[0].get_ylabel() == "mean error (m), log scale"
    write_report(tmp_path / "report.html", scenario, rows)
    page = (tmp_path / "report.html").read_text()
    assert "distances to its true state, in m." in page and re.search(r"mean error of structural is [\d.]+ m\.", page)


def test_values_that_have_none_beside_them_are_dots() -> None:
    (line,) = Figure().add_subplot().plot([1.0, np.nan, 2.0, 3.0, np.nan, 4.0])
    dot_alone(line)
    assert line.get_markevery() == [0, 5]
    assert line.get_marker() == "."


def test_a_replay_without_truth_shows_its_verdicts_over_time(tmp_path: Path) -> None:
    from garrison.figures import overview_figure, verdict_figure
    from garrison.importers.adsb import import_adsb

    import_adsb(ROOT / "examples" / "import" / "adsb_sample.json.gz").write(tmp_path)
    scenario = read_scenario(tmp_path / "scenario.toml")
    rows = run_scenario(scenario)
    run = rows[0].run
    assert run is not None and run.verdict is not None
    figure = verdict_figure(scenario, run)
    (ax,) = figure.axes
    assert [text.get_text() for text in ax.get_yticklabels()] == scenario.names
    words = {text.get_text() for text in ax.get_legend().get_texts()}
    assert words == {"cleared", "not tested", "accused"}
    drawn = sum(len(bars.get_paths()) for bars in ax.collections)
    kinds = np.asarray(run.verdict)[0, 1:]
    spells = sum(int((np.diff(kinds[:, k] == v, prepend=False) & (kinds[:, k] == v)).sum())
                 for k in range(4) for v in (0, 2, 4))  # fmt: skip
    assert drawn == spells
    assert len(overview_figure(scenario, rows, None).axes) == 2  # and not half of it empty
    write_report(tmp_path / "report.html", scenario, rows)
    page = (tmp_path / "report.html").read_text()
    assert "Verdicts over time" in page and "The samples around the first accusation." in page
    assert any("sensor position east was accused" in line for line in warnings_of(scenario, rows))


def test_the_caption_speaks_of_bounds_only_where_some_are_drawn(tmp_path: Path) -> None:
    drawn = LOG.replace('[data]\nfile = "y.csv"', "[run]\nsteps = 40")
    for text, bounds in ((drawn, True), (re.sub(r'name = "saturation"[^[]*', 'name = "scalar_gain"\n', drawn), False)):
        (tmp_path / "x.toml").write_text(text)
        scenario = read_scenario(tmp_path / "x.toml")
        rows = run_scenario(scenario)
        write_report(tmp_path / "report.html", scenario, rows)
        page = (tmp_path / "report.html").read_text()
        assert ("The certified bound" in page) == bounds
        run = rows[0].run
        assert run is not None and bool(np.isfinite(np.asarray(run.bound)).any()) == bounds


def test_the_report_of_a_string_says_what_accuses_and_its_pictures_have_words(tmp_path: Path) -> None:
    scenario = read_scenario(ROOT / "examples" / "platoon" / "spoofed.toml", set={"run.steps": 100, "run.trials": 1})
    rows = run_scenario(scenario)
    write_report(tmp_path / "report.html", scenario, rows)
    page = (tmp_path / "report.html").read_text()
    # trimmed means and plain steering accuse nobody, whatever happens
    assert "platoon, stronger tests, platoon, as published: a proof as long as" in page and "an alarm" not in page
    assert "&quot;not attacked&quot;: the same data without the attack." in page
    assert "2 of 8 sensors are attacked, first at t = 40: sensors 2, 5." in page
    assert all('role="img" aria-label="' in tag for tag in re.findall(r"<svg[^>]*>", page)) and "<svg" in page
