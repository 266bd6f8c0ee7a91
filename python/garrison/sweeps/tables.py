"""The tables of a sweep: one row per point, filter, condition and trial, and one per point summed up."""

import csv
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from garrison._core import certificate
from garrison.sweeps.grid import Point
from garrison.sweeps.work import COLUMNS

Row = dict[str, Any]

#: columns of a trial that are summed up per point
_SUMMED = ("mean_error", "worst_error", "final_error")
_TEXTS = ("filter", "attacked", "status", "seconds", "scenario_hash", "version")


def read_part(path: Path) -> list[Row]:
    """The rows of a part, as texts."""
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def trial_rows(points: Sequence[Point], parts: Sequence[tuple[int, list[Row]]], marks: Row) -> list[Row]:
    """All trials in the order of point, filter, attacked first, trial: the same whatever the parts were."""
    order: dict[tuple[int, str], int] = {}
    rows: dict[tuple[Any, ...], Row] = {}
    for point, content in parts:
        for row in content:
            place = order.setdefault((point, row["filter"]), len(order))
            trial = int(row["trial"]) if row["trial"] else -1
            key = (point, place, row["attacked"] != "True", trial)
            rows[key] = {"point": point} | points[point] | {c: row[c] for c in COLUMNS} | marks
    return [rows[key] for key in sorted(rows)]


def point_rows(points: Sequence[Point], trials: Sequence[Row]) -> list[Row]:
    """Per point, filter and condition: trials, and for each error its median and 95 % quantile over trials.

    Each quantile has an interval of order statistics that holds the true one with 95 % (columns _from and _to, empty
    where there are too few trials).
    """
    groups: dict[tuple[int, str, str], list[Row]] = {}
    for row in trials:
        groups.setdefault((row["point"], row["filter"], row["attacked"]), []).append(row)
    out = []
    for (point, label, attacked), rows in groups.items():
        fine = [row for row in rows if row["status"] == "ok"]
        found: Row = {"point": point} | points[point] | {"filter": label, "attacked": attacked, "trials": len(fine)}
        for name in _SUMMED:
            for words, share in (("median", 0.5), ("q95", 0.95)):
                found |= _quantile(f"{name}_{words}", _numbers(fine, name), share)
        found["share_with_bound"] = _mean(_numbers(fine, "share_with_bound"))
        found["inside_bound"] = _mean(_numbers(fine, "inside_bound"))
        found["detected"] = len(_numbers(fine, "first_detected"))
        found["false_alarms"] = int(_numbers(fine, "false_alarms").sum())
        found["status"] = next((row["status"] for row in rows if row["status"] != "ok"), "ok")
        out.append(found)
    return out


def _numbers(rows: Sequence[Row], name: str) -> NDArray[np.float64]:
    return np.array([float(row[name]) for row in rows if row[name] not in ("", None)])


def _mean(values: NDArray[np.float64]) -> float | str:
    return float(values.mean()) if len(values) else ""


def _quantile(name: str, values: NDArray[np.float64], share: float) -> Row:
    if not len(values):
        return {name: "", f"{name}_from": "", f"{name}_to": ""}
    _, low, high = certificate.empirical_quantile(values, 1.0 - share)
    ends = ["" if np.isnan(v) else float(v) for v in (low, high)]
    return {name: float(np.quantile(values, share)), f"{name}_from": ends[0], f"{name}_to": ends[1]}


def write_csv(path: Path, rows: Sequence[Row]) -> None:
    """All rows with the columns of the first; the file appears whole."""
    temporary = path.with_suffix(".tmp")
    with temporary.open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, list(dict.fromkeys(k for row in rows for k in row)), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    temporary.replace(path)


def write_parquet(path: Path, rows: Sequence[Row]) -> bool:
    """The same with pyarrow; False where that is not installed."""
    try:
        import pyarrow as pa
        import pyarrow.parquet as pq
    except ImportError:
        return False
    columns = list(dict.fromkeys(k for row in rows for k in row))
    table = pa.table({name: _column([row.get(name) for row in rows], name) for name in columns})
    temporary = path.with_suffix(".tmp")
    pq.write_table(table, temporary)
    temporary.replace(path)
    return True


def _column(values: list[Any], name: str) -> list[Any]:
    plain = [None if v in ("", None) else v for v in values]
    if name in _TEXTS or not all(_numeric(v) for v in plain):
        return [None if v is None else str(v) for v in plain]
    return [float(v) if isinstance(v, str) else v for v in plain]


def _numeric(value: Any) -> bool:
    if not isinstance(value, str):
        return True
    try:
        float(value)
    except ValueError:
        return False
    return True
