"""garrison: a network that keeps its estimate while some of its own sensors lie.

Resilient distributed state estimation. The maths is in the compiled core; this package adds scenarios,
results, plots and the command line.
"""

from garrison import attacks, filters
from garrison._core import (
    Agent,
    Attack,
    DesignInfeasible,
    Error,
    Filter,
    InvalidInput,
    IoError,
    Message,
    Model,
    Network,
    SubsetBound,
    __version__,
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
from garrison.checks import Check, check
from garrison.drivers import central_kalman, replay, simulate
from garrison.fitting import Fit, fit
from garrison.lmi import lmi_gains
from garrison.mitigation import Mitigated, replay_mitigated
from garrison.record import Run
from garrison.resilience import Resilience, resilience_per_byte
from garrison.verdict import Verdict

__all__ = [
    "Agent",
    "Attack",
    "Check",
    "DesignInfeasible",
    "Error",
    "Filter",
    "Fit",
    "InvalidInput",
    "IoError",
    "Message",
    "Mitigated",
    "Model",
    "Network",
    "Resilience",
    "Run",
    "SubsetBound",
    "Verdict",
    "__version__",
    "attacks",
    "central_kalman",
    "check",
    "filters",
    "fit",
    "lambda0",
    "lmi_gains",
    "observable",
    "one_step_sparse_observable",
    "partial_sharing",
    "platoon",
    "replay",
    "replay_mitigated",
    "resilience_per_byte",
    "s_sparse_observable",
    "saturation",
    "simulate",
    "split_outputs",
    "structural",
    "structure",
]
