"""garrison: a network that keeps its estimate while some of its own sensors lie.

Resilient distributed state estimation. The maths is in the compiled core; this package adds scenarios,
results, plots and the command line.
"""

from typing import TYPE_CHECKING, Any

from garrison._core import (
    Agent,
    AgentInfo,
    Attack,
    DesignInfeasible,
    Error,
    Filter,
    InvalidInput,
    IoError,
    Message,
    Model,
    Network,
    Response,
    SubsetBound,
    __version__,
    budget,
    certificate,
    lambda0,
    observable,
    one_step_sparse_observable,
    partial_sharing,
    platoon,
    s_sparse_observable,
    saturation,
    split_outputs,
    structural,
    structure,
)
from garrison.bound_kind import BoundKind
from garrison.verdict import Verdict
from garrison.words import refuse_attribute


def _model_html(self: Any) -> str:
    from garrison.notebook import of_model

    return of_model(self)


def _network_html(self: Any) -> str:
    from garrison.notebook import of_network

    return of_network(self)


# Compiled classes know nothing of notebooks; the stubs could not name them in annotations.
setattr(Model, "_repr_html_", _model_html)  # noqa: B010
setattr(Network, "_repr_html_", _network_html)  # noqa: B010

if TYPE_CHECKING:
    from garrison import attacks, filters
    from garrison.answers import Analysis, analyze
    from garrison.calibration import Calibration, calibrate
    from garrison.certifying import Certified, certify
    from garrison.checks import Check, check
    from garrison.comparison import Comparison, compare
    from garrison.designing import Designed, design
    from garrison.drivers import again, every, reduce, replay, simulate
    from garrison.exposing import Exposed, expose
    from garrison.kalman import central_kalman, extended_kalman, local_kalman
    from garrison.lmi import lmi_gains
    from garrison.mitigation import Mitigated, replay_mitigated
    from garrison.nonlinear import NonlinearModel
    from garrison.prepared import Prepared, prepare
    from garrison.record import Run
    from garrison.resilience import Resilience, resilience_per_byte
    from garrison.static_plant import StaticPlant
    from garrison.stored import StoredRun
    from garrison.sweeps import Sweep, sweep
    from garrison.varying import VaryingModel
    from garrison.varying_network import VaryingNetwork

#: modules that are attributes
_MODULES = ("attacks", "filters")
#: what is imported when it is asked for -> its module
_LATER = {
    "Analysis": "answers",
    "analyze": "answers",
    "Calibration": "calibration",
    "calibrate": "calibration",
    "Certified": "certifying",
    "certify": "certifying",
    "Check": "checks",
    "check": "checks",
    "Prepared": "prepared",
    "prepare": "prepared",
    "Run": "record",
    "StaticPlant": "static_plant",
    "StoredRun": "stored",
    "again": "drivers",
    "every": "drivers",
    "reduce": "drivers",
    "replay": "drivers",
    "simulate": "drivers",
    "central_kalman": "kalman",
    "extended_kalman": "kalman",
    "local_kalman": "kalman",
    "NonlinearModel": "nonlinear",
    "VaryingModel": "varying",
    "VaryingNetwork": "varying_network",
    "Exposed": "exposing",
    "expose": "exposing",
    "Fit": "fitting",
    "fit": "identifying",
    "Mitigated": "mitigation",
    "replay_mitigated": "mitigation",
    "Resilience": "resilience",
    "resilience_per_byte": "resilience",
    "lmi_gains": "lmi",
    "Comparison": "comparison",
    "Designed": "designing",
    "design": "designing",
    "compare": "comparison",
    "Sweep": "sweeps",
    "sweep": "sweeps",
}

__all__ = [
    "Agent",
    "AgentInfo",
    "Analysis",
    "Attack",
    "BoundKind",
    "Calibration",
    "Certified",
    "Check",
    "Comparison",
    "DesignInfeasible",
    "Designed",
    "Error",
    "Exposed",
    "Filter",
    "Fit",
    "InvalidInput",
    "IoError",
    "Message",
    "Mitigated",
    "Model",
    "Network",
    "NonlinearModel",
    "Prepared",
    "Resilience",
    "Response",
    "Run",
    "StaticPlant",
    "StoredRun",
    "SubsetBound",
    "Sweep",
    "VaryingModel",
    "VaryingNetwork",
    "Verdict",
    "__version__",
    "again",
    "analyze",
    "attacks",
    "budget",
    "calibrate",
    "central_kalman",
    "certificate",
    "certify",
    "check",
    "compare",
    "design",
    "every",
    "expose",
    "extended_kalman",
    "filters",
    "fit",
    "lambda0",
    "lmi_gains",
    "local_kalman",
    "observable",
    "one_step_sparse_observable",
    "partial_sharing",
    "platoon",
    "prepare",
    "reduce",
    "replay",
    "replay_mitigated",
    "resilience_per_byte",
    "s_sparse_observable",
    "saturation",
    "simulate",
    "split_outputs",
    "structural",
    "structure",
    "sweep",
]


def __getattr__(name: str) -> Any:
    if name not in _LATER and name not in _MODULES:
        refuse_attribute("garrison", name, __all__)
    from importlib import import_module

    if name in _MODULES:
        return import_module(f"garrison.{name}")
    value = getattr(import_module(f"garrison.{_LATER[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
