"""What certificates with memory say against their own assumptions, in runs, replays and gr.certify."""

from typing import Any

import garrison as gr
import numpy as np
import pytest

Array = np.ndarray
WANTED: dict[str, Any] = {"certificate": "direct", "attacked": 1, "memory": True}
DEPENDENT = "depend on those before them"
APART = "have no point in common"


def plant(process: float, agents: int = 5, **more: Any) -> gr.Model:
    """A slow state that every agent measures with deviation 1."""
    return gr.Model([[0.98]], [[[1.0]]] * agents, process_covariance=process, measurement_covariance=1.0, **more)


def coloured(rng: np.random.Generator, shape: tuple[int, int], correlation: float) -> Array:
    """Noise of variance 1 whose neighbours in time have this correlation."""
    fresh = rng.normal(size=shape)
    noise = fresh.copy()
    for t in range(1, len(noise)):
        noise[t] = correlation * noise[t - 1] + np.sqrt(1 - correlation**2) * fresh[t]
    return noise


def states(rng: np.random.Generator, samples: int, process: float) -> Array:
    x = np.zeros((samples, 1))
    for t in range(1, samples):
        x[t] = 0.98 * x[t - 1] + np.sqrt(process) * rng.normal()
    return x


def replayed(model: gr.Model, measurements: Array, **more: Any) -> gr.Run:
    network = gr.Network.complete(model.agents)
    wanted = WANTED | more
    return gr.replay(model, network, gr.filters.Lfre(), measurements=measurements, conditions=False, **wanted)


def told(lines: list[str], words: str) -> list[str]:
    return [line for line in lines if words in line]


def test_noise_with_a_correlation_of_one_half_is_told_with_names_and_figures() -> None:
    rng = np.random.default_rng(1)
    model = plant(1e-4, sources=[f"gauge {i}" for i in range(5)])
    for _ in range(5):
        y = states(rng, 300, 1e-4) + coloured(rng, (300, 5), 0.5)
        (line,) = told(replayed(model, y).warnings, DEPENDENT)
        assert "(agent " in line and "source gauge " in line and "correlation 0." in line and "pairs" in line
        certified = gr.certify(model, y, attacked=1)
        (line,) = told(certified.warnings, DEPENDENT)
        assert "(source gauge " in line
        assert f"warning: {line}" in str(certified)


def test_one_run_is_told_among_many_and_by_the_name_of_the_agent() -> None:
    rng = np.random.default_rng(2)
    logs = np.stack([states(rng, 300, 1e-4) + rng.normal(size=(300, 5)) for _ in range(4)])
    logs[2] = states(rng, 300, 1e-4) + coloured(rng, (300, 5), 0.5)
    names = ["north", "south", "east", "west", "centre"]
    network = gr.Network([(i, j) for i in range(5) for j in range(i)], names=names)
    run = gr.replay(plant(1e-4), network, gr.filters.Lfre(), measurements=logs, conditions=False, **WANTED)
    (line,) = told(run.warnings, DEPENDENT)
    assert "trial 2" in line and any(f"({name}, " in line for name in names)


def test_white_noise_raises_no_doubt_whatever_is_lost_and_whoever_lies() -> None:
    rng = np.random.default_rng(3)
    for k in range(40):
        n, agents = int(rng.integers(1, 4)), int(rng.integers(4, 7))
        root = 0.2 * rng.normal(size=(n, n))
        model = gr.Model(
            np.linalg.qr(rng.normal(size=(n, n)))[0] * rng.uniform(0.8, 1.02),
            rng.normal(size=(agents, n)),
            process_covariance=root @ root.T + 1e-6 * np.eye(n),
            measurement_covariance=float(10 ** rng.uniform(-1, 1)),
        )
        liar = int(rng.integers(agents))
        lie = [
            gr.attacks.Bias(agents=[liar], value=2.0, start=20),
            gr.attacks.Ramp(agents=[liar], slope=0.05, start=10),
            gr.attacks.Autoregressive(agents=[liar], size=1.0, start=10),
        ][k % 3]
        run = gr.simulate(
            model,
            gr.Network.complete(agents),
            gr.filters.Lfre(),
            steps=150,
            attack=lie,
            noise="normal",
            seed=k,
            conditions=False,
            link={"drop": 0.2},
            **(WANTED | {"certificate": ("local", "direct", "flooded")[k % 3]}),
        )
        y = np.where(rng.uniform(size=run.measurements[0].shape) < 0.1, np.nan, run.measurements[0])
        certified = gr.certify(model, y, attacked=1, method=("bank", "window")[k % 2], window=6)
        for lines in (run.warnings, certified.warnings):
            assert not told(lines, DEPENDENT) + told(lines, APART) + told(lines, "memory"), lines
        assert not certified.refuted.any()


@pytest.mark.parametrize(("agents", "attacked"), [(5, 1), (18, 5)])  # all sets of liars, and too many of them
def test_windows_tell_noise_that_remembers_its_past_too(agents: int, attacked: int) -> None:
    rng = np.random.default_rng(7)
    model = plant(1e-4, agents=agents)
    for correlation in (0.5, 0.0):
        y = states(rng, 300, 1e-4) + coloured(rng, (300, agents), correlation)
        y[:, : attacked - 1] = states(rng, 300, 0.0) + coloured(rng, (300, attacked - 1), 0.9)  # a lie, of fewer
        found = gr.certify(model, y, attacked=attacked, method="window", window=5)
        if correlation == 0:
            assert not found.warnings
        else:
            (line,) = found.warnings
            assert DEPENDENT in line and "(source agent " in line and "over 29" in line


def test_liars_that_move_leave_no_honest_past_to_compare_with() -> None:
    rng = np.random.default_rng(8)
    y = states(rng, 100, 1e-4) + coloured(rng, (100, 5), 0.9)
    assert not gr.certify(plant(1e-4), y, attacked=1, moving=True, window=5).warnings
    assert gr.certify(plant(1e-4), y, attacked=0, moving=True, window=5).warnings  # without liars there is one


def test_a_window_apart_from_its_sample_is_told_and_gives_no_region() -> None:
    rng = np.random.default_rng(9)
    y = 0.2 * np.arange(60.0)[:, None] + 0.01 * rng.normal(size=(60, 12))  # no process noise of deviation 0.001 does so
    found = gr.certify(plant(1e-6, agents=12), y, attacked=1, moving=True, window=40)
    (line,) = told(found.warnings, APART)
    at = int(line.split("first in sample ")[1].split()[0])
    assert found.answered[at - 1] and found.refuted[at] and np.isnan(found.box[at]).all()


def test_noise_of_one_source_alone_may_be_a_lie() -> None:
    rng = np.random.default_rng(4)
    y = states(rng, 400, 1e-4) + rng.normal(size=(400, 5))
    y[:, 2] = states(rng, 400, 0.0)[:, 0] + coloured(rng, (400, 1), 0.6)[:, 0]
    assert not told(replayed(plant(1e-4), y).warnings, DEPENDENT)
    (line,) = told(replayed(plant(1e-4), y, attacked=0).warnings, DEPENDENT)
    assert "source agent 2" in line


def test_process_noise_ten_times_as_large_as_modelled_puts_memory_and_sample_apart() -> None:
    rng = np.random.default_rng(5)
    found = 0
    for _ in range(6):
        y = states(rng, 150, 1.0) + rng.normal(size=(150, 12))
        run = replayed(plant(0.01, agents=12), y)
        certified = gr.certify(plant(0.01, agents=12), y, attacked=1)
        lines = [told(one.warnings, APART) for one in (run, certified)]
        found += sum(map(len, lines))
        assert all("x1)" in line for some in lines for line in some)
        doubts = [told(run.warnings, words) for words in (APART, DEPENDENT, "assumes, first at sample")]
        assert any(doubts) and certified.warnings + certified.refuted.nonzero()[0].tolist()
    assert found >= 6


@pytest.mark.parametrize("attack", [None, gr.attacks.Forge(agents=[1], offset=50.0)])
def test_agents_that_lie_to_others_are_not_taken_for_noise(attack: Any) -> None:
    run = gr.simulate(
        plant(1e-2),
        gr.Network.complete(5),
        gr.filters.Lfre(),
        steps=200,
        seed=6,
        noise="normal",
        attack=[attack] if attack else [],
        conditions=False,
        **(WANTED | {"certificate": "flooded"}),
    )
    assert not told(run.warnings, "memory")
