"""What the tables and keys of a scenario mean."""

TABLES = {
    "model": "The plant and the sensors: matrices, a fit to records (`fit`), a model file (`file`), or vehicles.",
    "network": "Who hears whom: `edges`, a generator (`kind`), or `stations` on a map.",
    "filter": "The filter: `name`, `label`, and its parameters; [the pages of the filters](../filters/index.md) list "
    "them, and so does `garrison list NAME`.",
    "compare": "Other filters on the same data, as often as wanted, with the same keys as `[filter]`; "
    "`central_kalman` is a Kalman filter that sees every measurement, `local_kalman` one per agent that sees those of "
    "its neighbours and its own.",
    "attack": "Who is attacked, when and how, as often as wanted; the other keys are the parameters of the "
    "[attack](attacks.md).",
    "link": "Messages that are lost or late, by chance. Without this table every message arrives in its round.",
    "noise": "The law of the simulated noise.",
    "data": "Recorded measurements, which are replayed instead of simulated ones.",
    "run": "How long, how often, from where. `steps` is required unless there is `[data]`.",
    "certificate": "Bounds on the error that need no filter; see [certificates](../certificates.md).",
}

MEANINGS = {
    "model": {
        "A": 'n x n numbers, row by row, or `{ file = "A.csv" }`: x(t) = A x(t-1) + w',
        "C": "measurements, one entry per agent: a row of n numbers, a matrix of several rows, or `[]` for a relay "
        "without sensors",
        "process_bound": "length of w at most, in units of the state",
        "measurement_bound": "size of a measurement's noise at most; one number or one per measurement",
        "process_covariance": "covariance of w: n x n numbers, or one number for a multiple of the identity",
        "measurement_covariance": "covariance of each agent's noise: one number, or one matrix per agent",
        "fit": "CSV of clean records from which the model is identified (`garrison fit` writes the same to a file)",
        "from": "first date or time that is used",
        "to": "last one",
        "factors": "number of states",
        "harmonics": "sines and cosines of the season that are removed first",
        "period": "with `fit`: length of the season in samples; with `vehicles`: sampling time in s",
        "root": "true: work with square roots of the records (wind speeds are then close to Gaussian)",
        "factor": "multiplies every record first, to change units",
        "standardise": "true: factors of every column in units of its own spread; false: all columns have one unit; "
        "left out: true where the header names different units",
        "vehicles": "number of vehicles in a string: position (m) and velocity (m/s) each",
        "names": "names of the agents (with `vehicles`: of these), for tables and pictures",
        "inputs": "with `B`: names of the known inputs; with `fit`: columns that are known inputs; with `vehicles`: "
        "true = recorded control inputs are part of the data",
        "B": "what known inputs u do: x(t+1) = A x(t) + B u(t) + w; n x p numbers, a row per state",
        "states": 'names of the states; with `fit`: "factors", or "all" for a model with every station as a state',
        "order": 'with `states = "all"`: samples of the past that count; left out: chosen by held-out likelihood',
        "most": "largest order that is tried (4)",
        "held_out": "share of the samples, the last ones, that choose the order (0.25)",
        "noise": "part of a station's residual variance that is taken for measurement noise (0.01)",
        "outputs": "names of all measurements, agent by agent; columns of `[data]` are matched by them",
        "sources": "who can falsify each measurement; those of one receiver have one source",
        "units": 'units by the names of states, outputs and inputs: `{ x = "m" }`, or one for all',
        "exposed": "per agent, how many of its first outputs an attacker can reach",
        "interval": "sampling time: `A` and `B` are those of dx/dt = A x + B u, discretised exactly",
        "times": "T + 1 times, increasing, likewise: the start's, then one per sample, in the unit of time of `A`",
        "process_intensity": "with these two: spectral density of the noise, n x n numbers, or one for all states",
        "A_over_time": "A of every step, in place of `A`: T x n x n numbers, or a file with the matrices below "
        "each other; see [plants that change](../how-to/changing-plants.md)",
        "B_over_time": "likewise",
        "C_over_time": "likewise, of samples 1, 2, ..: the rows of all agents",
        "process_covariance_over_time": "likewise",
        "measurement_covariance_over_time": "variances of all outputs, a row per sample; or the covariances "
        "of all agents below each other, per sample",
        "file": "a [model file](../files.md#model-json): `garrison fit -o model.json` and `garrison import` write them",
    },
    "network": {
        "edges": "pairs of agents, by number (from 0) or by name",
        "agents": "number of agents; left out: as many as `[model].C` has entries",
        "directed": "true: a pair is (sender, receiver) and not both ways",
        "present": "T x edges numbers 0 or 1 (or a file): whether each link is there at samples 1, 2, ..",
        "kind": "a generated network, see below",
        "stations": "CSV with a code, latitude and longitude per agent",
        "radius_km": "stations at most so far apart are neighbours",
    },
    "filter": {
        "name": "which filter",
        "label": "its name in tables and pictures",
        "gate": "of the Kalman filters: probability at which a chi-square test leaves out an honest output",
        "huber": "of the Kalman filters: deviations from which on a residual pulls no harder",
    },
    "attack": {
        "kind": "which attack",
        "agents": "numbers or names of the attacked agents; one may stand without a list",
        "start": "first attacked sample, or a date where the records have dates",
        "stop": "first sample that is not attacked any more; left out: never",
        "schedule": "pairs of a start and agents, for sets that change: `[[100, [3]], [200, [5, 7]]]`",
        "probability": "chance per sample that the attack acts (1)",
    },
    "link": {
        "drop": "probability that a message is lost",
        "delay": "probability that it is late",
        "delay_rounds": "how many rounds a late message is late, >= 1; its receiver has ended the round by then, so "
        "that for estimates it is lost",
    },
    "certificate": {
        "spread": '"none"; "local": from the measurements of an agent and its neighbours; '
        '"flooded": from all that the rounds bring; "direct": as "local", where agents may lie in their messages',
        "failure": "probability per agent and sample that it is wrong, for Gaussian noise; 0: for bounded noise",
        "memory": "certify from all measurements so far, too: the same liars at all times",
        "levels": 'z1 and z2 that clean records exceed at the rate `failure`, or "calibrated": those of the fit',
        "attacked": "most attacked sensors at a time; left out: that of the filter",
    },
    "noise": {"law": '"auto", or a law that the model has the bounds or covariances for'},
    "data": {
        "file": "CSV of measurements: a column per sensor, and a column of times where there are any",
        "from": "first date or time that is replayed",
        "to": "last one",
        "inputs": "names of the columns of `file` that are known inputs: a row holds what led to its sample",
    },
    "run": {
        "inputs": 'known inputs of a model with `B`: a row u(t) per step, or `{ file = "u.csv" }` '
        "(by name where they have names)",
        "steps": "samples per trial",
        "trials": "repetitions with other noise (1)",
        "seed": "of noise, attacks and losses; equal seeds give bit-identical results (0)",
        "threads": "0: as many as there are processors; the result does not depend on it",
        "x0": "state at time 0",
        "start": "estimate at time 0: one for all agents, or one row per agent",
        "start_error": "the start of every trial is moved by a random vector of at most this length (0)",
    },
}
