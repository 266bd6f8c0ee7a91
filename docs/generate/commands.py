"""The reference of the command line, from its parsers."""

import argparse

from garrison import cli

from generate.markdown import cell, code, table


def page() -> str:
    """The page of the command `garrison`."""
    parser = cli._parser()
    parts = ["# Command line\n", "`garrison COMMAND`, or `python -m garrison COMMAND`.\n", cell(parser.epilog) + "\n"]
    return "\n".join([*parts, *_commands(parser, 2)])


def _commands(parser: argparse.ArgumentParser, depth: int) -> list[str]:
    """The commands of a parser under headings of this depth, and those below them under deeper ones."""
    parts = []
    for group in (a for a in parser._actions if isinstance(a, argparse._SubParsersAction)):
        helps = {a.dest: a.help or "" for a in group._choices_actions}
        for name, command in group.choices.items():
            text = helps[name]
            parts.append(f"{'#' * depth} {command.prog}\n\n{cell(text[:1].upper() + text[1:])}.\n")
            parts.append("```text\n" + command.format_usage().removeprefix("usage: ") + "```\n")
            parts.append(_arguments(command))
            parts += _commands(command, depth + 1)
    return parts


def _arguments(command: argparse.ArgumentParser) -> str:
    rows = [[_name(a), cell(_help(command, a))] for a in command._actions if _is_shown(a)]
    return table(["argument", "meaning"], rows) if rows else ""


def imports() -> dict[str, str]:
    """The arguments of every `garrison import KIND`, a table each, for the pages of the guides."""
    return {name: _arguments(kind) for name, kind in _below(_below(cli._parser())["import"]).items()}


def _below(parser: argparse.ArgumentParser) -> dict[str, argparse.ArgumentParser]:
    group = next(a for a in parser._actions if isinstance(a, argparse._SubParsersAction))
    return dict(group.choices)


def _is_shown(action: argparse.Action) -> bool:
    inner = isinstance(action, argparse._SubParsersAction)
    return action.help != argparse.SUPPRESS and action.dest != "help" and not inner


def _name(action: argparse.Action) -> str:
    value = action.metavar or (action.dest.upper() if action.nargs != 0 else "")
    if not action.option_strings:
        return code(action.metavar or action.dest)
    shown = value if isinstance(value, str) else " ".join(value)
    return ", ".join(code(f"{flag} {shown}".strip()) for flag in action.option_strings)


def _help(command: argparse.ArgumentParser, action: argparse.Action) -> str:
    return command._get_formatter()._expand_help(action) if action.help else ""
