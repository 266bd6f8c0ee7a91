"""Docstrings as reStructuredText: numpydoc sections become lists, everything else is literal text.

Marks of reStructuredText in docstrings (|x|, x', A_t, *) are meant literally.
"""

import re

_MARKS = re.compile(r"([\\*`|_]|:(?=:|$))")
_SECTIONS = ("Attributes", "Parameters", "Returns", "Raises")


def process(_app: object, _kind: str, _name: str, _thing: object, _options: object, lines: list[str]) -> None:
    """Escape every mark; keep the lines of paragraphs that are indented; show sections as definition lists."""
    text, sections = _split(lines)
    out = [line for paragraph in _paragraphs(text) for line in [*_shown(paragraph), ""]]
    for name, body in sections:
        out += [f"**{name}**", "", *_definitions(body), ""]
    lines[:] = out


def _split(lines: list[str]) -> tuple[list[str], list[tuple[str, list[str]]]]:
    """The text before the first section, and the sections."""
    heads = [
        k
        for k, line in enumerate(lines[:-1])
        if line in _SECTIONS and lines[k + 1].strip() and not lines[k + 1].strip("-")
    ]
    if not heads:
        return lines, []
    ends = [*heads[1:], len(lines)]
    sections = [(lines[k], lines[k + 2 : end]) for k, end in zip(heads, ends, strict=True)]
    return lines[: heads[0]], sections


def _definitions(body: list[str]) -> list[str]:
    """`name : type` and the indented lines below it."""
    out: list[str] = []
    for line in body:
        if not line.strip():
            continue
        if not line.startswith(" "):
            name, separator, kind = line.partition(" : ")
            shown = f"**{_escaped(name)}** : {_escaped(kind)}" if separator else f"**{_escaped(name)}**"
            out += ["", shown]
        else:
            out.append(f"   {_escaped(line.strip())}")
    return out[1:]


def _escaped(text: str) -> str:
    return _MARKS.sub(r"\\\1", text)


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
    escaped = [_escaped(line[depth:]) for line in paragraph]
    if any(line.startswith(" ") for line in escaped) or re.match(r"(\d+[.)]|[-+#(.=]) ?", escaped[0]):
        return [f"| {line}" for line in escaped]
    return escaped
