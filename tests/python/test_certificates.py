"""Certificates from Python: whatever is given, an answer that holds or the project's own refusal."""

import math
from typing import Any

import garrison as gr
import numpy as np
import pytest
from garrison import certificate
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

NASTY = st.one_of(
    st.floats(allow_nan=True, allow_infinity=True),
    st.sampled_from([0.0, -0.0, 1.0, -1.0, 1e-300, 1e150, -1e150, 1e308, 5e-324]),
    st.floats(-10, 10),
)
POSITIVE = st.one_of(st.floats(1e-3, 1e3), st.sampled_from([1e-300, 1e150, 1e-12]))


def vectors(size: int, of: Any = NASTY) -> Any:
    return arrays(float, size, elements=of)


@st.composite
def samples(draw: Any) -> dict[str, Any]:
    m, n = draw(st.integers(0, 7)), draw(st.integers(1, 3))
    calm = draw(st.booleans())
    entries = st.floats(-10, 10) if calm else NASTY
    return {
        "y": draw(vectors(m, entries)),
        "C": draw(arrays(float, (m, n), elements=entries)),
        "R": draw(vectors(m, POSITIVE if calm else NASTY)),
        "s": draw(st.integers(-1, 8)),
        "z1": draw(st.one_of(st.floats(0, 10), NASTY)),
        "z2": draw(st.one_of(st.floats(0, 10), NASTY)),
        "sources": draw(st.one_of(st.just([]), st.lists(st.integers(-1, 5), min_size=m, max_size=m))),
        "proved": draw(st.lists(st.integers(-1, 6), max_size=3)),
    }


def _well_formed(w: certificate.Witness) -> None:
    assert w.radius >= 0 or math.isnan(w.radius)
    assert (w.center is None) == (not math.isfinite(w.radius))
    if w.center is not None:
        assert np.isfinite(w.center).all()
        assert w.region.bound_around(w.center) <= w.radius * (1 + 1e-12)
    if math.isnan(w.radius):
        assert w.proved == []


@settings(max_examples=300, deadline=None)
@given(samples(), st.booleans())
def test_witnesses_answer_or_refuse(sample: dict[str, Any], bounded: bool) -> None:
    for ask in (certificate.leverage_ball, certificate.witness_subsets):
        extra = {"widths": np.abs(sample["R"])} if bounded and ask is certificate.leverage_ball else {}
        try:
            _well_formed(ask(**sample, **extra))
        except gr.InvalidInput as refusal:
            assert "got" in str(refusal) and "expected" in str(refusal)


@settings(max_examples=200, deadline=None)
@given(st.integers(0, 6).flatmap(lambda m: st.tuples(vectors(m), vectors(m))), st.integers(-1, 7), NASTY, NASTY)
def test_rules_for_one_state_answer_or_refuse(data: Any, s: int, z1: float, z2: float) -> None:
    y, width = data
    for ask in (
        lambda: certificate.interval(y, width, s),
        lambda: certificate.scan(y, width, s, z1, z2),
        lambda: (-certificate.order_bound(y, width, s), certificate.order_bound(y, width, s)),
        lambda: (-math.inf, certificate.order_rule(y, s)),
    ):
        try:
            lo, hi = ask()
        except gr.InvalidInput:
            continue
        assert lo <= hi or (math.isnan(lo) and math.isnan(hi))


@settings(max_examples=200, deadline=None)
@given(st.data())
def test_tables_and_relays_answer_or_refuse(data: Any) -> None:
    n, N = data.draw(st.integers(1, 2)), data.draw(st.integers(1, 4))
    calm = data.draw(st.booleans())
    any_number = st.floats(0, 2) if calm else NASTY
    A = data.draw(arrays(float, (n, n), elements=any_number))
    C = np.eye(n)[np.arange(N) % n] if calm else data.draw(arrays(float, (N, n), elements=any_number))
    J = np.full((N, N), 1 / N) if data.draw(st.booleans()) else data.draw(arrays(float, (N, N), elements=any_number))
    one, v, s = data.draw(any_number), data.draw(vectors(N, any_number)), data.draw(st.integers(-1, 5))
    Q = data.draw(arrays(float, (n, n), elements=any_number))
    regions = certificate.Region(np.zeros(n), 1.0)
    questions = [
        lambda: certificate.table(_kernels(A, C, J), s=s, start=one, T=6, bw=one, bv=v).d,
        lambda: certificate.gaussian_table(_kernels(A, C, J), s=s, start=one, T=6, Q=Q, R=v, z=one).bound(6, 0.1),
        lambda: certificate.informed(certificate.error_system(A, C, J, [0]), v, 3, one, v),
        lambda: certificate.Recovery(_kernels(A, C, J), s).rb,
        lambda: certificate.TwoNumbers(A, C, s, one, one, one, v).step(one),
        lambda: certificate.averaged(v, J, v).radius,
        lambda: certificate.Propagation.bounded(A, s, one).age(regions, 1).radius,
        lambda: certificate.Propagation.gaussian(A, s, Q, one).age(regions, 1).radius,
        lambda: certificate.calibrated_levels(J, v, s, one)[0],
        lambda: certificate.chi(one, s),
        lambda: certificate.two_sided(one),
    ]
    for ask in questions:
        try:
            answer = np.asarray(ask())
        except gr.InvalidInput:
            continue
        assert not np.isnan(answer).any()
        assert (answer >= 0).all()


def _kernels(A: Any, C: Any, J: Any) -> certificate.Kernels:
    return certificate.kernels(certificate.error_system(A, C, J), 3)


def test_a_sample_with_one_liar() -> None:
    y = np.array([1.0, 1.1, 0.9, 1.05, 40.0])
    C, R = np.ones((5, 1)), np.full(5, 0.01)
    z1, z2 = certificate.gaussian_levels(1e-6, 5, 1)
    ball = certificate.leverage_ball(y, C, R, 1, z1, z2)
    assert ball.proved == [4] and ball.kept == [True] * 4 + [False]
    assert abs(ball.center[0] - 1.0125) < 1e-12
    assert ball.radius == pytest.approx(z2 * 0.05)
    assert ball.region.bound_around(np.array([3.0])) == pytest.approx(1.9875 + ball.radius)
    assert certificate.witness_subsets(y, C, R, 1, z1, z2).proved == [4]
    assert math.isnan(certificate.leverage_ball(y, C, R, 0, z1, z2).radius)
    assert certificate.leverage_ball(y, C, R, 5, z1, z2).radius == math.inf


def test_all_rows_of_a_source_go_together() -> None:
    C = np.array([[1.0], [1.0], [1.0], [1.0], [1.0]])
    y = np.array([0.0, 0.0, 0.0, 50.0, 0.0])
    w = certificate.leverage_ball(y, C, np.full(5, 0.01), 1, 5.0, 5.0, sources=[0, 1, 2, 3, 3])
    assert w.proved == [3] and w.kept == [True, True, True, False, False]
