"""garrison-mpi: the same file, the same bits, on any number of ranks."""

import subprocess
from pathlib import Path

import documents
import garrison
import numpy as np
import pytest
from conftest import ROOT
from garrison import drivers
from garrison.scenario.reader import read_scenario
from mpi_jobs import ENVIRONMENT, FILTERS, NEEDED, PROGRAM, TROUBLE, mpi, reading_scenario, scenario, write_inputs
from scipy.io import netcdf_file

pytestmark = NEEDED


@pytest.mark.parametrize("trouble", ["", TROUBLE], ids=["perfect", "faults"])
@pytest.mark.parametrize("label", FILTERS)
def test_any_number_of_ranks_writes_the_estimates_of_simulate(label: str, trouble: str, tmp_path: Path) -> None:
    path = scenario(tmp_path, label, trouble)
    plain = read_scenario(path)
    (_, filter), *_ = plain.filters
    assert filter is not None
    expected = drivers.simulate(
        plain.model, plain.network, filter, attack=plain.attacks, link=plain.link, noise=plain.noise, **plain.run
    ).estimate
    files = []
    for ranks, halo in ((1, 1), (2, 1), (3, 1), (2, 4), (3, 2)):
        out = tmp_path / f"{ranks}-{halo}.nc"
        done = mpi(ranks, "run", path, "-o", out, "--halo", halo)
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


@pytest.mark.parametrize("filter", ["saturation", "rdkf"])
def test_networks_and_sensors_read_by_rank_run_as_those_of_one_process(filter: str, tmp_path: Path) -> None:
    write_inputs(tmp_path / "in.nc")
    path = reading_scenario(tmp_path, filter, TROUBLE)
    with netcdf_file(str(tmp_path / "in.nc"), mmap=False) as inputs:
        given = {name: variable[:].astype(float) for name, variable in inputs.variables.items()}
    model = garrison.Model(
        [[0.99, 0.05], [-0.05, 0.99]],
        given["C"],
        process_bound=0.01,
        measurement_bound=given["measurement_bound"],
        process_covariance=0.0004,
        measurement_covariance=given["measurement_covariance"].reshape(-1, 1, 1),
    )
    network = garrison.Network(given["edges"].astype(int).tolist())
    inline = scenario(tmp_path, filter, TROUBLE)
    text = inline.read_text()
    attacked = text.index("[[attack]]")  # on measurements, which the other file has not
    inline.write_text(text[:attacked] + TROUBLE)
    plain = read_scenario(inline)
    (_, one), *_ = plain.filters
    assert one is not None
    expected = drivers.simulate(
        model, network, one, steps=9, seed=3, x0=[1.0, -2.0], attack=plain.attacks, link=plain.link, noise=plain.noise
    ).estimate
    files = []
    for ranks, halo in ((1, 1), (2, 2), (3, 1)):
        out = tmp_path / f"{ranks}.nc"
        done = mpi(ranks, "run", path, "-o", out, "--halo", halo)
        assert done.returncode == 0, done.stderr
        files.append(out.read_bytes())
    assert files[0] == files[1] == files[2]
    with netcdf_file(str(tmp_path / "3.nc"), mmap=False) as results:
        got = results.variables["estimate"][:].astype(float)
    assert np.array_equal(got, np.asarray(expected).reshape(10, 40, 2)[1:])


@pytest.mark.parametrize("words", [("whole", "{path}"), ("run", "{path}", "--hash"), ("--help",)])
def test_what_cannot_be_printed_is_no_success(words: tuple[str, ...], tmp_path: Path) -> None:
    path = scenario(tmp_path, "saturation", "")
    with Path("/dev/full").open("w") as full:
        command = [str(PROGRAM), *(word.format(path=path) for word in words)]
        done = subprocess.run(command, env=ENVIRONMENT, stdout=full, stderr=subprocess.PIPE, text=True, timeout=120)
    assert done.returncode == 2
    assert "standard output: got No space left on device" in done.stderr


def test_help_is_there_behind_a_command_too() -> None:
    done = mpi(1, "run", "--help")
    assert done.returncode == 0
    assert done.stdout == mpi(1, "--help").stdout
    assert "--checkpoint" in done.stdout


_PAGE = ROOT / "docs/how-to/one-huge-network.md"


def test_the_scenarios_of_the_page_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("xarray")
    monkeypatch.chdir(tmp_path)
    documents.run(_PAGE, tmp_path)
    assert "1000 agents, 4.0 neighbours each" in mpi(2, "run", "read.toml", "-o", "read.nc").stdout
    big = Path("big.toml")
    text = big.read_text()
    for many, few in (("agents = 1000000", "agents = 10000"), ("0.00245", "0.0245"), ("steps = 1000", "steps = 20")):
        assert many in text
        text = text.replace(many, few)
    big.write_text(text)
    done = mpi(2, "run", "big.toml", "-o", "big-run.nc", "--checkpoint", "10")
    assert done.returncode == 0, done.stderr
    with netcdf_file("big-run.nc", mmap=False) as results:
        assert results.variables["time"][:].tolist() == [10, 20]


def test_a_list_of_links_in_parquet_becomes_netcdf(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("xarray")
    pytest.importorskip("pyarrow")
    pd = pytest.importorskip("pandas")
    monkeypatch.chdir(tmp_path)
    pd.DataFrame({"weight": [1.0, 1.0], "to": [1, 2], "from": [0, 1]}).to_parquet("links.parquet")
    [block] = [b.text for b in documents.blocks(_PAGE) if "read_parquet" in b.text]
    exec(block, {})
    with netcdf_file("links.nc", mmap=False) as links:
        assert links.variables["edges"][:].tolist() == [[0, 1], [1, 2]]


def test_a_partition_that_leaves_a_rank_without_agents_is_refused_or_replaced(tmp_path: Path) -> None:
    path = tmp_path / "four.toml"
    text = (
        '[model]\nA = [[1.0]]\nrows = "unit"\n[network]\nkind = "path"\nagents = 4\n'
        '[filter]\nname = "scalar_gain"\nrounds = 1\nstep = 0.3\n[run]\nsteps = 1\n[partition]\nmethod = '
    )
    path.write_text(text + '"metis"\n')
    done = mpi(3, "run", path)
    if "without METIS" in done.stderr:
        pytest.skip("METIS is not built in")
    assert done.returncode == 2
    assert done.stderr.count("garrison-mpi: partition (METIS): got no agent on rank") == 1
    assert "expected 1 to 2 agents on every rank" in done.stderr
    path.write_text(text + '"auto"\n')
    done = mpi(3, "run", path)
    assert done.returncode == 0, done.stderr
    assert "(coordinates, because METIS left no agent on rank" in done.stdout
    near = 'kind = "random_geometric"\nagents = 3\nradius = 1.9\nseed = 4'
    path.write_text((text + '"auto"\n').replace('kind = "path"\nagents = 4', near))
    done = mpi(3, "run", path)
    assert done.returncode == 0, done.stderr
    assert "at most 1 agents on one" in done.stdout


def test_a_partition_that_cannot_be_kept_does_not_end_the_run(tmp_path: Path) -> None:
    path = scenario(tmp_path, "scalar_gain", "")
    Path(f"{path}.2.partition.new").mkdir()
    done = mpi(2, "run", path)
    assert done.returncode == 0, done.stderr
    assert "not kept: " in done.stdout
    alone = mpi(1, "partition", path, "--ranks", "2")
    assert alone.returncode == 2
    assert alone.stderr.count("garrison-mpi: ") == 1
