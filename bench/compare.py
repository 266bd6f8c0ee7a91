"""This build against another one, interleaved: `python bench/compare.py OTHER [--repeats 9]`.

OTHER is a folder that holds an installed garrison (`pip install --target OTHER` of an earlier commit). Each build runs
in a process of its own; they take turns, A B A B, so that a machine whose speed drifts slows both. Prints processor
time of this build (median), and the median of the pairwise ratios this / other with its spread.
"""

import argparse
import inspect
import json
import os
import subprocess
import sys
import time
from collections.abc import Callable
from typing import Any

import numpy as np


def tasks(gr: Any) -> dict[str, Callable[[], Any]]:
    """Name -> one run of a family; networks and plants as its users have them."""
    rng = np.random.default_rng(1)
    net = gr.Network.random_geometric(1000, 0.06, 1)
    n = 4
    A = np.eye(n) * 0.98 + 0.01 * rng.normal(size=(n, n))
    rows = rng.normal(size=(1000, 1, n))
    rows /= np.linalg.norm(rows, axis=2, keepdims=True)
    model = gr.Model(
        A,
        list(rows),
        process_bound=0.02,
        measurement_bound=0.01,
        process_covariance=0.04 * np.eye(n),
        measurement_covariance=[np.eye(1) * 0.1] * 1000,
    )
    small = gr.Model(
        A,
        list(rows[:20]),
        process_bound=0.02,
        measurement_bound=0.01,
        process_covariance=0.04 * np.eye(n),
        measurement_covariance=[np.eye(1) * 0.1] * 20,
    )
    few = gr.Network.random_geometric(20, 0.5, 1)
    f = gr.filters
    detector = f.Saturation(threshold=0.5, rounds=30, attacked=2, initial_error=2.0, detector=True)
    vehicles = gr.platoon.model(200, 0.01)
    string = gr.Network.band(200, 3)
    platoon = f.Platoon(
        threshold=200.0,
        attacked=2,
        process_noise=0.1,
        measurement_noise=0.1,
        initial_error=4000.0,
        reference=[200.0, 10.0],
        gs=50.0,
        gv=50.0,
    )

    def run(model: Any, net: Any, filt: Any, steps: int, **more: Any) -> Callable[[], Any]:
        if "conditions" in inspect.signature(gr.simulate).parameters:
            more["conditions"] = False
        keep = more.pop("keep", ["estimate", "report"])
        return lambda: gr.simulate(model, net, filt, steps=steps, keep=keep, threads=1, seed=2, **more)

    lossy = {"drop": 0.1}
    return {
        "saturation, N = 1000": run(model, net, f.Saturation(threshold=0.5, rounds=3), 300),
        "saturation, N = 1000, 10 % lost": run(model, net, f.Saturation(threshold=0.5, rounds=3), 60, link=lossy),
        "saturation, detector, N = 20": run(small, few, detector, 6000),
        "saturation, 64 trials side by side": run(
            small, few, f.Saturation(threshold=0.5, rounds=3), 1600, trials=64, keep=["estimate"]
        ),
        "scalar_gain, N = 1000": run(model, net, f.ScalarGain(rounds=3), 300),
        "rdkf, N = 20": run(small, few, f.Rdkf(weight=0.5), 9000),
        "dkf, N = 20": run(small, few, f.Dkf(), 9000),
        "structural, N = 20": run(small, few, f.Structural(), 12000),
        "structural, N = 20, 10 % lost": run(small, few, f.Structural(), 8000, link=lossy),
        "partial_sharing, N = 1000, frozen": run(model, net, f.PartialSharing(gain=0.05, shared=2), 400),
        "partial_sharing, N = 1000, varying": run(
            model, net, f.PartialSharing(gain=0.05, shared=2, gains="varying"), 200
        ),
        "partial_sharing, N = 1000, 10 % lost": run(model, net, f.PartialSharing(gain=0.05, shared=2), 100, link=lossy),
        "lfre, N = 20, poles given": run(small, few, f.Lfre(poles=[0.3, 0.4, 0.5, 0.6]), 60000),
        "platoon, N = 200": run(vehicles, string, platoon, 300),
    }


def serve() -> None:
    """Run the task that each line of standard input names; answer with its processor seconds."""
    import garrison as gr

    known: dict[str, Callable[[], Any]] = tasks(gr)
    print(json.dumps(list(known)), flush=True)
    for line in sys.stdin:
        run = known[line.strip()]
        start = time.process_time()
        run()
        print(time.process_time() - start, flush=True)


class Build:
    """A process with one build."""

    def __init__(self, site: str | None) -> None:
        environment = os.environ | ({"PYTHONPATH": site} if site else {})
        command = [sys.executable, __file__, "--serve"]
        self.process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, env=environment
        )
        self.names: list[str] = json.loads(self._read())

    def _read(self) -> str:
        assert self.process.stdout is not None
        line = self.process.stdout.readline()
        if not line:
            raise SystemExit("compare: a build has ended, see above")
        return line

    def seconds(self, name: str) -> float:
        """Processor time of one run."""
        assert self.process.stdin is not None
        self.process.stdin.write(f"{name}\n")
        self.process.stdin.flush()
        return float(self._read())


def main() -> None:
    """Compare."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("other", help="folder with another installed garrison")
    parser.add_argument("--repeats", type=int, default=9)
    parser.add_argument("--only", default="", help="rows whose name contains this")
    args = parser.parse_args()
    this, other = Build(None), Build(args.other)
    print(f"{'row':40} {'ms':>9} {'this / other':>13}   spread")
    for name in this.names:
        if args.only not in name:
            continue
        pairs = []
        for k in range(args.repeats + 1):
            pair = (this.seconds(name), other.seconds(name))
            if k > 0:  # the first one warms up
                pairs.append(pair)
        ratios = np.array([a / b for a, b in pairs])
        ms = 1e3 * float(np.median([a for a, _ in pairs]))
        low, high = np.quantile(ratios, [0.25, 0.75])
        print(f"{name:40} {ms:9.2f} {np.median(ratios):13.3f}   {low:.3f} .. {high:.3f}", flush=True)


if __name__ == "__main__":
    serve() if "--serve" in sys.argv else main()
