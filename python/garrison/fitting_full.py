"""A model with every station as a state: `fit(records, states="all")`."""

import json
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from garrison import _core
from garrison.arguments import number, texts, whole
from garrison.fitting import Fit, Whiteness, _by_name, _options
from garrison.numeric import sparse
from garrison.tables import Records
from garrison.words import hinted_methods, only, refusal, shown

Array = NDArray[np.float64]
_ORDER = ("order", "most", "held_out", "noise", "inputs")
_SEASON = ("harmonics", "period", "root", "factor")
#: part of a station's residual variance that is taken for measurement noise where nothing else is said
_NOISE = 0.01


@hinted_methods
@dataclass(frozen=True, eq=False, repr=False)
class FullFit(Fit):
    """A vector autoregression: every station's deviation from its season is a state, with `order` samples of the past.

    Attributes
    ----------
    model : Model
        States named as the stations, B for known inputs.
    identified : object
        Season, scale and matrices, as they were found.
    records : Records
        What it was fitted to, the stations alone.
    autoregression : object
        order, residuals and the likelihoods that chose the order.
    inputs : tuple of str
        Names of the columns that are known inputs.
    """

    autoregression: _core.Autoregression
    inputs: tuple[str, ...] = ()

    def known(self, records: Records) -> Array | None:
        """Known inputs (samples, p) among other records, matched by name; a row holds what led to its sample."""
        return records.of(list(self.inputs)).values if self.inputs else None

    def reference(self, records: Records) -> Array:
        """What we call truth: the measurements and those of the samples before; nan where one is missing."""
        y = self.measurements(records)
        before = [
            np.vstack([np.full((lag, y.shape[1]), np.nan), y])[: len(y)] for lag in range(self.autoregression.order)
        ]
        return np.hstack(before)

    def robust_reference(self, records: Records) -> Array:
        """The same: no state is seen by several stations."""
        return self.reference(records)

    def whiteness(self, lags: int = 10) -> Whiteness:
        """Whether the residuals depend on their own past: Ljung-Box test, station by station. lags: 1..samples - 1."""
        e = np.asarray(self.autoregression.residuals)
        statistic, correlation, p_value = _core.certificate.whiteness(e, lags)
        return Whiteness(self.records.stations, statistic, correlation, p_value, lags)

    def to_json(self, attacked: int | None = None, failure: float = 1e-3) -> str:
        """The model as text, which `[model] file` reads: matrices, noise, names and units, known inputs.

        attacked: refused, since levels of clean records exist for one state only (`levels`).
        """
        if attacked is not None:
            raise refusal(
                "attacked", shown(attacked), "none beside every station as a state", "fit one factor for levels"
            )
        m = self.model
        given = {"B": sparse(m.B), "inputs": m.input_names} if self.inputs else {}
        content = {
            "garrison_model": 1,
            "A": sparse(m.A),
            "C": [sparse(one) for one in m.C],
            **given,
            "process_bound": m.process_bound,
            "process_covariance": sparse(m.process_covariance),
            "measurement_covariance": [one.tolist() for one in m.measurement_covariance],
            "agents": self.records.stations,
            "states": m.state_names,
            "units": m.units,
        }
        return json.dumps(content, indent=1)


def fit_full(records: Records, **options: Any) -> FullFit:
    """The model of `fit(records, states="all")`.

    options: harmonics, period, root, factor as in `fit`; the others are described
    there, too.
    """
    only("fit", options, [*_SEASON, *_ORDER])
    inputs = texts("fit.inputs", options.get("inputs", []))
    missing = [name for name in inputs if name not in records.stations]
    if missing:
        raise refusal("fit.inputs", ", ".join(missing), f"columns of the records: {', '.join(records.stations)}")
    stations = records.of([s for s in records.stations if s not in inputs])
    if not stations.stations:
        raise refusal("fit.inputs", "all columns", "fewer: some must be stations")
    given = _options(stations, {k: v for k, v in options.items() if k in _SEASON})
    season_options = {"harmonics": 2, "root": False, "factor": 1.0} | {k: v for k, v in given.items() if k in _SEASON}
    u = records.of(inputs).values if inputs else np.zeros((len(records.values), 0))
    how: dict[str, Any] = {k: whole(f"fit.{k}", options[k], 0) for k in ("order", "most") if k in options}
    if "held_out" in options:
        how["held_out"] = number("fit.held_out", options["held_out"])
    how["most"] = max(how.get("most", 4), how.get("order", 0))
    try:
        z, season = _core.anomalies(stations.values, stations.first, **season_options)
        found = _core.autoregress(z, u, **how)
        noise = number("fit.noise", options.get("noise", _NOISE))
        identified = _core.identified(found, season, **season_options, noise=noise)
    except _core.Error as error:
        raise type(error)(_by_name(str(error), stations)) from None
    return FullFit(_model(identified, found, stations, inputs), identified, stations, found, tuple(inputs))


def _model(
    identified: _core.Identified, found: _core.Autoregression, stations: Records, inputs: list[str]
) -> _core.Model:
    names = [s if lag == 0 else f"{s}, {lag} before" for lag in range(found.order) for s in stations.stations]
    units = dict(zip(stations.stations, stations.units, strict=True)) if stations.units else {}
    known = {name: unit for name, unit in units.items() if unit}
    given: dict[str, Any] = {"B": found.B, "inputs": inputs} if inputs else {}
    return _core.Model(
        identified.A,
        [row[None] for row in np.asarray(identified.C)],
        process_bound=identified.process_bound,
        process_covariance=identified.process_covariance,
        measurement_covariance=[[[v]] for v in np.asarray(identified.measurement_variance)],
        states=names,
        units=known,
        **given,
    )
