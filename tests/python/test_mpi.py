"""garrison-mpi, where it was built (GARRISON_BUILD_MPI) and mpirun is installed: the same file, the same bits."""

import os
import re
import shutil
import signal
import subprocess
import time
from pathlib import Path

import documents
import garrison
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
    "GARRISON_MEMORY_GB": "8",
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


def _inputs(path: Path, **other: np.ndarray) -> None:
    """The agents and links of `_read_scenario`, as any netCDF library writes them."""
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


def _read_scenario(folder: Path, filter: str, trouble: str = "") -> Path:
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
{_FILTERS[filter]}

[run]
steps = 9
seed = 3
x0 = [1.0, -2.0]
{trouble}"""
    )
    return path


@pytest.mark.parametrize("filter", ["saturation", "rdkf"])
def test_networks_and_sensors_read_by_rank_run_as_those_of_one_process(filter: str, tmp_path: Path) -> None:
    _inputs(tmp_path / "in.nc")
    path = _read_scenario(tmp_path, filter, _TROUBLE)
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
    inline = _scenario(tmp_path, filter, _TROUBLE)
    text = inline.read_text()
    attacked = text.index("[[attack]]")  # on measurements, which the other file has not
    inline.write_text(text[:attacked] + _TROUBLE)
    plain = read_scenario(inline)
    (_, one), *_ = plain.filters
    assert one is not None
    expected = drivers.simulate(
        model, network, one, steps=9, seed=3, x0=[1.0, -2.0], attack=plain.attacks, link=plain.link, noise=plain.noise
    ).estimate
    files = []
    for ranks, halo in ((1, 1), (2, 2), (3, 1)):
        out = tmp_path / f"{ranks}.nc"
        done = _mpi(ranks, "run", path, "-o", out, "--halo", halo)
        assert done.returncode == 0, done.stderr
        files.append(out.read_bytes())
    assert files[0] == files[1] == files[2]
    with netcdf_file(str(tmp_path / "3.nc"), mmap=False) as results:
        got = results.variables["estimate"][:].astype(float)
    assert np.array_equal(got, np.asarray(expected).reshape(10, 40, 2)[1:])


@pytest.mark.parametrize(
    ("inputs", "message"),
    [
        (None, "No such file"),
        (b"agent,C\n0,1\n", "something else, expected a netCDF file in a classic form"),
        (b"\x89HDF\r\n\x1a\n" + bytes(500), "HDF5 (netCDF-4)"),
        (60, "expected a netCDF file in a classic form"),
        (-8, "cut short"),
        ({"C": np.ones((40, 3))}, "40 x 3 numbers, expected 40 x 2, a row per agent"),
        ({"C": np.ones((39, 2))}, "39 x 2 numbers, expected 40 x 2"),
        ({"C": np.array([[1.0, 0.0]] * 39 + [[0.0, np.inf]])}, "agent 39: got inf, expected a finite number"),
        ({"C": np.array([[1.0, 0.0]] * 39 + [[0.0, 2.0**123 * 0.9375]])}, "agent 39: got nan"),  # never written
        ({"measurement_bound": np.full(40, -1.0)}, "expected a finite number >= 0"),
        ({"measurement_bound": np.ones((40, 1))}, "40 x 1 numbers, expected 40, one per agent"),
        ({"edges": np.array([[0, 1, 2]], np.int32)}, "1 x 3 numbers, expected edges x 2"),
        ({"edges": np.array([[0.0, 1.5]])}, "floating-point numbers, expected whole ones"),
        ({"edges": np.zeros((0, 2), np.int32)}, "no numbers, expected at least one row"),
        ({"edges": np.array([[0, 1], [1, 40]], np.int32)}, "row 1: got (1, 40), expected two different agents"),
        ({"edges": np.array([[0, 1], [5, 5]], np.int32)}, "row 1: got (5, 5)"),
        ({"edges": np.array([[0, 1], [2, 3]], np.int32)}, "not connected"),
        ({"edges": np.array([[b"a", b"b"]], "c")}, "text, expected numbers"),
        ("variable", 'no variable "K", expected one; it has'),
        ("key", 'did you mean "file"'),
        ("empty", '[C].file: got "", expected the path of a netCDF file'),
    ],
)
def test_a_file_that_does_not_fit_is_told_once_and_ends_every_rank_with_2(
    inputs: bytes | int | str | dict[str, np.ndarray] | None, message: str, tmp_path: Path
) -> None:
    file = tmp_path / "in.nc"
    path = _read_scenario(tmp_path, "saturation")
    _inputs(file, **(inputs if isinstance(inputs, dict) else {}))
    if inputs is None:
        file.unlink()
    elif isinstance(inputs, bytes):
        file.write_bytes(inputs)
    elif isinstance(inputs, int):
        file.write_bytes(file.read_bytes()[:inputs])
    elif isinstance(inputs, str):
        change = {"variable": 'file = "in.nc", variable = "K"', "key": 'fil = "in.nc"', "empty": 'file = ""'}[inputs]
        path.write_text(path.read_text().replace('file = "in.nc"', change, 1))
    done = _mpi(3, "run", path)
    assert done.returncode == 2, done.stderr
    told = [line for line in done.stderr.splitlines() if line.startswith("garrison-mpi:")]
    assert len(told) == 1
    assert message in told[0]


def test_values_that_say_missing_are_refused(tmp_path: Path) -> None:
    _inputs(tmp_path / "in.nc", C=np.array([[1.0, 0.0]] * 39 + [[0.0, -999.0]]))
    with netcdf_file(str(tmp_path / "in.nc"), "a") as inputs:
        inputs.variables["C"]._FillValue = -999.0
    done = _mpi(2, "run", _read_scenario(tmp_path, "saturation"))
    assert done.returncode == 2
    assert 'variable "C", agent 39: got nan, expected a finite number' in done.stderr
    _inputs(tmp_path / "in.nc", edges=np.array([[k, k + 1] for k in range(39)], np.int32))
    with netcdf_file(str(tmp_path / "in.nc"), "a") as inputs:
        inputs.variables["edges"].missing_value = np.array([-1, 7], np.int32)
    done = _mpi(2, "run", _read_scenario(tmp_path, "saturation"))
    assert done.returncode == 2
    assert '"edges", row 6: got 7, which its _FillValue or missing_value says is missing' in done.stderr


@pytest.mark.parametrize("name", ["in.nc", "scenario"])
def test_a_pipe_that_nobody_writes_into_is_not_waited_for(name: str, tmp_path: Path) -> None:
    _inputs(tmp_path / "in.nc")
    path = _read_scenario(tmp_path, "saturation")
    pipe = path if name == "scenario" else tmp_path / name
    pipe.unlink()
    os.mkfifo(pipe)
    done = _mpi(2, "run", path)
    assert done.returncode == 2
    assert done.stderr.count("got no plain file, expected") == 1


def test_a_full_disk_ends_the_run_and_what_was_written_is_whole(tmp_path: Path) -> None:
    namespace = ["unshare", "--map-root-user", "--mount", "sh", "-c"]
    disk = tmp_path / "disk"
    disk.mkdir()
    mount = f"mount -t tmpfs -o size=256k tmpfs '{disk}'"
    if subprocess.run([*namespace, mount], capture_output=True).returncode != 0:
        pytest.skip("no disks of our own here")
    path = _scenario(tmp_path, "scalar_gain", "", steps=2000)  # 300 bytes per sample
    whole, part = tmp_path / "whole.nc", tmp_path / "part.nc"
    assert _mpi(2, "run", path, "-o", whole).returncode == 0
    run = f"'{_MPIRUN}' -n 2 '{_PROGRAM}' run '{path}' -o '{disk}/out.nc'"
    script = f"{mount} && {run}; code=$?; cp '{disk}/out.nc' '{part}'; exit $code"
    done = subprocess.run([*namespace, script], env=_ENVIRONMENT, capture_output=True, text=True, timeout=120)
    assert done.returncode == 2
    assert done.stderr.count("got No space left on device, expected room for") == 1
    assert "pwritev" not in done.stderr  # nobody wrote where no room was
    with netcdf_file(str(part), mmap=False) as got, netcdf_file(str(whole), mmap=False) as expected:
        samples = got.variables["time"][:].size
        assert 100 < samples < 1000
        for name in ("time", "truth", "error_q95", "estimate"):
            assert np.array_equal(got.variables[name][:], expected.variables[name][:samples])


def test_a_part_of_a_checkpoint_that_was_changed_is_refused(tmp_path: Path) -> None:
    path = _scenario(tmp_path, "scalar_gain", "")
    words = ("run", path, "-o", tmp_path / "out.nc", "--checkpoint", "4")
    assert _mpi(2, *words).returncode == 0
    part = tmp_path / "out.nc.checkpoint" / "sample-8.1-of-2"
    content = bytearray(part.read_bytes())
    content[20] ^= 4
    part.write_bytes(content)
    done = _mpi(3, *words, "--resume")
    assert done.returncode == 2
    told = [line for line in done.stderr.splitlines() if line.startswith("garrison-mpi:")]
    assert "sample-8.1-of-2: got a file that was cut or changed" in told[0]
    assert "start without --resume" in told[0]


def test_a_run_is_not_gone_on_with_after_its_inputs_changed(tmp_path: Path) -> None:
    _inputs(tmp_path / "in.nc")
    path = _read_scenario(tmp_path, "saturation")
    words = ("run", path, "-o", tmp_path / "out.nc", "--checkpoint", "3")
    assert _mpi(2, *words).returncode == 0
    _inputs(tmp_path / "in.nc", C=np.ones((40, 2)))
    done = _mpi(2, *words, "--resume")
    assert done.returncode == 2
    assert "another scenario" in done.stderr
    assert done.stdout == ""  # before the network was cut


def test_a_killed_rank_ends_the_job_and_three_ranks_go_on(tmp_path: Path) -> None:
    folder = tmp_path / "it's here"  # the command to go on can be pasted whatever the paths
    folder.mkdir()
    path = _scenario(folder, "saturation", _TROUBLE, steps=3000)
    whole, out = folder / "whole.nc", folder / "out.nc"
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
    assert not Path(f"{out}.ended").exists()
    with netcdf_file(str(out), mmap=False) as results:  # what was written can be read
        assert results.variables["time"][:].tolist() == list(range(1, len(results.variables["time"][:]) + 1))
    [line] = re.findall(r"^  (mpirun .*--resume)$", words, flags=re.M)
    pasted = line.replace("-n 2", "-n 3") + " --halo 3"
    resumed = subprocess.run(pasted, shell=True, env=_ENVIRONMENT, capture_output=True, text=True, timeout=120)
    assert resumed.returncode == 0, resumed.stderr
    assert out.read_bytes() == whole.read_bytes()


def test_states_with_sets_of_agents_go_on_on_another_number_of_ranks(tmp_path: Path) -> None:
    path = _scenario(tmp_path, "structural", "")
    angles = np.arange(144) * 0.4
    rows = np.column_stack([np.cos(angles), np.sin(angles)]).tolist()
    text = re.sub(r"^C = .*$", f"C = {rows}", path.read_text(), flags=re.M)
    path.write_text(text.replace("rows = 4\ncolumns = 4", "rows = 12\ncolumns = 12"))
    words = ("run", path, "-o", tmp_path / "out.nc", "--checkpoint", "5")
    assert _mpi(1, *words).returncode == 0
    whole = (tmp_path / "out.nc").read_bytes()
    resumed = _mpi(3, *words, "--resume")
    assert resumed.returncode == 0, resumed.stderr
    assert "checkpoint of sample 5" in resumed.stdout
    assert (tmp_path / "out.nc").read_bytes() == whole


@pytest.mark.parametrize(
    ("change", "words", "message"),
    [
        (("rows = 4\ncolumns = 4", "rows = 1\ncolumns = 2"), [], "16 rows, expected 2, one per agent"),
        (
            ('"saturation"', '"platoon"'),
            [],
            '[filter].name: got "platoon", expected a filter that runs on many ranks: saturation, scalar_gain',
        ),
        (("threshold = 0.3", ""), [], "saturation.threshold: got no value"),
        (("step = 0.1", "stepp = 0.1"), [], 'did you mean "step"?'),
        (
            ('kind = "bias"\nagents = [2, 7]\nstart = 2\nvalue', 'kind = "stealthy"\nagents = [2]\nfraction'),
            [],
            "does not depend on the filter",
        ),
        (("steps = 9", "steps = 0"), [], "a whole number in 1.."),
        (("steps = 9", "steps = 1e1"), [], "got 10, written as a decimal, expected a whole number in 1.."),
        (('kind = "grid"\n', ""), [], "[network].kind: got neither kind nor edges"),
        (("[run]", '[noise]\nlaw = "norma"\n[run]'), [], 'did you mean "normal"?'),
        (("value = 3.0", ""), [], "[attack].kind: bias.value: got no value"),
        (
            ('kind = "bias"\nagents = [2, 7]\nstart = 2\nvalue = 3.0', 'kind = "outdated"\nagents = [2]\nage = 2'),
            ["-o", "{folder}/new.nc", "--checkpoint", "3"],
            "cannot be gone on with",
        ),
        (("", ""), ["-o", "/dev/null", "--force"], "no plain file, expected a file"),
        (("[run]", "[link]\ndelay_rounds = 2\n[run]"), [], "[link].delay_rounds: got a delay without its probability"),
        (('kind = "bias"', 'kind = "bais"'), [], 'did you mean "bias"?'),
        (("[run]", "[output]\nevery = 10\n[run]"), [], "got 10, expected at most 9, [run].steps"),
        (('"grid"', '"complete"'), [], 'got "complete", expected one of grid'),
        (
            ('kind = "grid"\nrows = 4\ncolumns = 4', 'kind = "ring"\nagents = 2000000000'),
            [],
            "[network].agents: got 2000000000, which takes",
        ),
        (
            ('kind = "grid"\nrows = 4\ncolumns = 4', 'kind = "random_geometric"\nagents = 1000000\nradius = 0.1'),
            [],
            "[network].radius: got 0.1, some 28799 neighbours each, which takes",
        ),
        (
            ('kind = "grid"\nrows = 4\ncolumns = 4', 'kind = "band"\nagents = 1000000\nrange = 100000'),
            [],
            "[network].range: got 100000, some 200000 neighbours each, which takes",
        ),
        (
            ("rows = 4\ncolumns = 4", "rows = 1000000\ncolumns = 1000000"),
            [],
            "1000000 x 1000000 agents, which takes",
        ),
        (("agents = [2, 7]", "agents = [2, 99]"), [], "ids in 0..15"),
        (("", ""), ["-o", "{folder}/no/such/folder/out.nc"], "make the folder {folder}/no/such/folder"),
        (("", ""), ["-o", "{folder}", "--force"], "a folder, expected a file"),
        (("", ""), ["-o", ""], "-o: got nothing behind it"),
        (("", ""), ["-o", "--hash"], "-o: got nothing behind it"),
        (("", ""), ["-o", "{folder}/new.nc", "--resume"], "new.nc, which is not there"),
        (("", ""), ["-o", "{folder}/new.nc", "--checkpoint", "10"], "got 10, expected at most 9, the steps"),
        (("", ""), ["-o", "{folder}/barred.nc", "--checkpoint", "3"], "barred.nc.checkpoint: got a file"),
        (("", ""), ["-o", "{folder}/there.nc"], "which exists"),
        (("", ""), ["-o", "{folder}/there.nc", "--resume"], "expected the results that are gone on with"),
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
    (tmp_path / "barred.nc.checkpoint").write_text("no folder")
    done = _mpi(2, "run", path, *(word.format(folder=tmp_path) for word in words))
    assert done.returncode == 2
    told = [line for line in done.stderr.splitlines() if line.startswith("garrison-mpi:")]
    assert len(told) == 1
    assert message.format(folder=tmp_path) in told[0]
    assert done.stdout == ""  # before anything was done, which takes minutes for huge networks


@pytest.mark.parametrize("family", ["rdkf", "partial_sharing"])
def test_what_a_design_asks_of_the_model_is_refused_before_the_partition(family: str, tmp_path: Path) -> None:
    path = _scenario(tmp_path, family, "")
    path.write_text(path.read_text().replace("process_covariance = 0.0004", ""))
    done = _mpi(2, "run", path)
    assert done.returncode == 2
    assert done.stderr.count("garrison-mpi: process_covariance") == 1
    assert done.stdout == ""


@pytest.mark.parametrize("words", [("whole", "{path}"), ("run", "{path}", "--hash"), ("--help",)])
def test_what_cannot_be_printed_is_no_success(words: tuple[str, ...], tmp_path: Path) -> None:
    path = _scenario(tmp_path, "saturation", "")
    with Path("/dev/full").open("w") as full:
        command = [str(_PROGRAM), *(word.format(path=path) for word in words)]
        done = subprocess.run(command, env=_ENVIRONMENT, stdout=full, stderr=subprocess.PIPE, text=True, timeout=120)
    assert done.returncode == 2
    assert "standard output: got No space left on device" in done.stderr


def test_help_is_there_behind_a_command_too() -> None:
    done = _mpi(1, "run", "--help")
    assert done.returncode == 0
    assert done.stdout == _mpi(1, "--help").stdout
    assert "--checkpoint" in done.stdout


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


def test_a_checkpoint_of_an_earlier_run_is_forgotten(tmp_path: Path) -> None:
    path = _scenario(tmp_path, "scalar_gain", "")
    out = tmp_path / "out.nc"
    assert _mpi(2, "run", path, "-o", out, "--checkpoint", "4").returncode == 0
    out.unlink()
    assert _mpi(2, "run", path, "-o", out).returncode == 0  # writes none
    done = _mpi(2, "run", path, "-o", out, "--resume")
    assert done.returncode == 2
    assert "run with --checkpoint and --force first" in done.stderr
    assert "the job was ended" not in done.stderr


def test_results_that_were_cut_are_not_gone_on_with(tmp_path: Path) -> None:
    path = _scenario(tmp_path, "scalar_gain", "", steps=30)
    out = tmp_path / "out.nc"
    assert _mpi(2, "run", path, "-o", out, "--checkpoint", "20").returncode == 0
    whole = out.read_bytes()
    out.write_bytes(whole[: len(whole) // 2])
    done = _mpi(3, "run", path, "-o", out, "--resume")
    assert done.returncode == 2
    assert "do not hold all samples up to 20" in done.stderr
    out.write_bytes(whole)
    assert _mpi(3, "run", path, "-o", out, "--resume").returncode == 0
    assert out.read_bytes() == whole


def test_results_do_not_take_the_place_of_what_is_read(tmp_path: Path) -> None:
    path = _scenario(tmp_path, "scalar_gain", "")
    text = path.read_text()
    done = _mpi(2, "run", path, "-o", path, "--force")
    assert done.returncode == 2
    assert "which this run reads" in done.stderr
    assert path.read_text() == text


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("agents = [4, 9]", "agents = [4.7]", "got 4.7, expected whole numbers of agents"),
        ("agents = [4, 9]", "agents = []", "expected the agents that are attacked"),
        ("agents = [4, 9]", "agents = [1e30]", "expected whole numbers of agents"),
        ("step = 0.1", "step = inf", "lambda_max >= 5"),
        ("step = 0.1", "step = 0.5", "lambda_max >= 5"),
    ],
)
def test_numbers_that_run_refuses_are_refused(old: str, new: str, words: str, tmp_path: Path) -> None:
    path = _scenario(tmp_path, "scalar_gain", _TROUBLE)
    assert old in path.read_text()
    path.write_text(path.read_text().replace(old, new))
    done = _mpi(2, "run", path)
    assert done.returncode == 2
    assert words in done.stderr
    assert done.stderr.count("garrison-mpi: ") == 1


_PAGE = ROOT / "docs/how-to/one-huge-network.md"


def test_the_scenarios_of_the_page_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("xarray")
    monkeypatch.chdir(tmp_path)
    documents.run(_PAGE, tmp_path)
    assert "1000 agents, 4.0 neighbours each" in _mpi(2, "run", "read.toml", "-o", "read.nc").stdout
    big = Path("big.toml")
    text = big.read_text()
    for many, few in (("agents = 1000000", "agents = 10000"), ("0.00245", "0.0245"), ("steps = 1000", "steps = 20")):
        assert many in text
        text = text.replace(many, few)
    big.write_text(text)
    done = _mpi(2, "run", "big.toml", "-o", "big-run.nc", "--checkpoint", "10")
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
    done = _mpi(3, "run", path)
    if "without METIS" in done.stderr:
        pytest.skip("METIS is not built in")
    assert done.returncode == 2
    assert done.stderr.count("garrison-mpi: partition (METIS): got no agent on rank") == 1
    assert "expected 1 to 2 agents on every rank" in done.stderr
    path.write_text(text + '"auto"\n')
    done = _mpi(3, "run", path)
    assert done.returncode == 0, done.stderr
    assert "(coordinates, because METIS left no agent on rank" in done.stdout
    near = 'kind = "random_geometric"\nagents = 3\nradius = 1.9\nseed = 4'
    path.write_text((text + '"auto"\n').replace('kind = "path"\nagents = 4', near))
    done = _mpi(3, "run", path)
    assert done.returncode == 0, done.stderr
    assert "at most 1 agents on one" in done.stdout


def test_a_partition_that_cannot_be_kept_does_not_end_the_run(tmp_path: Path) -> None:
    path = _scenario(tmp_path, "scalar_gain", "")
    Path(f"{path}.2.partition.new").mkdir()
    done = _mpi(2, "run", path)
    assert done.returncode == 0, done.stderr
    assert "not kept: " in done.stdout
    alone = _mpi(1, "partition", path, "--ranks", "2")
    assert alone.returncode == 2
    assert alone.stderr.count("garrison-mpi: ") == 1
