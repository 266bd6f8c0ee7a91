"""
One function per attack.
"""

from __future__ import annotations
import collections.abc
import garrison._core
import typing

__all__: list[str] = [
    "Autoregressive",
    "Bias",
    "Constant",
    "Coordinated",
    "Denial",
    "Equivocate",
    "FalseTrajectory",
    "Falsify",
    "Forge",
    "Outdated",
    "Perturb",
    "Ramp",
    "Random",
    "Replay",
    "Scale",
    "Silence",
    "Sinusoid",
    "Stealthy",
]

def Autoregressive(
    agents: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] | None = None,
    *,
    coefficient: typing.SupportsFloat | typing.SupportsIndex = 0.9,
    size: typing.SupportsFloat | typing.SupportsIndex = 1.0,
    start: typing.SupportsInt | typing.SupportsIndex | None = None,
    stop: typing.SupportsInt | typing.SupportsIndex | None = None,
    schedule: collections.abc.Sequence[
        tuple[
            typing.SupportsInt | typing.SupportsIndex,
            collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex],
        ]
    ]
    | None = None,
    probability: typing.SupportsFloat | typing.SupportsIndex = 1.0,
) -> garrison._core.Attack:
    """
    correlated noise is added (measurement attack).

    coefficient: memory of the added signal [1]
    size: standard deviation of its noise [measurement]
    agents: ids that are attacked from sample `start` (default 1) on, or schedule: (start, agents) phases in
    order of time; stop: first sample that is not attacked any more; probability: chance that an agent is
    attacked at a sample. Raises InvalidInput when something does not fit.
    """

def Bias(
    agents: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] | None = None,
    *,
    value: typing.SupportsFloat | typing.SupportsIndex,
    start: typing.SupportsInt | typing.SupportsIndex | None = None,
    stop: typing.SupportsInt | typing.SupportsIndex | None = None,
    schedule: collections.abc.Sequence[
        tuple[
            typing.SupportsInt | typing.SupportsIndex,
            collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex],
        ]
    ]
    | None = None,
    probability: typing.SupportsFloat | typing.SupportsIndex = 1.0,
) -> garrison._core.Attack:
    """
    a constant is added (measurement attack).

    value: added to the measurement [measurement]
    agents: ids that are attacked from sample `start` (default 1) on, or schedule: (start, agents) phases in
    order of time; stop: first sample that is not attacked any more; probability: chance that an agent is
    attacked at a sample. Raises InvalidInput when something does not fit.
    """

def Constant(
    agents: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] | None = None,
    *,
    value: typing.Any = "nan",
    start: typing.SupportsInt | typing.SupportsIndex | None = None,
    stop: typing.SupportsInt | typing.SupportsIndex | None = None,
    schedule: collections.abc.Sequence[
        tuple[
            typing.SupportsInt | typing.SupportsIndex,
            collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex],
        ]
    ]
    | None = None,
    probability: typing.SupportsFloat | typing.SupportsIndex = 1.0,
) -> garrison._core.Attack:
    """
    the sensor says one value, which may be nan, inf or huge (measurement attack).

    value: what the sensor says instead: a number as text, nan or inf included [measurement]
    agents: ids that are attacked from sample `start` (default 1) on, or schedule: (start, agents) phases in
    order of time; stop: first sample that is not attacked any more; probability: chance that an agent is
    attacked at a sample. Raises InvalidInput when something does not fit.
    """

def Coordinated(
    agents: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] | None = None,
    *,
    covariance: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex] = [],
    start: typing.SupportsInt | typing.SupportsIndex | None = None,
    stop: typing.SupportsInt | typing.SupportsIndex | None = None,
    schedule: collections.abc.Sequence[
        tuple[
            typing.SupportsInt | typing.SupportsIndex,
            collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex],
        ]
    ]
    | None = None,
    probability: typing.SupportsFloat | typing.SupportsIndex = 1.0,
) -> garrison._core.Attack:
    """
    the agents add Gaussian noise that they draw together (message attack).

    covariance: of the perturbations of all attacked agents together, agents in ascending order, one number per state: a square matrix, row by row; may be singular [state^2]
    agents: ids that are attacked from sample `start` (default 1) on, or schedule: (start, agents) phases in
    order of time; stop: first sample that is not attacked any more; probability: chance that an agent is
    attacked at a sample. Raises InvalidInput when something does not fit.
    """

def Denial(
    agents: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] | None = None,
    *,
    start: typing.SupportsInt | typing.SupportsIndex | None = None,
    stop: typing.SupportsInt | typing.SupportsIndex | None = None,
    schedule: collections.abc.Sequence[
        tuple[
            typing.SupportsInt | typing.SupportsIndex,
            collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex],
        ]
    ]
    | None = None,
    probability: typing.SupportsFloat | typing.SupportsIndex = 1.0,
) -> garrison._core.Attack:
    """
    the measurement is lost (measurement attack).

    agents: ids that are attacked from sample `start` (default 1) on, or schedule: (start, agents) phases in
    order of time; stop: first sample that is not attacked any more; probability: chance that an agent is
    attacked at a sample. Raises InvalidInput when something does not fit.
    """

def Equivocate(
    agents: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] | None = None,
    *,
    size: typing.SupportsFloat | typing.SupportsIndex = 1.0,
    start: typing.SupportsInt | typing.SupportsIndex | None = None,
    stop: typing.SupportsInt | typing.SupportsIndex | None = None,
    schedule: collections.abc.Sequence[
        tuple[
            typing.SupportsInt | typing.SupportsIndex,
            collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex],
        ]
    ]
    | None = None,
    probability: typing.SupportsFloat | typing.SupportsIndex = 1.0,
) -> garrison._core.Attack:
    """
    the agent tells each neighbour another lie (message attack).

    size: length of the lie told to each neighbour [state]
    agents: ids that are attacked from sample `start` (default 1) on, or schedule: (start, agents) phases in
    order of time; stop: first sample that is not attacked any more; probability: chance that an agent is
    attacked at a sample. Raises InvalidInput when something does not fit.
    """

def FalseTrajectory(
    agents: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] | None = None,
    *,
    offset: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex] = [],
    push: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex] = [],
    start: typing.SupportsInt | typing.SupportsIndex | None = None,
    stop: typing.SupportsInt | typing.SupportsIndex | None = None,
    schedule: collections.abc.Sequence[
        tuple[
            typing.SupportsInt | typing.SupportsIndex,
            collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex],
        ]
    ]
    | None = None,
    probability: typing.SupportsFloat | typing.SupportsIndex = 1.0,
) -> garrison._core.Attack:
    """
    all attacked sensors report one false state that obeys the plant (measurement attack).

    offset: displacement of the false state at the start, one number per state [state]
    push: added to the displacement at every sample; left out: 0 [state/sample]
    agents: ids that are attacked from sample `start` (default 1) on, or schedule: (start, agents) phases in
    order of time; stop: first sample that is not attacked any more; probability: chance that an agent is
    attacked at a sample. Raises InvalidInput when something does not fit.
    """

def Falsify(
    agents: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] | None = None,
    *,
    field: typing.Any,
    value: typing.SupportsFloat | typing.SupportsIndex = 0.0,
    members: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex] = [],
    start: typing.SupportsInt | typing.SupportsIndex | None = None,
    stop: typing.SupportsInt | typing.SupportsIndex | None = None,
    schedule: collections.abc.Sequence[
        tuple[
            typing.SupportsInt | typing.SupportsIndex,
            collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex],
        ]
    ]
    | None = None,
    probability: typing.SupportsFloat | typing.SupportsIndex = 1.0,
) -> garrison._core.Attack:
    """
    the agent lies in one field of its messages, e.g. a set or a flag (message attack).

    field: name of the field, e.g. "estimate", "intact", "proved", "bound" (the page of each filter lists them)
    value: what numbers, counts and optional numbers become; a flag is set where it is not 0 [of the field]
    members: what a set becomes [agents]
    agents: ids that are attacked from sample `start` (default 1) on, or schedule: (start, agents) phases in
    order of time; stop: first sample that is not attacked any more; probability: chance that an agent is
    attacked at a sample. Raises InvalidInput when something does not fit.
    """

def Forge(
    agents: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] | None = None,
    *,
    offset: typing.SupportsFloat | typing.SupportsIndex = 1.0,
    replace: bool = False,
    start: typing.SupportsInt | typing.SupportsIndex | None = None,
    stop: typing.SupportsInt | typing.SupportsIndex | None = None,
    schedule: collections.abc.Sequence[
        tuple[
            typing.SupportsInt | typing.SupportsIndex,
            collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex],
        ]
    ]
    | None = None,
    probability: typing.SupportsFloat | typing.SupportsIndex = 1.0,
) -> garrison._core.Attack:
    """
    the agent sends a false estimate to all neighbours (message attack).

    offset: added to every number of the message [state]
    replace: send the offset alone
    agents: ids that are attacked from sample `start` (default 1) on, or schedule: (start, agents) phases in
    order of time; stop: first sample that is not attacked any more; probability: chance that an agent is
    attacked at a sample. Raises InvalidInput when something does not fit.
    """

def Outdated(
    agents: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] | None = None,
    *,
    age: typing.SupportsInt | typing.SupportsIndex,
    start: typing.SupportsInt | typing.SupportsIndex | None = None,
    stop: typing.SupportsInt | typing.SupportsIndex | None = None,
    schedule: collections.abc.Sequence[
        tuple[
            typing.SupportsInt | typing.SupportsIndex,
            collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex],
        ]
    ]
    | None = None,
    probability: typing.SupportsFloat | typing.SupportsIndex = 1.0,
) -> garrison._core.Attack:
    """
    the agent sends what it sent some samples ago, as new (message attack).

    age: how old what is sent is [samples]
    agents: ids that are attacked from sample `start` (default 1) on, or schedule: (start, agents) phases in
    order of time; stop: first sample that is not attacked any more; probability: chance that an agent is
    attacked at a sample. Raises InvalidInput when something does not fit.
    """

def Perturb(
    agents: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] | None = None,
    *,
    width: typing.SupportsInt | typing.SupportsIndex,
    deltas: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex] = [],
    start: typing.SupportsInt | typing.SupportsIndex | None = None,
    stop: typing.SupportsInt | typing.SupportsIndex | None = None,
    schedule: collections.abc.Sequence[
        tuple[
            typing.SupportsInt | typing.SupportsIndex,
            collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex],
        ]
    ]
    | None = None,
    probability: typing.SupportsFloat | typing.SupportsIndex = 1.0,
) -> garrison._core.Attack:
    """
    the agents add given numbers (message attack).

    width: numbers per sample: attacked agents times states [numbers]
    deltas: what is added, sample by sample from the start on; agents in ascending order, one number per state [state]
    agents: ids that are attacked from sample `start` (default 1) on, or schedule: (start, agents) phases in
    order of time; stop: first sample that is not attacked any more; probability: chance that an agent is
    attacked at a sample. Raises InvalidInput when something does not fit.
    """

def Ramp(
    agents: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] | None = None,
    *,
    slope: typing.SupportsFloat | typing.SupportsIndex = 0.1,
    start: typing.SupportsInt | typing.SupportsIndex | None = None,
    stop: typing.SupportsInt | typing.SupportsIndex | None = None,
    schedule: collections.abc.Sequence[
        tuple[
            typing.SupportsInt | typing.SupportsIndex,
            collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex],
        ]
    ]
    | None = None,
    probability: typing.SupportsFloat | typing.SupportsIndex = 1.0,
) -> garrison._core.Attack:
    """
    a growing drift is added (measurement attack).

    slope: growth of the added drift [measurement/sample]
    agents: ids that are attacked from sample `start` (default 1) on, or schedule: (start, agents) phases in
    order of time; stop: first sample that is not attacked any more; probability: chance that an agent is
    attacked at a sample. Raises InvalidInput when something does not fit.
    """

def Random(
    agents: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] | None = None,
    *,
    size: typing.SupportsFloat | typing.SupportsIndex = 1.0,
    law: str = "normal",
    replace: bool = False,
    start: typing.SupportsInt | typing.SupportsIndex | None = None,
    stop: typing.SupportsInt | typing.SupportsIndex | None = None,
    schedule: collections.abc.Sequence[
        tuple[
            typing.SupportsInt | typing.SupportsIndex,
            collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex],
        ]
    ]
    | None = None,
    probability: typing.SupportsFloat | typing.SupportsIndex = 1.0,
) -> garrison._core.Attack:
    """
    noise is added, or sent instead (measurement attack).

    size: half width, or scale of the law [measurement]
    law: distribution of the noise
    replace: drop the measurement, send noise only
    agents: ids that are attacked from sample `start` (default 1) on, or schedule: (start, agents) phases in
    order of time; stop: first sample that is not attacked any more; probability: chance that an agent is
    attacked at a sample. Raises InvalidInput when something does not fit.
    """

def Replay(
    agents: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] | None = None,
    *,
    delay: typing.SupportsInt | typing.SupportsIndex = 10,
    start: typing.SupportsInt | typing.SupportsIndex | None = None,
    stop: typing.SupportsInt | typing.SupportsIndex | None = None,
    schedule: collections.abc.Sequence[
        tuple[
            typing.SupportsInt | typing.SupportsIndex,
            collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex],
        ]
    ]
    | None = None,
    probability: typing.SupportsFloat | typing.SupportsIndex = 1.0,
) -> garrison._core.Attack:
    """
    an old recorded measurement is sent (measurement attack).

    delay: age of the recorded measurement that is sent [samples]
    agents: ids that are attacked from sample `start` (default 1) on, or schedule: (start, agents) phases in
    order of time; stop: first sample that is not attacked any more; probability: chance that an agent is
    attacked at a sample. Raises InvalidInput when something does not fit.
    """

def Scale(
    agents: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] | None = None,
    *,
    factor: typing.SupportsFloat | typing.SupportsIndex = 3.0,
    start: typing.SupportsInt | typing.SupportsIndex | None = None,
    stop: typing.SupportsInt | typing.SupportsIndex | None = None,
    schedule: collections.abc.Sequence[
        tuple[
            typing.SupportsInt | typing.SupportsIndex,
            collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex],
        ]
    ]
    | None = None,
    probability: typing.SupportsFloat | typing.SupportsIndex = 1.0,
) -> garrison._core.Attack:
    """
    the measurement is multiplied (measurement attack).

    factor: the measurement is multiplied by it (3 = the paper's attack) [1]
    agents: ids that are attacked from sample `start` (default 1) on, or schedule: (start, agents) phases in
    order of time; stop: first sample that is not attacked any more; probability: chance that an agent is
    attacked at a sample. Raises InvalidInput when something does not fit.
    """

def Silence(
    agents: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] | None = None,
    *,
    start: typing.SupportsInt | typing.SupportsIndex | None = None,
    stop: typing.SupportsInt | typing.SupportsIndex | None = None,
    schedule: collections.abc.Sequence[
        tuple[
            typing.SupportsInt | typing.SupportsIndex,
            collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex],
        ]
    ]
    | None = None,
    probability: typing.SupportsFloat | typing.SupportsIndex = 1.0,
) -> garrison._core.Attack:
    """
    the agent sends nothing (message attack).

    agents: ids that are attacked from sample `start` (default 1) on, or schedule: (start, agents) phases in
    order of time; stop: first sample that is not attacked any more; probability: chance that an agent is
    attacked at a sample. Raises InvalidInput when something does not fit.
    """

def Sinusoid(
    agents: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] | None = None,
    *,
    amplitude: typing.SupportsFloat | typing.SupportsIndex = 1.0,
    period: typing.SupportsFloat | typing.SupportsIndex = 20.0,
    phase: typing.SupportsFloat | typing.SupportsIndex = 0.0,
    start: typing.SupportsInt | typing.SupportsIndex | None = None,
    stop: typing.SupportsInt | typing.SupportsIndex | None = None,
    schedule: collections.abc.Sequence[
        tuple[
            typing.SupportsInt | typing.SupportsIndex,
            collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex],
        ]
    ]
    | None = None,
    probability: typing.SupportsFloat | typing.SupportsIndex = 1.0,
) -> garrison._core.Attack:
    """
    a wave is added (measurement attack).

    amplitude: size of the added wave [measurement]
    period: length of one wave [samples]
    phase: phase at the start [rad]
    agents: ids that are attacked from sample `start` (default 1) on, or schedule: (start, agents) phases in
    order of time; stop: first sample that is not attacked any more; probability: chance that an agent is
    attacked at a sample. Raises InvalidInput when something does not fit.
    """

def Stealthy(
    agents: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] | None = None,
    *,
    fraction: typing.SupportsFloat | typing.SupportsIndex = 0.99,
    start: typing.SupportsInt | typing.SupportsIndex | None = None,
    stop: typing.SupportsInt | typing.SupportsIndex | None = None,
    schedule: collections.abc.Sequence[
        tuple[
            typing.SupportsInt | typing.SupportsIndex,
            collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex],
        ]
    ]
    | None = None,
    probability: typing.SupportsFloat | typing.SupportsIndex = 1.0,
) -> garrison._core.Attack:
    """
    stays inside the threshold that the agent applies (closed loop) (measurement attack).

    fraction: share of the tolerated deviation that is used; its sign is the direction [1]
    agents: ids that are attacked from sample `start` (default 1) on, or schedule: (start, agents) phases in
    order of time; stop: first sample that is not attacked any more; probability: chance that an agent is
    attacked at a sample. Raises InvalidInput when something does not fit.
    """
