"""`garrison import rosbag` and `mcap`: samples, frames, messages of other encodings, what is refused."""

import json
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import ROOT
from garrison import _core
from garrison.cli import main
from garrison.importers.robot_files import Message
from garrison.importers.robot_frames import in_one_frame
from garrison.importers.robot_signals import Topic, read_topics
from garrison.importers.robots import Assumptions, _states, import_bag, import_mcap
from garrison.jobs import run_scenario
from garrison.scenario import read_scenario

FOLDER = ROOT / "examples" / "import"
BAG, ROS2 = FOLDER / "robot_sample.bag", FOLDER / "robot_sample_ros2"
MCAP = ROS2 / "robot_sample_ros2.mcap"


def test_the_pulled_gps_of_the_bag_is_accused(tmp_path: Path) -> None:
    pytest.importorskip("rosbags")
    assert main(["import", "rosbag", str(BAG), "-o", str(tmp_path / "bag")]) == 0
    assert main(["check", str(tmp_path / "bag" / "scenario.toml")]) == 0
    row = run_scenario(read_scenario(tmp_path / "bag" / "scenario.toml"))[0]
    assert set(row.summary["detected"]) == {"gps/fix y"}
    assert row.summary["detected"]["gps/fix y"] > 800  # pulled from 80 s on


def test_a_ros_2_bag_and_its_mcap_file_are_the_same() -> None:
    pytest.importorskip("rosbags")
    pytest.importorskip("mcap")
    folder, file = import_bag([ROS2]).measurements, import_mcap(MCAP).measurements
    whole = import_bag([BAG]).measurements
    assert folder is not None and file is not None and whole is not None
    assert np.array_equal(folder.values, file.values, equal_nan=True)
    assert folder.columns == file.columns == whole.columns
    odom = [k for k, name in enumerate(whole.columns) if name.startswith("odom")]
    assert np.allclose(whole.values[: len(file.values), odom], file.values[:, odom], atol=1e-6)


def test_topics_can_be_chosen() -> None:
    pytest.importorskip("rosbags")
    bundle = import_bag([BAG], ["/odom"], Assumptions(period=0.5))
    assert bundle.measurements is not None and bundle.model is not None
    assert {name.split()[0] for name in bundle.measurements.columns} == {"odom"}
    assert dict(bundle.facts)["samples"] == "240, every 0.5 s"
    with pytest.raises(_core.InvalidInput, match=r"--topic: got /lidar, expected topics .* heading: /"):
        import_bag([BAG], ["/odom", "/lidar"])
    with pytest.raises(_core.InvalidInput, match="expected a position or a heading"):
        _states("x.bag", {"rate"})


def test_frames_are_turned_and_moved_onto_one_another() -> None:
    t = np.arange(200) * 0.1
    way = np.column_stack([t, 0.1 * t**2])
    odometry = Topic("/odom", "Odometry", t.tolist(), {"x": way[:, 0].tolist(), "y": way[:, 1].tolist()})
    angle = 1.1
    turned = way @ np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]]) + [500.0, -70.0]
    other = Topic("/fix", "PoseStamped", t.tolist(), {"x": turned[:, 0].tolist(), "y": turned[:, 1].tolist()})
    signals, base = in_one_frame([other, odometry], window=10.0)
    assert base == "/odom"
    moved = {s.name: np.column_stack([s.series["x"], s.series["y"]]) for s in signals}
    assert np.allclose(moved["/fix"], way, atol=1e-9)


def test_headings_are_continuous_and_share_their_zero() -> None:
    t = np.arange(400) * 0.1
    heading = 0.3 * t
    wrapped = (heading + np.pi) % (2 * np.pi) - np.pi
    odometry = Topic("/odom", "Odometry", t.tolist(), {"heading": wrapped.tolist(), "vx": np.ones(400).tolist()})
    imu = Topic("/imu", "Imu", t.tolist(), {"heading": ((wrapped + 2.0) % 6.283185307179586).tolist()})
    signals, _ = in_one_frame([odometry, imu], window=60.0)
    found = {s.name: s.series for s in signals}
    assert np.allclose(found["/odom"]["heading"], heading)
    assert np.allclose(found["/imu"]["heading"], heading, atol=1e-6)
    assert np.allclose(found["/odom"]["vx"], np.cos(heading)) and np.allclose(found["/odom"]["vy"], np.sin(heading))


def test_messages_say_what_they_do_not_know() -> None:
    half = {"x": 0.0, "y": 0.0, "z": np.sin(0.35), "w": np.cos(0.35)}
    imu = {"orientation": half, "angular_velocity": {"z": 0.2}, "orientation_covariance": [-1.0] + [0.0] * 8}
    fix = {"latitude": 48.0, "longitude": 11.0, "status": {"status": -1}, "header": {"stamp": {"sec": 9, "nanosec": 5}}}
    messages = [
        Message("/a", "Imu", 5.0, imu),
        Message("/a", "Imu", 4.0, imu | {"orientation_covariance": [0.1] * 9}),
        Message("/b", "NavSatFix", 6.0, fix),
        Message("/b", "NavSatFix", 7.0, fix | {"status": {"status": 0}, "header": {}}),
    ]
    a, b = read_topics(messages, set())
    assert a.t == [4.0, 5.0] and a.values["rate"] == [0.2, 0.2]
    assert a.values["heading"][0] == pytest.approx(0.7) and np.isnan(a.values["heading"][1])
    assert b.t == pytest.approx([7.0, 9.0]) and np.isnan(b.values["latitude"][1])  # no fix; the header's time


def write_mcap(path: Path, encoding: str, schema: str, contents: list[dict[str, Any]]) -> Path:
    from mcap.writer import Writer

    with path.open("wb") as file:
        out = Writer(file)
        out.start()
        kind = out.register_schema(schema, "jsonschema", b"{}")
        channel = out.register_channel("/fix", encoding, kind)
        for k, content in enumerate(contents):
            out.add_message(channel, k * 10**9, json.dumps(content).encode(), k * 10**9)
        out.finish()
    return path


def test_json_in_mcap_is_read(tmp_path: Path) -> None:
    pytest.importorskip("mcap")
    contents = [{"latitude": 48.0 + 1e-5 * k, "longitude": 11.0} for k in range(30)]
    bundle = import_mcap(write_mcap(tmp_path / "x.mcap", "json", "foxglove.LocationFix", contents))
    assert bundle.measurements is not None
    y = bundle.measurements.values[:, bundle.measurements.columns.index("fix y")]
    assert np.allclose(np.diff(y[np.isfinite(y)]), 1.1121, atol=1e-3)  # 1e-5 degrees at 48 north


def test_what_is_no_recording_is_refused(tmp_path: Path) -> None:
    pytest.importorskip("rosbags")
    pytest.importorskip("mcap")
    wrong = tmp_path / "x.bag"
    wrong.write_bytes(b"not a bag at all")
    with pytest.raises(_core.InvalidInput, match=r"x\.bag: got no bag that can be read"):
        import_bag([wrong])
    with pytest.raises(_core.InvalidInput, match=r"x\.bag: got no MCAP file that can be read"):
        import_mcap(wrong)
    with pytest.raises(_core.IoError, match="no such file or folder"):
        import_bag([tmp_path / "absent.bag"])
    cut = tmp_path / "cut.bag"
    cut.write_bytes(BAG.read_bytes()[:60_000])
    with pytest.raises(_core.InvalidInput, match="no bag that can be read"):
        import_bag([cut])
    protobuf = write_mcap(tmp_path / "p.mcap", "protobuf", "foxglove.LocationFix", [{}])
    with pytest.raises(_core.InvalidInput, match="the encoding 'protobuf', expected cdr"):
        import_mcap(protobuf)
    clouds = write_mcap(tmp_path / "c.mcap", "json", "foxglove.PointCloud", [{}])
    with pytest.raises(_core.InvalidInput, match=r"/fix \(foxglove.PointCloud\), expected topics of the kinds"):
        import_mcap(clouds)
    frames = write_mcap(tmp_path / "tf.mcap", "json", "tf2_msgs/msg/TFMessage", [{"transforms": []}])
    with pytest.raises(_core.InvalidInput, match=r"/fix \(tf2_msgs/msg/TFMessage\).*/fix: trees of frames are not"):
        import_mcap(frames)


@pytest.mark.parametrize(("kind", "file", "module"), [("rosbag", BAG, "rosbags"), ("mcap", MCAP, "mcap")])
def test_a_missing_library_says_what_to_install(
    kind: str, file: Path, module: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    for name in [n for n in sys.modules if n.partition(".")[0] == module]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, module, None)
    assert main(["import", kind, str(file), "-o", "nowhere"]) == 2
    said = capsys.readouterr().err
    assert f"got no module {module}, expected the package {module}; install it: pip install {module}" in said
    assert not Path("nowhere").exists()
