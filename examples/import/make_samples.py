"""Writes the synthetic samples of this folder: same form as the real files, nothing of them.

    python examples/import/make_samples.py        # needs rosbags and mcap for the robot

Cars, an aircraft and a robot are simulated here; their sensors lie as SAMPLES.md says. Same bits every time.
"""

import csv
import gzip
import json
from pathlib import Path
from typing import Any

import numpy as np

HERE = Path(__file__).parent
Array = np.ndarray[Any, Any]
REPORT = [
    "timestamp",
    "icao24",
    "latitude",
    "longitude",
    "groundspeed",
    "track",
    "vertical_rate",
    "altitude",
    "last_position",
    "callsign",
]


def cars(rng: np.random.Generator, count: int = 5, rows: int = 600, period: float = 0.1) -> None:
    """An OpenACC file: five cars, car 3's wheel speed reads 1.5 % too much from 20 s on (an odometer that drifts)."""
    t = period * np.arange(rows)
    lead = 20.0 + 4.0 * np.sin(2 * np.pi * t / 25.0)
    speeds, gaps = [lead], []
    for _ in range(count - 1):
        v, gap = np.empty(rows), np.empty(rows)
        v[0], gap[0] = 20.0, 30.0
        for k in range(rows - 1):
            pull = 0.08 * (gap[k] - 5.0 - 1.25 * v[k]) + 0.6 * (speeds[-1][k] - v[k])
            v[k + 1] = v[k] + period * np.clip(pull, -3.0, 2.0)
            gap[k + 1] = gap[k] + period * (speeds[-1][k] + speeds[-1][k + 1] - v[k] - v[k + 1]) / 2
        speeds.append(v)
        gaps.append(gap)
    shown = [v + rng.normal(0, 0.03, rows) for v in speeds]
    shown[2] = shown[2] * np.where(t >= 20.0, 1.015, 1.0)
    head = [f"{name}{k}" for k in range(1, count + 1) for name in ("Speed", "E", "N")]
    head += [f"IVS{k}" for k in range(1, count)]
    east = -np.concatenate([[np.zeros(rows)], np.cumsum(gaps, axis=0)]) + np.cumsum(lead) * period
    with (HERE / "openacc_sample.csv").open("w", newline="", encoding="utf-8") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(["Date", 1, 1, 2024])
        out.writerow(["Vehicle_order", *(f"CAR_{k}" for k in range(1, count + 1))])
        out.writerow(["Number_of_vehicles", count])
        out.writerow(["ACC", 1])
        out.writerow(["Distance_setting", "M"])
        out.writerow(["Time", *head])
        for k in range(rows):
            places = [v for i in range(count) for v in (shown[i][k], east[i][k], 0.0)]
            out.writerow(
                [f"{t[k]:.1f}", *(f"{v:.3f}" for v in places), *(f"{g[k] + rng.normal(0, 0.1):.3f}" for g in gaps)]
            )


def aircraft(rng: np.random.Generator, rows: int = 1500) -> None:
    """State vectors of an airliner as pandas writes them; from 900 to 1200 s its satellite navigation is spoofed."""
    t = np.arange(rows, dtype=float)
    track = np.deg2rad(40.0 + 25.0 * np.clip((t - 400.0) / 60.0, 0, 1))
    speed = 230.0 + 5.0 * np.sin(t / 200.0)
    east, north = np.cumsum(speed * np.sin(track)), np.cumsum(speed * np.cos(track))
    lie = (t >= 900) & (t < 1200)
    shift = np.where(lie, 40_000.0 + 80.0 * (t - 900.0), 0.0)
    latitude = 47.0 + (north + rng.normal(0, 15, rows)) / 111_200.0
    longitude = 8.0 + (east + shift + rng.normal(0, 15, rows)) / (111_200.0 * np.cos(np.deg2rad(latitude)))
    velocity = np.column_stack([speed * np.sin(track) + 80.0 * lie, speed * np.cos(track)])
    epoch = 1_700_000_000
    heard = rng.uniform(size=rows) > 0.25
    columns: dict[str, list[Any]] = {name: [] for name in REPORT}
    last = 0
    for k in range(rows):
        last = k if heard[k] or k == 0 else last
        columns["timestamp"].append(1000 * (epoch + k))
        columns["icao24"].append("abcdef")
        columns["latitude"].append(round(float(latitude[last]), 6))
        columns["longitude"].append(round(float(longitude[last]), 6))
        columns["groundspeed"].append(round(float(np.hypot(*velocity[last]) * 3600 / 1852)))
        columns["track"].append(round(float(np.rad2deg(np.arctan2(*velocity[last])) % 360), 2))
        columns["vertical_rate"].append(0.0)
        columns["altitude"].append(36000.0)
        columns["last_position"].append(1000 * (epoch + last))
        columns["callsign"].append("SAMPLE1")
    plain = {name: {str(k): v for k, v in enumerate(values)} for name, values in columns.items()}
    (HERE / "adsb_sample.json.gz").write_bytes(gzip.compress(json.dumps(plain).encode(), mtime=0))


def way(rows: int, period: float) -> tuple[Array, Array, Array, Array]:
    """Place (rows, 2), heading, speed and turn rate of a robot on a winding way."""
    t = period * np.arange(rows)
    rate = 0.25 * np.sin(2 * np.pi * t / 30.0)
    heading = 0.3 + np.cumsum(rate) * period
    speed = 1.2 + 0.3 * np.sin(2 * np.pi * t / 17.0)
    place = np.cumsum(speed[:, None] * np.column_stack([np.cos(heading), np.sin(heading)]), axis=0) * period
    return place, heading, speed, rate


def robot(rng: np.random.Generator, rows: int = 1200, period: float = 0.1) -> None:
    """Odometry, IMU and GPS of a robot as a ROS 1 bag and a ROS 2 bag (an MCAP file); a pulled GPS from 80 s on."""
    from rosbags.rosbag1 import Writer as Writer1
    from rosbags.rosbag2 import StoragePlugin
    from rosbags.rosbag2 import Writer as Writer2
    from rosbags.typesys import Stores, get_typestore

    place, heading, speed, rate = way(rows, period)
    readings = []
    for k in range(rows):
        time = int(1e9 * (1_700_000_000 + k * period))
        angle = heading[k] + rng.normal(0, 0.02)
        odometry = (
            place[k] + rng.normal(0, 0.03, 2),
            angle,
            speed[k] + rng.normal(0, 0.02),
            rate[k] + rng.normal(0, 0.01),
        )
        readings.append((time, "/odom", odometry))
        readings.append((time, "/imu/data", (heading[k] + 0.4 + rng.normal(0, 0.02), rate[k] + rng.normal(0, 0.01))))
        if k % 5 == 0:
            pull = 0.5 * max(0.0, k * period - 80.0)
            readings.append((time, "/gps/fix", place[k] + [0.0, pull] + rng.normal(0, 0.2, 2)))
    (HERE / "robot_sample.bag").unlink(missing_ok=True)
    one, two = get_typestore(Stores.ROS1_NOETIC), get_typestore(Stores.ROS2_HUMBLE)
    bag = Writer1(HERE / "robot_sample.bag")
    bag.set_compression(Writer1.CompressionFormat.BZ2)
    with bag:
        known = {n: bag.add_connection(n, kind, typestore=one) for n, kind in KINDS.items()}
        for time, topic, reading in readings:
            content = message(one, topic, time, reading)
            bag.write(known[topic], time, one.serialize_ros1(content, KINDS[topic]))
    folder = HERE / "robot_sample_ros2"
    for old in folder.glob("*") if folder.exists() else []:
        old.unlink()
    if folder.exists():
        folder.rmdir()
    with Writer2(folder, version=9, storage_plugin=StoragePlugin.MCAP) as bag:
        known2 = {n: bag.add_connection(n, kind, typestore=two) for n, kind in KINDS.items()}
        for time, topic, reading in readings[: len(readings) // 6]:
            bag.write(known2[topic], time, two.serialize_cdr(message(two, topic, time, reading), KINDS[topic]))


KINDS = {"/odom": "nav_msgs/msg/Odometry", "/imu/data": "sensor_msgs/msg/Imu", "/gps/fix": "sensor_msgs/msg/NavSatFix"}


def message(store: Any, topic: str, time: int, reading: Any) -> Any:
    """A ROS message of one reading."""
    kinds = store.types
    stamp = kinds["builtin_interfaces/msg/Time"](sec=time // 10**9, nanosec=time % 10**9)
    more = {"seq": 0} if "seq" in kinds["std_msgs/msg/Header"].__annotations__ else {}
    header = kinds["std_msgs/msg/Header"](stamp=stamp, frame_id="map", **more)
    vector, quaternion = kinds["geometry_msgs/msg/Vector3"], kinds["geometry_msgs/msg/Quaternion"]
    if topic == "/gps/fix":
        status = kinds["sensor_msgs/msg/NavSatStatus"](status=0, service=1)
        degrees = 48.0 + reading[1] / 111_200.0, 11.0 + reading[0] / (111_200.0 * np.cos(np.deg2rad(48.0)))
        fix = kinds["sensor_msgs/msg/NavSatFix"]
        return fix(header, status, float(degrees[0]), float(degrees[1]), 500.0, np.zeros(9), 0)

    def turned(angle: float) -> Any:
        return quaternion(x=0.0, y=0.0, z=float(np.sin(angle / 2)), w=float(np.cos(angle / 2)))

    if topic == "/imu/data":
        return kinds["sensor_msgs/msg/Imu"](
            header,
            turned(reading[0]),
            np.zeros(9),
            vector(0.0, 0.0, float(reading[1])),
            np.zeros(9),
            vector(0.0, 0.0, 9.81),
            np.zeros(9),
        )
    at, angle, speed, rate = reading
    pose = kinds["geometry_msgs/msg/Pose"](
        kinds["geometry_msgs/msg/Point"](float(at[0]), float(at[1]), 0.0), turned(angle)
    )
    twist = kinds["geometry_msgs/msg/Twist"](vector(float(speed), 0.0, 0.0), vector(0.0, 0.0, float(rate)))
    return kinds["nav_msgs/msg/Odometry"](
        header,
        "base_link",
        kinds["geometry_msgs/msg/PoseWithCovariance"](pose, np.zeros(36)),
        kinds["geometry_msgs/msg/TwistWithCovariance"](twist, np.zeros(36)),
    )


def main() -> None:
    """All samples."""
    cars(np.random.default_rng(1))
    aircraft(np.random.default_rng(2))
    robot(np.random.default_rng(3))


if __name__ == "__main__":
    main()
