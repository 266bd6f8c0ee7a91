"""A run as one long table: a row per trial, time and agent."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from garrison.bound_kind import BoundKind
from garrison.families import family_of
from garrison.verdict import Verdict
from garrison.words import refusal

if TYPE_CHECKING:
    from garrison import _core
    from garrison.record import Run


#: columns that every table begins with, and numbers of reports
_OWN = ("trial", "time", "agent")
_REPORTED = ("error", "bound", "published", "statistic", "threshold")


def agent_names(run: Run) -> list[str] | None:
    """Names of the agents, where the network has them."""
    names = getattr(run.network, "names", None)
    return [str(n) for n in names] if names else None


def state_names(run: Run) -> list[str]:
    """Names of the states, else x0, x1, ..."""
    names = getattr(run.model, "state_names", None)
    return [str(n) for n in names] if names else [f"x{k}" for k in range(run.model.states)]


def state_columns(run: Run) -> list[str]:
    """Names of the columns that estimates have in tables: those of the states, told apart from other columns."""
    return [_column(name) for name in state_names(run)]


def common_unit(model: _core.Model) -> str:
    """The unit of all states, where they have one and the same: then errors and bounds have it too."""
    found = {model.units.get(s, "") for s in model.state_names}
    return found.pop() if len(found) == 1 else ""


def units(run: Run) -> dict[str, str]:
    """Unit by the name of a column, where it is known."""
    found = {
        name: unit
        for state, unit in run.model.units.items()
        for name in (_column(state), f"true_{state}", f"box_{state}")
    }
    if unit := common_unit(run.model):
        found |= dict.fromkeys(("error", "bound", "published"), unit)
    return found


def _column(state: str) -> str:
    return f"state_{state}" if state in (*_OWN, *_REPORTED, "date", "bound_kind", "verdict") else state


def columns(run: Run) -> dict[str, Any]:
    """Columns of the table, all of one length."""
    trials, times, agents = run.shape
    if trials == 0:
        raise refusal("to_pandas", "a run of which nothing was kept", 'keep to contain "estimate" or "report"')
    index = np.indices((trials, times, agents)).reshape(3, -1)
    names = agent_names(run)
    out: dict[str, Any] = {"trial": index[0], "time": index[1]}
    out["agent"] = index[2] if names is None else np.array(names, dtype=object)[index[2]]
    states = state_names(run)
    if run.estimate is not None:
        out |= {name: run.estimate[..., k].ravel() for k, name in enumerate(state_columns(run))}
    if run.truth is not None:
        truth = run.truth if family_of(run.filter).own_plants else run.truth[:, :, None]
        whole = np.broadcast_to(truth, (trials, times, agents, truth.shape[-1]))
        out |= {f"true_{name}": whole[..., k].ravel() for k, name in enumerate(states)}
    if run.box is not None:
        out |= {f"box_{name}": run.box[..., k].ravel() for k, name in enumerate(states)}
    for name in _REPORTED:
        if getattr(run, name) is not None:
            out[name] = getattr(run, name).ravel()
    if run.bound_kind is not None:
        out["bound_kind"] = np.array([k.word for k in BoundKind], dtype=object)[run.bound_kind.ravel()]
    if run.verdict is not None:
        words = np.array([v.word for v in Verdict], dtype=object)
        out["verdict"] = words[run.verdict.ravel()]
    return out | {f"signal_{name}" if name in out else name: v.ravel() for name, v in run.signals.items()}


def frame(run: Run) -> Any:
    """`columns` as a pandas.DataFrame."""
    try:
        import pandas as pd
    except ImportError:
        raise refusal("to_pandas", "no pandas", 'it installed: pip install "garrison[pandas]"') from None
    table = pd.DataFrame(columns(run))
    table.attrs["units"] = {name: unit for name, unit in units(run).items() if name in table}
    return table
