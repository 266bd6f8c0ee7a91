"""The certificate to expect, before anything runs."""

from typing import Any

import numpy as np

from garrison import _core
from garrison.certifying.methods import steady
from garrison.certifying.plant import Plant

#: samples after which one with memory is looked at
_REMEMBERED = 20
#: kinds of bounds that are a certificate of the measurements
_OWN = (2, 3, 11)
#: samples that the union over time is taken over, in theorem B2
_SAMPLES = 1000
#: pairs of sets, times n^3, that are gone through for it: about a second
_MOST_PAIRS = 2e6


def expected_certificate(design: _core.Design) -> list[dict[str, Any]]:
    """Quantities of `Check`: bounds of a sample on which all measurements agree with each other and the estimate.

    No message is lost. A lie that stands out is left out and costs nothing; one that hides in the noise makes the bound
    larger, by about as much as it may move the estimate. Empty without a certificate.
    """
    wanted = design.certificate
    if wanted is None:
        return []
    samples = _REMEMBERED if wanted.get("memory") else 1
    made = _core.replay(
        design,
        measurements=np.zeros((samples, design.model.outputs)),
        truth=None,
        trials=1,
        first_trial=0,
        seed=0,
        threads=1,
        start=None,
        attacks=[],
        link={},
        keep=["report"],
        inputs=np.zeros((samples if design.model.inputs else 0, design.model.inputs)),
        series={},
        functions={},
        progress=None,
    )
    bound, kind = made["bound"][0, -1], made["bound_kind"][0, -1]
    own = np.isin(kind, _OWN) & np.isfinite(bound)
    failure = wanted["failure"]
    if failure == 0:
        law = "for noise within its bounds"
    elif "levels" in wanted:
        law = f"at levels that clean records exceed at the rate {failure:g}"
    else:
        law = f"at {failure:g} per agent and sample"
    who = f"with any {wanted['attacked']} sources lying"
    when = "on a sample" if samples == 1 else f"after {samples} samples"
    return [
        {
            "name": "certificate_expected",
            "value": float(bound[own].max()) if own.any() else float("nan"),
            "meaning": f"{who}, the largest certified bound of an agent {when} where nothing stands out, {law}",
        },
        {
            "name": "certificate_agents",
            "value": float(own.mean()),
            "meaning": "share of the agents that have such a bound when no message is lost",
        },
        *_with_memory(design.model, wanted["attacked"], failure),
    ]


def _with_memory(model: _core.Model, attacked: int, failure: float) -> list[dict[str, Any]]:
    """What a bank of filters promises (theorem B2), per state, to who hears all measurements; for Gaussian noise."""
    if failure == 0:
        return []
    try:
        found = steady(Plant(model), attacked, failure * _SAMPLES, _SAMPLES, _MOST_PAIRS)
    except _core.InvalidInput:  # no covariances, or noise that sources share: no such theorem
        return []
    if found is None:
        return []
    meaning = (
        f"with any {attacked} sources lying, half width of {{}} that garrison.certify never exceeds in the end, at "
        f"{failure:g} per sample; inf: these sources could hide it for ever"
    )
    return [
        {"name": f"certify_{name}", "value": float(width), "meaning": meaning.format(name)}
        for name, width in zip(model.state_names, found, strict=True)
    ]


__all__ = ["expected_certificate"]
