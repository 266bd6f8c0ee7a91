"""The command `garrison-web`: a page and metrics of running nodes."""

import argparse
import sys
from pathlib import Path

from garrison._commands.terminal import port_number
from garrison.net.web.scene import Scene
from garrison.net.web.server import Server
from garrison.net.web.watcher import Watcher


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="garrison-web",
        description="A live page (/) and metrics for Prometheus (/metrics) of running nodes. Reads only.",
        epilog="Exit codes: 0 interrupted, 2 input refused.",
        allow_abbrev=False,
    )
    parser.add_argument("socket", nargs="+", type=Path, help="[socket].path of a node")
    parser.add_argument("--host", default="127.0.0.1", help="address to listen at (default 127.0.0.1)")
    parser.add_argument("--port", type=port_number, default=9470, help="port to listen at (default 9470)")
    return parser


def main(argv: list[str] | None = None) -> int:
    """Run the command line; returns the exit code."""
    try:
        args = _parser().parse_args(argv)
    except SystemExit as usage:
        return int(usage.code or 0)
    watcher = Watcher(args.socket, Scene())
    try:
        with Server(args.host, args.port, watcher) as server:
            watcher.start()
            print(f"http://{args.host}:{server.server_port}/", flush=True)
            server.serve_forever()
    except (OSError, OverflowError) as error:
        place = f"--host {args.host} --port {args.port}"
        print(f"garrison-web: {place}: got {error}, expected an address of this machine that is free", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        pass
    return 0
