"""Every public callable of garrison and of its core, with bad values: no signal, no hang, no foreign exception.

`python tests/fuzz/test_callables.py --seconds 600 --seed 1` runs longer, or with another seed. Seconds are those of a
processor. Each batch of calls runs in a process of its own; one call has ten seconds.
"""

from __future__ import annotations

import argparse
import sys

import garrison as gr
import pytest
from fuzz_calls import fuzz, report
from fuzz_samples import samples
from fuzz_targets import EXCLUDED, public

#: plain answers of functions, without arguments or methods that take any
ANSWERS = {
    "Analysis",
    "Calibration",
    "Certified",
    "Comparison",
    "Designed",
    "Exposed",
    "Fit",
    "Mitigated",
    "Resilience",
    "Sweep",
}
SECONDS = 60.0


def test_every_callable_survives_bad_values(figures: list[str], seed: int) -> None:
    line, failures = fuzz(SECONDS, seed)
    figures.append(line)
    assert not failures, line + "\n" + report(failures)


def test_every_callable_refuses_what_it_does_not_take() -> None:
    """Names that it does not have, and more arguments than it has."""
    for name, _, function in public():
        if name in EXCLUDED or name.endswith("__"):
            continue
        for positional, named in ((), {"no_such_name": 1}), (range(40), {}):
            with pytest.raises(gr.Error, match=": got "):
                function(*positional, **named)


def test_every_class_has_a_sample() -> None:
    """A class without one would not have its methods called."""
    classes = {value for _, _, value in public() if isinstance(value, type)}
    made = {type(x) for group in samples().values() for x in group}
    missing = {c.__name__ for c in classes if not any(issubclass(m, c) for m in made)}
    missing -= {"StoredRun"}  # a Run, which wants a store
    assert missing == {"BoundKind", "Verdict", "budget"} | ANSWERS


def test_what_is_excluded_exists() -> None:
    assert set(EXCLUDED) <= {name for name, _, _ in public()}


if __name__ == "__main__":
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--seconds", type=float, default=SECONDS)
    options.add_argument("--seed", type=int, default=0)
    options.add_argument("--all", action="store_true", help="show every failure")
    given = options.parse_args()
    words, failed = fuzz(given.seconds, given.seed)
    print(report(failed, 10**6 if given.all else 2))
    print(words)
    sys.exit(1 if failed else 0)
