"""The table of a run as text."""

import datetime as dt
import re

from garrison.families import family_of
from garrison.jobs import Row
from garrison.scenario import Scenario
from garrison.words import count

#: how the core names a sensor in its warnings
_SENSOR = re.compile(r"\bsensor (\d+)\b")
HEAD = [
    "filter",
    "sensors",
    "mean error",
    "worst error",
    "mean error to robust reference",
    "samples with a bound",
    "median bound",
    "error within bound",
    "accused",
    "false alarms",
]


def table_rows(scenario: Scenario, rows: list[Row]) -> tuple[list[str], list[list[str]]]:
    """Head and cells: what each run holds; a column that nobody has anything for is left out."""
    cells = [_cells(scenario, row) for row in rows]
    kept = [k for k in range(len(HEAD)) if k < 2 or any(line[k] != "-" for line in cells)]
    return [HEAD[k] for k in kept], [[line[k] for k in kept] for line in cells]


def _cells(scenario: Scenario, row: Row) -> list[str]:
    s = row.summary
    inside, detected = s.get("inside_bound"), s.get("detected")
    return [
        row.label,
        "attacked" if row.attacked else untouched(scenario),
        f"{s['mean_error']:.3f}" if "mean_error" in s else "-",
        f"{s['worst_error']:.3f}" if "worst_error" in s else "-",
        f"{s['mean_error_robust']:.3f}" if "mean_error_robust" in s else "-",
        f"{s['share_with_bound']:.0%}" if s.get("share_with_bound") else "-",
        f"{s['median_bound']:.3f}" if "median_bound" in s else "-",
        "-" if inside is None else f"{inside:.2%}",
        "-" if detected is None else detections(scenario, detected) or "nobody",
        "-" if "false_alarms" not in s else str(s["false_alarms"]),
    ]


def untouched(scenario: Scenario) -> str:
    """The word for sensors on which no attack is put."""
    return "as recorded" if scenario.measurements is not None else "not attacked"


def detections(scenario: Scenario, detected: dict[str, int], most: int = 12) -> str:
    """Who was accused, grouped by when: `DUB, CLO on 1972-01-01`."""
    groups: dict[int, list[str]] = {}
    for name, t in list(detected.items())[:most]:
        groups.setdefault(t, []).append(_named(scenario, name))
    words = [f"{', '.join(names)} {at_time(scenario, t)}" for t, names in groups.items()]
    more = len(detected) - most
    return "; ".join([*words, count(more, "other")] if more > 0 else words)


def _named(scenario: Scenario, name: str) -> str:
    """A name for people: numbers alone say nothing."""
    return f"agent {name}" if name.isdigit() else name


def at_time(scenario: Scenario, t: int) -> str:
    """`on 1972-01-01`, `at 12.5 s` or `at t = 41`."""
    if not scenario.dates or not 1 <= t <= len(scenario.dates):
        return f"at t = {t}"
    moment = scenario.dates[t - 1]
    if isinstance(moment, dt.datetime):
        return f"at {moment:%Y-%m-%d %H:%M:%S}"
    return f"on {moment}" if isinstance(moment, dt.date) else f"at {moment:g} s"


def error_note(scenario: Scenario) -> str:
    """What errors are distances to; nothing where there are none."""
    if scenario.measurements is None:
        return "Errors are distances to the true state."
    if scenario.truth is None:
        return ""
    return "Errors are distances to a reference, the least-squares state of the records of all stations."


def accusation_note(rows: list[Row]) -> str:
    """What an accusation is worth, filter by filter."""
    words: dict[str, list[str]] = {}
    for row in rows:
        if row.run is not None and "detected" in row.summary:
            proves = family_of(row.run.filter).proves
            how = "a proof as long as the filter's assumptions hold" if proves else "an alarm, false at a chosen rate"
            words.setdefault(how, []).append(row.label)
    return "; ".join(f"{', '.join(dict.fromkeys(labels))}: {how}" for how, labels in words.items())


def _with_names(warning: str, scenario: Scenario) -> str:
    """With the names of sensors in place of their numbers."""
    names = scenario.names
    return _SENSOR.sub(lambda m: f"sensor {names[int(m[1])]}" if int(m[1]) < len(names) else m[0], warning)


def warnings_of(scenario: Scenario, rows: list[Row]) -> list[str]:
    """All doubts, each once, with the filters that they are about."""
    found: dict[str, list[str]] = {}
    for row in rows:
        for warning in row.run.warnings if row.run is not None else []:
            found.setdefault(_with_names(warning, scenario), []).append(row.label)
    lines = [f"{', '.join(dict.fromkeys(labels))}: {warning}" for warning, labels in found.items()]
    return [*scenario.notes, *lines]
