"""Good and bad values for every argument of garrison, by its name."""

from __future__ import annotations

import functools
import random
from collections.abc import Callable
from pathlib import Path
from typing import Any

import garrison as gr
import numpy as np
from garrison import _core


def _model(agents: int = 3) -> gr.Model:
    A = np.array([[0.9, 0.1], [0.0, 0.8]])
    C = [np.eye(2)[[i % 2]] for i in range(agents)]
    return gr.Model(
        A,
        C,
        process_bound=0.1,
        measurement_bound=0.1,
        process_covariance=0.1,
        measurement_covariance=0.2,
        outputs=[f"y{i}" for i in range(agents)],
    )


@functools.cache
class Listener(gr.Filter):
    """A filter of one's own that does nothing, and keeps what an agent knows of itself."""

    seen: Any = None

    def sense(self, agent: gr.AgentInfo, state: Any, y: Any, t: int) -> Any:
        Listener.seen = agent

    def fuse(self, agent: gr.AgentInfo, state: Any, inbox: Any, round: int) -> Any:
        return None


def _agent_info(model: gr.Model, network: gr.Network) -> gr.AgentInfo:
    if Listener.seen is None:
        gr.simulate(model, network, Listener(), steps=1)
    found: gr.AgentInfo = Listener.seen
    return found


def samples() -> dict[str, list[Any]]:
    """Good objects by the name of their class, and one of another size of each where there is."""
    model, network = _model(), gr.Network.ring(3)
    other, cut = _model(5), gr.Network([(0, 1)], agents=5)
    assert set(GOOD_FILTERS) == {info["name"] for info in _core.filter_infos()}, "GOOD_FILTERS: one entry per family"
    filters = [gr.filters.make_filter(name, params) for name, params in GOOD_FILTERS.items()]
    shared = next(f for f in filters if f.name == "partial_sharing")
    analysis = gr.partial_sharing.Analysis(shared, model, network)
    structural = next(f for f in filters if f.name == "structural")
    weights = network.max_degree_weights()
    wind = np.random.default_rng(0).normal(size=(900, 3))
    found: dict[str, list[Any]] = {
        "Model": [model, other],
        "Network": [network, cut],
        "Filter": filters,
        "Attack": [gr.attacks.Bias([0], value=1.0), gr.attacks.Silence([1])],
        "WorstAttack": [gr.partial_sharing.worst_covariance(analysis, [0], 1.0, "steady", 1, None)],
        "SubsetBound": [gr.lambda0(np.eye(2), 0)],
        "Identified": [_core.identify(wind, 1, factors=1)],
        "Analysis": [analysis],
        "Selection": [gr.partial_sharing.Selection(np.eye(2), 1)],
        "SelectionProblem": [gr.partial_sharing.SelectionProblem(np.eye(4), 2, 1)],
        "SteadyState": [_core.rdkf.Setting(model, network).steady_state()],
        "Pattern": [gr.structure.Pattern.of(np.eye(3)), gr.structure.Pattern(2, 5, [(0, 1)])],
        "System": [gr.structure.System(gr.structure.Pattern.of(np.eye(2)))],
        "saturation.Setting": [
            gr.saturation.Setting(
                agents=3, a=0.9, lambda0=1.0, contraction=0.1, attacked=1, beta=1.0, eta0=1.0, b_w=0.1, b_v=0.1
            )
        ],
        "rdkf.Setting": [_core.rdkf.Setting(model, network)],
        "structural.Setting": [
            gr.structural.setting(structural, model, network),
            gr.structural.Setting(A=np.eye(2), C=np.eye(2), W=np.eye(2), U=np.eye(2)),
        ],
        "platoon.Setting": [
            gr.platoon.Setting(vehicles=6, range=2, period=0.1, attacked=1, eps=0.1, mu=0.1, q=1.0, beta=2.0)
        ],
        "weights": [weights],
        "AgentInfo": [_agent_info(model, network)],
    }
    found["FitOptions"] = [found["Identified"][0].options]
    driven = [f for f in filters if f.name in ("saturation", "rdkf", "structural", "partial_sharing")]
    found["Agent"] = [gr.Agent(model, network, f, 0) for f in driven]
    found["Message"] = [gr.Agent(model, network, f, 1).sense(1, [0.1]) for f in driven]
    prepared = gr.prepare(model, network, driven[0])
    found["Prepared"], found["Check"] = [prepared], [prepared.check()]
    found["Run"] = [prepared.simulate(steps=3, keep=["estimate", "report", "measurements", "signals", "details"])]
    found["Design"] = [_core.Design(model, network, f) for f in driven]
    return found | {type(one).__name__: [one] for one in certificates()}


def certificates() -> list[Any]:
    """One of each class of certificates."""
    c = gr.certificate
    A, C, noise = 0.9 * np.eye(2), np.eye(2)[[0, 1, 0]], np.full(3, 0.1)
    system = c.error_system(A, C, np.full((3, 3), 1 / 3))
    kernels = c.kernels(system, 5)
    window = c.Window(2, 2, 3, 3, 9)
    window.begin(1)
    window.prior_gaussian(np.zeros(2), np.eye(2))
    window.add(0, np.array([1.0, 0.0]), 0.1, 1.0)
    meters = np.array([[1.0, 0.0], [0.0, 1.0], [1.0, 1.0]])
    return [
        system,
        kernels,
        c.table(kernels, s=1, start=1.0, T=5, bw=0.1, bv=noise),
        c.gaussian_table(kernels, s=1, start=1.0, T=5, Q=0.1 * np.eye(2), R=noise, z=3.0),
        c.Region(np.zeros(2), 1.0),
        c.leverage_ball(np.zeros(3), C, noise, 1, 3.0, 3.0),
        c.Propagation.bounded(A, 3, 0.1),
        c.Recovery(kernels, 1),
        c.TwoNumbers(A, C, 1, 1.0, 0.0, 0.1, noise),
        window,
        c.leverage_window(window, 1, 3.0, 3.0, 3.0),
        c.Bank(A, 0.1 * np.eye(2), [(C[[k]], np.ones(1)) for k in range(3)], 1),
        c.meters(meters),
        c.smallest_undetectable(meters, 2),
        c.observer_table(A, C, np.full((2, 3), 0.1), np.eye(2), noise, s=1, bw=0.1, start=1.0, T=5, lags=4),
    ]


GOOD_FILTERS: dict[str, dict[str, Any]] = {
    "saturation": {"threshold": 1.0, "attacked": 1},
    "scalar_gain": {},
    "rdkf": {},
    "lfre": {"faulty": 0},
    "dkf": {},
    "partial_sharing": {"gain": 0.1},
    "structural": {},
    "platoon": {
        "process_noise": 0.1,
        "measurement_noise": 0.1,
        "initial_error": 1.0,
        "reference": [0.0, 1.0],
        "gs": 1.0,
        "gv": 2.0,
    },
    "platoon_baseline": {"kind": "pwm", "reference": [0.0, 1.0], "gs": 1.0, "gv": 2.0},
}

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
