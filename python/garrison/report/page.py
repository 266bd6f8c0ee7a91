"""The report of a run: one self-contained HTML page."""

import html
import tempfile
from pathlib import Path

from garrison import _core
from garrison.checks import verdict
from garrison.families import family_of
from garrison.figures import error_figure, innovation_figure, map_figure, verdict_figure
from garrison.figures.errors import bounded, smoothing_width
from garrison.jobs import Row, checked, signal_size
from garrison.longform import common_unit
from garrison.record import Run
from garrison.report.html import figure, image, page, table
from garrison.report.table import accusation_note, at_time, error_note, table_rows, untouched, warnings_of
from garrison.scenario import Scenario
from garrison.words import count


def write_report(path: Path, scenario: Scenario, rows: list[Row]) -> None:
    """Write the page. Its main filter is the first one of the scenario."""
    sections = [
        f"<h1>{html.escape(scenario.title)}</h1>",
        f'<p class="lead">{html.escape(_lead(scenario, rows))}</p>',
        *(f'<p class="doubt">{html.escape(w)}</p>' for w in warnings_of(scenario, rows)),
        "<h2>Results by filter</h2>",
        table(*table_rows(scenario, rows)),
        f"<p>{html.escape(_table_note(scenario, rows))}</p>",
        *_main_sections(scenario, rows),
        "<h2>Model and reference</h2>",
        f"<p>{html.escape(_model_text(scenario))}</p>",
        f"<footer>garrison {_core.__version__}, scenario {html.escape(scenario.path.name)}</footer>",
    ]
    path.write_text(page(scenario.title, sections), encoding="utf-8")


def _main_sections(scenario: Scenario, rows: list[Row]) -> list[str]:
    main = rows[0]
    out, first = [_clipped_table(main)], _shown(scenario, "First trial. ")
    run = main.run
    if (
        run is not None
        and family_of(run.filter).picture == "string"
        and run.truth is not None
        and run.bound is not None
    ):
        out += ["<h2>The string</h2>", figure(run.plot(), first + _STRING_NOTE), _animation(run)]
    elif run is not None and run.verdict is not None:
        out += [
            "<h2>The network at the end</h2>",
            figure(map_figure(scenario, run), first + _map_note(scenario)),
        ]
    if any(row.error is not None for row in rows):
        picture = error_figure(scenario, rows, signal_size(scenario))
        out += ["<h2>Errors over time</h2>", figure(picture, _error_note(scenario, rows))]
    elif run is not None and run.verdict is not None:
        out += ["<h2>Verdicts over time</h2>", figure(verdict_figure(scenario, run), first + _VERDICT_NOTE)]
    if run is not None and run.statistic is not None and run.threshold is not None:
        out += [
            "<h2>Statistics against thresholds</h2>",
            figure(innovation_figure(scenario, run), first + _statistics_note(scenario, run)),
        ]
    if run is not None:
        out += ["<h2>Conditions and bounds, before the run</h2>", _check_table(scenario, run.filter)]
    return out


def _lead(scenario: Scenario, rows: list[Row]) -> str:
    """What happened, in two sentences."""
    main = rows[0].summary
    signal = signal_size(scenario)
    parts = []
    when = at_time(scenario, scenario.first_attack)
    if scenario.hit:
        hit = [scenario.names[a] for a in scenario.hit]
        verb, noun = ("are", "sensors") if len(hit) > 1 else ("is", "sensor")
        names = ", ".join(hit)
        parts.append(f"{len(hit)} of {scenario.model.agents} sensors {verb} attacked, first {when}: {noun} {names}.")
    if "mean_error" in main:
        since = " from then on" if scenario.hit else ""
        unit = common_unit(scenario.model)
        text = f"The mean error of {rows[0].label}{since} is {main['mean_error']:.3f}{f' {unit}' if unit else ''}"
        others = [r.summary for r in rows if r.attacked == rows[0].attacked and r.label != rows[0].label]
        worse = [f"{o['mean_error']:.3f} for {o['filter']}" for o in others if "mean_error" in o]
        text += f", against {', '.join(worse)}" if worse else ""
        parts.append(text + (f"; the signal itself has mean size {signal:.3f}." if signal else "."))
    if not scenario.truth_is_declared:
        parts.append(
            "No attack was declared on these records: whether a sensor was attacked is not known, so accusations are "
            "neither right nor false alarms here."
        )
    return " ".join(parts)


def _model_text(scenario: Scenario) -> str:
    fit = scenario.fitted
    if fit is None and scenario.measurements is None:
        unit = common_unit(scenario.model)
        return f"The plant is simulated; errors are distances to its true state{f', in {unit}' if unit else ''}."
    if fit is None:
        return "The measurements are replayed from a log; the true state is not known."
    first, last = fit.records.dates[0], fit.records.dates[-1]
    share = ", ".join(f"{s:.0%}" for s in fit.identified.share)
    clean = "before any attack is put on them" if scenario.attacks else "with whatever is wrong in them"
    return (
        f"The model was identified from the records {first} to {last}: {count(scenario.model.states, 'common factor')} "
        f"carrying {share} of the variance around the season. The true state is not known. Errors are distances to a "
        f"reference, which is not a filter's estimate: sample by sample the least-squares state of the records of all "
        f"stations, {clean}. Their unit is that of a station's anomaly."
    )


def _check_table(scenario: Scenario, filter: _core.Filter) -> str:
    found, doubts = checked(scenario, filter)
    conditions = [[c["name"], c["meaning"], f"{c['value']:.4g}", c["needed"], verdict(c)] for c in found.conditions]
    quantities = [[q["name"], q["meaning"], f"{q['value']:.4g}"] for q in found.quantities]
    return (
        table(["condition", "meaning", "value", "needed", "verdict"], conditions)
        + table(["quantity", "meaning", "value"], quantities)
        + "".join(f'<p class="doubt">{html.escape(doubt)}</p>' for doubt in doubts)
    )


def _shown(scenario: Scenario, words: str) -> str:
    """Which of several trials something shows: the words, or nothing where there is one."""
    return words if scenario.run.get("trials", 1) > 1 else ""


_VERDICT_NOTE = "The higher the bar, the worse the verdict; no bar: no measurement."
_STRING_NOTE = "The bounds and the least gaps are certified at run time: they hold whatever the attackers send."


def _table_note(scenario: Scenario, rows: list[Row]) -> str:
    since = "from the start of the attack on" if scenario.attacks else "over all samples"
    parts = [error_note(scenario)] if error_note(scenario) else []
    if scenario.attacks:
        parts.append(f'"{untouched(scenario)}": the same data without the attack.')
    shown = set(table_rows(scenario, rows)[0])
    meanings = {
        "mean error": f"Means are over agents, {since}.",
        "samples with a bound": "Samples with a bound: share of all agents and samples with a certified error bound.",
        "median bound": f"Median bound: {since}.",
        "error within bound": "Error within bound: how often the error was below it.",
        "accused": f"Accused: who was accused, and when first{_shown(scenario, ' (first trial)')}.",
    }
    parts += [text for name, text in meanings.items() if name in shown]
    if any("mean_error_robust" in row.summary for row in rows):
        parts.append(
            "The robust reference is the state with the least sum of absolute deviations from all sensors: a minority "
            "of wrong sensors does not pull it."
        )
    if note := accusation_note(rows):
        parts.append(f"What an accusation is: {note}.")
    return " ".join(parts)


def _map_note(scenario: Scenario) -> str:
    ring = " The ring marks who was actually attacked." if scenario.hit else ""
    return f"Lines join agents that exchange messages. The marker is the verdict at the end.{ring}"


def _statistics_note(scenario: Scenario, run: Run) -> str:
    """Which samples the picture shows."""
    if scenario.attacks:
        return "The samples around the start of the first attack."
    return "The samples around the first accusation." if run.first_accused() else "The whole run."


def _error_note(scenario: Scenario, rows: list[Row]) -> str:
    width = smoothing_width(scenario.steps)
    means = f"Means over {count(width, 'sample')}. " if width > 1 else ""
    row = bounded(scenario, rows)
    if row is None or row.run is None:
        return means
    wanted = scenario.certificate
    if not wanted or wanted["certificate"] == "none":
        return (
            f"{means}The certified bound holds at every sample for the worst noise that the model allows, whatever the "
            "attackers send."
        )
    failure = wanted["failure"]
    if failure == 0:
        law = "for the worst noise that the model allows"
    elif "levels" in wanted:
        law = f"at levels that noise like that of clean records exceeds at the rate {failure:g}"
    else:
        law = f"except with probability {failure:g} per agent and sample, for the model's noise"
    if wanted.get("memory"):
        law += ", as long as the liars are always the same"
    published = (
        " The published bound is what the filter's paper alone promises." if row.run.published is not None else ""
    )
    return (
        f"{means}The certified bound is the largest of any agent: it holds {law}, whatever the attackers send "
        f"and whatever messages are lost, for any filter.{published}"
    )


def _clipped_table(main: Row) -> str:
    """How often each sensor's measurement was clipped or suspected."""
    limited = main.summary.get("limited", {})
    if not limited:
        return ""
    ordered = sorted(limited.items(), key=lambda item: -item[1])
    cells = [[name, f"{share:.1%}" if share >= 0.0005 else "< 0.1%"] for name, share in ordered]
    return "<h2>Sensors whose measurements were clipped or suspected</h2>" + table(
        ["sensor", "share of samples"], cells
    )


def _animation(run: Run) -> str:
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "string.gif"
        run.animate(file)
        return image(file.read_bytes(), "gif", "the string over time")
