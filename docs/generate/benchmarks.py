"""The page of the benchmarks: the newest file of bench/results."""

import json
from pathlib import Path
from typing import Any

from generate.markdown import cell, table

_RESULTS = Path(__file__).parents[2] / "bench" / "results"


def page() -> str:
    """Every measured row of the newest file."""
    newest = max(_RESULTS.glob("*.json"))
    found = json.loads(newest.read_text())
    versions = ", ".join(f"{name} {version}" for name, version in found["versions"].items())
    parts = [
        "# Benchmarks\n",
        f"Measured on {newest.stem} on a machine with {found['cores']} cores{_machine(found)} under a load of "
        f"{found['load'][0]:.1f}; {versions}. `make bench` measures anew and writes `bench/results`. "
        "Figures of one table were measured in turns: `ratio` is to the first row (more is slower), `spread` its range "
        "over the repetitions; ratios are steadier than times.\n",
        "## The machine\n",
        table(["limit", "value"], [[cell(k), f"{v:.1f}"] for k, v in found["limits"].items()]),
    ]
    for title, rows in found.items():
        if isinstance(rows, list) and rows and isinstance(rows[0], dict):
            parts.append(f"## {cell(title)}\n\n{_rows(rows)}")
    return "\n".join(parts)


def _machine(found: dict[str, Any]) -> str:
    return f" ({cell(found['machine'])})" if "machine" in found else ""


def _rows(rows: list[dict[str, Any]]) -> str:
    head = list(dict.fromkeys(key for row in rows for key in row))
    return table([cell(key) for key in head], [[_shown(row.get(key, "")) for key in head] for row in rows])


def _shown(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.4g}"
    if isinstance(value, list) and all(isinstance(v, float) for v in value):
        return " to ".join(f"{v:.3g}" for v in value)
    return cell(value)
