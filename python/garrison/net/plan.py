"""The file that `garrison-net` reads: a scenario, and how its agents are put on a network."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from garrison.families import family_of
from garrison.net.reference import Reference, reference_of
from garrison.scenario import Scenario, read_document, read_scenario
from garrison.scenario.section import Section
from garrison.words import refusal, shown

_SHARES = ("loss", "duplicates", "replay", "mutate", "forge")
_TIMES = ("delay_ms", "jitter_ms")


@dataclass
class Plan:
    """What is to be run. Times in ms; shares in 0..1; flood in datagrams per second."""

    path: Path
    scenario: Scenario
    reference: Reference
    period_ms: float
    round_ms: float | None
    resend_ms: float | None
    seed: int = 1
    relay: dict[str, float] = field(default_factory=dict)
    expect: dict[str, float] = field(default_factory=dict)
    state_every_s: float = 60.0  # 1 where power cuts have to meet the moment in which it is written
    wrong_clock: str | None = None  # a library before the daemons, by which their clocks can step
    liar: int | None = None  # an agent that tells some neighbours something else, with keys

    @property
    def samples(self) -> int:
        """Of the run."""
        return len(self.reference.measurements)

    @property
    def seconds(self) -> float:
        """From the start to the end of the last sample."""
        return (self.samples + 1) * self.period_ms / 1000


def read_plan(path: str | Path, override: Mapping[str, Any] | None = None) -> Plan:
    """Read and check the file; paths in it are relative to it.

    override: other values for keys of the scenario. Raises IoError and InvalidInput as `read_scenario`.
    """
    path = Path(path)
    whole = Section(str(path), read_document(path), path.parent)
    whole.only(["scenario", "set", "run", "relay", "expect"])
    values = {**whole.table.get("set", {}), **(override or {})}
    scenario = read_scenario(whole.file("scenario"), values)
    filter = scenario.filters[0][1]
    if filter is None or family_of(filter).own_plants:
        raise refusal("[filter]", "agents that drive plants of their own", "a filter that watches one plant")
    run = _section(whole, "run")
    run.only(["period_ms", "round_ms", "resend_ms"])
    relay, expect = _section(whole, "relay"), _section(whole, "expect")
    relay.only(["seed", *_SHARES, *_TIMES, "flood"])
    expect.only(["complete", "bound"])
    return Plan(
        path=path,
        scenario=scenario,
        reference=reference_of(scenario),
        period_ms=run.number("period_ms", 1000.0, positive=True),
        round_ms=run.number("round_ms", 0.0, positive=True) if "round_ms" in run else None,
        resend_ms=run.number("resend_ms", 0.0, positive=True) if "resend_ms" in run else None,
        seed=relay.whole("seed", 1, 0),
        relay={key: _share(relay, key) for key in _SHARES}
        | {key: _time(relay, key) for key in _TIMES}
        | {"flood": float(relay.whole("flood", 0, 0, 1_000_000))},
        expect={key: _share(expect, key) for key in ("complete", "bound")},
    )


def _section(whole: Section, name: str) -> Section:
    return Section(f"[{name}]", whole.table.get(name, {}), whole.folder)


def _share(section: Section, key: str) -> float:
    value = section.number(key, 0.0)
    if not 0 <= value <= 1:
        raise refusal(section.place(key), shown(value), "a share in 0..1")
    return value


def _time(section: Section, key: str) -> float:
    value = section.number(key, 0.0)
    if not 0 <= value <= 10_000:
        raise refusal(section.place(key), shown(value), "ms in 0..10000")
    return value
