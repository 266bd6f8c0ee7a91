"""Where a refusal, or a condition that is not met, says what to do, doing it helps or ends in another true refusal."""

import re
from collections.abc import Callable
from typing import Any

import garrison as gr
import numpy as np
import pytest
from garrison import certificate, saturation, structure

A, NOISE = [[0.9, 0.1], [0.0, 0.8]], {"process_bound": 0.1, "measurement_bound": 0.1}
GAUSS = {"process_covariance": 0.1, "measurement_covariance": 0.2}
ROWS = [[[1, 0]], [[0, 1]], [[1, 0]], [[0, 1]]]
NET, RING = gr.Network.complete(4), gr.Network.ring(4)
BOUNDED = {"threshold": 5.0, "attacked": 1, "initial_error": 9.0, "rounds": 8}


def plant(C: Any = ROWS, **more: Any) -> gr.Model:
    return gr.Model(A, C, **(NOISE | GAUSS | more))


def run(model: gr.Model | None = None, net: gr.Network = NET, filter: gr.Filter | None = None, **more: Any) -> gr.Run:
    return gr.simulate(model or plant(), net, filter or gr.filters.ScalarGain(), **({"steps": 5} | more))


def sat(**more: Any) -> gr.Filter:
    return gr.filters.Saturation(**(BOUNDED | more))


def two_rows() -> list[Any]:
    return [[[1, 0], [0, 1]], *ROWS[1:]]


def split(filter: gr.Filter) -> gr.Run:
    model, net, _ = gr.split_outputs(plant(two_rows()), NET)
    return run(model, net, filter)


def unit_rows() -> gr.Model:
    found = saturation.normalise_rows([[2.0, 0], [0, 1], [1, 0], [0, 1]], [0.1] * 4)
    return plant([[row] for row in np.asarray(found["C"])], measurement_bound=np.asarray(found["b_v"]).tolist())


INDEFINITE, LOPSIDED = [[1.0, 0.0], [0.0, -1.0]], np.array([[1.0, 0.3], [0.1, 1.0]])
WINDOW = np.zeros((5, 4))


@pytest.mark.parametrize(
    ("wrong", "advice", "remedied"),
    [
        # sensors
        (lambda: run(plant([[[1, 0]], [[0, 0]], *ROWS[2:]]), filter=sat()), "take its row away (C[1] = []",
         lambda: run(plant([[[1, 0]], [], *ROWS[2:]]), filter=sat())),
        (lambda: run(plant([[[2.0, 0]], *ROWS[1:]]), filter=sat()), "divide the row, its measurements and",
         lambda: run(unit_rows(), filter=sat())),
        (lambda: run(plant(two_rows()), filter=sat()), "split_outputs", lambda: split(sat())),
        (lambda: run(plant(two_rows()), filter=gr.filters.Structural()), "split_outputs",
         lambda: split(gr.filters.Structural())),
        (lambda: saturation.normalise_rows([[1.0, 0], [0, 0]], [0.1, 0.1]), "leave this sensor out",
         lambda: saturation.normalise_rows([[1.0, 0]], [0.1])),
        # noise and matrices
        (lambda: plant(process_covariance=LOPSIDED), "use (M + M') / 2",
         lambda: plant(process_covariance=(LOPSIDED + LOPSIDED.T) / 2)),
        (lambda: plant(process_bound=float("inf")), "leave it out when it is not known",
         lambda: gr.Model(A, ROWS, measurement_bound=0.1)),
        (lambda: run(gr.Model(A, ROWS, **GAUSS), filter=sat()), "leave initial_error out to run without",
         lambda: run(gr.Model(A, ROWS, **GAUSS), filter=gr.filters.Saturation(threshold=5.0, attacked=1))),
        (lambda: run(gr.Model(A, ROWS, **NOISE), filter=gr.filters.Structural()), "or give the gains with",
         lambda: run(filter=gr.filters.Structural())),
        (lambda: run(gr.Model(A, ROWS), filter=gr.filters.PartialSharing(gain=0.01)), "gains follow from it",
         lambda: run(filter=gr.filters.PartialSharing(gain=0.01))),
        (lambda: run(plant(measurement_covariance=0.0), filter=gr.filters.PartialSharing(gain=0.01)),
         "give it a small variance",
         lambda: run(plant(measurement_covariance=1e-6), filter=gr.filters.PartialSharing(gain=0.01))),
        (lambda: run(plant(measurement_covariance=0.0), filter=gr.filters.Rdkf()), "add a small multiple of the",
         lambda: run(plant(measurement_covariance=1e-9), filter=gr.filters.Rdkf())),
        (lambda: run(gr.Model(A, ROWS, **GAUSS), noise="uniform"), "give both bounds", lambda: run(noise="uniform")),
        (lambda: run(gr.Model(A, ROWS, **NOISE), noise="normal"), "give process and measurement covariance",
         lambda: run(noise="normal")),
        # networks
        (lambda: run(net=gr.Network([(0, 1), (1, 2), (2, 3), (3, 0)], directed=True), filter=sat()), "undirected",
         lambda: run(net=RING, filter=sat())),
        (lambda: gr.Network([[1, 0], [0, 1]]), "Network.from_adjacency(matrix), or tuples",
         lambda: gr.Network.from_adjacency([[0, 1], [1, 0]])),
        (lambda: gr.Network.from_adjacency([[0, 1], [0, 0]]), "directed=True makes a directed network",
         lambda: gr.Network.from_adjacency([[0, 1], [0, 0]], directed=True)),
        (lambda: gr.Network.from_adjacency([[0, 0.5], [0.5, 0]]), "pass matrix != 0",
         lambda: gr.Network.from_adjacency(np.array([[0, 0.5], [0.5, 0]]) != 0)),
        # parameters
        (lambda: run(filter=gr.filters.Saturation(attacked=1)), "or set adaptive = true",
         lambda: run(filter=gr.filters.Saturation(attacked=1, adaptive=True, initial_error=9.0))),
        (lambda: run(filter=sat(recovery=True)), "set table = true",
         lambda: run(filter=sat(recovery=True, table=True))),
        (lambda: run(filter=sat(failure=1e-6, horizon=20)), "set table = true",
         lambda: run(filter=sat(failure=1e-6, table=True, horizon=20))),
        (lambda: run(filter=sat(accuse_missing=True)), "give detector = true too",
         lambda: run(filter=sat(accuse_missing=True, detector=True))),
        (lambda: run(filter=sat(step=10.0)), "leave it out for the best one", lambda: run(filter=sat())),
        (lambda: run(filter=sat(), start=np.arange(8.0).reshape(4, 2)), "leave initial_error out to run without",
         lambda: run(filter=gr.filters.Saturation(threshold=5.0), start=np.arange(8.0).reshape(4, 2))),
        (lambda: run(filter=gr.filters.Structural(test="residual", isolate=True)), "innovation",
         lambda: run(filter=gr.filters.Structural(test="innovation", isolate=True))),
        # certificates
        (lambda: run(gr.Model(A, ROWS, **GAUSS), certificate="local", failure=0.0, attacked=1), "take failure > 0",
         lambda: run(gr.Model(A, ROWS, **GAUSS), certificate="local", failure=1e-6, attacked=1)),
        (lambda: run(gr.Model(A, ROWS, **NOISE), certificate="local", failure=1e-6, attacked=1), "or take failure = 0",
         lambda: run(gr.Model(A, ROWS, **NOISE), certificate="local", failure=0.0, attacked=1)),
        (lambda: run(certificate="local", failure=0.0, attacked=1, memory=True), "failure",
         lambda: run(certificate="local", failure=1e-6, attacked=1, memory=True)),
        (lambda: certificate.empirical_quantile(np.arange(9.0), 0.0), "in (0, 1)",
         lambda: certificate.empirical_quantile(np.arange(9.0), 0.5)),
        # drivers
        (lambda: run(attack=gr.attacks.Bias([4], value=1.0)), "agents are numbered from 0",
         lambda: run(attack=gr.attacks.Bias([3], value=1.0))),
        (lambda: run(inputs=np.zeros((5, 1))), "give the model B, one column per input",
         lambda: run(plant(B=[[1.0], [0.0]]), inputs=np.zeros((5, 1)))),
        (lambda: gr.replay(plant(), NET, sat(), measurements=WINDOW[:, :3]), "one column per row of the C_i",
         lambda: gr.replay(plant(), NET, sat(), measurements=WINDOW)),
        (lambda: run(gr.Model([[1.1, 0], [0, 1]], [[0, 1]] * 4, **GAUSS), filter=gr.filters.Rdkf()),
         "add a sensor for that mode",
         lambda: run(gr.Model([[1.1, 0], [0, 1]], [[0, 1]] * 3 + [[1, 1]], **GAUSS), filter=gr.filters.Rdkf())),
        (lambda: run(gr.Model([[1.1, 0], [0, 1]], [[0, 1]] * 4, **GAUSS), filter=gr.filters.Structural()),
         "add a sensor on the state that it moves",
         lambda: run(gr.Model([[1.1, 0], [0, 1]], [[0, 1]] * 3 + [[1, 0]], **GAUSS), filter=gr.filters.Structural())),
        (lambda: run(plant([[[0, 1]]] * 4), filter=gr.filters.Lfre()), "use the saturation filter here",
         lambda: run(plant([[[1, 0]]] * 4), filter=sat())),
        (lambda: structure.visibility(A, [[1, 0, 0]]), "as many as A", lambda: structure.visibility(A, [[1, 0]])),
    ],
)  # fmt: skip
def test_what_a_refusal_advises_helps(wrong: Callable[[], Any], advice: str, remedied: Callable[[], Any]) -> None:
    with pytest.raises(gr.Error, match=re.escape(advice)):
        wrong()
    remedied()


#: "raise rounds to 7", "lower initial_error to 2.5, or ..", "threshold 3 with initial_error 2", ..
_SET = re.compile(r"(?:raise|lower) (\w+)(?: \(\w+\))? to ([0-9.e+-]*[0-9])")
_BOTH = re.compile(r"threshold ([0-9.e+-]+) with initial_error ([0-9.e+-]+)")
_FROM = re.compile(r"choose a threshold from ([0-9.e+-]+) to")


def advised(failed: list[dict[str, Any]], given: dict[str, Any]) -> dict[str, Any] | None:
    """Parameters that the meanings of failed conditions name; None where they name none."""
    for words in (c["meaning"] for c in failed):
        if both := _BOTH.search(words):
            return {"threshold": float(both[1]), "initial_error": float(both[2])}
        if one := _FROM.search(words):
            return {"threshold": float(one[1])}
        if one := _SET.search(words):
            return {name: type(given[name])(float(value)) for name, value in _SET.findall(words)}
        if "more rounds" in words:
            return {"rounds": 2 * given["rounds"]}
    return None


def follow(check: Callable[[dict[str, Any]], gr.Check], given: dict[str, Any]) -> int | None:
    """Steps of advice until all required conditions are met; None where there is no advice any more."""
    for steps in range(12):
        try:
            found = check(given).failed
        except gr.DesignInfeasible as refused:
            found = [{"meaning": str(refused)}]
        if not found:
            return steps
        more = advised(found, given)
        if more is None:
            return None
        assert any(given[k] != v for k, v in more.items()), (given, found)
        given = given | more
    raise AssertionError(f"the advice does not end: {given}")


@pytest.mark.parametrize("kind", [{}, {"detector": True}, {"chebyshev": True}])
def test_numbers_that_conditions_of_saturation_advise(kind: dict[str, Any]) -> None:
    steps = []
    for seed in range(80):
        rng = np.random.default_rng(seed)
        n, N = int(rng.integers(1, 4)), int(rng.integers(3, 9))
        A = rng.normal(size=(n, n))
        rows = [c / np.linalg.norm(c) for c in rng.normal(size=(N, 1, n))]
        noise = 10 ** rng.uniform(-4, 0, size=2)
        model = gr.Model(
            rng.uniform(0.3, 1.15) / np.linalg.norm(A, 2) * A, rows, process_bound=noise[0], measurement_bound=noise[1]
        )
        net = gr.Network.complete(N) if rng.uniform() < 0.5 else gr.Network.ring(N)
        given: dict[str, Any] = {"rounds": int(rng.integers(1, 6)), "attacked": int(rng.integers(0, 3))}
        given |= {"threshold": float(10 ** rng.uniform(-2, 1)), "initial_error": float(10 ** rng.uniform(-2, 1))}

        def check(p: dict[str, Any], model: gr.Model = model, net: gr.Network = net) -> gr.Check:
            return gr.check(model, net, gr.filters.Saturation(**p, **kind))

        steps.append(follow(check, given))
    helped = [s for s in steps if s]
    assert len(helped) > 20 and steps.count(None) < 20


def test_numbers_that_conditions_of_platoon_advise() -> None:
    steps = []
    for seed in range(40):
        rng = np.random.default_rng(seed)
        L = int(rng.integers(1, 4))
        N = int(rng.integers(2 * L + 1, 10))
        given = {"attacked": int(rng.integers(1, max(2, L))), "initial_error": float(10 ** rng.uniform(-1, 2))}
        noise = {"process_noise": 10 ** rng.uniform(-3, -1), "measurement_noise": 10 ** rng.uniform(-2, 0)}
        control = {"reference": [200.0, 10.0], "gs": 50.0, "gv": 50.0}

        def check(p: dict[str, Any], N: int = N, L: int = L, rest: dict[str, Any] = noise | control) -> gr.Check:
            return gr.check(gr.platoon.model(N, 0.01), gr.Network.band(N, L), gr.filters.Platoon(**p, **rest))

        steps.append(follow(check, given))
    assert len([s for s in steps if s]) > 3


def in_units(states: list[float], outputs: list[float]) -> gr.Model:
    """The same plant in other units."""
    T, inverse = np.diag(states), np.diag(1.0 / np.array(states))
    return gr.Model(
        T @ A @ inverse,
        [s * np.array(c) @ inverse for s, c in zip(outputs, ROWS, strict=True)],
        process_covariance=0.1 * T @ T,
        measurement_covariance=[[[0.2 * s * s]] for s in outputs],
    )


def test_units_of_models() -> None:
    """Estimates are those in other units; where a filter depends on units, it says what to change."""
    y = np.random.default_rng(0).normal(size=(30, 4))
    plain, far, odd = in_units([1, 1], [1] * 4), in_units([1e-9, 1e9], [1] * 4), in_units([1, 1], [1e-9, 1, 1e9, 1])
    for filter in (gr.filters.Dkf(), gr.filters.Rdkf()):
        expected = gr.replay(plain, NET, filter, measurements=y).estimate
        scaled = gr.replay(far, NET, filter, measurements=y).estimate
        weighed = gr.replay(odd, NET, filter, measurements=y * [1e-9, 1, 1e9, 1]).estimate
        assert expected is not None and scaled is not None and weighed is not None
        assert np.allclose(scaled / [1e-9, 1e9], expected, rtol=1e-9, atol=1e-12)
        assert np.allclose(weighed, expected, rtol=1e-9, atol=1e-12)
    structural = gr.filters.Structural()
    with pytest.raises(gr.DesignInfeasible, match="bring them to comparable units"):
        gr.prepare(far, NET, structural)
    run = gr.replay(odd, NET, structural, measurements=y * [1e-9, 1, 1e9, 1])
    assert any("by the noise's standard deviation" in w for w in run.warnings)
    again = gr.replay(in_units([1, 1], [0.2**-0.5] * 4), NET, structural, measurements=y * 0.2**-0.5)
    assert not any("standard deviation" in w for w in again.warnings)
