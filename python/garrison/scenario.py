"""Scenario files: TOML in, objects out. Unknown keys are refused with the nearest known name."""

import csv
import datetime as dt
import math
import tomllib
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from garrison import _core, attacks, filters
from garrison.fitting import Fit, Records, fit, read_records

Array = NDArray[np.float64]
Table = dict[str, Any]

#: name of the baseline that is no distributed filter
CENTRAL_KALMAN = "central_kalman"
_EARTH_KM_PER_DEGREE = 111.2

_TABLES = ["model", "network", "filter", "compare", "attack", "link", "noise", "data", "run"]
_FIT_KEYS = ["fit", "from", "to", "factors", "harmonics", "period", "root", "factor"]
_MODEL_KEYS = ["A", "C", "process_bound", "measurement_bound", "process_covariance", "measurement_covariance"]
_VEHICLE_KEYS = ["vehicles", "period", "inputs"]
_GENERATORS = {
    "band": ["agents", "range"],
    "ring": ["agents"],
    "path": ["agents"],
    "star": ["agents"],
    "complete": ["agents"],
    "grid": ["rows", "columns"],
    "random_geometric": ["agents", "radius", "seed"],
    "erdos_renyi": ["agents", "probability", "seed"],
}


@dataclass
class Scenario:
    """Everything one run needs, read and checked."""

    path: Path
    title: str
    model: _core.Model
    network: _core.Network
    filters: list[tuple[str, _core.Filter | None]]  # label and filter, the main one first; None = central Kalman
    attacks: list[_core.Attack]
    link: dict[str, float]
    run: Table
    noise: str
    names: list[str]  # of the agents
    positions: Array | None = None  # (agents, 2), kilometres east and north
    places: list[str] | None = None  # full names of the agents
    fitted: Fit | None = None
    records: Records | None = None
    measurements: Array | None = None
    truth: Array | None = None
    dates: list[dt.date] = field(default_factory=list)

    @property
    def steps(self) -> int:
        """Samples of a trial."""
        return int(self.run["steps"]) if self.measurements is None else len(self.measurements)


def _refuse(where: str, message: str) -> _core.InvalidInput:
    return _core.InvalidInput(f"{where}: {message}")


def _only(where: str, table: Table, known: Iterable[str]) -> Table:
    known = list(known)
    for key in table:
        if key not in known:
            near = _core.nearest_name(key, known)
            hint = f"; did you mean {near!r}?" if near else ""
            raise _refuse(where, f"got the unknown key {key!r}, expected one of {', '.join(known)}{hint}")
    return table


def _array(where: str, value: Any, folder: Path) -> Any:
    """Numbers inline, or `{ file = "A.csv" }`."""
    if not isinstance(value, dict):
        return value
    _only(where, value, ["file"])
    path = folder / value["file"]
    try:
        return np.loadtxt(path, delimiter=",", ndmin=2)
    except OSError as error:
        raise _core.IoError(f"{path}: got {error}, expected a CSV file with the numbers of {where}") from error
    except ValueError as error:
        raise _refuse(str(path), f"got {error}, expected rows of numbers separated by commas") from error


def _date(where: str, value: Any) -> dt.date:
    if isinstance(value, dt.date):
        return value
    try:
        return dt.date.fromisoformat(value)
    except (TypeError, ValueError):
        raise _refuse(where, f"got {value!r}, expected a date YYYY-MM-DD") from None


def _between(where: str, records: Records, table: Table) -> Records:
    ends = [_date(f"{where}.{key}", table[key]) if key in table else None for key in ("from", "to")]
    return records.between(ends[0], ends[1])


def _model(table: Table, folder: Path) -> tuple[_core.Model, Fit | None]:
    if "fit" in table:
        _only("[model]", table, _FIT_KEYS)
        records = _between("[model]", read_records(folder / table["fit"]), table)
        options = {k: v for k, v in table.items() if k not in ("fit", "from", "to")}
        fitted = fit(records, **options)
        return fitted.model, fitted
    if "vehicles" in table:
        _only("[model]", table, _VEHICLE_KEYS)
        if "period" not in table:
            raise _refuse("[model]", "got vehicles without a period, expected the sampling time in s")
        return _core.platoon.model(**table), None
    _only("[model]", table, [*_MODEL_KEYS, "fit", "vehicles"])
    for key in ("A", "C"):
        if key not in table:
            raise _refuse("[model]", f'got no {key}, expected A and C, fit = "records.csv", or vehicles and period')
    values = {k: _array(f"[model].{k}", v, folder) for k, v in table.items()}
    rest = {k: v for k, v in values.items() if k not in ("A", "C")}
    A = np.atleast_2d(np.asarray(values["A"], dtype=float))
    return _core.Model(A, values["C"], **rest), None


def _stations(path: Path, codes: list[str] | None) -> tuple[list[str], list[str], Array]:
    """Codes, names and kilometres of the stations in a CSV file code,name,latitude,longitude."""
    try:
        with path.open(newline="", encoding="utf-8") as file:
            rows = {row["code"]: row for row in csv.DictReader(file)}
    except (OSError, KeyError, UnicodeDecodeError) as error:
        raise _core.IoError(f"{path}: got {error!r}, expected a CSV file code,name,latitude,longitude") from error
    wanted = codes if codes is not None else list(rows)
    missing = [code for code in wanted if code not in rows]
    if missing:
        raise _refuse(str(path), f"got no station {', '.join(missing)}, expected all of {', '.join(wanted)}")
    degrees = np.array([[float(rows[c]["longitude"]), float(rows[c]["latitude"])] for c in wanted])
    middle = math.radians(float(degrees[:, 1].mean()))
    km = (degrees - degrees.mean(axis=0)) * _EARTH_KM_PER_DEGREE * np.array([math.cos(middle), 1.0])
    return wanted, [rows[c]["name"] for c in wanted], km


def _network(table: Table, folder: Path, codes: list[str] | None, agents: int) -> tuple[_core.Network, dict[str, Any]]:
    if "stations" in table:
        _only("[network]", table, ["stations", "radius_km"])
        names, places, km = _stations(folder / table["stations"], codes)
        distance = np.linalg.norm(km[:, None] - km[None], axis=2)
        radius = float(table.get("radius_km", math.inf))
        pairs = [(i, j) for i in range(len(km)) for j in range(i + 1, len(km)) if distance[i, j] <= radius]
        return _core.Network(pairs, agents=len(km)), {"names": names, "places": places, "positions": km}
    if "kind" in table:
        kind = table["kind"]
        if kind not in _GENERATORS:
            near = _core.nearest_name(str(kind), list(_GENERATORS))
            hint = f"; did you mean {near!r}?" if near else ""
            raise _refuse("[network].kind", f"got {kind!r}, expected one of {', '.join(_GENERATORS)}{hint}")
        _only(f"[network] kind = {kind!r}", table, ["kind", *_GENERATORS[kind]])
        arguments = {k: v for k, v in table.items() if k != "kind"}
        if "agents" in _GENERATORS[kind]:
            arguments.setdefault("agents", agents)
        return getattr(_core.Network, kind)(**arguments), {}
    _only("[network]", table, ["edges", "agents", "directed", "stations", "kind"])
    if "edges" not in table:
        raise _refuse("[network]", "got no edges, expected edges, kind or stations")
    edges = [tuple(int(v) for v in edge) for edge in np.asarray(_array("[network].edges", table["edges"], folder))]
    return _core.Network(edges, agents=table.get("agents", agents), directed=table.get("directed", False)), {}


def _agents(where: str, wanted: Any, names: list[str]) -> list[int]:
    out = []
    for agent in wanted:
        if isinstance(agent, int):
            out.append(agent)
        elif agent in names:
            out.append(names.index(agent))
        else:
            near = _core.nearest_name(str(agent), names)
            hint = f"; did you mean {near!r}?" if near else ""
            raise _refuse(where, f"got the agent {agent!r}, expected a number or one of {', '.join(names)}{hint}")
    return out


def _time(where: str, value: Any, dates: list[dt.date]) -> int:
    """A sample number, or a date of the records (sample 1 is the first one)."""
    if isinstance(value, int) and not isinstance(value, bool):
        return value
    if not dates:
        raise _refuse(where, f"got {value!r}, expected a sample number (dates need [data] with dates)")
    return (_date(where, value) - dates[0]).days + 1


def _attack(number: int, table: Table, names: list[str], dates: list[dt.date]) -> _core.Attack:
    where = f"[[attack]] {number}"
    infos = {info["name"]: info for info in _core.attack_infos()}
    if "kind" not in table:
        raise _refuse(where, f"got no kind, expected one of {', '.join(infos)}")
    kind = table["kind"]
    common = ["kind", "agents", "start", "stop", "schedule", "probability"]
    if kind in infos:
        _only(where, table, [*common, *(p["name"] for p in infos[kind]["params"])])
    arguments = {k: v for k, v in table.items() if k != "kind"}
    if "agents" in arguments:
        arguments["agents"] = _agents(f"{where}.agents", arguments["agents"], names)
    for key in ("start", "stop"):
        if key in arguments:
            arguments[key] = _time(f"{where}.{key}", arguments[key], dates)
    if "schedule" in arguments:
        arguments["schedule"] = [
            (_time(f"{where}.schedule", t, dates), _agents(f"{where}.schedule", a, names))
            for t, a in arguments["schedule"]
        ]
    return attacks.make(kind, **arguments)


def _filters(document: Table) -> list[tuple[str, _core.Filter | None]]:
    if "filter" not in document:
        known = ", ".join(info["name"] for info in _core.filter_infos())
        raise _refuse("scenario", f"got no [filter], expected one with name = one of {known}")
    found: list[tuple[str, _core.Filter | None]] = []
    for table in [document["filter"], *document.get("compare", [])]:
        if "name" not in table:
            raise _refuse("[filter]", "got no name; see `garrison list filters`")
        label = str(table.get("label", table["name"]))
        params = {k: v for k, v in table.items() if k not in ("name", "label")}
        if table["name"] == CENTRAL_KALMAN and found:
            _only(f"[[compare]] {CENTRAL_KALMAN}", params, [])
            found.append((label, None))
        else:
            found.append((label, filters.make_filter(table["name"], params)))
    return found


def _positive(where: str, value: Any) -> int:
    if isinstance(value, bool) or not isinstance(value, int) or value < 1:
        raise _refuse(where, f"got {value!r}, expected a whole number >= 1")
    return value


def read_scenario(path: str | Path) -> Scenario:
    """Read and check a scenario file; paths in it are relative to the file.

    Raises IoError when a file cannot be read, InvalidInput when its content does not fit, always with where, what
    was found and what was expected.
    """
    path = Path(path)
    try:
        document = tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise _core.IoError(f"{path}: got {error.strerror}, expected a scenario file (TOML)") from error
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise _refuse(str(path), f"got {error}, expected a TOML document") from error
    _only("scenario", document, ["title", *_TABLES])
    folder = path.parent
    model, fitted = _model(document.get("model", {}), folder)
    codes = fitted.records.stations if fitted else None
    network, known = _network(document.get("network", {}), folder, codes, model.agents)
    names = known.get("names") or codes or [str(i) for i in range(model.agents)]

    run = _only("[run]", document.get("run", {}), ["steps", "trials", "seed", "threads", "x0", "start", "start_error"])
    for key in ("steps", "trials"):
        if key in run:
            _positive(f"[run].{key}", run[key])
    noise = _only("[noise]", document.get("noise", {}), ["law"]).get("law", "auto")
    scenario = Scenario(
        path=path,
        title=str(document.get("title", path.stem)),
        model=model,
        network=network,
        filters=_filters(document),
        attacks=[],
        link=dict(_only("[link]", document.get("link", {}), ["drop", "delay", "delay_rounds"])),
        run=dict(run),
        noise=noise,
        names=names,
        positions=known.get("positions"),
        places=known.get("places"),
        fitted=fitted,
    )
    _data(scenario, document.get("data"), folder)
    dates = scenario.dates
    scenario.attacks = [_attack(k, t, names, dates) for k, t in enumerate(document.get("attack", []), start=1)]
    return scenario


def _data(scenario: Scenario, table: Table | None, folder: Path) -> None:
    """Recorded measurements, with their truth where the model was fitted; else the scenario is simulated."""
    if table is None:
        if "steps" not in scenario.run:
            raise _refuse("scenario", "got neither [data] nor [run] steps, expected one of them")
        return
    _only("[data]", table, ["file", "from", "to"])
    if "steps" in scenario.run:
        raise _refuse("[run].steps", "got a number together with [data], expected none; the records say how many")
    if scenario.fitted is None:
        scenario.measurements = np.asarray(_array("[data]", {"file": table["file"]}, folder), dtype=float)
        return
    records = _between("[data]", read_records(folder / table["file"]), table)
    scenario.records = records
    scenario.dates = records.dates
    scenario.measurements = scenario.fitted.measurements(records)
    reference = scenario.fitted.reference(records)
    # The state before the first record is not known; its error is not counted (see `first` in the summary).
    scenario.truth = np.vstack([reference[:1], reference])
