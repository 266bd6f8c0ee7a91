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
    s_sparse_observable,
    saturation,
    split_outputs,
    structural,
    structure,
)
from garrison.checks import Check, check
from garrison.fitting import Fit, fit
from garrison.mitigation import Mitigated, replay_mitigated
from garrison.run import Run, central_kalman, replay, simulate

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
    "Run",
    "SubsetBound",
    "__version__",
    "attacks",
    "central_kalman",
    "check",
    "filters",
    "fit",
    "lambda0",
    "observable",
    "one_step_sparse_observable",
    "replay",
    "replay_mitigated",
    "s_sparse_observable",
    "saturation",
    "simulate",
    "split_outputs",
    "structural",
    "structure",
]
