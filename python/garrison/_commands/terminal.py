"""What all commands share: exit codes, tables, JSON."""

from __future__ import annotations

import argparse
import json
import math
import sys
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, TypeAlias

from garrison import _core

if TYPE_CHECKING:
    from rich.console import Console

OK, NO, REFUSED, BUG, INTERRUPTED = 0, 1, 2, 70, 130
#: what `add_subparsers` returns
Commands: TypeAlias = "argparse._SubParsersAction[argparse.ArgumentParser]"
_WIDTH = 140  # of tables that do not go to a terminal
_LONG_WORD = 11  # letters; longer words may be broken


def console_for(stderr: bool = False) -> Console:
    """Where tables go. Texts of users are never read as markup."""
    from rich.console import Console

    stream = sys.stderr if stderr else sys.stdout
    return Console(stderr=stderr, width=None if stream.isatty() else _WIDTH, markup=False, emoji=False, highlight=False)


def whole_number(text: str) -> int:
    """A whole number on the command line; 3.0 is one."""
    try:
        value = number(text)
        if value == int(value):
            return int(value)
    except (ValueError, OverflowError, argparse.ArgumentTypeError):
        pass
    raise argparse.ArgumentTypeError(f"got {text!r}, expected a whole number")


def port_number(text: str) -> int:
    """A port on the command line; 0 = any that is free."""
    value = whole_number(text)
    if not 0 <= value <= 65535:
        raise argparse.ArgumentTypeError(f"got {text!r}, expected a port, 0..65535")
    return value


def count_number(text: str) -> int:
    """How often, on the command line."""
    value = whole_number(text)
    if value < 0:
        raise argparse.ArgumentTypeError(f"got {text!r}, expected a whole number >= 0")
    return value


def number(text: str) -> float:
    """A number on the command line."""
    try:
        if "_" in text:  # Python takes 1_0.5 for 10.5
            raise ValueError
        return float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"got {text!r}, expected a number, without its unit") from None


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
    """One JSON document on standard output."""
    print(json.dumps(clean(value), indent=1))


def print_table(title: str, head: list[str], rows: list[list[str]], console: Console) -> None:
    """A table that breaks lines between words, as long as the words are not too long for the terminal."""
    from rich import box
    from rich.table import Table
    from rich.text import Text

    table = Table(
        title=Text(title) if title else None,
        title_justify="left",
        box=box.SIMPLE_HEAD,
        padding=0,
        show_edge=False,
        pad_edge=False,
    )
    for k, name in enumerate(head):
        words = [word for cell in (name, *(row[k] for row in rows)) for word in cell.split()]
        table.add_column(Text(name), overflow="fold", min_width=min(max(map(len, words), default=1), _LONG_WORD))
    for row in rows:
        table.add_row(*(Text(cell) for cell in row))
    console.print(table)


def print_warnings(lines: Iterable[str], stderr: bool = False) -> None:
    """Doubts, one a line."""
    for line in lines:
        print(f"warning: {line}", file=sys.stderr if stderr else sys.stdout)


@contextmanager
def working(words: str) -> Iterator[None]:
    """Say on the terminal what is being done, as long as it lasts; nothing where stderr is a file."""
    console = console_for(stderr=True)
    if not console.is_terminal:
        yield
        return
    with console.status(f"{words} (Ctrl-C ends it)"):
        yield


def in_options(error: _core.Error, options: Mapping[str, str]) -> _core.Error:
    """The refusal of a function with the command's options in place of its arguments (name -> option)."""
    name, colon, rest = str(error).partition(":")
    return type(error)(f"{options[name]}:{rest}") if colon and name in options else error


def tell_work(words: str, done: int, total: int) -> None:
    """Progress of a call that does several things one after the other: which one it is at, on a line of its own."""
    line = "" if done >= total else f"{done + 1} of {total}: {words}"
    print(f"\r\033[K{line[:100]}", end="", file=sys.stderr, flush=True)
