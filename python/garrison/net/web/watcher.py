"""Asks all nodes for their status again and again, in a thread of its own."""

import json
import threading
import time
from pathlib import Path
from typing import Any

from garrison import _core
from garrison.bound_kind import BoundKind
from garrison.net.client import Client
from garrison.net.web.scene import Scene

_WHY = {kind.word: kind.why for kind in BoundKind}


class Watcher:
    """The last status of every node; sockets: their paths. Nodes are named by what they say, before that by path."""

    def __init__(self, sockets: list[Path], scene: Scene, pause: float = 0.5) -> None:
        self._clients = [Client(path, timeout=1.0) for path in sockets]
        self._names = [str(path) for path in sockets]
        self._scene, self._pause = scene, pause
        self._changed = threading.Condition()
        self._statuses: list[dict[str, Any] | None] = [None] * len(sockets)
        self._turn = 0
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)

    def start(self) -> None:
        """Begin to ask."""
        self._thread.start()

    def end(self) -> None:
        """Ask no more."""
        self._ended.set()
        self._thread.join()

    def statuses(self) -> dict[str, dict[str, Any] | None]:
        """Name -> last status, None where the node does not answer."""
        with self._changed:
            return dict(zip(self._names, self._statuses, strict=True))

    def next_event(self, seen: int, patience: float = 5.0) -> tuple[int, str]:
        """The number and the JSON of the newest picture of all nodes, once it is another one than `seen`."""
        with self._changed:
            self._changed.wait_for(lambda: self._turn != seen, patience)
            turn = self._turn
        return turn, json.dumps(self._picture())

    def _picture(self) -> dict[str, Any]:
        nodes = []
        for name, status in self.statuses().items():
            if status is None:
                nodes.append({"name": name, "answers": False})
                continue
            keys = ("t", "state", "estimate", "bound", "bound_kind", "verdict", "statistic", "threshold", "complete")
            node = {key: status[key] for key in keys} | {"name": name, "answers": True}
            node |= {"accused": status["accused"], "id": status["id"], "error": self._scene.error(status)}
            node["proved"] = [self._scene.source(k) for k in status["proved"]]
            node |= {"why": _WHY.get(status["bound_kind"], ""), "counters": status["counters"]}
            node["links"] = [
                {key: link[key] for key in ("name", "state", "age_s", "delay_us")} for link in status["links"]
            ]
            nodes.append(node)
        scene = self._scene
        return {"title": scene.title, "positions": scene.positions, "hijacked": scene.hijacked, "nodes": nodes}

    def _run(self) -> None:
        while not self._ended.is_set():
            began = time.monotonic()
            found = [self._ask(client) for client in self._clients]
            with self._changed:
                self._statuses = found
                self._names = [s["node"] if s else name for s, name in zip(found, self._names, strict=True)]
                self._turn += 1
                self._changed.notify_all()
            self._ended.wait(max(0.0, self._pause - (time.monotonic() - began)))

    @staticmethod
    def _ask(client: Client) -> dict[str, Any] | None:
        try:
            return client.status()
        except (OSError, ValueError, _core.Error):
            return None
