"""garrison-mpi: what does not fit is told once, and ends every rank with 2."""

import os
from pathlib import Path

import numpy as np
import pytest
from mpi_jobs import NEEDED, TROUBLE, mpi, reading_scenario, scenario, write_inputs
from scipy.io import netcdf_file

pytestmark = NEEDED


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
    path = reading_scenario(tmp_path, "saturation")
    write_inputs(file, **(inputs if isinstance(inputs, dict) else {}))
    if inputs is None:
        file.unlink()
    elif isinstance(inputs, bytes):
        file.write_bytes(inputs)
    elif isinstance(inputs, int):
        file.write_bytes(file.read_bytes()[:inputs])
    elif isinstance(inputs, str):
        change = {"variable": 'file = "in.nc", variable = "K"', "key": 'fil = "in.nc"', "empty": 'file = ""'}[inputs]
        path.write_text(path.read_text().replace('file = "in.nc"', change, 1))
    done = mpi(3, "run", path)
    assert done.returncode == 2, done.stderr
    told = [line for line in done.stderr.splitlines() if line.startswith("garrison-mpi:")]
    assert len(told) == 1
    assert message in told[0]


def test_values_that_say_missing_are_refused(tmp_path: Path) -> None:
    write_inputs(tmp_path / "in.nc", C=np.array([[1.0, 0.0]] * 39 + [[0.0, -999.0]]))
    with netcdf_file(str(tmp_path / "in.nc"), "a") as inputs:
        inputs.variables["C"]._FillValue = -999.0
    done = mpi(2, "run", reading_scenario(tmp_path, "saturation"))
    assert done.returncode == 2
    assert 'variable "C", agent 39: got nan, expected a finite number' in done.stderr
    write_inputs(tmp_path / "in.nc", edges=np.array([[k, k + 1] for k in range(39)], np.int32))
    with netcdf_file(str(tmp_path / "in.nc"), "a") as inputs:
        inputs.variables["edges"].missing_value = np.array([-1, 7], np.int32)
    done = mpi(2, "run", reading_scenario(tmp_path, "saturation"))
    assert done.returncode == 2
    assert '"edges", row 6: got 7, which its _FillValue or missing_value says is missing' in done.stderr


@pytest.mark.parametrize("name", ["in.nc", "scenario"])
def test_a_pipe_that_nobody_writes_into_is_not_waited_for(name: str, tmp_path: Path) -> None:
    write_inputs(tmp_path / "in.nc")
    path = reading_scenario(tmp_path, "saturation")
    pipe = path if name == "scenario" else tmp_path / name
    pipe.unlink()
    os.mkfifo(pipe)
    done = mpi(2, "run", path)
    assert done.returncode == 2
    assert done.stderr.count("got no plain file, expected") == 1


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
    path = scenario(tmp_path, "saturation", "")
    path.write_text(path.read_text().replace(*change, 1))
    (tmp_path / "there.nc").write_text("no netCDF")
    (tmp_path / "barred.nc.checkpoint").write_text("no folder")
    done = mpi(2, "run", path, *(word.format(folder=tmp_path) for word in words))
    assert done.returncode == 2
    told = [line for line in done.stderr.splitlines() if line.startswith("garrison-mpi:")]
    assert len(told) == 1
    assert message.format(folder=tmp_path) in told[0]
    assert done.stdout == ""  # before anything was done, which takes minutes for huge networks


@pytest.mark.parametrize("family", ["rdkf", "partial_sharing"])
def test_what_a_design_asks_of_the_model_is_refused_before_the_partition(family: str, tmp_path: Path) -> None:
    path = scenario(tmp_path, family, "")
    path.write_text(path.read_text().replace("process_covariance = 0.0004", ""))
    done = mpi(2, "run", path)
    assert done.returncode == 2
    assert done.stderr.count("garrison-mpi: process_covariance") == 1
    assert done.stdout == ""


def test_more_ranks_than_agents_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "two.toml"
    path.write_text(
        '[model]\nA = [[1.0]]\nC = [[1.0], [1.0]]\n[network]\nkind = "path"\nagents = 2\n'
        '[filter]\nname = "scalar_gain"\nrounds = 1\nstep = 0.3\n[run]\nsteps = 1\n'
    )
    assert mpi(2, "run", path).returncode == 0
    done = mpi(3, "run", path)
    assert done.returncode == 2
    assert "got 3, expected at most 2, one per agent" in done.stderr


def test_results_do_not_take_the_place_of_what_is_read(tmp_path: Path) -> None:
    path = scenario(tmp_path, "scalar_gain", "")
    text = path.read_text()
    done = mpi(2, "run", path, "-o", path, "--force")
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
    path = scenario(tmp_path, "scalar_gain", TROUBLE)
    assert old in path.read_text()
    path.write_text(path.read_text().replace(old, new))
    done = mpi(2, "run", path)
    assert done.returncode == 2
    assert words in done.stderr
    assert done.stderr.count("garrison-mpi: ") == 1
