"""Benchmarks: us and our peers, interleaved in one run. `make bench` builds what it needs and calls this.

Correctness is checked before anything is timed; a wrong result voids its row. Single-thread rows are processor time,
rows with threads are wall clock. Medians of the repeats; ratios are medians of the pairwise ratios.
"""

import argparse
import json
import os
import platform
import time
from pathlib import Path
from typing import Any

import certified
import consensus
import garrison as gr
import garrison_bench as peers
import lambda0
import montecarlo
import numpy as np
import partial_sharing
import platoon
import rdkf
import remembered
import scipy
import set_based
import structure
from rich.console import Console
from rich.table import Table

HERE = Path(__file__).parent
#: modules with tasks(repeats)
TOPICS = (certified, remembered, consensus, montecarlo, lambda0, rdkf, partial_sharing, structure, platoon, set_based)


def limits() -> dict[str, float]:
    sizes = {"L1": 24_000, "L2": 384_000, "L3": 4_000_000, "DRAM": 400_000_000}
    return {"multiply-add GF/s": peers.multiply_add_gflops()} | {
        f"triad {name} GB/s": peers.triad_gigabytes(size) for name, size in sizes.items()
    }


def show(console: Console, title: str, rows: list[dict[str, Any]]) -> None:
    table = Table(title=title, title_justify="left")
    for name in ("row", "median ms", "ratio to ours", "spread"):
        table.add_column(name)
    for row in rows:
        low, high = row["spread"]
        table.add_row(row["row"], f"{row['ms']:.4g}", f"{row['ratio']:.4g}", f"{low:.3g} .. {high:.3g}")
    console.print(table)


def machine() -> str:
    """Processor and system, as the system tells them."""
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        lines = []
    names = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return (
        f"{names[0] if names else platform.processor() or platform.machine()}, {platform.system()} {platform.release()}"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repeats", type=int, default=9)
    parser.add_argument("--only", help="run only the tasks whose name contains this")
    args = parser.parse_args()
    console = Console(width=110)
    tasks = {name: run for topic in TOPICS for name, run in topic.tasks(args.repeats).items()}
    results: dict[str, Any] = {
        "versions": {
            "garrison": gr.__version__,
            "numpy": np.__version__,
            "scipy": scipy.__version__,
            "python": platform.python_version(),
        },
        "machine": machine(),
        "load": os.getloadavg(),
        "cores": os.cpu_count(),
        "limits": limits(),
    }
    console.print(results)
    for name, task in tasks.items():
        if args.only and args.only not in name:
            continue
        results[name] = task()
        show(console, name, results[name])
    results["limits at the end"] = limits()
    if not args.only:
        folder = HERE / "results"
        folder.mkdir(exist_ok=True)
        (folder / f"{time.strftime('%Y-%m-%d')}.json").write_text(json.dumps(results, indent=1) + "\n")


if __name__ == "__main__":
    main()
