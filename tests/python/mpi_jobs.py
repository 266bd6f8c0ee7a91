"""Jobs of garrison-mpi, where it was built (GARRISON_BUILD_MPI) and mpirun is installed, and what they read."""

import os
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT
from scipy.io import netcdf_file

_BUILT = sorted(ROOT.glob("build/*/src/mpi/garrison-mpi"), key=lambda path: path.stat().st_mtime)
PROGRAM = str(_BUILT[-1]) if _BUILT else shutil.which("garrison-mpi")
MPIRUN = shutil.which("mpirun")
#: of every test of it
NEEDED = pytest.mark.skipif(
    PROGRAM is None or MPIRUN is None, reason="garrison-mpi was not built, or mpirun is not installed"
)
# One machine, processes that share its cores, and no network.
ENVIRONMENT = {
    **os.environ,
    "OMPI_ALLOW_RUN_AS_ROOT": "1",
    "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
    "OMPI_MCA_btl": "self,vader",
    "OMPI_MCA_rmaps_base_oversubscribe": "1",
    "OMPI_MCA_mpi_yield_when_idle": "1",
    "GARRISON_MEMORY_GB": "8",
}
FILTERS = {
    "saturation": "threshold = 0.3\nrounds = 4\nstep = 0.1",
    "saturation with detector": "threshold = 0.5\nrounds = 12\nattacked = 2\ninitial_error = 4.0\ndetector = true",
    "scalar_gain": "rounds = 3\nstep = 0.1",
    "rdkf": "weight = 0.5",
    "partial_sharing": "gain = 0.1\nshared = 1",
    "structural": "",
}
TROUBLE = """
[link]
drop = 0.1
delay = 0.05

[[attack]]
kind = "forge"
agents = [4, 9]
start = 3
offset = 0.4
"""


def scenario(folder: Path, label: str, trouble: str, steps: int = 9) -> Path:
    angles = np.arange(16) * 0.4
    rows = np.column_stack([np.cos(angles), np.sin(angles)])
    path = folder / f"{label.replace(' ', '_')}.toml"
    path.write_text(
        f"""[model]
A = [[0.99, 0.05], [-0.05, 0.99]]
C = {rows.tolist()}
process_bound = 0.01
measurement_bound = 0.02
process_covariance = 0.0004
measurement_covariance = 0.01

[network]
kind = "grid"
rows = 4
columns = 4

[filter]
name = "{label.split()[0]}"
{FILTERS[label]}

[run]
steps = {steps}
seed = 3
x0 = [1.0, -2.0]
start_error = 0.1

[[attack]]
kind = "bias"
agents = [2, 7]
start = 2
value = 3.0
{trouble}"""
    )
    return path


def mpi(ranks: int, *words: object) -> subprocess.CompletedProcess[str]:
    command = [str(MPIRUN), "-n", str(ranks), str(PROGRAM), *map(str, words)]
    return subprocess.run(command, env=ENVIRONMENT, capture_output=True, text=True, timeout=120)


def write_inputs(path: Path, **other: np.ndarray) -> None:
    """The agents and links of `reading_scenario`, as any netCDF library writes them."""
    rng = np.random.default_rng(5)
    tree = [(rng.integers(0, i), i) for i in range(1, 40)]
    variables = {
        "edges": np.array([*tree, *tree[:5], (3, 30), (30, 3), (8, 21)], np.int32),
        "C": rng.normal(size=(40, 2)),
        "measurement_bound": np.full(40, 0.02) + 0.001 * np.arange(40),
        "measurement_covariance": np.full(40, 0.01) + 0.001 * np.arange(40),
    } | other
    with netcdf_file(str(path), "w") as out:
        for name, values in variables.items():
            for axis, size in enumerate(values.shape):
                out.createDimension(f"{name}_{axis}", size)
            kind = values.dtype.char.replace("S", "c")
            dimensions = tuple(f"{name}_{axis}" for axis in range(values.ndim))
            out.createVariable(name, kind, dimensions)[:] = values


def reading_scenario(folder: Path, filter: str, trouble: str = "") -> Path:
    path = folder / "read.toml"
    path.write_text(
        f"""[model]
A = [[0.99, 0.05], [-0.05, 0.99]]
C = {{ file = "in.nc" }}
process_bound = 0.01
process_covariance = 0.0004
measurement_bound = {{ file = "in.nc" }}
measurement_covariance = {{ file = "in.nc" }}

[network]
agents = 40
edges = {{ file = "in.nc" }}

[filter]
name = "{filter}"
{FILTERS[filter]}

[run]
steps = 9
seed = 3
x0 = [1.0, -2.0]
{trouble}"""
    )
    return path
