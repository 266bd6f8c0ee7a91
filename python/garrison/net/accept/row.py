"""One row of the table of what a network of daemons has to meet."""

from collections.abc import Callable
from dataclasses import dataclass

from garrison.net.programs import NODE


@dataclass(frozen=True)
class Measured:
    """What came of a row: in words, and whether its bar is met."""

    text: str
    met: bool


@dataclass(frozen=True)
class Row:
    """One row.

    bar: what has to be met; run(seconds, programs): measures for about so long, with the programs of that folder.
    seconds: how long it takes in full, as `accept NAME` does it; 0 = its work is a count, which does not change.
    needs: a program; rows of programs that are not installed are left out unless they are named.
    """

    name: str
    bar: str
    run: Callable[[float, str | None], Measured]
    seconds: float = 0.0
    needs: str = NODE
