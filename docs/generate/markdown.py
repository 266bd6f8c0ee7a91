"""Small pieces of Markdown."""

from collections.abc import Iterable


def cell(text: object) -> str:
    """Text that may stand in a table."""
    marks = str(text).replace("\\", "\\\\")
    for mark in "|*_`<[":
        marks = marks.replace(mark, "\\" + mark)
    return " ".join(marks.split())


def code(text: object) -> str:
    """Text as code in a table; nothing stays nothing."""
    return f"`{text}`".replace("|", "\\|") if str(text) else ""


def table(head: list[str], rows: Iterable[list[str]]) -> str:
    """A table of cells that are Markdown already."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines) + "\n"
