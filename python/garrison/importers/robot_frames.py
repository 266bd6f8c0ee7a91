"""Positions and headings of several topics in the frame of one of them."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from garrison.importers.earth import Plane
from garrison.importers.robot_signals import Topic

Array = NDArray[np.float64]
#: m that the robot has to move before a rotation between two frames is told from noise
_LEAST_WAY = 2.0


@dataclass
class Signal:
    """One topic in the common frame. t: s. series: quantity -> numbers; x, y, heading, vx, vy (of the frame), rate."""

    name: str
    t: Array
    series: dict[str, Array]
    notes: list[str] = field(default_factory=list)


def in_one_frame(topics: list[Topic], window: float) -> tuple[list[Signal], str]:
    """All topics in the frame of one, and its name. window: s from the start, in which frames are compared.

    The frame is that of an odometry with positions, else of the topic with most positions.
    """
    signals = [_flat(topic) for topic in topics]
    kinds = {topic.name: topic.kind for topic in topics}
    places = [s for s in signals if "x" in s.series] or signals
    base = max(places, key=lambda s: (kinds[s.name] == "Odometry", "heading" in s.series, len(s.t)))
    for signal in signals:
        if signal is not base:
            _align(signal, base, window)
        _turn(signal)
    return signals, base.name


def _flat(topic: Topic) -> Signal:
    """Latitudes and longitudes as metres; headings without jumps of a turn."""
    series = {k: topic.array(k) for k in ("x", "y", "heading", "vx", "vy", "rate") if topic.knows(k)}
    if topic.knows("latitude"):
        latitude, longitude = topic.array("latitude"), topic.array("longitude")
        first = int(np.argmax(np.isfinite(latitude)))
        at = Plane(float(latitude[first]), float(longitude[first])).position(latitude, longitude)
        series |= {"x": at[:, 0], "y": at[:, 1]}
    if "heading" in series:
        known = np.isfinite(series["heading"])
        series["heading"][known] = np.unwrap(series["heading"][known])
    return Signal(topic.name, np.asarray(topic.t), series)


def _align(signal: Signal, base: Signal, window: float) -> None:
    """Turn and move positions onto those of the base, and headings likewise, by the first seconds of both."""
    start = max(signal.t[0], base.t[0])
    part = (signal.t >= start) & (signal.t <= min(start + window, base.t[-1]))
    if "x" in signal.series and "x" in base.series:
        _align_positions(signal, base, part)
    if "heading" in signal.series and "heading" in base.series:
        other = _at(signal.t[part], base, "heading")
        away = other - signal.series["heading"][part]
        away = away[np.isfinite(away)]
        if len(away):
            middle = float(np.angle(np.exp(1j * away).mean()))
            middle += 2.0 * np.pi * float(np.rint(np.median(away - middle) / (2.0 * np.pi)))
            signal.series["heading"] = signal.series["heading"] + middle


def _align_positions(signal: Signal, base: Signal, part: NDArray[np.bool_]) -> None:
    mine = np.column_stack([signal.series["x"][part], signal.series["y"][part]])
    other = np.column_stack([_at(signal.t[part], base, k) for k in "xy"])
    known = np.isfinite(mine).all(axis=1) & np.isfinite(other).all(axis=1)
    if known.sum() < 2:
        signal.notes.append(f"{signal.name} and {base.name} have no positions of the same time; not aligned")
        return
    mine, other = mine[known], other[known]
    a, b = mine - mine.mean(axis=0), other - other.mean(axis=0)
    angle = 0.0
    if np.ptp(other, axis=0).max() >= _LEAST_WAY:
        angle = float(np.arctan2((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum(), (a * b).sum()))
    else:
        signal.notes.append(f"{signal.name} is moved onto {base.name}, not turned: too short a way at the start")
    c, s = np.cos(angle), np.sin(angle)
    turn = np.array([[c, -s], [s, c]])
    whole = np.column_stack([signal.series["x"], signal.series["y"]])
    moved = (whole - mine.mean(axis=0)) @ turn.T + other.mean(axis=0)
    signal.series |= {"x": moved[:, 0], "y": moved[:, 1]}


def _turn(signal: Signal) -> None:
    """Velocities along and across the body as velocities in the frame, by the topic's own heading."""
    vx, vy = signal.series.pop("vx", None), signal.series.pop("vy", None)
    heading = signal.series.get("heading")
    if vx is None or heading is None:
        return
    vy = np.zeros_like(vx) if vy is None else vy
    c, s = np.cos(heading), np.sin(heading)
    signal.series |= {"vx": c * vx - s * vy, "vy": s * vx + c * vy}


def _at(t: Array, signal: Signal, quantity: str) -> Array:
    """A quantity at other times, on straight lines between its readings; nan outside of them."""
    known = np.isfinite(signal.series[quantity])
    return np.asarray(
        np.interp(t, signal.t[known], signal.series[quantity][known], left=np.nan, right=np.nan)
        if known.any()
        else np.full(len(t), np.nan)
    )
