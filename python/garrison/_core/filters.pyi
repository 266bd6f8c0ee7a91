"""
One class per filter family.
"""

from __future__ import annotations
import collections.abc
import garrison._core
import typing

__all__: list[str] = [
    "Dkf",
    "Lfre",
    "PartialSharing",
    "Platoon",
    "PlatoonBaseline",
    "Rdkf",
    "Saturation",
    "ScalarGain",
    "Structural",
]

class Saturation(garrison._core.Filter):
    """
    Saturated consensus filter, with attack detector.
    Source: He, Ren, Sandberg, Johansson, IEEE TAC 2022, Algorithms 1 and 2

    Parameters
    ----------
    threshold : float, optional
        innovations above this are clipped; inf = never. May be left out with adaptive = true [measurement], > 0
    rounds : int, optional
        consensus rounds per sample [1], >= 0, <= 1e+06
    step : float, optional
        consensus step; left out: 2/(lambda_2 + lambda_max) [1], >= 0
    chebyshev : bool, optional
        Chebyshev-filtered rounds: stronger contraction from the same messages
    attacked : int, optional
        most sensors attacked (or missing) at a time; enters bound and detector [agents], >= 0
    initial_error : float, optional
        bound on the distance of the common initial estimate from the state; giving it asks for run-time error bounds [state], > 0
    detector : bool, optional
        Algorithm 2: prove and isolate attacked sensors (their set must not change over time)
    detector_index : str, optional
        which count of proved sensors enters rhobar(t): "t" = d_i(t-1) as printed, "t+1" = d_i(t), sharper and as sound; one of: t, t+1
    adaptive : bool, optional
        let the threshold follow the known bound on honest innovations (not in the paper; needs initial_error)
    accuse_missing : bool, optional
        detector: a missing (NaN) measurement counts as proof of attack
    table : bool, optional
        also bound errors, and with detector or adaptive threshold honest innovations, by the data-free table (docs/certificates.md, theorem T): a bound that outlives the proof of all attackers. Design takes the time of (agents times states)^3
    recovery : bool, optional
        with table: go on after lost messages (docs/certificates.md, theorem L). The bound is that of the table and an excess that fades once messages arrive again, and the detector goes on testing. Agents that a loss lies behind send up to 32 bytes more
    failure : float, optional
        with table: above 0 it is that of Gaussian noise with the model's covariances, for which no noise bounds are needed (theorem TG), and the whole run has this probability at most that anything it says is false: a bound, or an accusation, of any agent at any of the samples 1 to horizon, >= 0, <= 1
    horizon : int, optional
        with failure: the samples that it is shared by; after them the table says nothing [samples], >= 0

    Raises
    ------
    InvalidInput
        A parameter is out of range.
    """
    def __copy__(self) -> typing.Any: ...
    def __deepcopy__(self, memo: dict) -> typing.Any: ...
    def __getstate__(self) -> dict: ...
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
        table: bool = False,
        recovery: bool = False,
        failure: typing.SupportsFloat | typing.SupportsIndex = 0.0,
        horizon: typing.SupportsInt | typing.SupportsIndex = 0,
    ) -> None: ...
    def __reduce__(self) -> tuple: ...
    def __setstate__(self, arg0: dict) -> None: ...

class ScalarGain(garrison._core.Filter):
    """
    Scalar-gain consensus filter (no protection).
    Source: Khan, Jadbabaie, Automatica 2014; baseline of the saturation paper

    Parameters
    ----------
    rounds : int, optional
        consensus rounds per sample [1], >= 0, <= 1e+06
    step : float, optional
        consensus step; left out: 2/(lambda_2 + lambda_max) [1], >= 0
    chebyshev : bool, optional
        Chebyshev-filtered rounds: stronger contraction from the same messages

    Raises
    ------
    InvalidInput
        A parameter is out of range.
    """
    def __copy__(self) -> typing.Any: ...
    def __deepcopy__(self, memo: dict) -> typing.Any: ...
    def __getstate__(self) -> dict: ...
    def __init__(
        self,
        *,
        rounds: typing.SupportsInt | typing.SupportsIndex = 3,
        step: typing.SupportsFloat | typing.SupportsIndex = ...,
        chebyshev: bool = False,
    ) -> None: ...
    def __reduce__(self) -> tuple: ...
    def __setstate__(self, arg0: dict) -> None: ...

class Lfre(garrison._core.Filter):
    """
    Local-filtering-based resilient estimation.
    Source: Mitra, Sundaram, Automatica 2019; baseline of the saturation paper

    Parameters
    ----------
    faulty : int, optional
        values trimmed from each end of the parents' estimates [agents], >= 0
    poles : sequence of float, optional
        real poles of the sources' observers, one per state; left out: equally spaced over 0.1, from 0.3 to 0.8, where the noise gives each source the least error [1], >= -1, <= 1

    Raises
    ------
    InvalidInput
        A parameter is out of range.
    """
    def __copy__(self) -> typing.Any: ...
    def __deepcopy__(self, memo: dict) -> typing.Any: ...
    def __getstate__(self) -> dict: ...
    def __init__(
        self,
        *,
        faulty: typing.SupportsInt | typing.SupportsIndex = 1,
        poles: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex] = [],
    ) -> None: ...
    def __reduce__(self) -> tuple: ...
    def __setstate__(self, arg0: dict) -> None: ...

class Rdkf(garrison._core.Filter):
    """
    Resilient distributed Kalman filter.
    Source: Dutta, Zhang, Jin, 2019

    Parameters
    ----------
    weight : float, optional
        lambda of (8), the pull of a measurement at most; its estimate moves by at most half of (10), which is proportional to it; 0 ignores all measurements [1], >= 0, <= 1e+100
    penalty : str, optional
        of the whitened residual: "norm" = the paper's; "huber" = the same pull, but a Kalman step as long as it is not reached; "l1" = sensor by sensor; "group" = the neighbours' measurements too, which then travel; one of: norm, huber, l1, group
    solver : str, optional
        how the step is solved: "exact", or "ipopt" as a slow cross-check of penalty "norm" in builds that have it; one of: exact, ipopt
    smoothing : float, optional
        penalty "norm" only: lambda sqrt(|r|^2 + epsilon^2); solver "ipopt" takes 1e-6 for 0 [1], >= 0, <= 1e+100
    initial_error : float, optional
        bound on the distance of every initial estimate from the state; giving it asks for run-time error bounds (needs the model's process_bound) [state], >= 0

    Raises
    ------
    InvalidInput
        A parameter is out of range.
    """
    def __copy__(self) -> typing.Any: ...
    def __deepcopy__(self, memo: dict) -> typing.Any: ...
    def __getstate__(self) -> dict: ...
    def __init__(
        self,
        *,
        weight: typing.SupportsFloat | typing.SupportsIndex = 1.0,
        penalty: str = "norm",
        solver: str = "exact",
        smoothing: typing.SupportsFloat | typing.SupportsIndex = 0.0,
        initial_error: typing.SupportsFloat | typing.SupportsIndex = ...,
    ) -> None: ...
    def __reduce__(self) -> tuple: ...
    def __setstate__(self, arg0: dict) -> None: ...

class Dkf(garrison._core.Filter):
    """
    Distributed Kalman filter, steady state (no protection).
    Source: (7) of Dutta, Zhang, Jin, 2019

    Raises
    ------
    InvalidInput
        A parameter is out of range.
    """
    def __copy__(self) -> typing.Any: ...
    def __deepcopy__(self, memo: dict) -> typing.Any: ...
    def __getstate__(self) -> dict: ...
    def __init__(self) -> None: ...
    def __reduce__(self) -> tuple: ...
    def __setstate__(self, arg0: dict) -> None: ...

class PartialSharing(garrison._core.Filter):
    """
    Consensus Kalman filter with partial sharing (BR-CDF).
    Source: Moradi, Gogineni, Venkategowda, Werner, 2023, Algorithm 1

    Parameters
    ----------
    gain : float
        factor of the consensus gain C_i = gamma (A - K_i H_i) P_i; see the stability tests of check [1], >= 0, <= 1e+06
    shared : int, optional
        entries of the estimate that every agent sends per sample; 0 = all [entries], >= 0
    shared_each : sequence of float, optional
        the same, one number per agent; overrides shared [entries], >= 1
    selection : sequence of float, optional
        which entries every agent sends first: zeros and ones, agent by agent, one per state; overrides shared, shared_each and starts, >= 0, <= 1
    starts : str, optional
        first selections: "random" subsets (uncoordinated, the paper), or "coordinated": everybody begins with the first entries; one of: random, coordinated
    selection_seed : int, optional
        seed of the random first selections, >= 0
    shift : int, optional
        circular shift of all selections per sample; any whole number. Without a common factor with the number of states every entry has its turn [entries]
    start_variance : float, optional
        P_0 = start_variance I [state^2], >= 0, <= 1e+100
    start_covariance : sequence of float, optional
        P_0 row by row, symmetric positive semidefinite; overrides start_variance [state^2]
    start_is_prediction : bool, optional
        the initial estimate and P_0 belong to the first measurement (xhat(0) of the paper), not to the sample before it
    gains : str, optional
        "frozen" once (11) has converged, "varying" for ever (same values but for rounding; in a plant that changes they follow it), or "steady": the limits from the start; one of: frozen, varying, steady

    Raises
    ------
    InvalidInput
        A parameter is out of range.
    """
    def __copy__(self) -> typing.Any: ...
    def __deepcopy__(self, memo: dict) -> typing.Any: ...
    def __getstate__(self) -> dict: ...
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
    def __reduce__(self) -> tuple: ...
    def __setstate__(self, arg0: dict) -> None: ...

class Structural(garrison._core.Filter):
    """
    Single-time-scale estimator with exact residual tests.
    Source: Doostmohammadian et al., IEEE TNSE 2021

    Parameters
    ----------
    design : str, optional
        how the gains are found; auto: riccati, else kalman, else h2; one of: auto, riccati, kalman, h2, projection
    share : str, optional
        whose measurements an agent uses besides its own; one of: neighbours, none
    self_weight : float, optional
        weight of an agent's own estimate, the rest spread evenly over its neighbours; left out: 1/(degree + 1). Small ones stabilise more [1], >= 0, <= 1
    weights : sequence of float, optional
        N*N mixing weights row by row, instead of self_weight [1], >= 0
    sharing : sequence of float, optional
        N*N numbers 0 or 1 row by row, instead of share [1], >= 0, <= 1
    gain : sequence of float, optional
        N*n*n numbers, K_i row by row, agent by agent, instead of design [1]
    false_alarm : float, optional
        probability per sample of an alarm without an attack [1], > 0, <= 1
    test : str, optional
        what is tested: y - c'x after the update (residual) or before it; auto: innovation with isolate, else residual; one of: auto, residual, innovation
    window : int, optional
        1: a test per sample; more: chi-square over so many residuals, exact covariance [samples], >= 1, <= 1000
    alarm_after : int, optional
        tests in a row above the threshold before the verdict [samples], >= 1, <= 1e+06
    clear_after : int, optional
        tests in a row below it before the verdict is taken back [samples], >= 1, <= 1e+06
    settle : int, optional
        samples without a test after the start; -1: until rho^k < 0.01 (rho: spectral radius of the error dynamics) [samples], >= -1, <= 1e+06
    isolate : bool, optional
        leave out measurements over their level, the own one while the alarm lasts
    accuse_missing : bool, optional
        a missing own measurement counts as an alarm

    Raises
    ------
    InvalidInput
        A parameter is out of range.
    """
    def __copy__(self) -> typing.Any: ...
    def __deepcopy__(self, memo: dict) -> typing.Any: ...
    def __getstate__(self) -> dict: ...
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
        test: str = "auto",
        window: typing.SupportsInt | typing.SupportsIndex = 1,
        alarm_after: typing.SupportsInt | typing.SupportsIndex = 1,
        clear_after: typing.SupportsInt | typing.SupportsIndex = 5,
        settle: typing.SupportsInt | typing.SupportsIndex = -1,
        isolate: bool = False,
        accuse_missing: bool = False,
    ) -> None: ...
    def __reduce__(self) -> tuple: ...
    def __setstate__(self, arg0: dict) -> None: ...

class Platoon(garrison._core.Filter):
    """
    Observer, detector and controller of a string of vehicles.
    Source: He, Hashemi, Johansson, Automatica 2021, Algorithms 1, 2 and 3

    Parameters
    ----------
    threshold : float, optional
        saturation threshold: beta_{i,0} of (25), or the static one; left out: the one with the least certified limit under the adaptive threshold [m, m/s], > 0
    adaptive : bool, optional
        the threshold follows the error bound (25); false: static
    attacked : int, optional
        most absolute sensors attacked, 1..L [sensors]
    process_noise : float
        bound on the process noise of a vehicle per sample [m, m/s], >= 0
    measurement_noise : float, optional
        length of the noise vector of every absolute and relative sensor is at most mu; may be left out when the four bounds on entries are given [m, m/s], >= 0
    absolute_position_noise : float, optional
        bound on the noise of the absolute sensors' position; left out: measurement_noise [m], >= 0
    absolute_velocity_noise : float, optional
        the same for their velocity [m/s], >= 0
    relative_position_noise : float, optional
        bound on the noise of the relative sensors' position; left out: measurement_noise [m], >= 0
    relative_velocity_noise : float, optional
        the same for their velocity [m/s], >= 0
    initial_error : float
        bound on the error of the first estimate [m, m/s], > 0
    varpi : float, optional
        1/varpi is the observer gain of vehicles that hear fewer than 2L others [1], > 1
    reference : sequence of float, optional
        position and velocity of the reference at time 0, or at times 0, 1, ...; constant velocity after the last pair. Without reference, gs and gv the filter only observes [m, m/s]
    spacing : float, optional
        desired gap between vehicles [m]
    gs : float, optional
        controller gain on positions, > 0 [1/s^2]
    gv : float, optional
        controller gain on velocities, > T g_s [1/s]
    input_bound : float, optional
        |u_i(t)| <= input_bound where inputs are not recorded, for a filter that only observes (no reference, gs and gv): T input_bound enters eps [m/s^2], >= 0
    detector : bool, optional
        Algorithm 2; false: the sets stay as given
    bound : str, optional
        "safe" (valid), "tight" (valid, smaller, more work) or "printed": (17) as printed, which is false (counterexamples: cases process_noise_counterexample and lemma1_counterexample) and is therefore never reported as a bound; one of: safe, tight, printed
    tie : str, optional
        (13), two sources equally near: lower label or smaller error bound; one of: low, bound
    count : str, optional
        (29): "runs" of suspects as printed, or "cover": send the pairs that fired and count the least number of sensors that explains them; never weaker; one of: runs, cover
    pairs : bool, optional
        test (27) for all pairs in range and conclude from all explanations by at most b attackers (not in the paper)
    neighbours : bool, optional
        test (28) for the measurements of all neighbours (not in the paper)
    median : bool, optional
        take the median of the reconstructed measurements where its bound is smaller (not in the paper)
    accuse_missing : bool, optional
        a missing (NaN) absolute measurement counts as proof of attack
    prior_attacked : sequence of float, optional
        known before the start: pairs vehicle, sensor proved attacked
    prior_suspected : sequence of float, optional
        the same for suspected sensors
    prior_free : sequence of float, optional
        the same for sensors that are known to be free

    Raises
    ------
    InvalidInput
        A parameter is out of range.
    """
    def __copy__(self) -> typing.Any: ...
    def __deepcopy__(self, memo: dict) -> typing.Any: ...
    def __getstate__(self) -> dict: ...
    def __init__(
        self,
        *,
        threshold: typing.SupportsFloat | typing.SupportsIndex = ...,
        adaptive: bool = True,
        attacked: typing.SupportsInt | typing.SupportsIndex = 1,
        process_noise: typing.SupportsFloat | typing.SupportsIndex = ...,
        measurement_noise: typing.SupportsFloat | typing.SupportsIndex = ...,
        absolute_position_noise: typing.SupportsFloat | typing.SupportsIndex = ...,
        absolute_velocity_noise: typing.SupportsFloat | typing.SupportsIndex = ...,
        relative_position_noise: typing.SupportsFloat | typing.SupportsIndex = ...,
        relative_velocity_noise: typing.SupportsFloat | typing.SupportsIndex = ...,
        initial_error: typing.SupportsFloat | typing.SupportsIndex = ...,
        varpi: typing.SupportsFloat | typing.SupportsIndex = 2.0,
        reference: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex] = [],
        spacing: typing.SupportsFloat | typing.SupportsIndex = 20.0,
        gs: typing.SupportsFloat | typing.SupportsIndex = ...,
        gv: typing.SupportsFloat | typing.SupportsIndex = ...,
        input_bound: typing.SupportsFloat | typing.SupportsIndex = ...,
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
    def __reduce__(self) -> tuple: ...
    def __setstate__(self, arg0: dict) -> None: ...

class PlatoonBaseline(garrison._core.Filter):
    """
    Unprotected and trimmed-mean control of a string of vehicles.
    Source: baselines PWM, PTD (Lin, Jia 2009), PBE (Mitra, Sundaram 2019) of the platoon paper; our definitions

    Parameters
    ----------
    kind : str
        which controller: pwm, ptd or pbe; one of: pwm, pbe, ptd
    attacked : int, optional
        pbe: values trimmed from each end [sensors], >= 0
    varpi : float, optional
        pbe: 1/varpi is the gain of the local update [1], >= 1
    reference : sequence of float
        position and velocity of the reference at time 0, or at times 0, 1, ... [m, m/s]
    spacing : float, optional
        desired gap between vehicles [m]
    gs : float
        controller gain on positions, > 0 [1/s^2]
    gv : float
        controller gain on velocities, > T g_s [1/s]
    process_noise : float, optional
        of the simulated vehicles [m, m/s], >= 0
    measurement_noise : float, optional
        of the simulated sensors [m, m/s], >= 0

    Raises
    ------
    InvalidInput
        A parameter is out of range.
    """
    def __copy__(self) -> typing.Any: ...
    def __deepcopy__(self, memo: dict) -> typing.Any: ...
    def __getstate__(self) -> dict: ...
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
    def __reduce__(self) -> tuple: ...
    def __setstate__(self, arg0: dict) -> None: ...
