"""garrison-mpi: jobs that are ended, disks that are full, and what goes on after them."""

import os
import re
import signal
import subprocess
import time
from pathlib import Path

import numpy as np
import pytest
from mpi_jobs import ENVIRONMENT, MPIRUN, NEEDED, PROGRAM, TROUBLE, mpi, reading_scenario, scenario, write_inputs
from scipy.io import netcdf_file

pytestmark = NEEDED


def test_a_full_disk_ends_the_run_and_what_was_written_is_whole(tmp_path: Path) -> None:
    namespace = ["unshare", "--map-root-user", "--mount", "sh", "-c"]
    disk = tmp_path / "disk"
    disk.mkdir()
    mount = f"mount -t tmpfs -o size=256k tmpfs '{disk}'"
    if subprocess.run([*namespace, mount], capture_output=True).returncode != 0:
        pytest.skip("no disks of our own here")
    path = scenario(tmp_path, "scalar_gain", "", steps=1200)  # 300 bytes per sample
    whole, part = tmp_path / "whole.nc", tmp_path / "part.nc"
    assert mpi(2, "run", path, "-o", whole).returncode == 0
    run = f"'{MPIRUN}' -n 2 '{PROGRAM}' run '{path}' -o '{disk}/out.nc'"
    script = f"{mount} && {run}; code=$?; cp '{disk}/out.nc' '{part}'; exit $code"
    done = subprocess.run([*namespace, script], env=ENVIRONMENT, capture_output=True, text=True, timeout=120)
    assert done.returncode == 2
    assert done.stderr.count("got No space left on device, expected room for") == 1
    assert "pwritev" not in done.stderr  # nobody wrote where no room was
    with netcdf_file(str(part), mmap=False) as got, netcdf_file(str(whole), mmap=False) as expected:
        samples = got.variables["time"][:].size
        assert 100 < samples < 1000
        for name in ("time", "truth", "error_q95", "estimate"):
            assert np.array_equal(got.variables[name][:], expected.variables[name][:samples])


def test_a_part_of_a_checkpoint_that_was_changed_is_refused(tmp_path: Path) -> None:
    path = scenario(tmp_path, "scalar_gain", "")
    words = ("run", path, "-o", tmp_path / "out.nc", "--checkpoint", "4")
    assert mpi(2, *words).returncode == 0
    part = tmp_path / "out.nc.checkpoint" / "sample-8.1-of-2"
    content = bytearray(part.read_bytes())
    content[20] ^= 4
    part.write_bytes(content)
    done = mpi(3, *words, "--resume")
    assert done.returncode == 2
    told = [line for line in done.stderr.splitlines() if line.startswith("garrison-mpi:")]
    assert "sample-8.1-of-2: got a file that was cut or changed" in told[0]
    assert "start without --resume" in told[0]


def test_a_run_is_not_gone_on_with_after_its_inputs_changed(tmp_path: Path) -> None:
    write_inputs(tmp_path / "in.nc")
    path = reading_scenario(tmp_path, "saturation")
    words = ("run", path, "-o", tmp_path / "out.nc", "--checkpoint", "3")
    assert mpi(2, *words).returncode == 0
    write_inputs(tmp_path / "in.nc", C=np.ones((40, 2)))
    done = mpi(2, *words, "--resume")
    assert done.returncode == 2
    assert "another scenario" in done.stderr
    assert done.stdout == ""  # before the network was cut


def test_a_killed_rank_ends_the_job_and_three_ranks_go_on(tmp_path: Path) -> None:
    folder = tmp_path / "it's here"  # the command to go on can be pasted whatever the paths
    folder.mkdir()
    path = scenario(folder, "saturation", TROUBLE, steps=1000)
    whole, out = folder / "whole.nc", folder / "out.nc"
    assert mpi(2, "run", path, "-o", whole).returncode == 0
    latest = Path(f"{out}.checkpoint/latest")
    command = [str(MPIRUN), "-n", "2", str(PROGRAM), "run", str(path), "-o", str(out), "--checkpoint", "20"]
    with subprocess.Popen(command, env=ENVIRONMENT, stderr=subprocess.PIPE, text=True) as job:
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
    resumed = subprocess.run(pasted, shell=True, env=ENVIRONMENT, capture_output=True, text=True, timeout=120)
    assert resumed.returncode == 0, resumed.stderr
    assert out.read_bytes() == whole.read_bytes()


def test_states_with_sets_of_agents_go_on_on_another_number_of_ranks(tmp_path: Path) -> None:
    path = scenario(tmp_path, "structural", "")
    angles = np.arange(144) * 0.4
    rows = np.column_stack([np.cos(angles), np.sin(angles)]).tolist()
    text = re.sub(r"^C = .*$", f"C = {rows}", path.read_text(), flags=re.M)
    path.write_text(text.replace("rows = 4\ncolumns = 4", "rows = 12\ncolumns = 12"))
    words = ("run", path, "-o", tmp_path / "out.nc", "--checkpoint", "5")
    assert mpi(1, *words).returncode == 0
    whole = (tmp_path / "out.nc").read_bytes()
    resumed = mpi(3, *words, "--resume")
    assert resumed.returncode == 0, resumed.stderr
    assert "checkpoint of sample 5" in resumed.stdout
    assert (tmp_path / "out.nc").read_bytes() == whole


def test_a_checkpoint_of_an_earlier_run_is_forgotten(tmp_path: Path) -> None:
    path = scenario(tmp_path, "scalar_gain", "")
    out = tmp_path / "out.nc"
    assert mpi(2, "run", path, "-o", out, "--checkpoint", "4").returncode == 0
    out.unlink()
    assert mpi(2, "run", path, "-o", out).returncode == 0  # writes none
    done = mpi(2, "run", path, "-o", out, "--resume")
    assert done.returncode == 2
    assert "run with --checkpoint and --force first" in done.stderr
    assert "the job was ended" not in done.stderr


def test_results_that_were_cut_are_not_gone_on_with(tmp_path: Path) -> None:
    path = scenario(tmp_path, "scalar_gain", "", steps=30)
    out = tmp_path / "out.nc"
    assert mpi(2, "run", path, "-o", out, "--checkpoint", "20").returncode == 0
    whole = out.read_bytes()
    out.write_bytes(whole[: len(whole) // 2])
    done = mpi(3, "run", path, "-o", out, "--resume")
    assert done.returncode == 2
    assert "do not hold all samples up to 20" in done.stderr
    out.write_bytes(whole)
    assert mpi(3, "run", path, "-o", out, "--resume").returncode == 0
    assert out.read_bytes() == whole
