"""A string of vehicles: time per step of the closed loop (vehicles, sensors, observer, detector, controller)."""

import garrison as gr
import numpy as np
from timing import Rows, Tasks, cpu, interleaved, summary

STEPS = 20


def _string(vehicles: int) -> tuple[gr.Model, gr.Network, gr.Filter, np.ndarray]:
    """Model, network, filter and starting states."""
    filter = gr.filters.Platoon(
        threshold=200.0,
        attacked=3,
        process_noise=0.1,
        measurement_noise=0.1,
        initial_error=300.0,
        reference=[0.0, 10.0],
        gs=50.0,
        gv=50.0,
    )
    start = np.column_stack([-20.0 * np.arange(vehicles), np.full(vehicles, 10.0)])
    return gr.platoon.model(vehicles, 0.01), gr.Network.band(vehicles, 3), filter, start


def _steps(vehicles: int, attacked: bool) -> float:
    """Processor seconds per step on one thread, after the start."""
    model, net, filter, start = _string(vehicles)
    middle = vehicles // 2
    attack = gr.attacks.Random(agents=[middle, middle + 1, middle + 5], law="normal", size=1e3) if attacked else ()

    def run(steps: int, seed: int = 0) -> float:
        return cpu(
            lambda: gr.simulate(
                model,
                net,
                filter,
                steps=steps,
                start=start,
                attack=attack,
                keep=(),
                threads=1,
                seed=seed,
                conditions=False,
            )
        )

    return (run(STEPS + 1) - run(1)) / STEPS


def _check(vehicles: int) -> None:
    """The detector finds the attackers and every bound holds before anything is timed."""
    model, net, filter, start = _string(vehicles)
    attack = gr.attacks.Random(agents=[5, 6, 9], law="normal", size=1e3)
    run = gr.simulate(model, net, filter, steps=12, start=start, attack=attack, keep=["report"])
    assert run.error is not None and run.bound is not None
    assert (run.error <= run.bound).all() and set(run.first_accused()) == {5, 6, 9}


def growth(attacked: bool, repeats: int) -> Rows:
    _check(100)
    sizes = (1_000, 10_000, 100_000)
    rows = {f"N = {n:,}, L = 3, per 1000 vehicles": lambda n=n: _steps(n, attacked) * 1000 / n for n in sizes}
    return summary(interleaved(rows, repeats), next(iter(rows)))


def tasks(repeats: int) -> Tasks:
    return {
        "platoon, time per step and its growth": lambda: growth(False, repeats),
        "platoon under attack": lambda: growth(True, repeats),
    }
