"""man_pages.py FOLDER [PROGRAMS]: manual pages, from what the commands say of themselves.

Of garrison and of every command of it, of garrison-net and garrison-web from their parsers; of the compiled programs
that lie in PROGRAMS, from what they print for --help.
"""

import argparse
import re
import subprocess
import sys
from pathlib import Path

from garrison import __version__
from garrison.cli import _parser
from garrison.net import command as net
from garrison.net.web import command as web

PROGRAMS = {
    "garrison-ctl": "ask a running node, or read what it left behind",
    "garrison-keygen": "make the key of a node",
    "garrison-mpi": "run one network on the ranks of an MPI job",
    "garrison-node": "run one agent of a network over authenticated datagrams",
    "garrison-relay": "stand between nodes of one machine, and lose or change what they send",
}


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


def program_page(name: str, summary: str, text: str) -> str:
    """The page of a program that prints `text` for --help: its usage, and the rest as it stands."""
    usage, _, rest = text.strip().partition("\n\n")
    as_it_stands = [line.replace("\\", "\\e").replace("-", "\\-") for line in rest.splitlines()]
    return "\n".join(
        [
            f'.TH "{name.upper()}" 1 "" "garrison {__version__}" "User Commands"',
            ".SH NAME",
            f"{roff(name)} \\- {roff(summary)}",
            ".SH SYNOPSIS",
            ".nf",
            *(roff(line) for line in usage.removeprefix("usage:").splitlines()),
            ".fi",
            ".SH DESCRIPTION",
            ".nf",
            *as_it_stands,
            ".fi",
            "",
        ]
    )


def pages_of(parser: argparse.ArgumentParser) -> dict[str, str]:
    """The page of a command by its name, and one per command below it."""
    name = parser.prog
    below = next((a for a in parser._actions if isinstance(a, argparse._SubParsersAction)), None)
    summaries = {a.dest: a.help or "" for a in below._choices_actions} if below else {}
    commands = [(f"{name}-{sub}", summary) for sub, summary in summaries.items()]
    others = ", ".join(f"\\fB{roff(other)}\\fR(1)" for other, _ in commands or [("garrison", "")])
    pages = {name: page(parser, name, parser.description or "", commands, others)}
    for sub, summary in summaries.items():
        pages[f"{name}-{sub}"] = page(below.choices[sub], f"{name}-{sub}", summary, [], f"\\fB{roff(name)}\\fR(1)")
    return pages


def main(folder: Path, programs: Path | None) -> None:
    """Write them all."""
    folder.mkdir(parents=True, exist_ok=True)
    pages = pages_of(_parser()) | pages_of(net._parser()) | pages_of(web._parser())
    for name, summary in PROGRAMS.items():
        if programs is None or not (programs / name).exists():
            continue  # not built: debian/rules misses its page
        said = subprocess.run([programs / name, "--help"], check=True, capture_output=True, text=True)
        pages[name] = program_page(name, summary, said.stdout or said.stderr)
    for name, text in pages.items():
        (folder / f"{name}.1").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]) if len(sys.argv) > 2 else None)
