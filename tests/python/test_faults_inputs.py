"""What people pass by mistake or with good reason: sparse matrices, views of one number, ranges, huge records."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import garrison as gr
import numpy as np
import pytest
from garrison.tables import read_records
from scipy import sparse

RING = gr.Network.ring(6)
HUGE = np.broadcast_to(1.0, (10**6, 10**6))


@pytest.mark.parametrize("kind", [sparse.csr_matrix, sparse.coo_matrix, sparse.coo_array])
def test_sparse_matrices_are_no_lists_of_numbers(kind: Callable[..., Any]) -> None:
    with pytest.raises(gr.InvalidInput, match=r"Structural.weights: got a sparse matrix, expected a list of numbers"):
        gr.filters.Structural(weights=kind(RING.metropolis_weights()))
    C = kind(np.eye(3))
    assert gr.Model(np.eye(3), C) == gr.Model(np.eye(3), np.eye(3))  # a row per agent: nothing else can be meant


@pytest.mark.parametrize(
    ("call", "said"),
    [
        (lambda: gr.attacks.Bias(agents=sparse.coo_matrix([[1.0, 0.0]])), "agents: got a sparse matrix, expected"),
        (lambda: gr.attacks.Bias(agents=sparse.coo_array(np.eye(2)), value=1.0), "agents: got a sparse matrix"),
        (lambda: gr.attacks.Bias(agents=range(10**10)), r"agents: got 1e\+10 entries, which takes 400 GB"),
        (lambda: gr.attacks.Bias(agents=range(10**30)), r"agents: got .* entries, which takes"),
        (lambda: gr.Model(HUGE, [1.0]), r"A: got an array of shape \(1000000, 1000000\), which takes 8e\+03 GB"),
        (lambda: gr.Model(1.0, HUGE), r"C.*: got an array of shape .*, which takes"),
        (lambda: gr.Network(range(10**10)), "which takes|expected"),
        (
            lambda: gr.replay(gr.Model(1.0, [1.0]), gr.Network.complete(1), gr.filters.ScalarGain(), measurements=HUGE),
            r"measurements: got an array of shape \(1000000, 1000000\), which would take",
        ),
    ],
)
def test_what_no_machine_holds_is_refused_in_our_words(call: Callable[[], Any], said: str) -> None:
    with pytest.raises(gr.InvalidInput, match=said):
        call()


@pytest.mark.parametrize("name", [np.array(["a", "b"], dtype=object), np.array([1.0, 2.0]), 3, None, ["gamma"]])
def test_a_condition_is_asked_for_by_its_name(name: Any) -> None:
    model = gr.Model(0.9, [1.0] * 6, process_bound=0.1, measurement_bound=0.1)
    found = gr.check(model, RING, gr.filters.ScalarGain())
    with pytest.raises(gr.InvalidInput, match=r"Check\[...\]: got .*, expected the name of a condition or quantity"):
        found[name]
    with pytest.raises(KeyError):
        found["no such name"]


@pytest.mark.parametrize("states", ["factors", "all"])
@pytest.mark.parametrize(("row", "station"), [(17, 0), (300, 2), (599, 4)])
def test_a_fit_names_the_record_that_hides_all_others(states: str, row: int, station: int, tmp_path: Path) -> None:
    rng = np.random.default_rng(1)
    common = np.zeros(600)
    for t in range(1, 600):
        common[t] = 0.8 * common[t - 1] + rng.normal()
    values = 10 + common[:, None] + 0.3 * rng.normal(size=(600, 5))
    values[row, station] = 1e20
    days = np.datetime64("2020-01-01") + np.arange(600)
    lines = ["time,north,east,south,west,centre"]
    lines += [f"{day},{','.join(map(repr, one.tolist()))}" for day, one in zip(days, values, strict=True)]
    (tmp_path / "records.csv").write_text("\n".join(lines) + "\n")
    given: dict[str, Any] = {"states": "all"} if states == "all" else {"factors": 1}
    name = lines[0].split(",")[1 + station]
    said = rf"station {name}, record of {days[row]}.*: got [0-9.e+]+, expected a number of the size of the others"
    with pytest.raises(gr.InvalidInput, match=said):
        gr.fit(read_records(tmp_path / "records.csv"), harmonics=0, **given)
