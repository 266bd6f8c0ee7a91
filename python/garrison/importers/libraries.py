"""Libraries that an importer needs and garrison does not: their absence says what to install."""

import importlib
from typing import Any

from garrison import _core
from garrison.words import refusal


def library(name: str, extra: str, purpose: str) -> Any:
    """The module `name`; where it is missing, an InvalidInput that says which extra brings it.

    purpose: what it is needed for, as "reading bags".
    """
    try:
        return importlib.import_module(name)
    except ModuleNotFoundError as error:
        raise missing(name, extra, purpose, error) from None


def missing(name: str, extra: str, purpose: str, error: ModuleNotFoundError) -> _core.InvalidInput:
    """The refusal of an import that needs `name` or something that `name` needs."""
    package = name.partition(".")[0]
    absent = (error.name or package).partition(".")[0]
    return refusal(
        purpose,
        f"no module {absent}",
        f"the package {package}",
        f'install it: pip install {package}, or pip install "garrison[{extra}]"',
    )
