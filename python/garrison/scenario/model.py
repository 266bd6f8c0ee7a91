"""[model]: matrices, a fit to records, or vehicles."""

from typing import Any

import numpy as np

from garrison import _core
from garrison.fitting import Fit
from garrison.identifying import fit
from garrison.numeric import numbers
from garrison.scenario.continuous import sampled
from garrison.scenario.model_file import read_model_file
from garrison.scenario.section import Section, moment, number, renamed
from garrison.sizes import require_memory
from garrison.tables import Records, read_records
from garrison.varying import VaryingModel, parted
from garrison.words import count, refusal, shown

_FIT_KEYS = [
    "fit",
    "from",
    "to",
    "factors",
    "harmonics",
    "period",
    "root",
    "factor",
    "standardise",
    "states",
    "order",
    "most",
    "held_out",
    "noise",
    "inputs",
]
_MATRIX_KEYS = [
    "A",
    "C",
    "interval",
    "times",
    "process_intensity",
    "process_bound",
    "measurement_bound",
    "process_covariance",
    "measurement_covariance",
    "B",
    "inputs",
    "states",
    "outputs",
    "sources",
    "units",
    "exposed",
    "names",
    "A_over_time",
    "B_over_time",
    "C_over_time",
    "process_covariance_over_time",
    "measurement_covariance_over_time",
]
_VEHICLE_KEYS = ["vehicles", "period", "inputs", "names"]
_FILE_KEYS = ["file"]
KEYS = [_MATRIX_KEYS, _FIT_KEYS, _VEHICLE_KEYS, _FILE_KEYS]


def read_model(section: Section) -> tuple[_core.Model | VaryingModel, Fit | None, list[str] | None]:
    """The model (over time where it is sampled at irregular times), the fit behind it where there is one, and the names
    of the stations where they are known.
    """
    if "fit" in section:
        section.only(_FIT_KEYS)
        fitted = _fitted(section)
        return fitted.model, fitted, fitted.records.stations
    if "vehicles" in section:
        section.only(_VEHICLE_KEYS)
        model = _vehicles(section)
        return model, None, _agent_names(section, model.agents, "vehicle")
    if "file" in section:
        section.only(_FILE_KEYS)
        model, names = read_model_file(section.file("file"))
        return model, None, names
    section.only([*_MATRIX_KEYS, "fit", "vehicles", "file"])
    plant = _matrices(section)
    return plant, None, _agent_names(section, parted(plant)[0].agents, "agent")


def between(section: Section, records: Records) -> Records:
    """The records between the section's `from` and `to`."""
    ends = [
        moment(section.place(k), section.table[k], last=k == "to") if k in section else None for k in ("from", "to")
    ]
    try:
        return records.between(*ends)
    except _core.Error as error:
        raise renamed(error, section.where) from None


def _fitted(section: Section) -> Fit:
    records = between(section, read_records(section.file("fit")))
    options: dict[str, Any] = {}
    if "states" in section:
        options["states"] = section.choice("states", "factors", ["factors", "all"])
    if "inputs" in section:
        options["inputs"] = section.table["inputs"]
    for key in ("factors", "harmonics", "order", "most"):
        if key in section:
            options[key] = section.whole(key, 0)
    for key in ("period", "factor", "held_out", "noise"):
        if key in section:
            options[key] = section.number(key, 0.0, positive=True)
    options["root"] = section.flag("root", False)
    if "standardise" in section:
        options["standardise"] = section.flag("standardise", False)
    return fit(records, **options)


def _vehicles(section: Section) -> _core.Model:
    section.require("period", "the sampling time in s beside vehicles")
    vehicles = section.whole("vehicles", 0, 1)
    # Every vehicle has up to 5 outputs of 2 states, and sets and covariances of all the others.
    require_memory(section.place("vehicles"), str(vehicles), 40.0 * vehicles + float(vehicles) ** 2)
    return _core.platoon.model(vehicles, section.number("period", 0.0, positive=True), section.flag("inputs", False))


def _agent_names(section: Section, agents: int, noun: str) -> list[str] | None:
    if "names" not in section:
        return None
    given = section.table["names"]
    texts = isinstance(given, list) and all(isinstance(name, str) for name in given)
    if not texts or len(set(given)) != agents or len(given) != agents:
        raise refusal(section.place("names"), shown(given), f"{agents} different names in quotes, one per {noun}")
    return list(given)


def _matrices(section: Section) -> _core.Model | VaryingModel:
    for key in ("A", "C"):
        section.require(key, 'A and C, fit = "records.csv", or vehicles and period')
    A = np.atleast_2d(section.numbers("A"))
    if A.ndim != 2 or A.shape[0] != A.shape[1]:
        raise refusal(section.place("A"), f"{' x '.join(map(str, A.shape))} numbers", "a square matrix")
    C = _rows(section, len(A))
    rest = _noise(section, len(A), [len(c) for c in C]) | _driven(section, len(A)) | _labels(section)
    try:
        return sampled(section, A, C, rest)
    except _core.Error as error:
        raise renamed(error, section.where) from None


def _driven(section: Section, n: int) -> dict[str, Any]:
    if "B" not in section:
        return {}
    B = section.numbers("B")
    return {"B": B.reshape(n, -1) if B.ndim < 2 and B.size == n else np.atleast_2d(B)}


def _labels(section: Section) -> dict[str, Any]:
    """Names, units and what an attacker can reach, as Model takes them."""
    return {
        key: section.table[key]
        for key in ("inputs", "states", "outputs", "sources", "units", "exposed")
        if key in section
    }


def _rows(section: Section, n: int) -> list[Any]:
    """One matrix (m_i, n) per agent: from rows, from matrices, or from both mixed; [] is a relay."""
    given = section.array("C")
    if isinstance(given, (int, float)) and not isinstance(given, bool) and n == 1:
        given = [[given]]
    if not isinstance(given, (list, np.ndarray)):
        raise refusal(section.place("C"), shown(given), "a list with a row (or a matrix) per agent")
    if n == 1 and all(isinstance(c, (int, float)) and not isinstance(c, bool) for c in given):
        given = [[c] for c in given]
    if (plain := _plain_rows(given, n)) is not None:
        return plain
    out = []
    for k, one in enumerate(given):
        rows = np.zeros((0, n)) if _is_empty(one) else numbers(f"{section.place('C')}[{k}]", one)
        if rows.ndim > 2 or rows.ndim == 0:
            raise refusal(
                f"{section.place('C')}[{k}]", shown(one), f"a row of {count(n, 'number')}, or a matrix with such rows"
            )
        out.append(np.atleast_2d(rows))
    return out


def _plain_rows(given: Any, n: int) -> list[Any] | None:
    """What is a list with one row of n doubles per agent, as large scenarios have it: all rows at once."""
    if not all(type(row) is list and len(row) == n and all(type(v) is float for v in row) for row in given):
        return None
    return list(np.array(given, dtype=float).reshape(len(given), 1, n))


def _is_empty(one: Any) -> bool:
    """Nothing, as a relay without sensors has it: [] or [[]]."""
    return isinstance(one, (list, np.ndarray)) and (len(one) == 0 or (len(one) == 1 and _is_empty(one[0])))


def _noise(section: Section, n: int, outputs: list[int]) -> dict[str, Any]:
    out: dict[str, Any] = {}
    if "process_bound" in section:
        out["process_bound"] = section.number("process_bound", 0.0)
    if "measurement_bound" in section:
        bound = section.numbers("measurement_bound")
        if bound.ndim > 1:
            raise refusal(section.place("measurement_bound"), f"{bound.ndim} dimensions", "a number, or one per agent")
        out["measurement_bound"] = bound
    if "process_covariance" in section:
        Q = section.numbers("process_covariance")
        if Q.ndim == 1 and len(Q) == n > 1:
            Q = np.diag(Q)
        out["process_covariance"] = np.diag(np.full(n, float(Q))) if Q.ndim == 0 else Q
    if "measurement_covariance" in section:
        out["measurement_covariance"] = _measurement_covariance(section, outputs)
    return out


def _measurement_covariance(section: Section, outputs: list[int]) -> list[Any]:
    """One (m_i, m_i) matrix per agent: from a number for all, a number per agent, or matrices."""
    where, given = section.place("measurement_covariance"), section.array("measurement_covariance")
    if not isinstance(given, (list, np.ndarray)):
        return [np.diag(np.full(m, number(where, given))) for m in outputs]
    total = sum(outputs)
    if len(outputs) > 1 and len(given) == total and all(np.shape(row) == (total,) for row in given):
        advice = "noises of different agents are independent: give the block of each agent, or numbers of the diagonal"
        raise refusal(where, f"{total} x {total} numbers", f"{len(outputs)} matrices, one per agent", advice)
    if len(given) != len(outputs):
        raise refusal(
            where, f"{count(len(given), 'entry', 'entries')}", f"{len(outputs)}, one per agent (or one number for all)"
        )
    out = []
    for k, (one, m) in enumerate(zip(given, outputs, strict=True)):
        R = np.zeros((0, 0)) if _is_empty(one) and m == 0 else numbers(f"{where}[{k}]", one)
        if R.ndim == 0:
            R = np.diag(np.full(m, float(R)))
        elif R.ndim == 1 and len(R) == m:
            R = np.diag(R)
        if R.shape != (m, m):
            raise refusal(f"{where}[{k}]", f"shape {R.shape}", f"a number, or {m} x {m} numbers")
        out.append(R)
    return out
