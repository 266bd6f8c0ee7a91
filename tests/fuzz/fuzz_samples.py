"""Good objects of every class of garrison."""

from __future__ import annotations

import functools
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


@functools.cache  # made once, before the batches fork: most of the time went into making them anew
def samples() -> dict[str, list[Any]]:
    """Good objects by the name of their class, and one of another size of each where there is."""
    model, network = _model(), gr.Network.ring(3)
    other, cut = _model(5), gr.Network([(0, 1)], agents=5)
    names = [info["name"] for info in _core.filter_infos()]
    assert set(GOOD_FILTERS) <= set(names), "GOOD_FILTERS: an entry of a family that does not exist"
    filters = [gr.filters.make_filter(name, GOOD_FILTERS.get(name, {})) for name in names]
    shared = next(f for f in filters if f.name == "partial_sharing")
    analysis = gr.partial_sharing.Analysis(model, network, shared)
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
            gr.structural.setting(model, network, structural),
            gr.structural.Setting(A=np.eye(2), C=np.eye(2), W=np.eye(2), U=np.eye(2)),
        ],
        "platoon.Setting": [
            gr.platoon.Setting(vehicles=6, range=2, period=0.1, attacked=1, eps=0.1, mu=0.1, q=1.0, beta=2.0)
        ],
        "weights": [weights],
        "AgentInfo": [_agent_info(model, network)],
        "VaryingModel": [
            gr.VaryingModel(model, A=np.repeat(np.asarray(model.A)[None], 3, axis=0)),
            gr.VaryingModel(model, measurement_covariance=np.ones((3, model.outputs))),
        ],
        "StaticPlant": [gr.StaticPlant.of(np.eye(3)[[0, 1, 2, 0]])],
        "NonlinearModel": [
            gr.NonlinearModel(lambda X, u, t: 0.9 * X, lambda X, t: X[:, 0], states=2, outputs=[1] * model.agents),
            gr.NonlinearModel(
                lambda X, u, t: 0.9 * X, np.ones((model.agents, 2)), states=2, outputs=[1] * model.agents
            ),
        ],
        "VaryingNetwork": [gr.VaryingNetwork([network] * 3)],
        "Response": [_core.Response(gr.Model([[0.5]], [[1.0]], B=[[1.0]]))],
        "Autoregression": [_core.autoregress(wind, np.zeros((900, 0)), order=1)],
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
        c.sparse_meters((2, 2), [0, 1], [0, 1], np.ones(2)),
        c.observer_table(A, C, np.full((2, 3), 0.1), np.eye(2), noise, s=1, bw=0.1, start=1.0, T=5, lags=4),
    ]


#: parameters of families that have some without a default; the others run as they come
GOOD_FILTERS: dict[str, dict[str, Any]] = {
    "saturation": {"threshold": 1.0, "attacked": 1},
    "lfre": {"faulty": 0},
    "partial_sharing": {"gain": 0.1},
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
