"""A file of one follower and its leader, whose columns are named in one of the usual ways."""

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from garrison.importers.texts import Grid
from garrison.words import refusal

Array = NDArray[np.float64]
_LEADER = {"leader", "lead", "l", "lv", "preceding", "pre", "ahead", "front", "lc", "prec"}
_OWN = {"follower", "follow", "fol", "f", "fv", "fav", "ego", "own", "subject", "sv", "following", "self"}
_QUANTITIES = {
    "position": {"x", "pos", "position", "location", "loc", "distance", "displacement"},
    "speed": {"v", "vel", "velocity", "speed", "spd"},
    "acceleration": {"a", "acc", "acceleration", "accel"},
    "gap": {"s", "gap", "spacing", "ivs", "space", "spatial", "clearance"},
}
#: words of columns that are made from others
_DERIVED = {"diff", "difference", "delta", "relative", "rel", "dv", "headway", "thw", "ttc", "jerk", "time"}
_MILLISECONDS = {"ms", "milliseconds"}


@dataclass(frozen=True)
class Follower:
    """t: s. speed, leader_speed: m/s. gap: m. acceleration: m/s^2, None where there is none."""

    path: Path
    t: Array
    speed: Array
    leader_speed: Array
    gap: Array
    acceleration: Array | None
    gap_is_of_positions: bool


def read_follower(grid: Grid) -> Follower:
    """The columns of a file, by their names. Raises InvalidInput where speeds or the gap are missing."""
    roles: dict[tuple[str, str], str] = {}
    for k, name in enumerate(grid.names):
        role = _role(name) if k != grid.time else None
        if role is not None:
            roles.setdefault(role, name)
    for who, quantity, word in (("own", "speed", "v_follower"), ("leader", "speed", "v_leader")):
        if (who, quantity) not in roles:
            columns = ", ".join(grid.names)
            raise refusal(
                str(grid.path),
                f"the columns {columns}",
                f"a {quantity} of the {who if who == 'leader' else 'follower'}, as {word}",
                "or the columns Speed1, Speed2, .., IVS1, .. of an original file",
            )
    column = {role: grid.column(name) for role, name in roles.items()}
    t = grid.column(grid.names[grid.time])
    if set(_words(grid.names[grid.time])) & _MILLISECONDS:
        t = t / 1000.0
    gap = column.get(("own", "gap"))
    x, ahead = column.get(("own", "position")), column.get(("leader", "position"))
    by_positions = gap is None and x is not None and ahead is not None
    if gap is None and x is not None and ahead is not None:
        gap = ahead - x
    if gap is None:
        raise refusal(
            str(grid.path),
            f"the columns {', '.join(grid.names)}",
            "the gap to the leader, as spacing, or the positions of both, as x_follower and x_leader",
        )
    own, lead = column["own", "speed"], column["leader", "speed"]
    return Follower(grid.path, t, own, lead, gap, column.get(("own", "acceleration")), by_positions)


def _role(name: str) -> tuple[str, str] | None:
    """(own or leader, quantity) of a column; None where it is something else."""
    words = _words(name)
    quantity = next((q for word in words for q, known in _QUANTITIES.items() if word in known), None)
    if quantity is None or set(words) & _DERIVED:
        return None
    if quantity == "gap":
        return "own", "gap"
    return ("leader" if set(words) & _LEADER else "own"), quantity


def _words(name: str) -> list[str]:
    """The words of a name: x_leader, leaderX, Speed_FAV, xl and v_lead(m/s) are understood."""
    spaced = re.sub(r"([a-z])([A-Z])", r"\1 \2", re.sub(r"[\[(].*?[\])]", "", name))
    words = [w for w in re.split(r"[^A-Za-z]+", spaced.lower()) if w]
    if len(words) == 1 and (short := re.fullmatch(r"([xva])(l|f)|(l|f)([xva])", words[0])):
        return [w for w in short.groups() if w]
    return words
