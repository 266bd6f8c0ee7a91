"""The certificate to expect, before anything runs."""

from typing import Any

import numpy as np

from garrison import _core

#: kinds of bounds that are a certificate of the measurements
_OWN = (2, 3)


def expected_certificate(design: _core.Design) -> list[dict[str, Any]]:
    """Quantities of `Check`: bounds of a sample on which all measurements agree with each other and the estimate.

    No message is lost. A lie that stands out is left out and costs nothing; one that hides in the noise makes the bound
    larger, by about as much as it may move the estimate. Empty without a certificate.
    """
    wanted = design.certificate
    if wanted is None:
        return []
    made = _core.replay(
        design,
        measurements=np.zeros((1, design.model.outputs)),
        truth=None,
        trials=1,
        first_trial=0,
        seed=0,
        threads=1,
        start=None,
        attacks=[],
        link={},
        keep=["report"],
        inputs=np.zeros((1 if design.model.inputs else 0, design.model.inputs)),
        series={},
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
    return [
        {
            "name": "certificate_expected",
            "value": float(bound[own].max()) if own.any() else float("nan"),
            "meaning": f"{who}, the largest certified bound of an agent on a sample where nothing stands out, {law}",
        },
        {
            "name": "certificate_agents",
            "value": float(own.mean()),
            "meaning": "share of the agents that have such a bound when no message is lost",
        },
    ]


__all__ = ["expected_certificate"]
