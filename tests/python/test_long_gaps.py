"""After a gap of all sensors `structural` tests against a bound: rarely false, and a lie beyond it is found."""

import garrison as gr
import numpy as np
import pytest

ASKED, TRIALS, FIRST = 0.01, 10, 150


def systems(seed: int, count: int) -> list[tuple[gr.Model, gr.Network, int]]:
    """Random plants with random sensors, and how long all of them are silent."""
    rng = np.random.default_rng(seed)
    found = []
    for _ in range(count):
        n, agents = int(rng.integers(1, 5)), int(rng.integers(3, 7))
        A = np.linalg.qr(rng.normal(size=(n, n)))[0] * rng.uniform(0.98, 1.04)
        rows = [rng.normal(size=(1, n)) for _ in range(agents)]
        noise = {"process_covariance": 0.1 * np.eye(n), "measurement_covariance": [0.5 * np.eye(1)] * agents}
        found.append((gr.Model(A, rows, **noise), gr.Network.complete(agents), int(rng.integers(5, 150))))
    return found


def silent(y: np.ndarray, gap: int) -> np.ndarray:
    """`y` without what was measured during the gap."""
    y = y.copy()
    y[FIRST : FIRST + gap] = np.nan
    return y


@pytest.mark.parametrize("isolate", [False, True])
def test_alarms_after_a_gap_are_no_more_frequent_than_asked(isolate: bool) -> None:
    tests = alarms = untold = 0
    for k, (model, network, gap) in enumerate(systems(5, 30)):
        f = gr.filters.Structural(false_alarm=ASKED, test="innovation", isolate=isolate)
        made = gr.simulate(model, network, f, steps=FIRST + gap + 30, trials=TRIALS, seed=k, keep=["measurements"])
        for y in np.asarray(made.measurements):
            run = gr.replay(model, network, f, measurements=silent(y, gap))
            after = slice(FIRST + gap + 1, None)
            statistic, threshold = run.statistic[0, after], run.threshold[0, after]
            tests += int(np.isfinite(threshold).sum())
            alarms += int((statistic >= threshold).sum())
            untold += int((np.isfinite(threshold) & (run.verdict[0, after] == gr.Verdict.NOT_TESTED)).sum())
    assert untold > 100  # some of the tests were such that only an alarm would have told something
    assert alarms / tests < 1.2 * ASKED  # sensors share their errors: more than independent tests would scatter


def test_a_lie_beyond_what_the_gap_allows_is_an_alarm_at_once() -> None:
    found = 0
    for k, (model, network, gap) in enumerate(systems(6, 30)):
        f = gr.filters.Structural(false_alarm=1e-4, test="innovation")
        y = np.asarray(
            gr.simulate(model, network, f, steps=FIRST + gap + 5, seed=k, keep=["measurements"]).measurements
        )[0]
        y = silent(y, gap)
        run = gr.replay(model, network, f, measurements=y)
        at = FIRST + gap + 1
        level = run.threshold[0, at, 0]
        y[at - 1, 0] += 3.0 * level
        lied = gr.replay(model, network, f, measurements=y)
        assert lied.verdict[0, at, 0] == gr.Verdict.ATTACKED
        found += int(run.verdict[0, at, 0] == gr.Verdict.NOT_TESTED)
    assert found > 5  # in so many of them the honest sample said nothing
