"""garrison-mpi spectrum, where it was built and mpirun is installed."""

import re
from pathlib import Path

import garrison as gr
import pytest
from mpi_jobs import NEEDED, mpi

pytestmark = NEEDED


def _network(folder: Path, agents: int, radius: float) -> Path:
    path = folder / f"geometric{agents}.toml"
    path.write_text(f"""[model]
A = [[1.0]]
rows = "unit"
process_bound = 0.01
measurement_bound = 0.05

[network]
kind = "random_geometric"
agents = {agents}
radius = {radius}
seed = 1

[filter]
name = "scalar_gain"
rounds = 3
step = 0.03

[run]
steps = 2
x0 = [1.0]
""")
    return path


def test_the_spectrum_is_that_of_the_network_with_the_same_digits_on_any_ranks(tmp_path):
    path = _network(tmp_path, 500, 0.1)
    lines = [mpi(ranks, "spectrum", path).stdout.splitlines()[1:] for ranks in (1, 2, 3)]
    assert len(lines[0]) == 3
    assert lines[0] == lines[1] == lines[2]
    low, high, step = (
        float(
            re.findall(r"[\d.]+(?:e-\d+)?", line.split(" = ")[-1].removeprefix("lambda_2").removeprefix("lambda_max"))[
                0
            ]
        )
        for line in lines[0]
    )
    expected = gr.Network.random_geometric(500, 0.1, seed=1).laplacian_spectrum()
    assert low == pytest.approx(expected[0], rel=1e-3)
    assert high == pytest.approx(expected[1], rel=1e-5)
    assert step == pytest.approx(2.0 / (expected[0] + expected[1]), rel=1e-5)


def test_too_few_products_are_told(tmp_path):
    done = mpi(2, "spectrum", _network(tmp_path, 500, 0.1), "--products", "10")
    assert done.returncode == 1
    assert "not settled after 10 products" in done.stdout
    assert "Certainly stable" in done.stdout


def test_what_has_no_spectrum_of_use_is_refused(tmp_path):
    done = mpi(2, "spectrum", _network(tmp_path, 500, 0.01))
    assert done.returncode == 2
    assert done.stderr.count("not connected") == 1
    done = mpi(2, "spectrum", _network(tmp_path, 500, 0.1), "--products", "none")
    assert done.returncode == 2
    assert done.stderr.count("--products") == 1


def test_slepc_that_is_not_built_in_is_refused_once(tmp_path):
    done = mpi(3, "spectrum", _network(tmp_path, 500, 0.1), "--slepc")
    if done.returncode == 0:
        pytest.skip("SLEPc is built in")
    assert done.returncode == 2
    assert done.stderr.count("garrison-mpi: --slepc") == 1
