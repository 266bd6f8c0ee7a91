"""[filter] and [[compare]]: the filters of a scenario, with their labels."""

from pathlib import Path
from typing import Any

from garrison import _core, filters
from garrison.parameters import cleaned
from garrison.scenario.section import Section, renamed, tables_of
from garrison.words import count, near, refusal, shown

#: names of the baselines that are no distributed filters: one Kalman filter of all measurements, or one per agent
CENTRAL_KALMAN, LOCAL_KALMAN = "central_kalman", "local_kalman"
BASELINES = (CENTRAL_KALMAN, LOCAL_KALMAN)
#: what protects them: garrison.central_kalman
SCREENS = ["gate", "huber"]


def read_filters(document: dict[str, Any], folder: Path) -> list[tuple[str, _core.Filter | None]]:
    """Label and filter, the main one first; None is a Kalman filter. Labels are different."""
    names = [info["name"] for info in _core.filter_infos()]
    if "filter" not in document:
        raise refusal("scenario", "no [filter]", f"one with name = one of {', '.join(names)}")
    main = document["filter"]
    if isinstance(main, list):
        raise refusal("[filter]", f"{count(len(main), 'table')} [[filter]]", "one [filter]; others are [[compare]]")
    sections = [Section("[filter]", main, folder), *tables_of("compare", document.get("compare", []), folder)]
    found: list[tuple[str, _core.Filter | None]] = []
    for k, section in enumerate(sections):
        known = names if k == 0 else [*names, *BASELINES]
        label, filter = _filter(section, known)
        found.append((_unused(label, [old for old, _ in found]), filter))
    return found


def read_screens(document: dict[str, Any], folder: Path, labels: list[str]) -> dict[str, dict[str, float]]:
    """What protects the Kalman filters, by label. labels: of [filter] and all [[compare]] in order."""
    sections = tables_of("compare", document.get("compare", []), folder)
    return {
        label: {key: section.number(key, 0.0) for key in SCREENS if key in section}
        for label, section in zip(labels[1:], sections, strict=True)
        if section.table["name"] in BASELINES
    }


def read_local(document: dict[str, Any], folder: Path, labels: list[str]) -> set[str]:
    """Labels of those that are one Kalman filter per agent."""
    sections = tables_of("compare", document.get("compare", []), folder)
    pairs = zip(labels[1:], sections, strict=True)
    return {label for label, section in pairs if section.table["name"] == LOCAL_KALMAN}


def _filter(section: Section, known: list[str]) -> tuple[str, _core.Filter | None]:
    name = section.require("name", "the name of a filter; see `garrison list filters`")
    if name not in known:
        advice = near(name, known) if isinstance(name, str) else ""
        raise refusal(section.place("name"), shown(name), f"one of {', '.join(known)}", advice)
    label = section.text("label", name)
    if not label.strip():
        raise refusal(section.place("label"), shown(label), "a string with a word in it")
    params = {k: v for k, v in section.table.items() if k not in ("name", "label")}
    if name in BASELINES:
        section.only(["name", "label", *SCREENS])
        return label, None
    info = next(i for i in _core.filter_infos() if i["name"] == name)
    try:
        return label, filters.make_filter(name, cleaned(name, info["params"], params))
    except _core.Error as error:
        raise renamed(error, section.where) from None


def _unused(label: str, taken: list[str]) -> str:
    """The label, numbered where another filter has it already."""
    k, free = 2, label
    while free in taken:
        free, k = f"{label} ({k})", k + 1
    return free
