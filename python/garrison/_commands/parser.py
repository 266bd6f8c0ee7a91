"""The reader of the command line: what is misspelt is refused with the name that was probably meant."""

import argparse
import re
from collections.abc import Sequence
from typing import Any, NoReturn

from garrison.words import near


class Parser(argparse.ArgumentParser):
    """Of `garrison` and of each of its commands."""

    def parse_known_args(self, args: Any = None, namespace: Any = None) -> Any:
        """Refuses here what this command does not know: its own options are the ones that were meant."""
        found, unknown = super().parse_known_args(args, namespace)
        if unknown:
            options = [name for action in self._actions if action.dest != "help" for name in action.option_strings]
            self.error(f"unrecognized arguments: {' '.join(unknown)}{_meant(unknown[0].split('=')[0], options)}")
        return found, unknown

    def error(self, message: str) -> NoReturn:
        """Ends with exit code 2."""
        if (choice := re.search(r"invalid choice: '([^']*)'", message)) is not None:
            message += _meant(choice[1], self._choices())
        super().error(message)

    def _choices(self) -> list[str]:
        return [str(one) for action in self._actions if action.choices is not None for one in action.choices]


def _meant(name: str, known: Sequence[str]) -> str:
    advice = near(name, known)
    return f"; {advice}" if advice else ""
