"""Fits do not depend on the units of records, nor on an offset; where they must, they are refused with the reason."""

import datetime as dt
from collections.abc import Callable
from pathlib import Path
from typing import Any

import garrison as gr
import numpy as np
import pytest
from garrison.cli import main
from garrison.tables import Records

GAINS = np.array([1.0, 0.8, 1.2, 0.9])
#: units of four columns, far apart
UNITS = np.array([1e-9, 1.0, 1e9, 1e3])


def raw(seed: int = 1) -> np.ndarray:
    """Four stations that see one state."""
    rng = np.random.default_rng(seed)
    x = np.zeros(1500)
    for t in range(1, len(x)):
        x[t] = 0.8 * x[t - 1] + rng.normal()
    return x[:, None] * GAINS + 0.3 * rng.normal(size=(len(x), len(GAINS)))


def records(values: np.ndarray, units: list[str] | None = None) -> Records:
    dates = [dt.date(2001, 1, 1) + dt.timedelta(days=k) for k in range(len(values))]
    return Records(dates, [f"S{k}" for k in range(values.shape[1])], values, 86400.0, units or [])


def one_factor(values: np.ndarray, **options: Any) -> gr.Fit:
    return gr.fit(records(values), factors=1, harmonics=0, **options)


@pytest.mark.parametrize("seed", [1, 2, 3])
@pytest.mark.parametrize(
    ("moved", "size", "accuracy"),
    [
        (lambda v: v + 1e10, 1.0, 1e-5),
        (lambda v: 1e-5 * v + 1e5, 1e-5, 1e-5),
        (lambda v: 1e-12 * v, 1e-12, 1e-9),
        (lambda v: 1e12 * v, 1e12, 1e-9),
        (lambda v: 1e-60 * v, 1e-60, 1e-9),
    ],
)
def test_offset_and_unit_of_all_records(
    seed: int, moved: Callable[[np.ndarray], np.ndarray], size: float, accuracy: float
) -> None:
    plain, other = one_factor(raw(seed)), one_factor(moved(raw(seed)))
    a, b = plain.identified, other.identified
    assert np.allclose(a.A, b.A, rtol=accuracy) and np.allclose(a.C, b.C, rtol=accuracy)
    for name, power in (("process_covariance", 2), ("measurement_variance", 2), ("measurement_bound", 1)):
        assert np.allclose(getattr(a, name), getattr(b, name) / size**power, rtol=accuracy, atol=accuracy), name
    for name in ("reference", "robust_reference"):
        x, y = getattr(plain, name)(plain.records), getattr(other, name)(other.records) / size
        assert np.allclose(x, y, rtol=accuracy, atol=accuracy), name
    assert plain.whiteness().p_value == pytest.approx(other.whiteness().p_value, rel=1e-3)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_units_of_single_columns(seed: int) -> None:
    plain, other = one_factor(raw(seed), standardise=True), one_factor(raw(seed) * UNITS, standardise=True)
    a, b = plain.identified, other.identified
    for name in ("A", "C", "process_covariance", "measurement_variance", "measurement_bound", "share", "weight"):
        assert np.allclose(getattr(a, name), getattr(b, name), rtol=1e-9), name
    assert np.allclose(np.asarray(b.scale) / np.asarray(a.scale), UNITS, rtol=1e-9)
    assert np.allclose(plain.reference(plain.records), other.reference(other.records), rtol=1e-7, atol=1e-9)
    # a column that is measured in degrees and one in kelvins of another size: the header says that units differ
    named = gr.fit(records(raw(seed) * UNITS, ["nm", "m", "nm", "km"]), factors=1, harmonics=0)
    assert np.allclose(named.identified.A, a.A, rtol=1e-9)


def test_units_of_single_columns_with_every_station_a_state() -> None:
    fits: list[Any] = [gr.fit(records(v), states="all", harmonics=0) for v in (raw(), raw() * UNITS, raw() + 1e10)]
    plain, other, moved = fits
    assert plain.autoregression.order == other.autoregression.order == moved.autoregression.order
    ratio = UNITS[:, None] / UNITS[None, :]
    assert np.allclose(other.autoregression.A[:4, :4] / ratio, plain.autoregression.A[:4, :4], rtol=1e-7, atol=1e-9)
    assert np.allclose(moved.autoregression.A, plain.autoregression.A, rtol=1e-3, atol=1e-4)


def test_what_depends_on_units_is_refused_and_the_advice_works(tmp_path: Path, capsys: Any) -> None:
    with pytest.raises(gr.InvalidInput, match=r"station S0: got deviations of about .* set standardise"):
        one_factor(raw() * UNITS)
    path = tmp_path / "records.csv"
    given = records(raw() * UNITS)
    lines = [f"{d},{','.join(map(repr, v.tolist()))}" for d, v in zip(given.dates, given.values, strict=True)]
    path.write_text("\n".join(["date,A,B,C,D", *lines]) + "\n")
    command = ["fit", str(path), "--factors", "1", "--harmonics", "0", "-o", str(tmp_path / "m.json")]
    assert main(command) == 2
    assert "set standardise" in capsys.readouterr().err
    assert main([*command, "--standardise"]) == 0
    assert "every column is taken in units of its own spread" in capsys.readouterr().out
    assert main([*command, "--states", "all", "--standardise"]) == 2


@pytest.mark.parametrize("constant", [0.1, 0.0, 1e10, -1e-12])
def test_a_constant_column_is_called_constant(constant: float) -> None:
    values = raw()
    values[:, 1] = constant
    with pytest.raises(gr.InvalidInput, match="station S1: got records without variation"):
        one_factor(values)


@pytest.mark.parametrize("size", [1e-100, 1e100, 1e200])
def test_sizes_whose_squares_are_no_numbers(size: float) -> None:
    with pytest.raises(gr.InvalidInput, match=r"station S0: got records that vary by .*fit\.factor"):
        one_factor(raw() * size)
    one_factor(raw() * size, factor=1.0 / size)  # the advice works
