"""The reference of the command line, from its parsers."""

import argparse

from garrison import cli

from generate.markdown import cell, code, table


def page() -> str:
    """The page of the command `garrison`."""
    parser = cli._parser()
    groups = [a for a in parser._actions if isinstance(a, argparse._SubParsersAction)]
    helps = {a.dest: a.help for a in groups[0]._choices_actions}
    parts = ["# Command line\n", "`garrison COMMAND`, or `python -m garrison COMMAND`.\n", cell(parser.epilog) + "\n"]
    for name, command in groups[0].choices.items():
        text = helps.get(name) or ""
        parts.append(f"## garrison {name}\n\n{cell(text[:1].upper() + text[1:])}.\n")
        parts.append("```text\n" + command.format_usage().removeprefix("usage: ") + "```\n")
        actions = [a for a in command._actions if a.help != argparse.SUPPRESS and a.dest != "help"]
        rows = [[_name(a), cell(_help(command, a))] for a in actions]
        parts.append(table(["argument", "meaning"], rows) if rows else "")
    return "\n".join(parts)


def _name(action: argparse.Action) -> str:
    value = action.metavar or (action.dest.upper() if action.nargs != 0 else "")
    if not action.option_strings:
        return code(action.metavar or action.dest)
    shown = value if isinstance(value, str) else " ".join(value)
    return ", ".join(code(f"{flag} {shown}".strip()) for flag in action.option_strings)


def _help(command: argparse.ArgumentParser, action: argparse.Action) -> str:
    return command._get_formatter()._expand_help(action) if action.help else ""
