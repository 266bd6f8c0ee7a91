"""[filter] and [[compare]]: the filters of a scenario, with their labels."""

from pathlib import Path
from typing import Any

from garrison import _core, filters
from garrison.parameters import cleaned
from garrison.scenario.section import Section, tables_of
from garrison.words import count, near, refusal, shown

#: name of the baseline that is no distributed filter
CENTRAL_KALMAN = "central_kalman"
#: what protects it: garrison.central_kalman
SCREENS = ["gate", "huber"]


def read_filters(document: dict[str, Any], folder: Path) -> list[tuple[str, _core.Filter | None]]:
    """Label and filter, the main one first; None is the central Kalman filter. Labels are different."""
    names = [info["name"] for info in _core.filter_infos()]
    if "filter" not in document:
        raise refusal("scenario", "no [filter]", f"one with name = one of {', '.join(names)}")
    main = document["filter"]
    if isinstance(main, list):
        raise refusal("[filter]", f"{count(len(main), 'table')} [[filter]]", "one [filter]; others are [[compare]]")
    sections = [Section("[filter]", main, folder), *tables_of("compare", document.get("compare", []), folder)]
    found: list[tuple[str, _core.Filter | None]] = []
    for k, section in enumerate(sections):
        known = names if k == 0 else [*names, CENTRAL_KALMAN]
        label, filter = _filter(section, known)
        found.append((_unused(label, [old for old, _ in found]), filter))
    return found


def read_screens(document: dict[str, Any], folder: Path, labels: list[str]) -> dict[str, dict[str, float]]:
    """What protects the central Kalman filters, by label. labels: of [filter] and all [[compare]] in order."""
    sections = tables_of("compare", document.get("compare", []), folder)
    return {
        label: {key: section.number(key, 0.0) for key in SCREENS if key in section}
        for label, section in zip(labels[1:], sections, strict=True)
        if section.table["name"] == CENTRAL_KALMAN
    }


def _filter(section: Section, known: list[str]) -> tuple[str, _core.Filter | None]:
    name = section.require("name", "the name of a filter; see `garrison list filters`")
    if name not in known:
        advice = near(name, known) if isinstance(name, str) else ""
        raise refusal(section.place("name"), shown(name), f"one of {', '.join(known)}", advice)
    label = section.table.get("label", name)
    if isinstance(label, (list, dict, bool)) or not str(label).strip():
        raise refusal(section.place("label"), shown(label), "a string")
    params = {k: v for k, v in section.table.items() if k not in ("name", "label")}
    if name == CENTRAL_KALMAN:
        section.only(["name", "label", *SCREENS])
        return str(label), None
    info = next(i for i in _core.filter_infos() if i["name"] == name)
    return str(label), filters.make_filter(name, cleaned(name, info["params"], params))


def _unused(label: str, taken: list[str]) -> str:
    """The label, numbered where another filter has it already."""
    k, free = 2, label
    while free in taken:
        free, k = f"{label} ({k})", k + 1
    return free
