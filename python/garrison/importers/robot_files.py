"""Messages of ROS 1 and ROS 2 bags and of MCAP files, one after the other."""

import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from garrison import _core
from garrison.importers.libraries import library
from garrison.words import refusal

_PURPOSE = "reading bags"


@dataclass(frozen=True)
class Message:
    """time: s, when it was recorded. kind: name of its type without its package and `msg`: Odometry, Imu.

    content: an object with the fields as attributes, or a dictionary of a JSON message.
    """

    topic: str
    kind: str
    time: float
    content: Any


def bag_messages(paths: Sequence[Path], kinds: set[str]) -> Iterator[Message]:
    """Messages of the kinds, in order of time: of a ROS 2 bag (a folder or its file), or of ROS 1 bags.

    Raises InvalidInput or IoError where the files are no bags.
    """
    reader = library("rosbags.highlevel", "robots", _PURPOSE)
    stores = library("rosbags.typesys", "robots", _PURPOSE)
    _require_files(paths)
    folders = [
        p.parent if p.suffix in (".db3", ".mcap") and (p.parent / "metadata.yaml").exists() else p for p in paths
    ]
    try:
        store = stores.get_typestore(stores.Stores.LATEST)  # of bags that hold no definitions
        with reader.AnyReader(folders, default_typestore=store) as bag:
            chosen = [c for c in bag.connections if _kind(c.msgtype) in kinds]
            if not chosen:
                raise _nothing(str(folders[0]), {c.topic: c.msgtype for c in bag.connections}, kinds)
            for connection, time, data in bag.messages(connections=chosen):
                content = bag.deserialize(data, connection.msgtype)
                yield Message(connection.topic, _kind(connection.msgtype), time * 1e-9, content)
    except _core.Error:
        raise
    except Exception as error:  # of the reader of others: every damaged byte may raise another one
        what = " ".join(str(error).split()) or type(error).__name__
        raise refusal(
            str(folders[0]), f"no bag that can be read ({what[:200]})", "a ROS 1 .bag or a ROS 2 folder"
        ) from None


def mcap_messages(path: Path, kinds: set[str]) -> Iterator[Message]:
    """Messages of the kinds in an MCAP file: ROS 2 (cdr), ROS 1, or JSON. Raises InvalidInput or IoError."""
    reading = library("mcap.reader", "robots", "reading MCAP")
    _require_files([path])
    try:
        with path.open("rb") as file:
            reader = reading.make_reader(file)
            decoder = _Decoder()
            skipped: dict[str, str] = {}
            some = False
            for schema, channel, message in reader.iter_messages():
                name = schema.name if schema is not None else ""
                if _kind(name) not in kinds:
                    skipped[channel.topic] = name or "no schema"
                    continue
                content = decoder.decode(str(path), channel, schema, message.data)
                some = True
                yield Message(channel.topic, _kind(name), message.log_time * 1e-9, content)
        if not some:
            raise _nothing(str(path), skipped, kinds)
    except _core.Error:
        raise
    except Exception as error:
        what = " ".join(str(error).split()) or type(error).__name__
        raise refusal(str(path), f"no MCAP file that can be read ({what[:200]})", "an MCAP file") from None


class _Decoder:
    """From bytes to fields, by the definitions in the file."""

    def __init__(self) -> None:
        self.known: dict[int, tuple[Any, str]] = {}

    def decode(self, where: str, channel: Any, schema: Any, data: bytes) -> Any:
        """The content of a message."""
        if channel.message_encoding == "json":
            return json.loads(data)
        if channel.message_encoding not in ("cdr", "ros1"):
            raise refusal(
                f"{where}, topic {channel.topic}",
                f"the encoding {channel.message_encoding!r}",
                "cdr (ROS 2), ros1 or json",
                "choose other topics with --topic, or convert the file",
            )
        store, kind = self._store(schema)
        read = store.deserialize_cdr if channel.message_encoding == "cdr" else store.deserialize_ros1
        return read(data, kind)

    def _store(self, schema: Any) -> tuple[Any, str]:
        if schema.id not in self.known:
            types = library("rosbags.typesys", "robots", "reading ROS messages in MCAP")
            name = schema.name if "/msg/" in schema.name else schema.name.replace("/", "/msg/", 1)
            read = types.get_types_from_idl if schema.encoding == "ros2idl" else types.get_types_from_msg
            text = schema.data.decode()
            store = types.get_typestore(types.Stores.EMPTY)
            store.register(read(text) if schema.encoding == "ros2idl" else read(text, name))
            self.known[schema.id] = store, name
        return self.known[schema.id]


def _kind(name: str) -> str:
    """sensor_msgs/msg/Imu, sensor_msgs/Imu, foxglove.LocationFix: the last word."""
    return name.replace(".", "/").rpartition("/")[2]


def _require_files(paths: Sequence[Path]) -> None:
    for path in paths:
        if not path.exists():
            raise _core.IoError(f"{path}: got no such file or folder, expected a recording")


def _nothing(where: str, topics: dict[str, str], kinds: set[str]) -> _core.InvalidInput:
    found = ", ".join(f"{topic} ({kind})" for topic, kind in list(topics.items())[:12]) or "no messages"
    trees = [topic for topic, kind in topics.items() if _kind(kind) in ("TFMessage", "FrameTransform", "tfMessage")]
    advice = (
        f"{', '.join(trees)}: trees of frames are not read, as one place that is passed through frames has nothing to "
        "test it; record the odometry, the IMU or the GPS themselves"
    )
    return refusal(where, found, f"topics of the kinds {', '.join(sorted(kinds))}", advice if trees else "")
