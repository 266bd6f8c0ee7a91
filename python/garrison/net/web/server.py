"""The HTTP server: /, /metrics, /events. It reads statuses and can change nothing."""

import threading
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from importlib.resources import files

from garrison.net.web.metrics import exposition
from garrison.net.web.watcher import Watcher

#: open event streams; more are refused, so that /metrics always has a thread
_MOST_STREAMS = 12


class Server(ThreadingHTTPServer):
    """Serves what a watcher knows on host:port; port 0 = any (see `server_port`)."""

    daemon_threads = True

    def __init__(self, host: str, port: int, watcher: Watcher) -> None:
        super().__init__((host, port), _Handler)
        self.watcher = watcher
        self.page = files("garrison.net.web").joinpath("page.html").read_bytes()
        self.streams = threading.BoundedSemaphore(_MOST_STREAMS)


class _Handler(BaseHTTPRequestHandler):
    server: Server
    protocol_version = "HTTP/1.1"
    timeout = 30

    def do_GET(self) -> None:
        """Answer one request."""
        path = self.path.split("?")[0]
        if path == "/":
            self._send(200, "text/html; charset=utf-8", self.server.page)
        elif path == "/metrics":
            text = exposition(self.server.watcher.statuses())
            self._send(200, "text/plain; version=0.0.4; charset=utf-8", text.encode())
        elif path == "/events":
            self._stream()
        else:
            self._send(404, "text/plain; charset=utf-8", b"got another path, expected /, /metrics or /events\n")

    def _stream(self) -> None:
        if not self.server.streams.acquire(blocking=False):
            self._send(503, "text/plain; charset=utf-8", b"too many event streams are open\n")
            return
        try:
            self.close_connection = True
            self.send_response(200)
            self.send_header("Content-Type", "text/event-stream")
            self.send_header("Cache-Control", "no-store")
            self.end_headers()
            turn = -1
            while True:
                turn, event = self.server.watcher.next_event(turn)
                self.wfile.write(f"data: {event}\n\n".encode())
        except OSError:  # the reader went away
            pass
        finally:
            self.server.streams.release()

    def _send(self, code: int, kind: str, content: bytes) -> None:
        self.send_response(code)
        self.send_header("Content-Type", kind)
        self.send_header("Content-Length", str(len(content)))
        self.send_header("Content-Security-Policy", "default-src 'self' 'unsafe-inline'")
        self.end_headers()
        self.wfile.write(content)

    def log_message(self, format: str, *args: object) -> None:
        """Requests are not logged."""
