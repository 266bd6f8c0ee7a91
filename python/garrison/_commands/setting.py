"""`--set KEY=VALUE`: other values for keys of a scenario."""

import argparse
import tomllib
from typing import Any

from garrison.words import refusal


def add_set(command: argparse.ArgumentParser) -> None:
    """Declare the option."""
    command.add_argument(
        "--set",
        action="append",
        default=[],
        metavar="KEY=VALUE",
        help="another value for a key, as in TOML: filter.threshold=0.7, 'attack[0].agents=[3, 4]', filter.name=dkf",
    )


def settings(given: list[str]) -> dict[str, Any]:
    """Key -> value. Raises InvalidInput on what is no KEY=VALUE, and on a key given twice."""
    found: dict[str, Any] = {}
    for text in given:
        key, equals, words = (part.strip() for part in text.partition("="))
        if not equals or not key or not words:
            raise refusal("--set", repr(text), "KEY=VALUE such as filter.threshold=0.7")
        if key in found:
            raise refusal("--set", f"{key} twice", "every key once")
        found[key] = _value(words)
    return found


def _value(words: str) -> Any:
    """A value of TOML; words that are none are a string, so that names need no quotes."""
    try:
        read = tomllib.loads(f"value = {words}")
    except tomllib.TOMLDecodeError:
        return words
    return read["value"] if len(read) == 1 else words
