"""Docstrings are plain text here; marks of reStructuredText in them (|x|, x', A_t, *) are meant literally."""

import re

_MARKS = re.compile(r"([\\*`|_]|:(?=:|$))")


def process(_app: object, _kind: str, _name: str, _thing: object, _options: object, lines: list[str]) -> None:
    """Escape every mark; keep the lines of paragraphs that are indented."""
    lines[:] = [line for paragraph in _paragraphs(lines) for line in [*_shown(paragraph), ""]]


def _paragraphs(lines: list[str]) -> list[list[str]]:
    found: list[list[str]] = [[]]
    for line in lines:
        if line.strip():
            found[-1].append(line)
        else:
            found.append([])
    return [paragraph for paragraph in found if paragraph]


def _shown(paragraph: list[str]) -> list[str]:
    depth = min(len(line) - len(line.lstrip()) for line in paragraph)
    escaped = [_MARKS.sub(r"\\\1", line[depth:]) for line in paragraph]
    if any(line.startswith(" ") for line in escaped) or re.match(r"(\d+[.)]|[-+#(.=]) ?", escaped[0]):
        return [f"| {line}" for line in escaped]
    return escaped
