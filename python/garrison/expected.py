"""The certificate to expect, before anything runs."""

from typing import Any

import numpy as np

from garrison import _core
from garrison.certifying.methods import steady, steady_window
from garrison.certifying.plant import Plant

#: samples after which one with memory is looked at
_REMEMBERED = 20
#: kinds of bounds that are a certificate of the measurements
_OWN = (2, 3, 11)
#: samples that the union over time is taken over, in theorem B2
_SAMPLES = 1000
#: samples of the window of theorem W3D, as of `certify`
_WINDOW = 20


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
        run = min(1.0, failure * _SAMPLES * design.model.agents)
        law = (
            f"at {failure:g} per agent and sample: that some bound of all agents over {_SAMPLES} samples is wrong has "
            f"a chance of at most {run:.2g}"
        )
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
        *_with_memory(design.model, wanted["attacked"], failure, windows=bool(wanted.get("memory"))),
    ]


def _with_memory(model: _core.Model, attacked: int, failure: float, windows: bool) -> list[dict[str, Any]]:
    """Steady widths per state, of who hears all measurements: of a bank (B2), and of windows (W3D) where asked for."""
    if failure == 0:
        return []
    try:
        plant = Plant(model)
        bank = steady(plant, attacked, failure, _SAMPLES)
        window = steady_window(plant, attacked, failure, _WINDOW) if windows else None
    except _core.InvalidInput:  # no covariances, or noise that sources share: no such theorem
        return []
    ways = {
        "certify": (
            bank,
            "half width of {} that a bank of filters over all measurements keeps in the long run (theorem B2)",
        ),
        "window": (window, f"the same of a window of the last {_WINDOW} samples, none missing (theorem W3D)"),
    }
    ending = (
        f" at {failure:g} per sample, with any {attacked} sources lying, always the same ones; inf: none is known, as "
        "where they could hide a lie that grows for ever"
    )
    return [
        {"name": f"{way}_{name}", "value": float(width), "meaning": words.format(name) + ending}
        for way, (widths, words) in ways.items()
        if widths is not None
        for name, width in zip(model.state_names, widths, strict=True)
    ]


__all__ = ["expected_certificate"]
