"""[network]: edges, a generator, or stations on the map that are near enough."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from garrison import _core
from garrison.scenario.section import Section, renamed, whole
from garrison.sizes import require_memory
from garrison.tables import read_rows
from garrison.tables.cells import has_decimal_comma, number
from garrison.tables.text import require_widths
from garrison.words import count, near, refusal, shown

Array = NDArray[np.float64]
_EARTH_KM = 111.2 * 180 / math.pi  # per radian
_EDGE_KEYS = ["edges", "agents", "directed", "present"]
_STATION_KEYS = ["stations", "radius_km"]
KEYS = [_EDGE_KEYS, _STATION_KEYS]
GENERATORS = {
    "band": ["agents", "range"],
    "ring": ["agents"],
    "path": ["agents"],
    "star": ["agents"],
    "complete": ["agents"],
    "grid": ["rows", "columns"],
    "random_geometric": ["agents", "radius", "seed"],
    "erdos_renyi": ["agents", "probability", "seed"],
}
#: columns of a station file and the other names that people give them
_COLUMNS = {
    "code": ("code", "id", "station", "key", "abbreviation"),
    "name": ("name", "label", "place", "title"),
    "latitude": ("latitude", "lat", "y"),
    "longitude": ("longitude", "lon", "lng", "long", "x"),
}


@dataclass
class Ground:
    """A network, and what is known of its agents: names, full names, kilometres east and north of their centre."""

    network: _core.Network
    names: list[str] | None = None
    places: list[str] | None = None
    positions: Array | None = None


def read_network(section: Section, names: list[str] | None, agents: int) -> Ground:
    """The network of `agents` agents; names: theirs, where the model knows them."""
    if "stations" in section:
        return _near_stations(section, names, agents)
    if "kind" in section:
        return Ground(_generated(section, agents))
    section.only([*_EDGE_KEYS, "stations", "kind"])
    if "edges" not in section:
        raise refusal(section.where, "no edges", "edges, kind or stations")
    count = _count(section, agents)
    edges = _edges(section, names)
    try:
        return Ground(_core.Network(edges, agents=count, directed=section.flag("directed", False)))
    except _core.Error as error:
        raise renamed(error, section.where) from None


def _count(section: Section, agents: int) -> int:
    """The number of agents, which must be that of the model."""
    count = section.whole("agents", agents, 1)
    if count != agents:
        raise refusal(section.place("agents"), str(count), f"{agents}, because C has one matrix per agent")
    return count


def _edges(section: Section, names: list[str] | None) -> list[tuple[int, int]]:
    """Pairs (sender, receiver) of numbers or names; a flat list of two is one edge."""
    where, given = section.place("edges"), section.array("edges")
    if isinstance(given, np.ndarray):
        given = given.tolist()
    if not isinstance(given, list):
        raise refusal(where, shown(given), "a list of pairs of agents")
    if len(given) == 2 and not any(isinstance(e, list) for e in given):
        given = [given]
    out = []
    for k, edge in enumerate(given):
        if not isinstance(edge, list) or len(edge) != 2:
            what = "a weighted edge" if isinstance(edge, list) and len(edge) == 3 else shown(edge)
            raise refusal(f"{where}[{k}]", what, "a pair of agents; edges have no weights here")
        out.append((_end(f"{where}[{k}]", edge[0], names), _end(f"{where}[{k}]", edge[1], names)))
    return out


def _end(where: str, value: Any, names: list[str] | None) -> int:
    if isinstance(value, str):
        return agent_number(where, value, names or [])
    return whole(where, value)


def agent_number(where: str, value: Any, names: list[str]) -> int:
    """The number of an agent that is given by number or by name."""
    if isinstance(value, str):
        if value in names:
            return names.index(value)
        words = f"a number or one of {', '.join(names)}" if names else "a number: the agents have no names"
        advice = near(value, names) if names else 'the key names in [model], as names = ["a", "b"], gives them some'
        raise refusal(where, f"the agent {value!r}", words, advice)
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise refusal(where, f"the agent {shown(value)}", "a number" + (" or a name" if names else ""))
    return whole(where, value)


def _generated(section: Section, agents: int) -> _core.Network:
    kind = section.choice("kind", "", list(GENERATORS))
    section = Section(f"[network] kind = {kind!r}", section.table, section.folder)
    section.only(["kind", *GENERATORS[kind]])
    arguments: dict[str, Any] = {}
    for key in GENERATORS[kind]:
        if key == "agents":
            arguments["agents"] = _count(section, agents)
        elif key in ("radius", "probability"):
            section.require(key, "a number")
            arguments[key] = section.number(key, 0.0)
        elif key == "seed":
            arguments[key] = section.whole(key, 0, 0, 2**63 - 1)
        else:
            section.require(key, "a whole number")
            arguments[key] = section.whole(key, 0, 0)
    if kind == "grid" and arguments["rows"] * arguments["columns"] != agents:
        got = f"{arguments['rows']} x {arguments['columns']} agents"
        raise refusal(section.where, got, f"{agents}, because C has one matrix per agent")
    require_memory(section.where, f"{agents} agents", float(agents) ** 2 / 4 if kind == "complete" else float(agents))
    try:
        network: _core.Network = getattr(_core.Network, kind)(**arguments)
    except _core.Error as error:
        raise renamed(error, section.where) from None
    return network


def _near_stations(section: Section, names: list[str] | None, agents: int) -> Ground:
    section.only(_STATION_KEYS)
    codes, places, degrees = _stations(section, names)
    if len(codes) != agents:
        raise refusal(
            section.place("stations"),
            f"{count(len(codes), 'station')}",
            f"{agents}, because C has one matrix per agent",
        )
    km = _kilometres(degrees)
    distance = np.linalg.norm(km[:, None] - km[None], axis=2)
    radius = section.number("radius_km", math.inf)
    if not radius >= 0:
        raise refusal(section.place("radius_km"), shown(radius), "a number >= 0")
    pairs = [(i, j) for i in range(agents) for j in range(i + 1, agents) if distance[i, j] <= radius]
    return Ground(_core.Network(pairs, agents=agents), codes, places, km)


def _kilometres(degrees: Array) -> Array:
    """Kilometres east and north of the centre; stations on both sides of 180 degrees stay together."""
    longitude = np.radians(degrees[:, 1])
    centre = math.atan2(float(np.sin(longitude).mean()), float(np.cos(longitude).mean()))
    east = (longitude - centre + math.pi) % (2 * math.pi) - math.pi
    latitude = np.radians(degrees[:, 0])
    plane = np.column_stack([(east - east.mean()) * math.cos(latitude.mean()), latitude - latitude.mean()])
    return plane * _EARTH_KM


def _stations(section: Section, wanted: list[str] | None) -> tuple[list[str], list[str], Array]:
    """Codes, names, and latitude and longitude in degrees."""
    rows = read_rows(section.file("stations"))
    require_widths(rows, 1, len(rows.cells[0]))
    at = _columns(str(rows.path), rows.cells[0])
    found: dict[str, tuple[str, float, float]] = {}
    for line, row in zip(rows.lines[1:], rows.cells[1:], strict=True):
        place, code = f"{rows.path}, line {line}", row[at["code"]]
        if not code:
            raise refusal(place, "no code", "the code of a station in every row")
        if code in found:
            raise refusal(place, f"the code {code!r} twice", "a different code for every station")
        latitude = _degrees(place, "latitude", row[at["latitude"]], 90.0)
        longitude = _degrees(place, "longitude", row[at["longitude"]], 360.0)
        found[code] = row[at["name"]] or code, latitude, longitude
    codes = list(found) if wanted is None else wanted
    missing = [code for code in codes if code not in found]
    if missing:
        raise refusal(str(rows.path), f"no station {', '.join(missing)}", f"all of {', '.join(codes)}")
    if not codes:
        raise refusal(str(rows.path), "no station", "a row per station")
    return codes, [found[c][0] for c in codes], np.array([found[c][1:] for c in codes])


def _columns(where: str, head: list[str]) -> dict[str, int]:
    lower = [h.split("[")[0].split("(")[0].strip().lower() for h in head]
    at: dict[str, int] = {}
    for name, words in _COLUMNS.items():
        places = [k for k, h in enumerate(lower) if h in words]
        if places:
            at[name] = places[0]
    at.setdefault("code", at.get("name", -1))
    at.setdefault("name", at["code"])
    if at["code"] < 0 or "latitude" not in at or "longitude" not in at:
        raise refusal(where, f"the header {','.join(head)}", "a header code,name,latitude,longitude")
    return at


def _degrees(place: str, name: str, cell: str, most: float) -> float:
    value = number(cell, has_decimal_comma([cell]))
    if value is None or not math.isfinite(value) or abs(value) > most:
        raise refusal(f"{place}, column {name}", repr(cell), f"degrees in {-most:g}..{most:g}, with a point")
    return value
