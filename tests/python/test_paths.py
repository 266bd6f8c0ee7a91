"""Files that a caller names appear whole or not at all, and nothing of others is lost."""

import resource
import signal
from collections.abc import Iterator
from pathlib import Path

import garrison as gr
import pytest

MODEL = gr.Model([[0.9]], [[1.0]] * 3, process_bound=0.1, measurement_bound=0.1)
RUN = gr.simulate(MODEL, gr.Network.ring(3), gr.filters.ScalarGain(), steps=20, seed=1)
KINDS = ("run.npz", "run.nc", "run.zarr")


@pytest.fixture
def small_disk() -> Iterator[None]:
    """Files of at most 100 kB."""
    limits, before = resource.getrlimit(resource.RLIMIT_FSIZE), signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, limits[1]))
    yield
    resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    signal.signal(signal.SIGXFSZ, before)


@pytest.mark.parametrize("name", KINDS)
def test_a_run_is_replaced_by_another(name: str, tmp_path: Path) -> None:
    pytest.importorskip("zarr")
    RUN.save(tmp_path / name)
    other = gr.simulate(MODEL, gr.Network.ring(3), gr.filters.ScalarGain(), steps=20, seed=2)
    other.save(tmp_path / name)
    assert gr.Run.load(tmp_path / name) == other
    assert [path.name for path in tmp_path.iterdir()] == [name]


def test_a_folder_of_others_stays(tmp_path: Path) -> None:
    pytest.importorskip("zarr")
    (tmp_path / "mine.zarr").mkdir()
    RUN.save(tmp_path / "mine.zarr")  # empty: nothing is lost
    for stranger in ("notes.txt", "error/notes.txt"):
        mine = tmp_path / "mine.zarr" / stranger
        mine.write_text("mine")
        with pytest.raises(gr.IoError, match=r"mine.zarr: got a folder with files of others.*nothing was changed"):
            RUN.save(tmp_path / "mine.zarr")
        assert mine.read_text() == "mine"
        mine.unlink()
    (tmp_path / "file.zarr").write_text("mine")
    with pytest.raises(gr.IoError, match=r"file.zarr: got a file"):
        RUN.save(tmp_path / "file.zarr")
    assert (tmp_path / "file.zarr").read_text() == "mine"


@pytest.mark.parametrize("name", KINDS)
def test_a_full_disk_leaves_what_was_there(name: str, tmp_path: Path, small_disk: None) -> None:
    pytest.importorskip("zarr")
    RUN.save(tmp_path / name)
    large = gr.simulate(MODEL, gr.Network.ring(3), gr.filters.ScalarGain(), steps=30_000, seed=1)
    with pytest.raises(gr.IoError, match=rf"{name}: got File too large, expected room for it; free some .what was"):
        large.save(tmp_path / name)
    assert gr.Run.load(tmp_path / name) == RUN
    assert [path.name for path in tmp_path.iterdir()] == [name]


@pytest.mark.parametrize("name", KINDS)
def test_places_that_cannot_be_written_to(name: str, tmp_path: Path) -> None:
    pytest.importorskip("zarr")
    with pytest.raises(gr.IoError, match=r"got No such file or directory"):
        RUN.save(tmp_path / "no" / "such" / name)
    (tmp_path / name).mkdir()
    (tmp_path / name / "mine").write_text("mine")
    with pytest.raises(gr.IoError, match=r"got a folder"):
        RUN.save(tmp_path / name)
    assert (tmp_path / name / "mine").read_text() == "mine"


def test_a_design_file_is_written_whole(tmp_path: Path, small_disk: None) -> None:
    prepared = gr.prepare(MODEL, gr.Network.ring(3), gr.filters.ScalarGain())
    prepared.save(tmp_path / "a.gdesign")
    large = gr.prepare(gr.Model([[0.9]], [[1.0]] * 9000), gr.Network.ring(9000), gr.filters.ScalarGain(step=0.1))
    with pytest.raises(gr.IoError, match=r"File too large"):
        large.save(tmp_path / "a.gdesign")
    assert gr.Prepared.load(tmp_path / "a.gdesign") == prepared
