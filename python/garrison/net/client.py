"""A client of a running node's Unix socket."""

import json
import socket
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from garrison.words import refusal


class Client:
    """Asks a node what it knows: `Client("/run/garrison/DUB/node.sock").status()`.

    path: [socket].path of its node.toml. Every call connects anew; timeout in seconds is for each answer.
    """

    def __init__(self, path: str | Path, timeout: float = 5.0) -> None:
        self.path, self.timeout = Path(path), timeout

    def status(self) -> dict[str, Any]:
        """Estimate, bound, verdict, counters and links, as docs/node.md lists them."""
        return self._ask("status")

    def measure(self, y: list[float]) -> dict[str, Any]:
        """Hand over a measurement, one number per output, nan = missing; for nodes with source = "socket"."""
        return self._ask(" ".join(["y", *(repr(float(value)) for value in y)]))

    def watch(self) -> Iterator[dict[str, Any]]:
        """One dictionary per sample, as they end, until the node does."""
        with self._connected() as found, found.makefile("r", encoding="utf-8") as lines:
            found.sendall(b"watch\n")
            for line in lines:
                yield json.loads(line)

    def _ask(self, request: str) -> dict[str, Any]:
        with self._connected() as found, found.makefile("r", encoding="utf-8") as lines:
            found.sendall(request.encode() + b"\n")
            answer: dict[str, Any] = json.loads(lines.readline())
        if "error" in answer:
            raise refusal(str(self.path), str(answer["error"]), str(answer["expected"]))
        return answer

    def _connected(self) -> socket.socket:
        found = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        found.settimeout(self.timeout)
        try:
            found.connect(str(self.path))
        except OSError:
            found.close()
            raise
        return found
