"""
Compiled core of garrison. Use it through the garrison package.
"""

from __future__ import annotations
import collections.abc
import numpy
import numpy.typing
import typing
from . import saturation
from . import rdkf
from . import structure
from . import structural
from . import partial_sharing
from . import platoon

__all__: list[str] = [
    "Agent",
    "Attack",
    "DesignInfeasible",
    "Dkf",
    "Error",
    "Filter",
    "Identified",
    "InvalidInput",
    "IoError",
    "Lfre",
    "Message",
    "Model",
    "Network",
    "PartialSharing",
    "Platoon",
    "PlatoonBaseline",
    "Rdkf",
    "Saturation",
    "ScalarGain",
    "Structural",
    "SubsetBound",
    "attack_infos",
    "central_kalman",
    "chebyshev_contraction",
    "check",
    "filter_infos",
    "identify",
    "lambda0",
    "lambda0_orthogonal",
    "lfre_parents",
    "make_attack",
    "make_filter",
    "nearest_name",
    "observable",
    "one_step_sparse_observable",
    "partial_sharing",
    "platoon",
    "rdkf",
    "replay",
    "s_sparse_observable",
    "saturation",
    "simulate",
    "split_outputs",
    "structural",
    "structure",
    "tau0",
    "varpi",
]

class Error(Exception):
    pass

class InvalidInput(Error, ValueError):
    pass

class DesignInfeasible(Error, ValueError):
    pass

class IoError(Error, OSError):
    pass

class Model:
    """
    The plant x(t+1) = A x(t) + w(t), y_i(t) = C_i x(t) + v_i(t). Immutable.

    A: (n, n). C: one (m_i, n) array per agent (m_i = 0: a relay), or an (N, n) array of rows.
    process_bound: ||w|| <= it, >= 0, nan = not known. measurement_bound: |v_i| <= it, a number or
    one per agent. Covariances: (n, n), or (N, n, n) where each agent takes another one for w (no noise is
    simulated from those), and one (m_i, m_i) array per agent.
    Raises InvalidInput when shapes do not fit or a number is not finite.
    """
    def __init__(
        self,
        A: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
        C: typing.Any,
        *,
        process_bound: typing.SupportsFloat | typing.SupportsIndex = ...,
        measurement_bound: typing.Any = None,
        process_covariance: typing.Any = None,
        measurement_covariance: typing.Any | None = None,
    ) -> None: ...
    def __repr__(self) -> str: ...
    @property
    def A(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (n, n)
        """
    @property
    def C(self) -> list[typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]]:
        """
        One (m_i, n) array per agent.
        """
    @property
    def agents(self) -> int:
        """
        N
        """
    @property
    def measurement_bound(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]: ...
    @property
    def outputs(self) -> int:
        """
        Scalar measurements per sample of the whole network.
        """
    @property
    def process_bound(self) -> float: ...
    @property
    def states(self) -> int:
        """
        n
        """

class Network:
    """
    Who hears whom. Immutable.

    edges: (sender, receiver) pairs, a networkx graph, or a sparse
    matrix whose entry (i, j) says that i hears j. agents: needed when the last ones have no edge.
    Pairs given twice count once. Raises InvalidInput on a self-loop or an index out of range.
    """
    @staticmethod
    def band(
        agents: typing.SupportsInt | typing.SupportsIndex, range: typing.SupportsInt | typing.SupportsIndex
    ) -> Network:
        """
        i and j hear each other when |i - j| <= range.
        """
    @staticmethod
    def complete(agents: typing.SupportsInt | typing.SupportsIndex) -> Network: ...
    @staticmethod
    def erdos_renyi(
        agents: typing.SupportsInt | typing.SupportsIndex,
        probability: typing.SupportsFloat | typing.SupportsIndex,
        seed: typing.SupportsInt | typing.SupportsIndex = 0,
    ) -> Network: ...
    @staticmethod
    def grid(
        rows: typing.SupportsInt | typing.SupportsIndex, columns: typing.SupportsInt | typing.SupportsIndex
    ) -> Network: ...
    @staticmethod
    def path(agents: typing.SupportsInt | typing.SupportsIndex) -> Network: ...
    @staticmethod
    def random_geometric(
        agents: typing.SupportsInt | typing.SupportsIndex,
        radius: typing.SupportsFloat | typing.SupportsIndex,
        seed: typing.SupportsInt | typing.SupportsIndex = 0,
    ) -> Network:
        """
        Points uniform in the unit square, edges below `radius`.
        """
    @staticmethod
    def ring(agents: typing.SupportsInt | typing.SupportsIndex) -> Network: ...
    @staticmethod
    def star(agents: typing.SupportsInt | typing.SupportsIndex) -> Network: ...
    def __init__(
        self, edges: typing.Any, agents: typing.SupportsInt | typing.SupportsIndex | None = None, directed: bool = False
    ) -> None: ...
    def __repr__(self) -> str: ...
    def laplacian(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]: ...
    def laplacian_spectrum(self) -> tuple[float, float]:
        """
        (lambda_2, lambda_max) of the Laplacian; undirected networks only.
        """
    def laplacian_weights(
        self, step: typing.SupportsFloat | typing.SupportsIndex
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        I - step * Laplacian
        """
    def max_degree_weights(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        I - Laplacian / (1 + largest degree)
        """
    def metropolis_weights(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        Doubly stochastic (N, N) weights; undirected only.
        """
    def neighbours(self, agent: typing.SupportsInt | typing.SupportsIndex) -> list[int]:
        """
        Sorted ids of the agents that `agent` hears.
        """
    @property
    def agents(self) -> int: ...
    @property
    def connected(self) -> bool: ...
    @property
    def directed(self) -> bool: ...
    @property
    def edges(self) -> list[tuple[int, int]]: ...

class Filter:
    """
    A filter family with its parameters.
    """
    def __repr__(self) -> str: ...
    @property
    def detail_names(self) -> list[str]:
        """
        Names of the lists (sets, gains) that a run can keep.
        """
    @property
    def name(self) -> str: ...
    @property
    def params(self) -> dict: ...
    @property
    def signal_names(self) -> list[str]:
        """
        Names of the signals that a run can keep.
        """

class Saturation(Filter):
    """
    Saturated consensus filter, with attack detector.

    Source: He, Ren, Sandberg, Johansson, IEEE TAC 2022, Algorithms 1 and 2

    threshold: largest innovation that is used in full; inf = never saturate. May be left out with adaptive = true [measurement], > 0
    rounds: consensus rounds per sample [1], >= 0, <= 1e+06
    step: consensus step; left out: 2/(lambda_2 + lambda_max) [1], >= 0
    chebyshev: Chebyshev-filtered rounds: stronger contraction from the same messages
    attacked: most sensors attacked (or missing) at a time; enters bound and detector [agents], >= 0
    initial_error: bound on the distance of the common initial estimate from the state; giving it asks for run-time error bounds [state], > 0
    detector: Algorithm 2: prove and isolate attacked sensors (their set must not change over time)
    detector_index: which count of proved sensors enters rhobar(t): "t" = d_i(t-1) as printed, "t+1" = d_i(t), sharper and as sound
    adaptive: let the threshold follow the known bound on honest innovations (our notes; needs initial_error)
    accuse_missing: detector: a missing (NaN) measurement counts as proof of attack
    """
    def __init__(
        self,
        *,
        threshold: typing.SupportsFloat | typing.SupportsIndex = ...,
        rounds: typing.SupportsInt | typing.SupportsIndex = 3,
        step: typing.SupportsFloat | typing.SupportsIndex = ...,
        chebyshev: bool = False,
        attacked: typing.SupportsInt | typing.SupportsIndex = 0,
        initial_error: typing.SupportsFloat | typing.SupportsIndex = ...,
        detector: bool = False,
        detector_index: str = "t",
        adaptive: bool = False,
        accuse_missing: bool = False,
    ) -> None: ...

class ScalarGain(Filter):
    """
    Scalar-gain consensus filter (no protection).

    Source: Khan, Jadbabaie, Automatica 2014; baseline of the saturation paper

    rounds: consensus rounds per sample [1], >= 0, <= 1e+06
    step: consensus step; left out: 2/(lambda_2 + lambda_max) [1], >= 0
    chebyshev: Chebyshev-filtered rounds: stronger contraction from the same messages
    """
    def __init__(
        self,
        *,
        rounds: typing.SupportsInt | typing.SupportsIndex = 3,
        step: typing.SupportsFloat | typing.SupportsIndex = ...,
        chebyshev: bool = False,
    ) -> None: ...

class Lfre(Filter):
    """
    Local-filtering-based resilient estimation.

    Source: Mitra, Sundaram, Automatica 2019; baseline of the saturation paper

    faulty: values trimmed from each end of the parents' estimates [agents], >= 0
    poles: real poles of the sources' observers, one per state; left out: equally spaced over 0.1, from 0.3 to 0.8, where the noise gives each source the least error [1], >= -1, <= 1
    """
    def __init__(
        self,
        *,
        faulty: typing.SupportsInt | typing.SupportsIndex = 1,
        poles: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex] = [],
    ) -> None: ...

class Rdkf(Filter):
    """
    Resilient distributed Kalman filter.

    Source: Dutta, Zhang, Jin, CDC 2019

    weight: lambda of (8), the pull of a measurement at most; its estimate moves by at most half of (10), which is proportional to it; 0 ignores all measurements [1], >= 0, <= 1e+100
    penalty: of the whitened residual: "norm" = the paper's; "huber" = the same pull, but a Kalman step as long as it is not reached; "l1" = sensor by sensor; "group" = the neighbours' measurements too, which then travel
    solver: of the step: "exact", or "ipopt" as a slow cross-check of penalty "norm" in builds that have it
    smoothing: penalty "norm" only: lambda sqrt(|r|^2 + epsilon^2); solver "ipopt" takes 1e-6 for 0 [1], >= 0, <= 1e+100
    initial_error: bound on the distance of every initial estimate from the state; giving it asks for run-time error bounds (needs the model's process_bound) [state], >= 0
    """
    def __init__(
        self,
        *,
        weight: typing.SupportsFloat | typing.SupportsIndex = 1.0,
        penalty: str = "norm",
        solver: str = "exact",
        smoothing: typing.SupportsFloat | typing.SupportsIndex = 0.0,
        initial_error: typing.SupportsFloat | typing.SupportsIndex = ...,
    ) -> None: ...

class Dkf(Filter):
    """
    Distributed Kalman filter, steady state (no protection).

    Source: (7) of Dutta, Zhang, Jin, CDC 2019

    """
    def __init__(self) -> None: ...

class Structural(Filter):
    """
    Single-time-scale estimator with exact residual tests.

    Source: Doostmohammadian et al., IEEE TNSE 2022

    design: how the gains are found; auto: riccati, else kalman, else h2
    share: whose measurements an agent uses besides its own
    self_weight: weight of an agent's own estimate, the rest spread evenly over its neighbours; left out: 1/(degree + 1). Small ones stabilise more [1], >= 0, <= 1
    weights: N*N mixing weights row by row, instead of self_weight [1], >= 0
    sharing: N*N numbers 0 or 1 row by row, instead of share [1], >= 0, <= 1
    gain: N*n*n numbers, K_i row by row, agent by agent, instead of design [1]
    false_alarm: probability per sample of an alarm without an attack [1], > 0, <= 1
    test: what is tested: y - c'x after the update, or before it (innovation)
    window: 1: a test per sample; more: chi-square over so many residuals, exact covariance [samples], >= 1, <= 1000
    alarm_after: tests in a row above the threshold before the verdict [samples], >= 1, <= 1e+06
    clear_after: tests in a row below it before the verdict is taken back [samples], >= 1, <= 1e+06
    settle: samples without a test after the start or a loss; -1: until rho^k < 0.01 [samples], >= -1, <= 1e+06
    isolate: leave the own measurement out while the alarm lasts
    accuse_missing: a missing own measurement counts as an alarm
    """
    def __init__(
        self,
        *,
        design: str = "auto",
        share: str = "neighbours",
        self_weight: typing.SupportsFloat | typing.SupportsIndex = ...,
        weights: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex] = [],
        sharing: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex] = [],
        gain: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex] = [],
        false_alarm: typing.SupportsFloat | typing.SupportsIndex = 0.01,
        test: str = "residual",
        window: typing.SupportsInt | typing.SupportsIndex = 1,
        alarm_after: typing.SupportsInt | typing.SupportsIndex = 1,
        clear_after: typing.SupportsInt | typing.SupportsIndex = 5,
        settle: typing.SupportsInt | typing.SupportsIndex = -1,
        isolate: bool = False,
        accuse_missing: bool = False,
    ) -> None: ...

class PartialSharing(Filter):
    """
    Consensus Kalman filter with partial sharing (BR-CDF).

    Source: Moradi, Gogineni, Venkategowda, Werner, 2023, Algorithm 1

    gain: factor of the consensus gain C_i = gamma (A - K_i H_i) P_i; see the stability tests of check [1], >= 0, <= 1e+06
    shared: entries of the estimate that every agent sends per sample; 0 = all [entries], >= 0
    shared_each: the same, one number per agent; overrides shared [entries], >= 1
    selection: which entries every agent sends first: zeros and ones, agent by agent, one per state; overrides shared, shared_each and starts, >= 0, <= 1
    starts: first selections: "random" subsets (uncoordinated, the paper), or "coordinated": everybody begins with the first entries
    selection_seed: seed of the random first selections, >= 0
    shift: circular shift of all selections per sample; any whole number. Without a common factor with the number of states every entry has its turn [entries]
    start_variance: P_0 = start_variance I [state^2], >= 0, <= 1e+100
    start_covariance: P_0 row by row, symmetric positive semidefinite; overrides start_variance [state^2]
    start_is_prediction: the initial estimate and P_0 belong to the first measurement (xhat(0) of the paper), not to the sample before it
    gains: "frozen" once (11) has converged, "varying" for ever (same values but for rounding), or "steady": the limits from the start
    """
    def __init__(
        self,
        *,
        gain: typing.SupportsFloat | typing.SupportsIndex = ...,
        shared: typing.SupportsInt | typing.SupportsIndex = 0,
        shared_each: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex] = [],
        selection: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex] = [],
        starts: str = "random",
        selection_seed: typing.SupportsInt | typing.SupportsIndex = 0,
        shift: typing.SupportsInt | typing.SupportsIndex = 1,
        start_variance: typing.SupportsFloat | typing.SupportsIndex = 1.0,
        start_covariance: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex] = [],
        start_is_prediction: bool = False,
        gains: str = "frozen",
    ) -> None: ...

class Platoon(Filter):
    """
    Observer, detector and controller of a string of vehicles.

    Source: He, Hashemi, Johansson, Automatica 2021, Algorithms 1, 2 and 3

    threshold: saturation threshold: beta_{i,0} of (25), or the static one; left out: the one with the least certified limit under the adaptive threshold [m, m/s], > 0
    adaptive: the threshold follows the error bound (25); false: static
    attacked: most absolute sensors attacked, 1..L [sensors]
    process_noise: ||d_i(t)|| <= eps [m, m/s], >= 0
    measurement_noise: length of the noise vector of every absolute and relative sensor is at most mu [m, m/s], >= 0
    initial_error: ||xhat_i(0) - x_i(0)|| <= q [m, m/s], > 0
    varpi: 1/varpi is the observer gain of vehicles that hear fewer than 2L others [1], > 1
    reference: position and velocity of the reference at time 0, or at times 0, 1, ...; constant velocity after the last pair [m, m/s]
    spacing: desired gap between vehicles [m]
    gs: controller gain on positions, > 0 [1/s^2]
    gv: controller gain on velocities, > T g_s [1/s]
    detector: Algorithm 2; false: the sets stay as given
    bound: "safe" (valid), "tight" (valid, smaller, more work) or "printed": (17) as printed, which is false (counterexamples: cases process_noise_counterexample and lemma1_counterexample) and is therefore never reported as a bound
    tie: (13), two sources equally near: lower label or smaller error bound
    count: (29): "runs" of suspects as printed, or "cover": send the pairs that fired and count the least number of sensors that explains them; never weaker
    pairs: test (27) for all pairs in range and conclude from all explanations by at most b attackers (our notes, S4)
    neighbours: test (28) for the measurements of all neighbours (our notes, S6)
    median: take the median of the reconstructed measurements where its bound is smaller (our notes, S3)
    accuse_missing: a missing (NaN) absolute measurement counts as proof of attack
    prior_attacked: what vehicles are told before the start: pairs vehicle, sensor proved attacked
    prior_suspected: the same for suspected sensors
    prior_free: the same for sensors that are known to be free
    """
    def __init__(
        self,
        *,
        threshold: typing.SupportsFloat | typing.SupportsIndex = ...,
        adaptive: bool = True,
        attacked: typing.SupportsInt | typing.SupportsIndex = 1,
        process_noise: typing.SupportsFloat | typing.SupportsIndex = ...,
        measurement_noise: typing.SupportsFloat | typing.SupportsIndex = ...,
        initial_error: typing.SupportsFloat | typing.SupportsIndex = ...,
        varpi: typing.SupportsFloat | typing.SupportsIndex = 2.0,
        reference: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex] = [],
        spacing: typing.SupportsFloat | typing.SupportsIndex = 20.0,
        gs: typing.SupportsFloat | typing.SupportsIndex = ...,
        gv: typing.SupportsFloat | typing.SupportsIndex = ...,
        detector: bool = True,
        bound: str = "safe",
        tie: str = "low",
        count: str = "runs",
        pairs: bool = False,
        neighbours: bool = False,
        median: bool = False,
        accuse_missing: bool = False,
        prior_attacked: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex] = [],
        prior_suspected: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex] = [],
        prior_free: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex] = [],
    ) -> None: ...

class PlatoonBaseline(Filter):
    """
    Unprotected and trimmed-mean control of a string of vehicles.

    Source: baselines PWM, PTD (Lin, Jia 2009), PBE (Mitra, Sundaram 2019) of the platoon paper; our definitions

    kind: which one
    attacked: pbe: values trimmed from each end [sensors], >= 0
    varpi: pbe: 1/varpi is the gain of the local update [1], >= 1
    reference: position and velocity of the reference at time 0, or at times 0, 1, ... [m, m/s]
    spacing: desired gap between vehicles [m]
    gs: controller gain on positions, > 0 [1/s^2]
    gv: controller gain on velocities, > T g_s [1/s]
    process_noise: of the simulated vehicles [m, m/s], >= 0
    measurement_noise: of the simulated sensors [m, m/s], >= 0
    """
    def __init__(
        self,
        *,
        kind: str = "",
        attacked: typing.SupportsInt | typing.SupportsIndex = 1,
        varpi: typing.SupportsFloat | typing.SupportsIndex = 2.0,
        reference: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex] = [],
        spacing: typing.SupportsFloat | typing.SupportsIndex = 20.0,
        gs: typing.SupportsFloat | typing.SupportsIndex = ...,
        gv: typing.SupportsFloat | typing.SupportsIndex = ...,
        process_noise: typing.SupportsFloat | typing.SupportsIndex = 0.0,
        measurement_noise: typing.SupportsFloat | typing.SupportsIndex = 0.0,
    ) -> None: ...

class Attack:
    """
    An attack with its schedule; made by the functions of garrison.attacks.
    """
    def __repr__(self) -> str: ...
    @property
    def agents(self) -> list[int]:
        """
        Every agent that is attacked at some time.
        """
    @property
    def name(self) -> str: ...
    @property
    def start(self) -> int:
        """
        First sample that may be attacked.
        """
    @property
    def target(self) -> str: ...

class Message:
    """
    A message between agents of the same filter.
    """
    @property
    def sender(self) -> int: ...
    @property
    def values(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Its numbers (a copy).
        """

class Agent:
    """
    One agent on its own: `sense` once per sample, then `fuse` once per round, with the same bits as
    inside simulate and replay.
    """
    def __init__(
        self, filter: Filter, model: Model, network: Network, id: typing.SupportsInt | typing.SupportsIndex
    ) -> None: ...
    def fuse(self, inbox: collections.abc.Sequence[Message]) -> Message:
        """
        Messages of the neighbours in any order; leave missing ones out. Returns the next message.
        """
    def reset(self, x0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"]) -> None:
        """
        Back to time 0 with the initial estimate x0, (n,).
        """
    def sense(self, y: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex]) -> Message:
        """
        One number per row of C_i, nan = missing. Returns the first message of this sample.
        """
    @property
    def accused(self) -> list[int]:
        """
        Agents that this one believes to be attacked.
        """
    @property
    def bound(self) -> float: ...
    @property
    def control(self) -> float:
        """
        What it does to its own plant until the next sample; nan where it has none.
        """
    @property
    def dropped(self) -> int:
        """
        Messages dropped because a number was not finite.
        """
    @property
    def estimate(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (n,)
        """
    @property
    def id(self) -> int: ...
    @property
    def rounds(self) -> int:
        """
        Rounds per sample.
        """
    @property
    def statistic(self) -> float: ...
    @property
    def threshold(self) -> float: ...
    @property
    def verdict(self) -> int: ...

class SubsetBound:
    """
    Result of a search over the s removed sensors; the true value lies in [lower, upper].
    Safe in theorems: lower of lambda0, upper of varpi and tau0.
    """
    def __repr__(self) -> str: ...
    @property
    def exact(self) -> bool:
        """
        The search finished.
        """
    @property
    def lower(self) -> float: ...
    @property
    def method(self) -> str: ...
    @property
    def nodes(self) -> int: ...
    @property
    def removed(self) -> list[int]:
        """
        Worst set found, sorted.
        """
    @property
    def upper(self) -> float: ...

class Identified:
    """
    A model identified from clean records; use garrison.fit.
    """
    def measurements(
        self,
        raw: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
        first: typing.SupportsInt | typing.SupportsIndex,
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        Measurements (T, N) of other records under this model.
        """
    def reference_states(
        self, measured: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"]
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        Least-squares states (T, n) of clean measurements of the same time.
        """
    @property
    def A(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (n, n)
        """
    @property
    def C(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (N, n), rows of unit length
        """
    @property
    def measurement_bound(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (N,)
        """
    @property
    def measurement_variance(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (N,)
        """
    @property
    def process_bound(self) -> float: ...
    @property
    def process_covariance(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (n, n)
        """
    @property
    def scale(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (N,): anomaly / scale = measurement
        """
    @property
    def season(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (1 + 2 harmonics, N)
        """
    @property
    def share(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (n,): part of the variance that each factor carries
        """

def attack_infos() -> list:
    """
    All attacks with the description of their parameters.
    """

def central_kalman(
    model: Model,
    measurements: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    x0: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    start_variance: typing.SupportsFloat | typing.SupportsIndex,
) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
    """
    Estimates (T + 1, n) of a central Kalman filter.
    """

def chebyshev_contraction(
    gamma: typing.SupportsFloat | typing.SupportsIndex, rounds: typing.SupportsInt | typing.SupportsIndex
) -> float:
    """
    What `rounds` Chebyshev-filtered rounds leave of a disagreement.
    """

def check(
    filter: Filter, model: Model, network: Network, seconds: typing.SupportsFloat | typing.SupportsIndex = ...
) -> tuple[list, list]:
    """
    Conditions and quantities of the family's theorems, as two lists of dicts. Searches end after `seconds` with a
    certified interval; a computation without partial results raises InvalidInput then. Ctrl-C ends it, too.
    """

def filter_infos() -> list:
    """
    All families with the description of their parameters.
    """

def identify(
    raw: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    first: typing.SupportsInt | typing.SupportsIndex,
    *,
    factors: typing.SupportsInt | typing.SupportsIndex = 2,
    harmonics: typing.SupportsInt | typing.SupportsIndex = 2,
    period: typing.SupportsFloat | typing.SupportsIndex = 365.25,
    root: bool = False,
    factor: typing.SupportsFloat | typing.SupportsIndex = 1.0,
) -> Identified:
    """
    Fit a model to clean records (T, N), nan = missing.
    """

def lambda0(
    C: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    s: typing.SupportsInt | typing.SupportsIndex,
    max_nodes: typing.SupportsInt | typing.SupportsIndex = 20000000,
    max_seconds: typing.SupportsFloat | typing.SupportsIndex = ...,
) -> SubsetBound:
    """
    (6) of the saturation paper: least lambda_min(sum C_i'C_i) over all sets of N - s rows of C, (N, n).
    """

def lambda0_orthogonal(
    C: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    s: typing.SupportsInt | typing.SupportsIndex,
) -> float | None:
    """
    Closed form of lambda0 for rows that are parallel or orthogonal; None for others.
    """

def lfre_parents(filter: Filter, model: Model, network: Network) -> list[list[int]]:
    """
    Parents of every agent in an Lfre filter.
    """

def make_attack(
    name: str,
    schedule: collections.abc.Sequence[
        tuple[
            typing.SupportsInt | typing.SupportsIndex,
            collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex],
        ]
    ],
    stop: typing.SupportsInt | typing.SupportsIndex | None,
    probability: typing.SupportsFloat | typing.SupportsIndex,
    params: dict,
) -> Attack:
    """
    The attack `name`. schedule: (start, agents) phases in order of time.
    """

def make_filter(name: str, params: dict) -> Filter:
    """
    The filter `name`; unknown names are refused with the nearest one.
    """

def nearest_name(unknown: str, known: collections.abc.Sequence[str]) -> str:
    """
    The known name closest to `unknown`, or an empty text.
    """

def observable(
    A: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    C: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
) -> bool:
    """
    (A, C) is observable, C (m, n).
    """

def one_step_sparse_observable(
    C: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    s: typing.SupportsInt | typing.SupportsIndex,
) -> bool:
    """
    Any N - s rows of C span the state.
    """

def replay(
    model: Model,
    network: Network,
    filter: Filter,
    *,
    measurements: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    truth: typing.Annotated[numpy.typing.ArrayLike, numpy.float64] | None,
    trials: typing.SupportsInt | typing.SupportsIndex,
    seed: typing.SupportsInt | typing.SupportsIndex,
    threads: typing.SupportsInt | typing.SupportsIndex,
    start: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"] | None,
    attacks: collections.abc.Sequence[Attack],
    link: dict,
    keep: collections.abc.Sequence[str],
    progress: typing.Any,
) -> dict:
    """
    Arrays of a replayed run; use garrison.replay.
    """

def s_sparse_observable(
    A: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    C: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    s: typing.SupportsInt | typing.SupportsIndex,
) -> bool:
    """
    (A, kept rows) is observable whichever s rows of C are lost.
    """

def simulate(
    model: Model,
    network: Network,
    filter: Filter,
    *,
    steps: typing.SupportsInt | typing.SupportsIndex,
    x0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
    start_error: typing.SupportsFloat | typing.SupportsIndex,
    noise: str,
    disturbances: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
    trials: typing.SupportsInt | typing.SupportsIndex,
    seed: typing.SupportsInt | typing.SupportsIndex,
    threads: typing.SupportsInt | typing.SupportsIndex,
    start: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"] | None,
    attacks: collections.abc.Sequence[Attack],
    link: dict,
    keep: collections.abc.Sequence[str],
    progress: typing.Any,
) -> dict:
    """
    Arrays of a simulated run; use garrison.simulate.
    """

def split_outputs(model: Model, network: Network) -> tuple[Model, Network, list[int]]:
    """
    (model, network, owner) with an agent per output: m agents that hear each other for one with m outputs.
    """

def tau0(
    C: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    A: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    s: typing.SupportsInt | typing.SupportsIndex,
) -> SubsetBound:
    """
    Theorem 5: largest (1/N) ||[C_i'C_i A]|| over sets of N - s rows.
    """

def varpi(
    C: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    A: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    s: typing.SupportsInt | typing.SupportsIndex,
) -> SubsetBound:
    """
    Theorem 3: largest ||(I - (1/N) sum C_i'C_i) A|| over sets of N - s rows.
    """

__version__: str = "0.1.0"
