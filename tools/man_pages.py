"""man_pages.py FOLDER: manual pages of the command line, from its own parsers: garrison(1) and one per command."""

import argparse
import re
import sys
from pathlib import Path

from garrison import __version__
from garrison.cli import _parser


def roff(text: str) -> str:
    """The text with what troff would take for itself escaped."""
    text = " ".join(text.split()).replace("\\", "\\e").replace("-", "\\-").replace("'", "\\(aq")
    return "\\&" + text if text.startswith(".") else text


def synopsis(parser: argparse.ArgumentParser) -> str:
    """The usage without its first word."""
    return roff(re.sub(r"^usage: ", "", parser.format_usage()))


def options(parser: argparse.ArgumentParser) -> list[str]:
    """One paragraph per argument."""
    lines = []
    formatter = parser._get_formatter()
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction) or action.help is argparse.SUPPRESS:
            continue
        name = formatter._format_action_invocation(action)
        lines += [".TP", f"\\fB{roff(name)}\\fR", roff(formatter._expand_help(action) if action.help else "")]
    return lines


def page(parser: argparse.ArgumentParser, name: str, summary: str, commands: list[tuple[str, str]], others: str) -> str:
    """One manual page."""
    lines = [
        f'.TH "{name.upper()}" 1 "" "garrison {__version__}" "User Commands"',
        ".SH NAME",
        f"{roff(name)} \\- {roff(summary)}",
        ".SH SYNOPSIS",
        synopsis(parser),
        ".SH DESCRIPTION",
        roff(parser.description or summary),
        ".SH OPTIONS",
        *options(parser),
    ]
    if commands:
        lines.append(".SH COMMANDS")
        for command, what in commands:
            lines += [".TP", f"\\fB{roff(command)}\\fR(1)", roff(what)]
    if parser.epilog:
        lines += [".SH NOTES", roff(parser.epilog)]
    return "\n".join([*lines, ".SH SEE ALSO", others, ""])


def main(folder: Path) -> None:
    """Write them all."""
    folder.mkdir(parents=True, exist_ok=True)
    parser = _parser()
    (choices,) = (a for a in parser._actions if isinstance(a, argparse._SubParsersAction))
    summaries = {a.dest: a.help or "" for a in choices._choices_actions}
    commands = [(f"garrison-{name}", summaries[name]) for name in choices.choices]
    others = ", ".join(f"\\fB{roff(name)}\\fR(1)" for name, _ in commands)
    pages = {"garrison": page(parser, "garrison", parser.description or "", commands, others)}
    for name, sub in choices.choices.items():
        pages[f"garrison-{name}"] = page(sub, f"garrison-{name}", summaries[name], [], "\\fBgarrison\\fR(1)")
    for name, text in pages.items():
        (folder / f"{name}.1").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
