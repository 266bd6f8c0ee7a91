"""What messages of robots say about a place on the ground: position, heading, velocity, turn rate."""

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from garrison.importers.robot_files import Message
from garrison.words import refusal

Array = NDArray[np.float64]
#: of every topic that is used: its values in one message, nan = missing
Values = dict[str, float]


@dataclass
class Topic:
    """Readings of one topic in order of time. values: quantity -> numbers, nan = missing.

    quantities: x, y (m), latitude, longitude (degrees), heading (rad, from east against the clock), vx, vy (m/s, along
    and across the body), rate (rad/s).
    """

    name: str
    kind: str
    t: list[float] = field(default_factory=list)
    values: dict[str, list[float]] = field(default_factory=dict)

    def array(self, quantity: str) -> Array:
        """One quantity over time."""
        return np.asarray(self.values[quantity], dtype=float)

    def knows(self, quantity: str) -> bool:
        """The topic has this quantity, at least twice."""
        return quantity in self.values and int(np.isfinite(self.array(quantity)).sum()) > 1


def read_topics(messages: Iterable[Message], wanted: set[str]) -> list[Topic]:
    """Readings by topic; wanted: the topics to use, empty = all. Raises InvalidInput where one of them is not there."""
    found: dict[str, Topic] = {}
    seen: dict[str, None] = {}
    for message in messages:
        seen[message.topic] = None
        if wanted and message.topic not in wanted:
            continue
        topic = found.setdefault(message.topic, Topic(message.topic, message.kind))
        topic.t.append(_stamp(message))
        values = KINDS[message.kind](message.content)
        for name in {*values, *topic.values}:
            series = topic.values.setdefault(name, [math.nan] * (len(topic.t) - 1))
            series.append(values.get(name, math.nan))
    if missing := sorted(wanted - set(found)):
        expected = "topics of the recording with a place or a heading"
        raise refusal("--topic", ", ".join(missing), f"{expected}: {', '.join(seen) or 'it has none'}")
    for topic in found.values():
        _sort(topic)
    return list(found.values())


def _sort(topic: Topic) -> None:
    order = np.argsort(topic.t, kind="stable")
    topic.t = [topic.t[k] for k in order]
    topic.values = {name: [series[k] for k in order] for name, series in topic.values.items()}


def _get(content: Any, path: str) -> Any:
    """A field of a message, an object or a dictionary; None where it is missing."""
    for name in path.split("."):
        content = content.get(name) if isinstance(content, dict) else getattr(content, name, None)
        if content is None:
            return None
    return content


def _stamp(message: Message) -> float:
    """The time in the header, where it is set; else when the message was recorded. Seconds."""
    stamp = _get(message.content, "header.stamp") or _get(message.content, "timestamp")
    whole = _get(stamp, "sec") if stamp is not None else None
    part = _get(stamp, "nanosec") if whole is not None else None
    part = _get(stamp, "nsec") if whole is not None and part is None else part
    seconds = float(whole or 0) + 1e-9 * float(part or 0)
    return seconds if seconds > 0.0 else message.time


def _number(content: Any, path: str) -> float:
    value = _get(content, path)
    return float(value) if isinstance(value, (int, float, np.number)) else math.nan


def _yaw(content: Any, path: str) -> float:
    """Heading of a quaternion; nan where it is no rotation."""
    x, y, z, w = (_number(content, f"{path}.{k}") for k in "xyzw")
    size = x * x + y * y + z * z + w * w
    if not size > 0.5:
        return math.nan
    return math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))


def _pose(content: Any, path: str) -> Values:
    place = {k: _number(content, f"{path}.position.{k}") for k in "xy"}
    return {**place, "heading": _yaw(content, f"{path}.orientation")}


def _odometry(content: Any) -> Values:
    motion = {"vx": _number(content, "twist.twist.linear.x"), "vy": _number(content, "twist.twist.linear.y")}
    return {**_pose(content, "pose.pose"), **motion, "rate": _number(content, "twist.twist.angular.z")}


def _imu(content: Any) -> Values:
    """Turn rate; heading where the sensor has one (its covariance does not start with -1)."""
    covariance = _get(content, "orientation_covariance")
    known = covariance is None or float(covariance[0]) != -1.0
    heading = _yaw(content, "orientation") if known else math.nan
    return {"heading": heading, "rate": _number(content, "angular_velocity.z")}


def _fix(content: Any) -> Values:
    """Latitude and longitude; nan without a fix."""
    status = _number(content, "status.status")
    at = {k: _number(content, k) for k in ("latitude", "longitude")}
    return at if not status < 0 else dict.fromkeys(at, math.nan)


def _transform(content: Any) -> Values:
    place = {k: _number(content, f"transform.translation.{k}") for k in "xy"}
    return {**place, "heading": _yaw(content, "transform.rotation")}


#: kind of message -> what is read from it
KINDS: dict[str, Callable[[Any], Values]] = {
    "Odometry": _odometry,
    "Imu": _imu,
    "NavSatFix": _fix,
    "LocationFix": _fix,
    "PoseStamped": lambda m: _pose(m, "pose"),
    "PoseWithCovarianceStamped": lambda m: _pose(m, "pose.pose"),
    "PoseInFrame": lambda m: _pose(m, "pose"),
    "PointStamped": lambda m: {k: _number(m, f"point.{k}") for k in "xy"},
    "TransformStamped": _transform,
    "TwistStamped": lambda m: {"rate": _number(m, "twist.angular.z")},
    "TwistWithCovarianceStamped": lambda m: {"rate": _number(m, "twist.twist.angular.z")},
}
