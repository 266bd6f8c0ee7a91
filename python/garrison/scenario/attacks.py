"""[[attack]]: who is attacked, when and how."""

import datetime as dt
from typing import Any

from garrison import _core, attacks
from garrison.parameters import cleaned
from garrison.scenario.network import agent_number
from garrison.scenario.section import Section, moment, renamed, whole
from garrison.tables import Records
from garrison.tables.clock import seconds_of
from garrison.words import near, refusal, shown

COMMON = ["kind", "agents", "start", "stop", "schedule", "probability"]


def read_attack(section: Section, names: list[str], records: Records | None, samples: int) -> _core.Attack:
    """One attack. names: of the agents; records: whose dates may be meant; samples: of the run."""
    infos = {info["name"]: info for info in _core.attack_infos()}
    kind = section.require("kind", f"one of {', '.join(infos)}")
    if not isinstance(kind, str) or kind not in infos:
        advice = near(kind, infos) if isinstance(kind, str) else ""
        raise refusal(section.place("kind"), shown(kind), f"one of {', '.join(infos)}", advice)
    section.only([*COMMON, *(p["name"] for p in infos[kind]["params"])])
    own = {k: v for k, v in section.table.items() if k not in COMMON}
    arguments = cleaned(section.where, infos[kind]["params"], own)
    if "probability" in section:
        arguments["probability"] = section.number("probability", 1.0)
    if "agents" in section:
        arguments["agents"] = _agents(section.place("agents"), section.table["agents"], names)
    for key in ("start", "stop"):
        if key in section:
            arguments[key] = _sample(section.place(key), section.table[key], records)
    if "schedule" in section:
        arguments["schedule"] = _schedule(section, names, records)
    try:
        attack = attacks.make(kind, **arguments)
    except _core.Error as error:
        raise renamed(error, f"{section.where}:") from None
    _require_somebody(section, attack)
    for agent in attack.agents:
        if not 0 <= agent < len(names):
            raise refusal(section.place("agents"), str(agent), f"numbers in 0..{len(names) - 1}")
    if attack.start > samples:
        raise refusal(
            section.place("start"), shown(section.table.get("start")), f"a start within the run of {samples} samples"
        )
    return attack


def _require_somebody(section: Section, attack: _core.Attack) -> None:
    if attack.agents:
        return
    key = next((k for k in ("schedule", "agents") if k in section), "agents")
    advice = "leave out the whole table where nobody is attacked"
    raise refusal(section.place(key), "no agents", "one agent at least", advice)


def _agents(where: str, wanted: Any, names: list[str]) -> list[int]:
    """Numbers of one agent or several; the names of stations are accepted too."""
    found = wanted if isinstance(wanted, list) else [wanted]
    return [agent_number(where, agent, names) for agent in found]


def _schedule(section: Section, names: list[str], records: Records | None) -> list[tuple[int, list[int]]]:
    where, given = section.place("schedule"), section.table["schedule"]
    if not isinstance(given, list) or any(not isinstance(p, list) or len(p) != 2 for p in given):
        raise refusal(where, shown(given), "pairs of a start and agents: [[100, [3]], [200, [5, 7]]]")
    return [(_sample(where, t, records), _agents(where, a, names)) for t, a in given]


def _sample(where: str, value: Any, records: Records | None) -> int:
    """A sample number, or a date of the records (sample 1 is the first one)."""
    if isinstance(value, (int, float)):
        return whole(where, value)
    if records is None or not isinstance(records.dates[0], dt.date):
        raise refusal(where, shown(value), "a sample number", "dates need [data] with dates")
    at = moment(where, value)
    index = records.index(where, at)
    if where.endswith(".stop") and index >= len(records.dates):
        return len(records.dates) + 1
    if index >= len(records.dates) or seconds_of(at) < seconds_of(records.dates[0]) - records.step / 2:
        span = f"{records.dates[0]}..{records.dates[-1]}"
        raise refusal(where, shown(value), f"a date within the records, {span}")
    return index + 1
