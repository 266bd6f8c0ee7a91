"""The table of a comparison: a row per filter and attack."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from garrison import _core
from garrison.drawing import drawn
from garrison.result import Result
from garrison.words import hinted_methods

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Array = NDArray[np.float64]
Row = dict[str, Any]

#: the name of no attack
NONE = "none"
#: columns of the table after filter and attack
COLUMNS = (
    "q50", "q95", "q99", "detection_delay", "false_alarms", "bound_share", "inside_bound", "bytes_per_sample",
    "microseconds", "status",
)  # fmt: skip


def empty(status: str) -> Row:
    """The columns of a row without numbers."""
    return dict.fromkeys(COLUMNS) | {"status": status}


@hinted_methods
@dataclass(eq=False, repr=False)
class Comparison(Result):
    """Errors, alarms, bounds and costs of filters and baselines under attacks.

    Attributes
    ----------
    title : str
        For tables and pictures.
    attacked : list of int
        Agents that lie.
    rows : list of dict
        One per filter and attack ("none" first), None where something does not exist for it. q50, q95, q99: quantiles
        of the errors of honest agents' estimates from the attack's start on, over agents, samples and trials.
        detection_delay: samples until an attacked agent is accused, median over the trials where one was.
        false_alarms: agents accused per trial while they were honest. bound_share, inside_bound: samples with an error
        bound, and errors within it, 0..1. bytes_per_sample: of all messages. microseconds: per agent and sample,
        conditions and design left out. status: "ok", or why there are no numbers.
    """

    title: str
    attacked: list[int]
    rows: list[Row]

    def table(self, column: str = "q95") -> tuple[list[str], list[str], Array]:
        """One column of all rows as a matrix.

        Parameters
        ----------
        column : str
            A key of `rows`, such as "q95".

        Returns
        -------
        (list of str, list of str, (filters, attacks) array)
            Filters, attacks and numbers; nan where a number does not exist.
        """
        filters = list(dict.fromkeys(row["filter"] for row in self.rows))
        attacks = list(dict.fromkeys(row["attack"] for row in self.rows))
        numbers = np.full((len(filters), len(attacks)), np.nan)
        for row in self.rows:
            value = row[column]
            if value is not None:
                numbers[filters.index(row["filter"]), attacks.index(row["attack"])] = value
        return filters, attacks, numbers

    def summary(self) -> list[Row]:
        """A row per filter: its error (q95) without an attack and the worst with lies in measurements and in messages,
        by which attack; the least inside_bound, and means of the other columns over the attacks.
        """
        message = {info["name"] for info in _core.attack_infos() if info["target"] == "message"}
        out = []
        for label in dict.fromkeys(row["filter"] for row in self.rows):
            rows = [row for row in self.rows if row["filter"] == label]
            fine = [row for row in rows if row["q95"] is not None]
            lied = [row for row in fine if row["attack"] != NONE]
            found: Row = {"filter": label, "none": next((r["q95"] for r in fine if r["attack"] == NONE), None)}
            for name, some in (
                ("measurements", [row for row in lied if row["attack"] not in message]),
                ("messages", [row for row in lied if row["attack"] in message]),
            ):
                worst = max(some, key=lambda row: float(row["q95"]), default=None)
                found |= {name: worst and worst["q95"], f"{name}_by": worst and worst["attack"]}
            for name in ("detection_delay", "false_alarms", "bound_share", "bytes_per_sample", "microseconds"):
                values = [row[name] for row in fine if row[name] is not None]
                found[name] = float(np.mean(values)) if values else None
            inside = [row["inside_bound"] for row in fine if row["inside_bound"] is not None]
            found["inside_bound"] = min(inside, default=None)
            found["status"] = "ok" if fine else rows[0]["status"]
            out.append(found)
        return out

    def to_pandas(self) -> Any:
        """The rows as a pandas.DataFrame (extra: pandas)."""
        import pandas as pd

        return pd.DataFrame(self.rows)

    def plot(self) -> Figure:
        """95 % quantiles of the errors as a map of filters and attacks (extra: plot)."""
        return drawn("comparison_figure", self)
