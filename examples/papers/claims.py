"""What every paper page prints: a claim, what came out, whether it holds, and if not, why."""

from collections.abc import Iterable, Sequence
from typing import Literal

from rich.console import Console
from rich.table import Table

Rows = list[list[str]]


def claim(text: str, found: str, holds: bool, why: str = "") -> list[str]:
    """A row of the table of claims."""
    return [text, found, "confirmed" if holds else "not confirmed", why]


def print_claims(title: str, rows: Rows) -> None:
    print_table(title, ("claim", "what came out", "verdict", "why"), rows)


def print_table(
    title: str, names: Iterable[str], rows: Iterable[Sequence[str]], justify: Literal["left", "right"] = "left"
) -> None:
    table = Table(title=title, title_justify="left")
    for name in names:
        table.add_column(name, overflow="fold", justify=justify)
    for row in rows:
        table.add_row(*row)
    Console(width=150).print(table)
