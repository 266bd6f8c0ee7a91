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

    Parameters
    ----------
    agents : sequence of int, optional
        Ids that are attacked from `start` on; or give `schedule`.
    coefficient : float, optional
        memory of the added signal [1]
    size : float, optional
        standard deviation of its noise [measurement], >= 0
    start : int, optional
        First sample that is attacked; below 1 is as 1; default 1.
    stop : int, optional
        First sample that is not attacked any more; default: never.
    schedule : sequence of (start, agents), optional
        Phases in order of time, instead of agents and start.
    probability : float
        Chance that an agent is attacked at a sample, 0..1.

    Returns
    -------
    Attack

    Raises
    ------
    InvalidInput
        A number out of range, or both or neither of agents and schedule.
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

    Parameters
    ----------
    agents : sequence of int, optional
        Ids that are attacked from `start` on; or give `schedule`.
    value : float
        added to the measurement [measurement]
    start : int, optional
        First sample that is attacked; below 1 is as 1; default 1.
    stop : int, optional
        First sample that is not attacked any more; default: never.
    schedule : sequence of (start, agents), optional
        Phases in order of time, instead of agents and start.
    probability : float
        Chance that an agent is attacked at a sample, 0..1.

    Returns
    -------
    Attack

    Raises
    ------
    InvalidInput
        A number out of range, or both or neither of agents and schedule.
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

    Parameters
    ----------
    agents : sequence of int, optional
        Ids that are attacked from `start` on; or give `schedule`.
    value : str, optional
        what the sensor says instead: a number as text, nan or inf included [measurement]
    start : int, optional
        First sample that is attacked; below 1 is as 1; default 1.
    stop : int, optional
        First sample that is not attacked any more; default: never.
    schedule : sequence of (start, agents), optional
        Phases in order of time, instead of agents and start.
    probability : float
        Chance that an agent is attacked at a sample, 0..1.

    Returns
    -------
    Attack

    Raises
    ------
    InvalidInput
        A number out of range, or both or neither of agents and schedule.
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

    Parameters
    ----------
    agents : sequence of int, optional
        Ids that are attacked from `start` on; or give `schedule`.
    covariance : sequence of float, optional
        of the perturbations of all attacked agents together, agents in ascending order, one number per state: a square matrix, row by row; may be singular [state^2]
    start : int, optional
        First sample that is attacked; below 1 is as 1; default 1.
    stop : int, optional
        First sample that is not attacked any more; default: never.
    schedule : sequence of (start, agents), optional
        Phases in order of time, instead of agents and start.
    probability : float
        Chance that an agent is attacked at a sample, 0..1.

    Returns
    -------
    Attack

    Raises
    ------
    InvalidInput
        A number out of range, or both or neither of agents and schedule.
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

    Parameters
    ----------
    agents : sequence of int, optional
        Ids that are attacked from `start` on; or give `schedule`.
    start : int, optional
        First sample that is attacked; below 1 is as 1; default 1.
    stop : int, optional
        First sample that is not attacked any more; default: never.
    schedule : sequence of (start, agents), optional
        Phases in order of time, instead of agents and start.
    probability : float
        Chance that an agent is attacked at a sample, 0..1.

    Returns
    -------
    Attack

    Raises
    ------
    InvalidInput
        A number out of range, or both or neither of agents and schedule.
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

    Parameters
    ----------
    agents : sequence of int, optional
        Ids that are attacked from `start` on; or give `schedule`.
    size : float, optional
        length of the lie sent to each neighbour [state], >= 0
    start : int, optional
        First sample that is attacked; below 1 is as 1; default 1.
    stop : int, optional
        First sample that is not attacked any more; default: never.
    schedule : sequence of (start, agents), optional
        Phases in order of time, instead of agents and start.
    probability : float
        Chance that an agent is attacked at a sample, 0..1.

    Returns
    -------
    Attack

    Raises
    ------
    InvalidInput
        A number out of range, or both or neither of agents and schedule.
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

    Parameters
    ----------
    agents : sequence of int, optional
        Ids that are attacked from `start` on; or give `schedule`.
    offset : sequence of float, optional
        displacement of the false state at the start, one number per state [state]
    push : sequence of float, optional
        added to the displacement at every sample; left out: 0 [state/sample]
    start : int, optional
        First sample that is attacked; below 1 is as 1; default 1.
    stop : int, optional
        First sample that is not attacked any more; default: never.
    schedule : sequence of (start, agents), optional
        Phases in order of time, instead of agents and start.
    probability : float
        Chance that an agent is attacked at a sample, 0..1.

    Returns
    -------
    Attack

    Raises
    ------
    InvalidInput
        A number out of range, or both or neither of agents and schedule.
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

    Parameters
    ----------
    agents : sequence of int, optional
        Ids that are attacked from `start` on; or give `schedule`.
    field : str
        name of the field, e.g. "estimate", "intact", "proved", "bound" (the page of each filter lists them)
    value : float, optional
        what numbers, counts and optional numbers become; a flag is set where it is not 0 [of the field]
    members : sequence of float, optional
        what a set becomes [agents], >= 0
    start : int, optional
        First sample that is attacked; below 1 is as 1; default 1.
    stop : int, optional
        First sample that is not attacked any more; default: never.
    schedule : sequence of (start, agents), optional
        Phases in order of time, instead of agents and start.
    probability : float
        Chance that an agent is attacked at a sample, 0..1.

    Returns
    -------
    Attack

    Raises
    ------
    InvalidInput
        A number out of range, or both or neither of agents and schedule.
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

    Parameters
    ----------
    agents : sequence of int, optional
        Ids that are attacked from `start` on; or give `schedule`.
    offset : float, optional
        added to every number of the message [state]
    replace : bool, optional
        send the offset alone
    start : int, optional
        First sample that is attacked; below 1 is as 1; default 1.
    stop : int, optional
        First sample that is not attacked any more; default: never.
    schedule : sequence of (start, agents), optional
        Phases in order of time, instead of agents and start.
    probability : float
        Chance that an agent is attacked at a sample, 0..1.

    Returns
    -------
    Attack

    Raises
    ------
    InvalidInput
        A number out of range, or both or neither of agents and schedule.
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

    Parameters
    ----------
    agents : sequence of int, optional
        Ids that are attacked from `start` on; or give `schedule`.
    age : int
        how old what is sent is [samples], >= 1
    start : int, optional
        First sample that is attacked; below 1 is as 1; default 1.
    stop : int, optional
        First sample that is not attacked any more; default: never.
    schedule : sequence of (start, agents), optional
        Phases in order of time, instead of agents and start.
    probability : float
        Chance that an agent is attacked at a sample, 0..1.

    Returns
    -------
    Attack

    Raises
    ------
    InvalidInput
        A number out of range, or both or neither of agents and schedule.
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

    Parameters
    ----------
    agents : sequence of int, optional
        Ids that are attacked from `start` on; or give `schedule`.
    width : int
        numbers per sample: attacked agents times states [numbers], >= 1
    deltas : sequence of float, optional
        what is added, sample by sample from the start on; agents in ascending order, one number per state [state]
    start : int, optional
        First sample that is attacked; below 1 is as 1; default 1.
    stop : int, optional
        First sample that is not attacked any more; default: never.
    schedule : sequence of (start, agents), optional
        Phases in order of time, instead of agents and start.
    probability : float
        Chance that an agent is attacked at a sample, 0..1.

    Returns
    -------
    Attack

    Raises
    ------
    InvalidInput
        A number out of range, or both or neither of agents and schedule.
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

    Parameters
    ----------
    agents : sequence of int, optional
        Ids that are attacked from `start` on; or give `schedule`.
    slope : float, optional
        growth of the added drift [measurement/sample]
    start : int, optional
        First sample that is attacked; below 1 is as 1; default 1.
    stop : int, optional
        First sample that is not attacked any more; default: never.
    schedule : sequence of (start, agents), optional
        Phases in order of time, instead of agents and start.
    probability : float
        Chance that an agent is attacked at a sample, 0..1.

    Returns
    -------
    Attack

    Raises
    ------
    InvalidInput
        A number out of range, or both or neither of agents and schedule.
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

    Parameters
    ----------
    agents : sequence of int, optional
        Ids that are attacked from `start` on; or give `schedule`.
    size : float, optional
        half width, or scale of the law [measurement], >= 0
    law : str, optional
        distribution of the noise; one of: uniform, normal, laplace, cauchy
    replace : bool, optional
        drop the measurement, send noise only
    start : int, optional
        First sample that is attacked; below 1 is as 1; default 1.
    stop : int, optional
        First sample that is not attacked any more; default: never.
    schedule : sequence of (start, agents), optional
        Phases in order of time, instead of agents and start.
    probability : float
        Chance that an agent is attacked at a sample, 0..1.

    Returns
    -------
    Attack

    Raises
    ------
    InvalidInput
        A number out of range, or both or neither of agents and schedule.
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

    Parameters
    ----------
    agents : sequence of int, optional
        Ids that are attacked from `start` on; or give `schedule`.
    delay : int, optional
        age of the recorded measurement that is sent [samples], >= 1
    start : int, optional
        First sample that is attacked; below 1 is as 1; default 1.
    stop : int, optional
        First sample that is not attacked any more; default: never.
    schedule : sequence of (start, agents), optional
        Phases in order of time, instead of agents and start.
    probability : float
        Chance that an agent is attacked at a sample, 0..1.

    Returns
    -------
    Attack

    Raises
    ------
    InvalidInput
        A number out of range, or both or neither of agents and schedule.
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

    Parameters
    ----------
    agents : sequence of int, optional
        Ids that are attacked from `start` on; or give `schedule`.
    factor : float, optional
        the measurement is multiplied by it (3 = the paper's attack) [1]
    start : int, optional
        First sample that is attacked; below 1 is as 1; default 1.
    stop : int, optional
        First sample that is not attacked any more; default: never.
    schedule : sequence of (start, agents), optional
        Phases in order of time, instead of agents and start.
    probability : float
        Chance that an agent is attacked at a sample, 0..1.

    Returns
    -------
    Attack

    Raises
    ------
    InvalidInput
        A number out of range, or both or neither of agents and schedule.
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

    Parameters
    ----------
    agents : sequence of int, optional
        Ids that are attacked from `start` on; or give `schedule`.
    start : int, optional
        First sample that is attacked; below 1 is as 1; default 1.
    stop : int, optional
        First sample that is not attacked any more; default: never.
    schedule : sequence of (start, agents), optional
        Phases in order of time, instead of agents and start.
    probability : float
        Chance that an agent is attacked at a sample, 0..1.

    Returns
    -------
    Attack

    Raises
    ------
    InvalidInput
        A number out of range, or both or neither of agents and schedule.
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

    Parameters
    ----------
    agents : sequence of int, optional
        Ids that are attacked from `start` on; or give `schedule`.
    amplitude : float, optional
        size of the added wave [measurement]
    period : float, optional
        length of one wave [samples], > 0
    phase : float, optional
        phase at the start [rad]
    start : int, optional
        First sample that is attacked; below 1 is as 1; default 1.
    stop : int, optional
        First sample that is not attacked any more; default: never.
    schedule : sequence of (start, agents), optional
        Phases in order of time, instead of agents and start.
    probability : float
        Chance that an agent is attacked at a sample, 0..1.

    Returns
    -------
    Attack

    Raises
    ------
    InvalidInput
        A number out of range, or both or neither of agents and schedule.
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

    Parameters
    ----------
    agents : sequence of int, optional
        Ids that are attacked from `start` on; or give `schedule`.
    fraction : float, optional
        share of the tolerated deviation that is used; its sign is the direction [1]
    start : int, optional
        First sample that is attacked; below 1 is as 1; default 1.
    stop : int, optional
        First sample that is not attacked any more; default: never.
    schedule : sequence of (start, agents), optional
        Phases in order of time, instead of agents and start.
    probability : float
        Chance that an agent is attacked at a sample, 0..1.

    Returns
    -------
    Attack

    Raises
    ------
    InvalidInput
        A number out of range, or both or neither of agents and schedule.
    """
