"""Nonlinear plants of which some outputs are linear: bounds on errors by the rows of one sample, and what has none."""

from typing import Any

import garrison as gr
import numpy as np
import pytest

NETWORK = gr.Network.complete(8)
#: four encoders, three gyroscopes and one range to an anchor, which is not linear
LINEAR = np.array([[1.0, 0.0]] * 4 + [[0.0, 1.0]] * 3 + [[np.nan, np.nan]])
ANCHOR = np.array([1.0, 0.0])
STEPS = 200


def pendulum(X: Any, u: Any, t: int) -> Any:
    angle, rate = X.T
    return np.stack([angle + 0.02 * rate, rate - 0.02 * 9.81 * np.sin(angle)], axis=1)


def seen(X: Any, t: int) -> Any:
    away = np.hypot(np.sin(X[7, 0]) - ANCHOR[0], -np.cos(X[7, 0]) - ANCHOR[1])
    return np.array([*X[:4, 0], *X[4:7, 1], away])


def swinging(h: Any = seen, linear: Any = LINEAR, **more: Any) -> gr.NonlinearModel:
    given: dict[str, Any] = {
        "states": ["angle", "rate"],
        "outputs": [1] * 8,
        "process_bound": 1e-3,
        "measurement_bound": 0.01,
        "process_covariance": 1e-6,
        "measurement_covariance": 1e-4,
    }
    return gr.NonlinearModel(pendulum, h, linear=linear, **(given | more))


LIE = gr.attacks.Bias(agents=[1], value=2.0, start=30)
SWING: dict[str, Any] = {"steps": STEPS, "x0": [0.8, 0.0], "start": [0.6, 0.0], "seed": 3, "attack": LIE}
FILTERS = [gr.filters.ScalarGain(rounds=3), gr.filters.Saturation(threshold=0.05, rounds=3)]


@pytest.mark.parametrize("filt", FILTERS)
@pytest.mark.parametrize("spread", ["local", "flooded", "direct"])
@pytest.mark.parametrize("failure", [0, 1e-6])
def test_errors_are_bounded_by_the_rows_that_are_linear(filt: Any, spread: str, failure: float) -> None:
    given = SWING | {"noise": "uniform" if failure == 0 else "normal", "trials": 4}
    run = gr.simulate(swinging(), NETWORK, filt, certificate=spread, failure=failure, attacked=1, **given)
    assert np.isfinite(run.bound[:, 1:]).all() and (run.error[:, 1:] <= run.bound[:, 1:]).all()
    assert set(np.unique(run.bound_kind[:, 1:])) <= {int(gr.BoundKind.WITNESS), int(gr.BoundKind.RELAYED)}
    if filt is FILTERS[1]:
        assert np.median(run.bound[:, 50:]) < 0.3
    # What is bounded does not depend on the filter's estimates being any good.
    bare = gr.simulate(swinging(), NETWORK, filt, **given)
    assert np.array_equal(bare.estimate, run.estimate) and np.isnan(bare.bound).all()


def test_the_bound_is_that_of_a_linear_plant_at_rest_with_the_same_measurements() -> None:
    """Sample by sample it rests on rows and measurements alone, whatever led there."""
    filt, plant = FILTERS[0], swinging()
    given: dict[str, Any] = {"certificate": "flooded", "failure": 1e-6, "attacked": 1}
    y = gr.simulate(plant, NETWORK, filt, **SWING).measurements[0, :40].copy()
    y[:, 7] = np.nan  # what is not linear would move estimates, but no region
    run = gr.replay(plant, NETWORK, filt, measurements=y, start=[0.6, 0.0], **given)
    still = gr.Model(np.eye(2), np.nan_to_num(LINEAR), measurement_covariance=1e-4)
    start = pendulum(run.estimate[0, 20], [], 20)
    witness = gr.replay(still, NETWORK, filt, measurements=y[20:21], start=start, **given)
    assert witness.bound_kind[0, 1, 0] == gr.BoundKind.WITNESS == run.bound_kind[0, 21, 0]
    assert np.allclose(run.estimate[0, 21], witness.estimate[0, 1], atol=1e-12)
    assert np.allclose(run.bound[0, 21], witness.bound[0, 1], atol=1e-12)


def test_nothing_is_carried_over_time() -> None:
    """Gyroscopes missing for a while: no bound then, though there was one before, because A is not known."""
    plant = swinging()
    run = gr.simulate(plant, NETWORK, FILTERS[0], **SWING)
    y = run.measurements[0].copy()
    y[100:110, 4:7] = np.nan
    log = gr.replay(
        plant, NETWORK, FILTERS[0], measurements=y, truth=run.truth[0], certificate="flooded", attacked=1,
        start=[0.6, 0.0],
    )  # fmt: skip
    gap = slice(101, 111)
    assert np.isinf(log.bound[0, gap]).all() and (log.bound_kind[0, gap] == gr.BoundKind.TOO_FEW).all()
    assert "linear outputs" in log.why_no_bound(0, 105)
    assert np.isfinite(log.bound[0, 99:101]).all() and np.isfinite(log.bound[0, 111:]).all()


def test_rows_alone_are_an_h() -> None:
    rows = np.nan_to_num(LINEAR, nan=0.5)
    functions = swinging(lambda X, t: (rows * X).sum(axis=1), None)
    alone = swinging(rows, None)
    assert alone == swinging(rows.copy(), None) and hash(alone) == hash(swinging(rows.copy(), None))
    assert alone.linear == list(range(8)) and np.array_equal(np.concatenate(alone.model.C), rows)
    for filt in FILTERS:
        one, two = (gr.simulate(p, NETWORK, filt, **SWING) for p in (functions, alone))
        assert np.allclose(one.estimate, two.estimate, atol=1e-8)
    f, h = alone.central
    assert np.allclose(h(np.array([1.0, 2.0]), 3), rows @ [1, 2]) and f(np.zeros(2), np.zeros(0), 0).shape == (2,)
    lists = [r[None] for r in LINEAR]
    assert swinging(linear=lists) == swinging() != swinging(linear=None)


def test_a_filter_of_ones_own_is_bounded_too() -> None:
    class Mean(gr.Filter):
        rounds = 1

        def sense(self, agent: Any, state: Any, y: Any, t: int) -> Any:
            C = agent.C
            return {"estimate": state.estimate + 0.5 * C.T @ np.nan_to_num(y - C @ state.estimate)}

        def fuse(self, agent: Any, state: Any, inbox: Any, round: int) -> Any:
            return {"estimate": np.mean([state.estimate, *(m["estimate"] for m in inbox.values())], axis=0)}

    run = gr.simulate(swinging(), NETWORK, Mean(), certificate="flooded", attacked=1, **SWING)
    assert np.isfinite(run.bound[0, 1:]).all() and (run.error[0, 1:] <= run.bound[0, 1:]).all()


def test_rows_that_h_contradicts_are_refused_in_the_run() -> None:
    wrong = LINEAR.copy()
    wrong[2] = [1.0, 0.1]
    with pytest.raises(gr.InvalidInput, match=r"linear: got output 2, of which h says .* and its row .*take it out"):
        gr.simulate(swinging(linear=wrong), NETWORK, FILTERS[0], **SWING)
    drifts = swinging(lambda X, t: seen(X, t) + 1e-3 * (t > 50))
    with pytest.raises(gr.InvalidInput, match=r"linear: got output 0.*at time 51"):
        gr.simulate(drifts, NETWORK, FILTERS[0], **SWING)


def test_what_rests_on_A_is_refused_by_name() -> None:
    plant = swinging()
    with pytest.raises(gr.InvalidInput, match="memory: got true with a plant by functions"):
        gr.simulate(plant, NETWORK, FILTERS[0], certificate="local", attacked=1, memory=True, **SWING)
    with pytest.raises(gr.InvalidInput, match="'local' with a NonlinearModel without linear outputs"):
        gr.simulate(swinging(linear=None), NETWORK, FILTERS[0], certificate="local", attacked=1, **SWING)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"linear": LINEAR[:7]}, r"linear: got \(7, 2\), expected \(8, 2\)"),
        ({"linear": [[1.0, 0.0, 0.0]] * 8}, r"linear\[0\]: got \(1, 3\), expected \(1, 2\)"),
        ({"linear": np.where(LINEAR > 0, np.nan, LINEAR)}, "partly nan"),
        ({"linear": np.where(LINEAR > 0, np.inf, LINEAR)}, "partly nan, or inf"),
        ({"h": LINEAR}, "rows beside rows as h"),
        ({"h": LINEAR, "linear": None}, "h: got rows of nan"),
        ({"h": None}, "h: got no value"),
    ],
)
def test_rows_that_do_not_fit_are_refused(given: dict[str, Any], words: str) -> None:
    with pytest.raises(gr.InvalidInput, match=words):
        swinging(**given)
