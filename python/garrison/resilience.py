"""What sharing less of an estimate costs and saves: bytes on the links against errors, honest and under attack."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np

from garrison import _core
from garrison._core import partial_sharing as theory
from garrison.arguments import number, whole_numbers
from garrison.filters import PartialSharing
from garrison.result import Result
from garrison.words import hinted, hinted_methods, refusal


@hinted_methods
@dataclass(frozen=True, eq=False, repr=False)
class Resilience(Result):
    """One number of shared entries. Errors are exact, means over the cycle of the periodic steady state.

    Attributes
    ----------
    shared : int
        Entries l per message.
    bytes_per_step : int
        Payload of all messages of a sample.
    mse : float
        Mean over agents of the squared error.
    mse_attacked : float
        The same under the worst coordinated covariance of the given energy.
    radius : float
        Of the error dynamics, unstable from 1 on (both errors are then inf).
    """

    shared: int
    bytes_per_step: int
    mse: float
    mse_attacked: float
    radius: float


@hinted
def resilience_per_byte(
    model: _core.Model,
    network: _core.Network,
    agents: Iterable[int],
    *,
    gain: float,
    energy: float,
    shared: Iterable[int] | None = None,
    **params: Any,
) -> list[Resilience]:
    """Bytes per sample, MSE, and MSE under the worst attack of some agents, over the number of shared entries.

    Parameters
    ----------
    model : Model
        The plant and its sensors.
    network : Network
        Who hears whom.
    agents : iterable of int
        The attackers.
    gain : float
        Of filters.PartialSharing, >= 0.
    energy : float
        Largest trace of the covariance of the attack.
    shared : iterable of int, optional
        Numbers of shared entries to try, default 1..n.
    **params
        Others of filters.PartialSharing.

    Returns
    -------
    list of Resilience
        One per number of shared entries.

    Raises
    ------
    InvalidInput
        An agent cannot detect the state alone, or something does not fit.
    """
    if not isinstance(model, _core.Model) or not isinstance(network, _core.Network):
        got = f"({type(model).__name__}, {type(network).__name__})"
        raise refusal("resilience_per_byte", got, "(model, network, agents)")
    liars = whole_numbers("agents", agents)
    if wrong := [a for a in liars if not 0 <= a < model.agents]:
        raise refusal("agents", str(wrong[0]), f"numbers in 0..{model.agents - 1}")
    if twice := [a for a in liars if liars.count(a) > 1]:
        raise refusal("agents", f"{twice[0]} twice", "every agent once")
    out = []
    for entries in range(1, model.states + 1) if shared is None else whole_numbers("shared", shared, 1):
        filt = PartialSharing(gain=gain, shared=entries, **params)
        analysis = theory.Analysis(model, network, filt)
        radius = analysis.cycle_radius()
        mse = attacked = float("inf")
        if radius < 1:
            mse = float(np.mean(analysis.periodic_mse()))
            attacked = mse + float(analysis.worst(liars, number("energy", energy))["gain"]) / model.agents
        out.append(Resilience(entries, analysis.bytes_per_step, mse, attacked, radius))
    return out
