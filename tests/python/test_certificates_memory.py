"""Certificates with memory: whatever the input, an answer that is an answer, or the project's own error."""

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
    st.floats(-3, 3), st.sampled_from([math.nan, math.inf, -math.inf, 1e308, -1e200, 5e-324, 0.0, 1e-160, 1e150])
)


def _numbers(data: Any, shape: tuple[int, ...], calm: bool) -> np.ndarray:
    return np.asarray(data.draw(arrays(float, shape, elements=st.floats(-2, 2) if calm else NASTY)))


def _well_formed(w: certificate.WindowWitness) -> None:
    assert w.radius >= 0 or math.isnan(w.radius)
    assert (w.center is None) == (not math.isfinite(w.radius))
    if math.isnan(w.radius):
        assert w.proved == [] and w.proved_at == {}
    if w.center is None or w.box is None or w.shape is None:
        return
    assert np.isfinite(w.center).all()
    assert (w.box >= 0).all()
    assert w.stretch >= 0
    assert w.radius <= np.linalg.norm(w.box) * (1 + 1e-9)
    assert w.region.bound_around(w.center) <= w.radius * (1 + 1e-9)


@settings(max_examples=300, deadline=None)
@given(st.data())
def test_windows_answer_or_refuse(data: Any) -> None:
    calm = data.draw(st.booleans())
    n, q, steps, sources = (data.draw(st.integers(a, b)) for a, b in ((1, 2), (0, 2), (1, 3), (1, 4)))
    one = st.floats(0, 2) if calm else NASTY
    s = data.draw(st.integers(0 if calm else -1, 4))
    levels = [data.draw(one) for _ in range(3)]
    try:
        w = certificate.Window(n, q, steps, sources, steps * sources)
        w.begin(steps, data.draw(st.just(math.nan) if calm else NASTY))
        if data.draw(st.booleans()):
            w.prior_set(_numbers(data, (n,), calm), np.eye(n), data.draw(one))
        for k in range(steps):
            for j in range(sources):
                w.add(j, _numbers(data, (n,), calm), data.draw(NASTY), data.draw(one), data.draw(one))
            if k < steps - 1:
                w.advance(_numbers(data, (n, n), calm), _numbers(data, (n, q), calm), np.zeros(n))
    except gr.InvalidInput as refusal:
        assert "got" in str(refusal) and "expected" in str(refusal)
        return
    for ask in (
        lambda: certificate.leverage_window(w, s, *levels),
        lambda: certificate.leverage_window(w, s, *levels, moving=True),
        lambda: certificate.subsets_window(w, s, *levels),
        lambda: certificate.anytime_window(w, s, *levels, leaves=5),
    ):
        try:
            _well_formed(ask())
        except gr.InvalidInput as refusal:
            assert "got" in str(refusal) and "expected" in str(refusal)


@settings(max_examples=200, deadline=None)
@given(st.data())
def test_banks_and_rules_answer_or_refuse(data: Any) -> None:
    calm = data.draw(st.booleans())
    n, m = data.draw(st.integers(1, 2)), data.draw(st.integers(1, 4))
    one = data.draw(st.floats(0, 2) if calm else NASTY)
    s = data.draw(st.integers(-1, 5))
    A, C = _numbers(data, (n, n), calm), _numbers(data, (m, n), calm)
    sources = [(c[None], np.array([abs(one) + (0.1 if calm else 0.0)])) for c in C]
    Q = np.diag(np.full(n, one))

    def bank() -> list[Any]:
        b = certificate.Bank(A, Q, sources, s)
        b.start_gaussian(np.zeros(n), np.eye(n))
        found = [b.update(_numbers(data, (m,), False), 5.0, 5.0, 5.0) for _ in range(2)]
        for w in found:
            _well_formed(w)
        return [w.radius for w in found if not math.isnan(w.radius)]

    region = certificate.ellipsoid(np.zeros(n), np.eye(n), 1.0)
    questions = [
        bank,
        lambda: certificate.bank_steady(A, Q, sources, s, 4.0, 4.0, 4.0),
        lambda: certificate.observer_table(A, C, C.T, A, np.full(m, one), s=s, bw=one, start=one, T=4, lags=3).d,
        lambda: certificate.meters(C).leverage,
        lambda: certificate.smallest_undetectable(C, 3).searched,
        lambda: [0.0] if certificate.range_row(C[0], A[0], one) is None else [1.0],
        lambda: certificate.order_rule_box([region], A[0], s),
        lambda: certificate.Propagation.bounded_entries(A, s, A, one).age(region, 1).box,
        lambda: certificate.Propagation.gaussian_entries(A, s, A, one, one).age(region, 1).box,
        lambda: certificate.intersection([region, certificate.Region(A[0], one)]).radius,
        lambda: certificate.window_levels(one, m, n),
    ]
    for ask in questions:
        try:
            answer = np.asarray(ask(), dtype=float)
        except gr.InvalidInput as refusal:
            assert "got" in str(refusal) and "expected" in str(refusal)
            continue
        assert not (answer < 0).any()


def test_a_bank_proves_two_liars_of_six_positions_where_one_sample_says_nothing() -> None:
    A, C = np.array([[1.0, 0.1], [0.0, 1.0]]), np.tile([1.0, 0.0], (6, 1))
    rng = np.random.default_rng(1)
    assert certificate.leverage_ball(np.zeros(6), C, np.ones(6), 2, 5.0, 5.0).radius == math.inf
    bank = certificate.Bank(A, 1e-4 * np.eye(2), [(c[None], np.ones(1)) for c in C], 2)
    bank.start_gaussian(np.zeros(2), np.eye(2))
    levels = certificate.window_levels(1e-6, 6, 2)
    x = np.zeros(2)
    for _ in range(60):
        x = A @ x + 0.01 * rng.normal(size=2)
        w = bank.update(C @ x + rng.normal(size=6) + np.array([0, 40, 0, 0, 40, 0]), *levels)
        assert w.center is not None and w.box is not None
        assert (np.abs(x - w.center) <= w.box).all()
    assert w.proved == [1, 4]
    assert bank.count == 1
    assert bank.left_out == [[1, 4]]
    bank.restart(w.region)
    assert bank.count == 15


@pytest.mark.parametrize(
    "ask",
    [
        lambda w: w.begin(9),
        lambda w: w.prior_gaussian(np.zeros(2), np.zeros((2, 2))),
        lambda w: w.advance(np.eye(3), np.ones((2, 1)), np.zeros(2)),
        lambda w: certificate.leverage_window(w, 1, 5.0, 5.0, 5.0),
        lambda w: certificate.hull_window(w, -1),
        lambda w: certificate.cells([], 0),
    ],
)
def test_refusals(ask: Any) -> None:
    w = certificate.Window(2, 1, 3, 2, 6)
    w.begin(2)
    w.add(0, np.array([1.0, 0.0]), 0.0, 1.0)
    with pytest.raises(gr.InvalidInput, match="expected"):
        ask(w)
