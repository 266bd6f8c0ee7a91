"""Bad arguments of the functions that answer a question: each is refused by its name."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import garrison as gr
import pytest

MODEL = gr.Model([[0.9]], [[1.0]] * 4, process_bound=0.1, measurement_bound=0.1)
NETWORK = gr.Network.complete(4)
BAD = (3.5, float("nan"), object(), b"x", -1)
#: function -> arguments that fit, and those that are replaced one by one
CASES: dict[str, tuple[Callable[..., Any], dict[str, Any], dict[str, tuple[Any, ...]]]] = {
    "analyze": (
        gr.analyze,
        {"model": MODEL, "network": NETWORK},
        {
            "model": (None, 1, NETWORK),
            "network": (None, "x", MODEL),
            "filter": (1, "saturation"),
            "candidates": ("x", object(), [[1.0, 2.0]]),
            "costs": ("x", [0.0], [float("nan")]),
            "names": BAD,
            "title": BAD,
            "seconds": (0, float("nan"), "x", None),
            "progress": (1, "x", len),
        },
    ),
    "compare": (
        gr.compare,
        {"model": MODEL, "network": NETWORK, "attacked": [0]},
        {
            "model": (None, 1.0),
            "network": (None, 1.0),
            "attacked": ([], [4], [-1], 0.5, "x", None),
            "filters": (1, [1], {"a": 1}, {1: gr.filters.ScalarGain()}),
            "attacks": (1, {"a": 1}),
            "baselines": (1, "x", None),
            "steps": (0, 1.5, "x"),
            "start": (0, 100, "x"),
            "trials": (0, "x"),
            "seed": (-1, "x"),
            "size": ("x",),
            "title": BAD,
            "progress": (1, "x", len),
        },
    ),
    "design": (
        gr.design,
        {"model": MODEL, "network": NETWORK, "attacked": 1, "initial_error": 1.0},
        {
            "model": (None, 1.0),
            "network": (None, 1.0),
            "family": (1, "rdkf", "saturatoin", b"x"),
            "attacked": (-1, 5, 0.5, "x"),
            "initial_error": (0, float("nan"), float("inf"), "x"),
            "goal": (1, "bits", b"x"),
            "chebyshev": (1, "x"),
            "most_rounds": (0, 1.5),
            "curve": (1, "x", None),
        },
    ),
    "sweep": (
        gr.sweep,
        {"scenario": "missing.toml", "out": "out"},
        {
            "scenario": (None, 1.0, "missing.toml"),
            "client": (1, "x"),
            "independent": (1, "x"),
            "progress": (1, "x"),
        },
    ),
}


@pytest.mark.parametrize(
    ("name", "argument", "value"),
    [
        (name, argument, value)
        for name, (_, _, bad) in CASES.items()
        for argument, values in bad.items()
        for value in values
    ],
)
def test_each_argument_is_refused_by_name(
    name: str, argument: str, value: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    function, fits, _ = CASES[name]
    with pytest.raises((gr.InvalidInput, gr.IoError)):
        function(**(fits | {argument: value}))
