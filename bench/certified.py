"""What a certificate costs: a step of the network with and without it, in the engine and by agents of bytes."""

import garrison_bench as peers
from timing import Rows, Tasks, interleaved, summary

#: samples of one measurement
SAMPLES = 200


def cost(agents: int, rounds: int, repeats: int) -> Rows:
    """W2 (no subsets) and, where there are few sets, W3; n = 4.

    s = 3 where all is flooded; else 1, of which neighbours have enough rows for a bound.
    """
    kinds = {
        "none": ("none", 0, 0),
        "local, W2, s=1": ("local", 0, 1),
        "direct, W2, s=1": ("direct", 0, 1),
        "flooded, W2, s=3": ("flooded", 0, 3),
    }
    if agents <= 12:
        kinds["flooded, W3, s=3"] = ("flooded", 1000, 3)
    steps = {name: peers.CertifiedStep(agents, rounds, *kind) for name, kind in kinds.items()}
    rows = {f"engine, {name}": lambda s=s: s.engine(SAMPLES) for name, s in steps.items()}
    rows |= {f"agents of bytes, {name}": lambda s=s: s.agents(SAMPLES) for name, s in steps.items()}
    times = interleaved(rows, repeats)
    out: Rows = []
    for way in ("engine", "agents of bytes"):  # each beside its own step without a certificate
        out += summary({k: v for k, v in times.items() if k.startswith(way)}, f"{way}, none")
    return out


def tasks(repeats: int) -> Tasks:
    """Network sizes of the benchmark."""
    return {f"certificate N={n} n=4 L=10": lambda n=n: cost(n, 10, repeats) for n in (12, 30)}
