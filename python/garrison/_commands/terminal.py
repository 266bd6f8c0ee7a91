"""What all commands share: exit codes, tables, JSON, files that are not overwritten."""

import argparse
import json
import math
import sys
from pathlib import Path
from typing import Any, TypeAlias

from rich.console import Console
from rich.table import Table

from garrison import _core

OK, NO, BAD = 0, 1, 2
#: what `add_subparsers` returns
Commands: TypeAlias = "argparse._SubParsersAction[argparse.ArgumentParser]"
_WIDTH = 140  # of tables that do not go to a terminal


def console_for(stderr: bool = False) -> Console:
    stream = sys.stderr if stderr else sys.stdout
    return Console(stderr=stderr, width=None if stream.isatty() else _WIDTH)


def clean(value: Any) -> Any:
    """Numbers that JSON does not have become null."""
    if isinstance(value, dict):
        return {str(k): clean(v) for k, v in value.items()}
    if isinstance(value, (list, tuple)):
        return [clean(v) for v in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value


def print_json(value: Any) -> None:
    print(json.dumps(clean(value), indent=1))


def print_table(title: str, head: list[str], rows: list[list[str]], console: Console) -> None:
    table = Table(title=title, title_justify="left", show_edge=False, pad_edge=False)
    for name in head:
        table.add_column(name, overflow="fold")
    for row in rows:
        table.add_row(*row)
    console.print(table)


def new_file(name: str, force: bool) -> Path:
    """The path of a file to write; refused where it exists and `force` is not given."""
    path = Path(name)
    if path.exists() and not force:
        raise _core.IoError(f"{path}: exists already; choose another name, or replace it with --force")
    return path
