"""The call that makes a run once more, bit for bit."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from garrison import _core
from garrison.objects import attack_of
from garrison.result import MOST_SHOWN
from garrison.varying import VaryingModel
from garrison.words import refusal

if TYPE_CHECKING:
    from garrison.record import Run


def recipe(run: Run) -> tuple[str, tuple[Any, ...], dict[str, Any]]:
    """Name of the driver, (model, network, filter), and the keyword arguments.

    Raises InvalidInput where the measurements are missing, or an attack or the plant was written in Python.
    """
    if not run.made:
        raise refusal("again", "a run that does not say what made it", "one of simulate or replay")
    if run.made.get("functions"):
        advice = "call simulate or replay with them"
        raise refusal("again", "a run of a NonlinearModel, whose functions no run keeps", "one of matrices", advice)
    given = {key: value for key, value in run.made.items() if key not in ("driver", "attack")}
    attacks = [attack_of(plain) for plain in run.made["attack"]]
    changes: dict[str, Any] = run.varying
    plant = VaryingModel(run.model, **changes) if changes else run.model
    given["inputs"] = run.inputs
    if run.made["driver"] == "simulate":
        given["attack"] = attacks
    else:
        if run.measurements is None:
            raise refusal("again", "a replay without its measurements", 'keep to contain "measurements"')
        given |= {"measurements": run.measurements if run.log is None else run.log, "truth": run.truth}
        # Without the log, as runs were saved before they kept it, attacks on measurements are in what was kept.
        given["attack"] = [attack for attack in attacks if run.log is not None or attack.target == "message"]
    return run.made["driver"], (plant, run.network, run.filter), given


def code(run: Run) -> str | None:
    """The call as Python code; None where there is none, or it would hold more than a thousand numbers of records."""
    try:
        driver, objects, given = recipe(run)
    except _core.InvalidInput:
        return None
    arrays = {key: value for key, value in given.items() if isinstance(value, np.ndarray)}
    if sum(value.size for value in arrays.values()) > MOST_SHOWN:
        return None
    given |= {key: value.tolist() for key, value in arrays.items()}
    words = [repr(one) for one in objects] + [f"{key}={value!r}" for key, value in given.items()]
    return f"garrison.{driver}({', '.join(words)})"
