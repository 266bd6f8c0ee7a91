"""The report of a run: one self-contained HTML page (extra: plot)."""

import base64
import html
import io
import tempfile
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from garrison import _core
from garrison.checks import check, verdict
from garrison.job import Row, attack_facts, signal_size
from garrison.plots import error_figure, innovation_figure, map_figure
from garrison.run import Run
from garrison.scenario import Scenario

_STYLE = """
body{font:16px/1.5 system-ui,sans-serif;color:#1a1a1a;max-width:62rem;margin:2rem auto;padding:0 1rem}
h1{font-size:1.7rem;margin-bottom:.2rem}h2{font-size:1.2rem;margin-top:2.2rem}
p.lead{font-size:1.1rem}table{border-collapse:collapse;width:100%;font-size:.92rem}
th,td{padding:.35rem .6rem;border-bottom:1px solid #ddd;text-align:right;vertical-align:top}
th:first-child,td:first-child{text-align:left}td.words,th.words{text-align:left}
svg{max-width:100%;height:auto}figure{margin:1rem 0}figcaption{color:#555;font-size:.9rem}
.no{font-weight:700}footer{color:#777;font-size:.85rem;margin-top:3rem}
"""


def table_rows(scenario: Scenario, rows: list[Row]) -> tuple[list[str], list[list[str]]]:
    """The table of a run as text: head and cells."""
    head = [
        "filter",
        "sensors",
        "mean error",
        "worst error",
        "bound exists",
        "inside it",
        "proved attacked",
        "false alarms",
    ]
    cells = []
    for row in rows:
        s = row.summary(scenario)
        known = "mean_error" in s
        inside = s.get("inside_bound")
        share = s.get("share_with_bound", 0.0)
        detected = s.get("detected")
        cells.append(
            [
                row.label,
                "attacked" if row.attacked else "as recorded" if scenario.dates else "honest",
                f"{s['mean_error']:.3f}" if known else "-",
                f"{s['worst_error']:.3f}" if known else "-",
                f"{share:.0%}",
                "-" if inside is None else f"{inside:.2%}",
                "-" if detected is None else _detections(scenario, detected) or "nobody",
                "-" if "false_alarms" not in s else str(s["false_alarms"]),
            ]
        )
    return head, cells


def _detections(scenario: Scenario, detected: dict[str, int]) -> str:
    """Who was proved attacked, grouped by when."""
    groups: dict[int, list[str]] = {}
    for name, t in detected.items():
        groups.setdefault(t, []).append(name)
    return "; ".join(f"{', '.join(names)} on {when(scenario, t)}" for t, names in groups.items())


def when(scenario: Scenario, t: int) -> str:
    """A sample as a date, where there are dates."""
    return str(scenario.dates[t - 1]) if scenario.dates else str(t)


def _svg(figure: Any) -> str:
    buffer = io.StringIO()
    figure.savefig(buffer, format="svg")
    text = buffer.getvalue()
    return text[text.index("<svg") :]


def _html_table(head: Iterable[str], cells: Iterable[Iterable[str]], words: int = 1) -> str:
    def line(tag: str, entries: Iterable[str]) -> str:
        kinds = [' class="words"' if k < words else "" for k, _ in enumerate(entries)]
        return (
            "<tr>"
            + "".join(f"<{tag}{c}>{html.escape(e)}</{tag}>" for c, e in zip(kinds, entries, strict=True))
            + "</tr>"
        )

    body = "".join(line("td", list(row)) for row in cells)
    return f"<table><thead>{line('th', list(head))}</thead><tbody>{body}</tbody></table>"


def _lead(scenario: Scenario, rows: list[Row]) -> str:
    """What happened, in two sentences."""
    main = rows[0].summary(scenario)
    signal = signal_size(scenario)
    hit = [scenario.names[a] for a in range(scenario.model.agents) if a not in attack_facts(scenario)[0]]
    parts = []
    if hit:
        start = when(scenario, attack_facts(scenario)[1])
        verb = "are" if len(hit) > 1 else "is"
        parts.append(
            f"{len(hit)} of {scenario.model.agents} sensors ({', '.join(hit)}) {verb} attacked from {start} on."
        )
    if "mean_error" in main:
        text = f"The mean error of {rows[0].label} since then is {main['mean_error']:.3f}"
        others = [r.summary(scenario) for r in rows if r.attacked == rows[0].attacked and r.label != rows[0].label]
        worse = [f"{o['mean_error']:.3f} for {o['filter']}" for o in others if "mean_error" in o]
        text += f", against {', '.join(worse)}" if worse else ""
        parts.append(text + (f"; the signal itself has mean size {signal:.3f}." if signal else "."))
    return " ".join(parts)


def _model_text(scenario: Scenario) -> str:
    fit = scenario.fitted
    if fit is None and scenario.measurements is None:
        return "The plant is simulated; errors are distances to its true state."
    if fit is None:
        return "The measurements are replayed from a log; the true state is not known."
    first, last = fit.records.dates[0], fit.records.dates[-1]
    share = ", ".join(f"{s:.0%}" for s in fit.identified.share)
    return (
        f"The model was identified from the clean records {first} to {last}: {scenario.model.states} common factor(s) "
        f"carrying {share} of the variance around the season. What is called truth (the reference) is not a filter's "
        "estimate: it is, day by day, the least-squares state of the clean records of that same day, all stations "
        "together, before any attack is put on them. Errors are distances to it, in units of a station's anomaly."
    )


def _check_table(scenario: Scenario, filter: _core.Filter) -> str:
    found = check(filter, scenario.model, scenario.network)
    conditions = [[c["name"], c["meaning"], f"{c['value']:.4g}", c["needed"], verdict(c)] for c in found.conditions]
    quantities = [[q["name"], q["meaning"], f"{q['value']:.4g}"] for q in found.quantities]
    return _html_table(["condition", "meaning", "value", "needed", "verdict"], conditions, 2) + _html_table(
        ["quantity", "meaning", "value"], quantities, 2
    )


_TABLE_NOTE = (
    "<p>Errors are means over agents, from the start of the attack on. Bound exists: share of agents and samples with "
    "a certified error bound (an agent that knows all attackers no longer tests, and reports none). Inside it: how "
    "often the error was below. Proved attacked: when the network first knew.</p>"
)
_STRING_NOTE = (
    "First trial. The bounds and the least gaps are certified at run time: they hold whatever the attackers send."
)
_MAP_NOTE = (
    "Lines join stations that exchange estimates. The marker says what the network believes, the ring who was hijacked."
)
_ERROR_NOTE = (
    "Means over the last 30 samples. The certified bound holds for the worst noise that the model allows, at every "
    "single sample, whatever the attackers send."
)


def _limited_table(scenario: Scenario, main: Row) -> str:
    """Who was being pulled: how often each sensor's measurement was limited."""
    limited = main.summary(scenario).get("limited", {})
    if not limited:
        return ""
    cells = [[name, f"{share:.1%}"] for name, share in sorted(limited.items(), key=lambda x: -x[1])]
    head = ["sensor", "samples at which its measurement was limited"]
    return "<h2>Who is being held back</h2>" + _html_table(head, cells)


def _figure(figure: Any, note: str = "") -> str:
    caption = f"<figcaption>{note}</figcaption>" if note else ""
    return f"<figure>{_svg(figure)}{caption}</figure>"


def _animation(run: Run) -> str:
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "string.gif"
        run.animate(file)
        data = base64.b64encode(file.read_bytes()).decode()
    return f'<figure><img alt="the string over time" src="data:image/gif;base64,{data}"></figure>'


def write_report(path: Path, scenario: Scenario, rows: list[Row]) -> None:
    """Write the page. Its main filter is the first one of the scenario."""
    main = rows[0]
    title = html.escape(scenario.title)
    head, cells = table_rows(scenario, rows)
    sections = [f"<h1>{title}</h1>", f'<p class="lead">{html.escape(_lead(scenario, rows))}</p>']
    sections += ["<h2>Who did how well</h2>", _html_table(head, cells, 2), _TABLE_NOTE]
    for row in rows:
        for warning in row.run.warnings if row.run is not None else []:
            sections.append(f'<p class="no">{html.escape(row.label)}: {html.escape(warning)}</p>')
    sections.append(_limited_table(scenario, main))
    if main.run is not None and main.run.truth is not None and main.run.truth.ndim == 4:
        sections += ["<h2>The string</h2>", _figure(main.run.plot(), _STRING_NOTE), _animation(main.run)]
    elif main.run is not None:
        sections += ["<h2>The network at the end</h2>", _figure(map_figure(scenario, main.run), _MAP_NOTE)]
    if any(row.error is not None for row in rows):
        figure = error_figure(scenario, rows, signal_size(scenario))
        sections += ["<h2>Errors over time</h2>", _figure(figure, _ERROR_NOTE)]
    if main.run is not None:
        sections += ["<h2>Statistics against thresholds</h2>", _figure(innovation_figure(scenario, main.run))]
        sections += ["<h2>What theory says before the run</h2>", _check_table(scenario, main.run.filter)]
    sections += ["<h2>Model and reference</h2>", f"<p>{html.escape(_model_text(scenario))}</p>"]
    sections.append(f"<footer>garrison {_core.__version__}, scenario {html.escape(scenario.path.name)}</footer>")
    meta = '<meta charset="utf-8"><meta name="viewport" content="width=device-width">'
    start = f'<!doctype html><html lang="en"><head>{meta}<title>{title}</title><style>{_STYLE}</style></head><body>'
    path.write_text(start + "".join(sections) + "</body></html>", encoding="utf-8")
