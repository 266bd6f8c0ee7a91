"""garrison-mpi, where it was built (GARRISON_BUILD_MPI) and mpirun is installed: the same file, the same bits."""

import os
import re
import shutil
import signal
import subprocess
import time
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT
from garrison import drivers
from garrison.scenario.reader import read_scenario
from scipy.io import netcdf_file

_BUILT = sorted(ROOT.glob("build/*/src/mpi/garrison-mpi"), key=lambda path: path.stat().st_mtime)
_PROGRAM = str(_BUILT[-1]) if _BUILT else shutil.which("garrison-mpi")
_MPIRUN = shutil.which("mpirun")
pytestmark = pytest.mark.skipif(
    _PROGRAM is None or _MPIRUN is None, reason="garrison-mpi was not built, or mpirun is not installed"
)
# One machine, processes that share its cores, and no network.
_ENVIRONMENT = {
    **os.environ,
    "OMPI_ALLOW_RUN_AS_ROOT": "1",
    "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
    "OMPI_MCA_btl": "self,vader",
    "OMPI_MCA_rmaps_base_oversubscribe": "1",
    "OMPI_MCA_mpi_yield_when_idle": "1",
}
_FILTERS = {
    "saturation": "threshold = 0.3\nrounds = 4\nstep = 0.1",
    "saturation with detector": "threshold = 0.5\nrounds = 12\nattacked = 2\ninitial_error = 4.0\ndetector = true",
    "scalar_gain": "rounds = 3\nstep = 0.1",
    "rdkf": "weight = 0.5",
    "partial_sharing": "gain = 0.1\nshared = 1",
    "structural": "",
}
_TROUBLE = """
[link]
drop = 0.1
delay = 0.05

[[attack]]
kind = "forge"
agents = [4, 9]
start = 3
offset = 0.4
"""


def _scenario(folder: Path, label: str, trouble: str, steps: int = 9) -> Path:
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
{_FILTERS[label]}

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


def _mpi(ranks: int, *words: object) -> subprocess.CompletedProcess[str]:
    command = [str(_MPIRUN), "-n", str(ranks), str(_PROGRAM), *map(str, words)]
    return subprocess.run(command, env=_ENVIRONMENT, capture_output=True, text=True, timeout=120)


@pytest.mark.parametrize("trouble", ["", _TROUBLE], ids=["perfect", "faults"])
@pytest.mark.parametrize("label", _FILTERS)
def test_any_number_of_ranks_writes_the_estimates_of_simulate(label: str, trouble: str, tmp_path: Path) -> None:
    path = _scenario(tmp_path, label, trouble)
    plain = read_scenario(path)
    (_, filter), *_ = plain.filters
    assert filter is not None
    expected = drivers.simulate(
        plain.model, plain.network, filter, attack=plain.attacks, link=plain.link, noise=plain.noise, **plain.run
    ).estimate
    files = []
    for ranks, halo in ((1, 1), (2, 1), (3, 1), (2, 4), (3, 2)):
        out = tmp_path / f"{ranks}-{halo}.nc"
        done = _mpi(ranks, "run", path, "-o", out, "--halo", halo)
        assert done.returncode == 0, done.stderr
        files.append(out.read_bytes())
    assert all(file == files[0] for file in files)
    with netcdf_file(str(tmp_path / "3-2.nc"), mmap=False) as results:
        got = results.variables["estimate"][:].astype(float)
        errors = np.linalg.norm(got - results.variables["truth"][:][:, None, :], axis=2)
        np.testing.assert_array_equal(results.variables["error_largest"][:], errors.max(axis=1))
        median = np.sort(errors, axis=1)[:, 7]
        assert np.all(results.variables["error_median"][:] >= median * (1 - 1e-9))
        assert np.all(results.variables["error_median"][:] <= median * 1.0101)
    assert np.array_equal(got, np.asarray(expected).reshape(10, 16, 2)[1:])


def test_a_killed_rank_ends_the_job_and_three_ranks_go_on(tmp_path: Path) -> None:
    path = _scenario(tmp_path, "saturation", _TROUBLE, steps=3000)
    whole, out = tmp_path / "whole.nc", tmp_path / "out.nc"
    assert _mpi(2, "run", path, "-o", whole).returncode == 0
    latest = Path(f"{out}.checkpoint/latest")
    command = [str(_MPIRUN), "-n", "2", str(_PROGRAM), "run", str(path), "-o", str(out), "--checkpoint", "50"]
    with subprocess.Popen(command, env=_ENVIRONMENT, stderr=subprocess.PIPE, text=True) as job:
        while not latest.exists() and job.poll() is None:
            time.sleep(0.01)
        ranks = subprocess.run(["pgrep", "-P", str(job.pid)], capture_output=True, text=True).stdout.split()
        os.kill(int(ranks[-1]), signal.SIGKILL)
        _, words = job.communicate(timeout=60)
    assert job.returncode != 0
    assert re.search(r"the checkpoint of sample \d+ is whole", words)
    assert words.count("--resume") == 1
    with netcdf_file(str(out), mmap=False) as results:  # what was written can be read
        assert results.variables["time"][:].tolist() == list(range(1, len(results.variables["time"][:]) + 1))
    resumed = _mpi(3, "run", path, "-o", out, "--checkpoint", "50", "--resume", "--halo", "3")
    assert resumed.returncode == 0, resumed.stderr
    assert out.read_bytes() == whole.read_bytes()


@pytest.mark.parametrize(
    ("change", "words", "message"),
    [
        (("rows = 4\ncolumns = 4", "rows = 1\ncolumns = 2"), [], "16 rows, expected 2, one per agent"),
        (('"saturation"', '"platoon"'), [], "expected a filter that runs on many ranks: saturation, scalar_gain"),
        (("step = 0.1", "stepp = 0.1"), [], 'did you mean "step"?'),
        (
            ('kind = "bias"\nagents = [2, 7]\nstart = 2\nvalue', 'kind = "stealthy"\nagents = [2]\nfraction'),
            [],
            "does not depend on the filter",
        ),
        (("steps = 9", "steps = 0"), [], "a whole number in 1.."),
        (("agents = [2, 7]", "agents = [2, 99]"), [], "ids in 0..15"),
        (("", ""), ["-o", "{folder}/no/such/folder/out.nc"], "no/such/folder/out.nc"),
        (("", ""), ["-o", "{folder}/there.nc"], "which exists"),
        (("", ""), ["-o", "{folder}/there.nc", "--resume"], "there.nc"),
        (("", ""), ["--resume"], "-o"),
        (("", ""), ["--ranks", "2"], "one SCENARIO"),
        (("", ""), ["--halo", "0"], "--halo"),
        (("", ""), ["--halo"], "a value"),
    ],
)
def test_bad_input_is_told_once_and_ends_every_rank_with_2(
    change: tuple[str, str], words: list[str], message: str, tmp_path: Path
) -> None:
    path = _scenario(tmp_path, "saturation", "")
    path.write_text(path.read_text().replace(*change, 1))
    (tmp_path / "there.nc").write_text("no netCDF")
    done = _mpi(2, "run", path, *(word.format(folder=tmp_path) for word in words))
    assert done.returncode == 2
    told = [line for line in done.stderr.splitlines() if line.startswith("garrison-mpi:")]
    assert len(told) == 1
    assert message in told[0]


def test_more_ranks_than_agents_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "two.toml"
    path.write_text(
        '[model]\nA = [[1.0]]\nC = [[1.0], [1.0]]\n[network]\nkind = "path"\nagents = 2\n'
        '[filter]\nname = "scalar_gain"\nrounds = 1\nstep = 0.3\n[run]\nsteps = 1\n'
    )
    assert _mpi(2, "run", path).returncode == 0
    done = _mpi(3, "run", path)
    assert done.returncode == 2
    assert "got 3, expected at most 2, one per agent" in done.stderr
