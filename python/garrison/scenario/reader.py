"""A scenario file as objects, all of it checked."""

import re
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from garrison import _core
from garrison.arguments import chance, flag, moderate
from garrison.doubts import waits
from garrison.files import contents
from garrison.fitting import Fit
from garrison.numeric import numbers
from garrison.objects import named
from garrison.run_options import ONE_SPREAD, SPREADS, pair_of_levels
from garrison.scenario.attacks import read_attack
from garrison.scenario.data import Recording, read_data
from garrison.scenario.filters import CENTRAL_KALMAN, read_filters, read_local, read_screens
from garrison.scenario.known import changing_keys, read_inputs, read_present, read_varying
from garrison.scenario.model import read_model
from garrison.scenario.network import read_network
from garrison.scenario.overrides import overridden
from garrison.scenario.section import Section, tables_of, whole
from garrison.tables import Records
from garrison.tables.clock import Moment
from garrison.tables.text import decoded
from garrison.varying import VaryingModel, parted
from garrison.varying_network import VaryingNetwork
from garrison.words import count, near, only, refusal, shown

Array = NDArray[np.float64]

TABLES = ["model", "network", "filter", "compare", "attack", "link", "noise", "data", "run", "certificate"]
RUN_KEYS = ["steps", "trials", "seed", "threads", "x0", "start", "start_error", "inputs"]
LINK_KEYS = ["drop", "delay", "delay_rounds"]
NOISE_KEYS = ["law"]
CERTIFICATE_KEYS = ["spread", "failure", "attacked", "levels", "memory"]


@dataclass
class Scenario:
    """Everything one run needs, read and checked."""

    path: Path
    title: str
    model: _core.Model
    network: _core.Network
    filters: list[tuple[str, _core.Filter | None]]  # label and filter, the main one first; None = Kalman
    attacks: list[_core.Attack]
    link: dict[str, float]
    run: dict[str, Any]
    noise: str
    screens: dict[str, dict[str, float]]  # of the Kalman filters, by label: arguments of central_kalman
    local: set[str]  # labels of those that are one filter per agent
    certificate: dict[str, Any]  # arguments of garrison.prepare; empty = none
    names: list[str]  # of the agents
    positions: Array | None = None  # (agents, 2), kilometres east and north
    places: list[str] | None = None  # full names of the agents
    fitted: Fit | None = None
    records: Records | None = None
    measurements: Array | None = None
    truth: Array | None = None  # or the reference in its place, of records
    robust: Array | None = None  # a second reference, where it is not declared who is attacked
    notes: list[str] = field(default_factory=list)  # doubts about the files
    inputs: Array | None = None  # (steps, p), of a model with B
    varying: VaryingModel | None = None  # the model over time, where it changes
    changing: list[str] = field(default_factory=list)  # by these keys of [model]
    present: VaryingNetwork | None = None  # the network over time, where links come and go

    @property
    def dates(self) -> list[Moment]:
        """Times of the recorded samples; empty where there are none."""
        return self.records.dates if self.records is not None else []

    @property
    def plant(self) -> _core.Model | VaryingModel:
        """What is simulated: the model, or the model over time."""
        return self.varying or self.model

    @property
    def ground(self) -> _core.Network | VaryingNetwork:
        """Who hears whom, over time where that changes."""
        return self.present or self.network

    def require_constant(self, command: str) -> None:
        """Refuse a plant that changes in time, for a command that is about [model] alone. Raises InvalidInput."""
        if self.varying is not None:
            advice = "garrison run takes it; leave these keys out to ask about the constant part"
            raise refusal("[model]", ", ".join(self.changing), f"a constant plant for garrison {command}", advice)

    @property
    def steps(self) -> int:
        """Samples of a trial."""
        return int(self.run["steps"]) if self.measurements is None else len(self.measurements)

    @property
    def truth_is_declared(self) -> bool:
        """It is known who is attacked: the plant is simulated, or attacks were put on the records."""
        return self.measurements is None or bool(self.attacks)

    @property
    def hit(self) -> list[int]:
        """Agents that some attack is put on."""
        return sorted({a for attack in self.attacks for a in attack.agents})

    @property
    def first_attack(self) -> int:
        """Start of the first attack; 1 where there is none."""
        return max(1, min((attack.start for attack in self.attacks), default=1))


def read_scenario(path: str | Path, set: Mapping[str, Any] | None = None) -> Scenario:
    """Read and check a scenario file; paths in it are relative to the file.

    Parameters
    ----------
    path : str or Path
        Of the TOML file.
    set : mapping of str, optional
        Other values for some keys, as `{"filter.threshold": 0.7, "attack[0].value": 5}`.

    Returns
    -------
    Scenario
        Model, network, filters, attacks and options of the run.

    Raises
    ------
    IoError
        A file cannot be read.
    InvalidInput
        Its content does not fit: where, what was found and what was expected.
    """
    path = Path(path)
    document = read_document(path)
    if set:
        document = overridden(document, set)
    only("scenario", document, ["title", *TABLES])
    folder = path.parent

    def section(name: str) -> Section:
        value = document.get(name, {})
        if isinstance(value, list):
            raise refusal(f"[{name}]", f"{count(len(value), 'table')} [[{name}]]", f"one table: a line [{name}]")
        return Section(f"[{name}]", value, folder)

    plant, fitted, names = read_model(section("model"))
    varying = read_varying(section("model"), plant)
    model = parted(plant)[0]
    ground = read_network(section("network"), names, model.agents)
    known = ground.names or names
    names = known or [str(i) for i in range(model.agents)]
    recording = read_data(section("data"), model, fitted, names) if "data" in document else None
    run = _run(section("run"), model, recording is not None)
    inputs = read_inputs(section("run"), model, recording.inputs if recording is not None else None)
    network = named(ground.network, known)
    filters = read_filters(document, folder)
    scenario = Scenario(
        path=path,
        title=read_title(document, path),
        model=model,
        network=network,
        inputs=inputs,
        varying=varying,
        changing=changing_keys(section("model")),
        present=read_present(section("network"), network),
        filters=filters,
        screens=read_screens(document, folder, [label for label, _ in filters]),
        local=read_local(document, folder, [label for label, _ in filters]),
        attacks=[],
        link=_link(section("link")),
        run=run,
        noise=_noise(section("noise"), recording),
        certificate=_certificate(section("certificate")),
        names=names,
        positions=ground.positions,
        places=ground.places,
        fitted=fitted,
    )
    _levels(scenario.certificate, fitted, "[certificate] levels")
    _put(scenario, recording)
    _require_long_enough(scenario)
    for entry in tables_of("attack", document.get("attack", []), folder):
        scenario.attacks.append(read_attack(entry, names, scenario.records, scenario.steps))
    return scenario


def read_document(path: Path) -> dict[str, Any]:
    """The tables of a scenario file, unchecked. Raises IoError or InvalidInput."""
    text = ""
    try:
        text = decoded(path, contents(path), "a TOML document")
        return tomllib.loads(text)
    except _core.IoError:
        raise
    except OSError as error:
        raise _core.IoError(f"{path}: got {error.strerror}, expected a scenario file (TOML)") from error
    except tomllib.TOMLDecodeError as error:
        raise _no_toml(path, text, str(error)) from None
    except (ValueError, RecursionError) as error:  # a NUL in the path, a number or nesting without end
        raise refusal(str(path), f"{type(error).__name__}: {error}", "a TOML document") from error


def _no_toml(path: Path, text: str, error: str) -> _core.InvalidInput:
    """The line of a file that Python's reader stumbled over, and how such lines are written."""
    place = re.search(r"\(at line (\d+), column \d+\)", error)
    reason = error.partition(" (at ")[0].lower()
    if place is None:
        return refusal(str(path), f"the end of the file ({reason})", "a TOML document", "close all brackets and quotes")
    number = int(place[1])
    where, line = f"{path}, line {number}", shown(text.split("\n")[number - 1].strip())
    if any(word in reason for word in ("twice", "overwrite", "mutate", "redefine")):
        return refusal(where, f"{line}, which is there already", "every key and every [table] once")
    advice = (
        "text stands in quotes, numbers are like 0.5, dates like 2024-01-31, lists in [ ]; true and false are small"
    )
    return refusal(where, f"{line} ({reason})", "a TOML document: lines such as key = value", advice)


def read_title(document: Mapping[str, Any], path: Path) -> str:
    """What the scenario calls itself; default: the name of its file."""
    value = document.get("title", path.stem)
    if not isinstance(value, str):
        raise refusal("title", shown(value), "a string, in quotes")
    return value


def _run(section: Section, model: _core.Model, recorded: bool) -> dict[str, Any]:
    section.only(RUN_KEYS)
    out: dict[str, Any] = {}
    for key, least in (("steps", 1), ("trials", 1), ("threads", 0)):
        if key in section:
            out[key] = section.whole(key, 1, least)
    if "seed" in section:
        out["seed"] = section.whole("seed", 0, 0, 2**63 - 1)
    if "start_error" in section:
        out["start_error"] = section.number("start_error", 0.0)
        moderate(section.place("start_error"), out["start_error"])
    for key in ("x0", "start"):
        if key in section:
            out[key] = numbers(section.place(key), section.array(key))
    if recorded:
        for key in ("steps", "x0", "start_error"):
            if key in out:
                advice = "the records say how many" if key == "steps" else "records are not simulated"
                raise refusal(section.place(key), f"{shown(section.table[key])} together with [data]", "none", advice)
    elif "steps" not in out:
        raise refusal("scenario", "neither [data] nor [run] steps", "one of them")
    return out


def _link(section: Section) -> dict[str, float]:
    section.only(LINK_KEYS)
    out: dict[str, float] = {}
    for key in ("drop", "delay"):
        if key in section:
            out[key] = section.number(key, 0.0)
            if not 0 <= out[key] <= 1:
                raise refusal(section.place(key), shown(section.table[key]), "a probability in 0..1")
    if "delay_rounds" in section:
        out["delay_rounds"] = whole(section.place("delay_rounds"), section.table["delay_rounds"], 1)
        if "delay" not in out:
            raise refusal(section.place("delay_rounds"), "a delay without its probability", "the key delay beside it")
    return out


def _certificate(section: Section) -> dict[str, Any]:
    """What to certify; the filters' own `attacked` where the section does not say."""
    section.only(CERTIFICATE_KEYS)
    if not section.table:
        return {}
    failure = chance(section.place("failure"), section.number("failure", 1e-6))
    out: dict[str, Any] = {"certificate": section.text("spread", "flooded"), "failure": failure}
    if out["certificate"] not in SPREADS:
        raise refusal(section.place("spread"), shown(out["certificate"]), ONE_SPREAD, near(out["certificate"], SPREADS))
    if "attacked" in section:
        out["attacked"] = section.whole("attacked", 0, 0)
    if "levels" in section:
        out["levels"] = section.table["levels"]
    if "memory" in section:
        out["memory"] = flag(section.place("memory"), section.table["memory"])
    return out


def _levels(certificate: dict[str, Any], fitted: Fit | None, where: str) -> None:
    """Puts numbers in place of the word: the levels that the records of the fit exceed at the rate `failure`."""
    given = certificate.get("levels")
    if given != "calibrated":
        if given is not None:
            certificate["levels"] = pair_of_levels(given)
        return
    words = '"calibrated" with a model that is fitted to records, or [z1, z2]'
    if fitted is None:
        raise refusal(where, shown(given), words)
    if "attacked" not in certificate:
        raise refusal(where, shown(given), "`attacked` beside it", "the levels depend on it")
    found = fitted.levels(certificate["attacked"], certificate["failure"]) if certificate["failure"] > 0 else None
    if found is None:
        least = 2.0 / (len(fitted.records.dates) + 1)
        advice = f"take failure >= {least:.2g}; for several states there are none"
        raise refusal(where, f"{shown(given)} with failure {certificate['failure']:g}", words, advice)
    certificate["levels"] = found


def _noise(section: Section, recording: Recording | None) -> str:
    section.only(NOISE_KEYS)
    if recording is not None and section.table:
        raise refusal(section.where, "a law together with [data]", "none", "records carry their own noise")
    return section.text("law", "auto")  # the laws are the plant's; a rehearsal of the run refuses others


def _require_long_enough(scenario: Scenario) -> None:
    """Refuse filters that cannot test, or raise an alarm, before the run is over."""
    for label, filter in scenario.filters:
        for name, needed, absent in waits(filter) if filter is not None else []:
            if filter is not None and needed > scenario.steps:
                most = scenario.steps - needed + filter.params[name]
                words = f"at most {most}, because the run has {count(scenario.steps, 'sample')}"
                raise refusal(f"{label}.{name}", str(filter.params[name]), words, f"{absent} before it is over")


def _put(scenario: Scenario, recording: Recording | None) -> None:
    if scenario.fitted is not None:
        scenario.notes += scenario.fitted.records.notes
    if recording is None:
        return
    scenario.measurements = recording.measurements
    scenario.truth = recording.reference
    scenario.robust = recording.robust
    scenario.records = recording.records
    scenario.notes += [note for note in recording.notes if note not in scenario.notes]


__all__ = ["CENTRAL_KALMAN", "Scenario", "read_document", "read_scenario"]
