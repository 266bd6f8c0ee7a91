"""Good and bad values for every argument of garrison, by its name."""

from __future__ import annotations

import random
from collections.abc import Callable
from pathlib import Path
from typing import Any

import garrison as gr
import numpy as np
from fuzz_samples import samples

#: good values by the name of an argument
GOOD: dict[str, list[Any]] = {
    "A": [np.diag([0.9, 0.8]), np.eye(3), 0.9],
    "C": [np.eye(2), [np.eye(2)[[0]]] * 3, np.ones((4, 2)), np.zeros((0, 2))],
    "G": [np.eye(4)],
    "Q": [np.eye(2)],
    "M": [np.eye(2)],
    "W": [np.full((2, 2), 0.5), np.eye(3)],
    "U": [np.ones((2, 2)), np.eye(3)],
    "E": [np.eye(2)],
    "R": [np.eye(2)],
    "K": [[np.eye(2)] * 3, [np.eye(2)], []],
    "P": [[np.eye(2)] * 3],
    "S": [np.eye(2)],
    "Sigma": [np.eye(6), None],
    "block": [np.eye(2)],
    "b": [np.ones(2)],
    "b_v": [np.ones(2)],
    "tau": [np.ones(2)],
    "x0": [np.zeros(2), np.zeros(3)],
    "y": [[0.1], [0.1, 0.2], np.zeros((4, 3))],
    "delta": [np.zeros((4, 6))],
    "start": [np.zeros(2), np.eye(2), np.zeros((3, 2)), [np.eye(2)] * 3, 1],
    "covariances": [[np.eye(3)] * 2],
    "dc_gain": [np.eye(3)],
    "measurements": [np.zeros((5, 3))],
    "measured": [[0, 1, None], np.zeros((5, 3))],
    "raw": [np.zeros((900, 3)), np.random.default_rng(1).normal(size=(900, 3))],
    "records": [np.zeros((9, 2))],
    "residuals": [np.zeros((5, 3))],
    "residual_std": [np.ones(3)],
    "threshold": [np.ones(3), 1.0],
    "estimates": [np.zeros((3, 2))],
    "errors": [np.zeros((3, 2))],
    "cost": [np.ones((2, 2))],
    "matrix": [np.eye(3), np.ones((2, 2))],
    "edges": [[(0, 1), (1, 2)], np.array([[0, 1], [1, 2]]), []],
    "entries": [[(0, 1)], []],
    "weights": [[1.0, 2.0]],
    "classes": [[[0], [1]], []],
    "types": [["alpha", "beta", "gamma"], None],
    "type": ["alpha", "gamma"],
    "choice": ["class", "exact"],
    "alarms": [[0], []],
    "indptr": [[0, 1, 2], [0]],
    "indices": [[0, 1], []],
    "alpha": [1.0, [1.0] * 6],
    "free": [[1], True],
    "labels": [[1, 2, 4]],
    "moments": ["p_e", "cycle"],
    "kind": ["steady", "one_step"],
    "method": ["auto", "riccati"],
    "penalty": ["norm", "l1"],
    "solver": ["exact"],
    "inbox": [[]],
    "agents": [3, [0], [0, 1]],
    "byzantine": [[0], []],
    "schedule": [[(1, [0])]],
    "names": [["a", "b", "c"], None],
    "states": [["a", "b"]],
    "name": ["saturation", "bias"],
    "unknown": ["x"],
    "known": [["x", "y"]],
    "params": [{}, {"threshold": 1.0}],
    "keep": [["estimate", "report"]],
    "link": [{"drop": 0.1}, {}, None],
    "noise": ["auto", "none", np.zeros((5, 3))],
    "disturbances": [np.zeros((0, 0))],
    "attacks": [[]],
    "attack": [()],
    "truth": [None, np.zeros((6, 2))],
    "progress": [None],
    "steps": [3],
    "trials": [1],
    "path": [Path("/nonexistent/file")],
    "vehicles": [6],
    "s": [1, np.zeros(4)],
    "T": [5],
    "values": [[0, 1]],
}


#: a scenario of a few milliseconds, in the folder where the calls are made
SCENARIO = """
[model]
A = [[0.9]]
C = [[1.0], [1.0], [1.0]]
process_bound = 0.1
measurement_bound = 0.1
[network]
kind = "ring"
[filter]
name = "scalar_gain"
[run]
steps = 3
threads = 1
"""
_TRIVIAL = gr.Model([[0.9]], [[1.0]] * 5, process_bound=0.1, measurement_bound=0.1)
_CORE = {
    "design": samples()["Prepared"][0],
    "steps": 3,
    "x0": np.zeros(2),
    "start_error": 0.0,
    "noise": "uniform",
    "disturbances": np.zeros((0, 0)),
    "measurements": np.zeros((4, 3)),
    "truth": None,
    "trials": 1,
    "first_trial": 0,
    "seed": 0,
    "threads": 1,
    "start": None,
    "attacks": [],
    "link": {},
    "keep": ["estimate"],
    "progress": None,
}
#: arguments that are always given to these callables, so that a call takes milliseconds or fits at all
KEPT: dict[str, dict[str, Any]] = {
    "garrison.analyze": {"seconds": 0.5},
    "garrison.compare": {
        "attacked": [0],
        "filters": {"one": gr.filters.ScalarGain()},
        "attacks": {"one": gr.attacks.Bias([0], value=1.0)},
        "steps": 4,
        "start": 2,
        "trials": 1,
    },
    "garrison.design": {
        "model": _TRIVIAL,
        "network": gr.Network.complete(5),
        "family": "saturation",
        "goal": "error",
        "attacked": 1,
        "initial_error": 1.0,
        "most_rounds": 5,
    },
    "garrison.sweep": {
        "scenario": "scenario.toml",
        "out": "swept",
        "set": {"run.seed": [1, 2]},
        "points": None,
        "trials": 1,
        "workers": 1,
        "client": None,
    },
    "garrison._core.simulate": _CORE,
    "garrison._core.replay": _CORE,
}
#: arguments that always keep their value: (callable, argument)
FIXED = {
    ("garrison._core.simulate", "progress"),  # garrison.simulate and garrison.replay look at it
    ("garrison._core.replay", "progress"),
}

#: bad values that every argument gets once, all others being good
ONCE: list[Callable[[], Any]] = [
    lambda: None,
    lambda: float("nan"),
    lambda: float("inf"),
    lambda: 1e308,
    lambda: -1,
    lambda: 0,
    lambda: 2**31 - 1,
    lambda: 2**63,
    lambda: 1 + 1j,
    lambda: True,
    lambda: "x",
    lambda: [],
    lambda: [2**31 - 1],
    lambda: [float("nan")] * 3,
    lambda: np.zeros((0, 0)),
    lambda: np.zeros((2, 0)),
    lambda: np.full((2, 2), 1e308),
    lambda: np.full((3, 3), np.nan),
    lambda: np.eye(7),
    lambda: np.zeros((2, 2, 2)),
    lambda: [np.eye(5)] * 4,
    lambda: object(),
    *[lambda k=k: list(samples().values())[k][-1] for k in range(12)],
]


def nasty(rng: random.Random) -> Any:
    """A value that does not belong here."""
    numbers = [
        float("nan"),
        float("inf"),
        -float("inf"),
        1e308,
        -1e308,
        1e-320,
        -1,
        0,
        1,
        2,
        2**31 - 1,
        -(2**31),
        2**63,
        10**400,
        0.5,
    ]
    plain: list[Callable[[], Any]] = [
        lambda: None,
        lambda: rng.choice(numbers),
        lambda: rng.choice(numbers),
        lambda: rng.choice(
            [
                True,
                False,
                1j,
                1 + 0j,
                "",
                "x",
                "nan",
                "\ud800",
                b"x",
                {},
                {"a": 1},
                set(),
                (),
                [],
                object(),
                Ellipsis,
                int,
                len,
            ]
        ),
        lambda: [rng.choice(numbers) for _ in range(rng.randrange(5))],
        lambda: [[rng.choice(numbers) for _ in range(rng.randrange(1, 4))] for _ in range(rng.randrange(1, 4))],
        lambda: np.full(
            rng.choice([(0,), (1,), (2,), (3,), (0, 0), (0, 2), (2, 0), (2, 2), (3, 2), (2, 3), (2, 2, 2)]),
            rng.choice([*numbers[:6], 0.0, 1.0]),
        ),
        lambda: np.array(
            rng.choice([["a"], [1j], [None], [[1, 2j]], ["2020-01-01"]]), dtype=rng.choice([None, object])
        ),
        lambda: np.ma.masked_array([[1.0, 2.0], [3.0, 4.0]], [[0, 1], [0, 0]]),
        lambda: rng.choice(
            [
                np.float64("nan"),
                np.int64(-1),
                np.bool_(True),
                np.complex128(1j),
                np.datetime64("2020-01-01"),
                np.ma.masked,
            ]
        ),
        lambda: np.array(1.0),
        lambda: rng.choice(rng.choice(list(samples().values()))),
        lambda: [rng.choice(rng.choice(list(samples().values())))],
        lambda: np.zeros((2, 2), order="F")[::-1],
        lambda: (x for x in [1, 2]),
        lambda: [1, [2, 3]],
        lambda: np.eye(40),
        lambda: np.random.default_rng(rng.randrange(9)).normal(size=(rng.randrange(1, 5), rng.randrange(1, 5))),
    ]
    return rng.choice(plain)()


def good(rng: random.Random, owner: str, parameter: str) -> Any:
    """A value that fits, as far as the name tells."""
    found = samples()
    key = {
        "model": "Model",
        "network": "Network",
        "net": "Network",
        "filter": "Filter",
        "steady": "SteadyState",
        "pattern": "Pattern",
        "analysis": "Analysis",
    }.get(parameter)
    if parameter == "setting":
        key = next((k for k in found if k == f"{owner}.Setting"), "structural.Setting")
    if key is None and parameter == "A" and owner == "structure":
        key = "Pattern"
    if key is not None:
        return found[key][0] if rng.random() < 0.8 else rng.choice(found[key])
    if parameter in GOOD:
        return rng.choice(GOOD[parameter])
    return rng.choice([1, 2, 0.5, 1.0, 0.1, 3])
