"""[model] in continuous time: sampled every `interval`, or at `times`."""

from typing import Any

from garrison import _core
from garrison.scenario.section import Section
from garrison.varying import VaryingModel
from garrison.words import refusal


def sampled(section: Section, A: Any, C: Any, rest: dict[str, Any]) -> _core.Model | VaryingModel:
    """The model of these matrices, which are those of dx/dt = A x + B u + white noise where the section says how it is
    sampled. rest: arguments of Model.
    """
    given = [key for key in ("interval", "times") if key in section]
    if len(given) > 1:
        raise refusal(section.where, "interval and times", "one of them")
    if given and "process_covariance" in rest:
        expected = "process_intensity, from which the covariance of every step follows"
        raise refusal(section.where, f"process_covariance beside {given[0]}", expected)
    if "process_intensity" in section:
        if not given:
            raise refusal(section.place("process_intensity"), "no interval and no times", "one of them beside it")
        intensity = section.numbers("process_intensity")
        rest = rest | {"process_intensity": float(intensity) if intensity.ndim == 0 else intensity}
    if "interval" in section:
        return _core.Model.from_continuous(A, C, section.number("interval", 0.0, positive=True), **rest)
    if "times" in section:
        return VaryingModel.from_continuous(A, C, section.numbers("times").ravel(), **rest)
    return _core.Model(A, C, **rest)


__all__ = ["sampled"]
