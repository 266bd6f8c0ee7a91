"""Models from recorded data: records in, model out."""

import json
import re
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from garrison import _core
from garrison.arguments import chance, number, whole
from garrison.clean import clean_levels
from garrison.notebook import of_model, titled
from garrison.numeric import real
from garrison.result import Result
from garrison.sizes import require_memory
from garrison.tables import Records
from garrison.words import hinted_methods, only, refusal, shown

Array = NDArray[np.float64]
#: rate at which clean records exceed the levels where nothing else is asked for
FAILURE = 1e-3
#: p-value below which residuals are called not white
_LEVEL = 0.01
#: how much larger than the noise of the records a bound should be that later noise keeps, too
INFLATION = 1.1


@hinted_methods
@dataclass(frozen=True, eq=False, repr=False)
class Whiteness(Result):
    """Ljung-Box test of a model's residuals, station by station.

    statistic (N,): chi-square with `lags` degrees if the residuals are independent of their past. correlation (N,):
    with the sample before. p_value: of the worst station, times the number of stations (Bonferroni).
    """

    stations: list[str]
    statistic: Array
    correlation: Array
    p_value: float
    lags: int

    def __str__(self) -> str:
        k = int(np.argmax(self.statistic))
        about = (
            f"whiteness of the residuals over {self.lags} lags: worst {self.stations[k]}, statistic "
            f"{self.statistic[k]:.4g}, correlation {self.correlation[k]:.2g} with the sample before, "
            f"p-value {self.p_value:.2g}"
        )
        if self.p_value >= _LEVEL:
            return f"{about}: no dependence on the past was found"
        return (
            f"{about}: not white, so false-alarm rates on records differ from what is asked (calibrate the filter), "
            "and certificates with memory do not hold, which take noise for white"
        )


@hinted_methods
@dataclass(frozen=True, eq=False, repr=False)
class Fit(Result):
    """A model identified from clean records.

    Attributes
    ----------
    model : Model
        With unit rows, noise bounds and covariances.
    identified : object
        Season, scale and matrices, as they were found.
    records : Records
        What it was fitted to.
    """

    model: _core.Model
    identified: _core.Identified
    records: Records

    def _repr_html_(self) -> str:
        about = f"Fit: {len(self.records.stations)} stations, {self.records.dates[0]} to {self.records.dates[-1]}"
        return titled(about, of_model(self.model))

    def measurements(self, records: Records) -> Array:
        """Measurements of other records of the same stations and period, matched by name.

        Parameters
        ----------
        records : Records
            As garrison.tables.read_records returns them.

        Returns
        -------
        (samples, stations) array
            In the units of the model; nan = missing.

        Raises
        ------
        InvalidInput
            Another period, or a station is missing.
        """
        if not isinstance(records, Records):
            raise refusal("records", shown(records), "Records, as garrison.tables.read_records returns them")
        if abs(records.step - self.records.step) > 1e-6 * self.records.step:
            raise refusal("records", f"a period of {records.step:g} s", f"{self.records.step:g} s, as the fitted ones")
        same = records.of(self.records.stations)
        return self.identified.measurements(same.values, same.first)

    def reference(self, records: Records) -> Array:
        """What we call truth: the least-squares state of clean records at every sample.

        Parameters
        ----------
        records : Records
            Of the same stations and period.

        Returns
        -------
        (samples, n) array
            States; nan where too few stations have a record.

        Raises
        ------
        InvalidInput
            As measurements.
        """
        return self.identified.reference_states(self.measurements(records))

    def robust_reference(self, records: Records) -> Array:
        """The state with the least sum of absolute deviations: a median over the stations.

        Unlike `reference` it is not pulled by a minority of stations that are wrong.

        Parameters
        ----------
        records : Records
            Of the same stations and period.

        Returns
        -------
        (samples, n) array
            States; nan where too few stations have a record.

        Raises
        ------
        InvalidInput
            As measurements.
        """
        return _least_absolute(np.asarray(self.identified.C), self.measurements(records))

    def whiteness(self, lags: int = 10) -> Whiteness:
        """Whether what the model leaves over depends on its own past: Ljung-Box test of the residuals of the records.

        Where it does, a test over several samples alarms more often than asked: `calibrate`.

        Parameters
        ----------
        lags : int
            1..samples - 1.

        Returns
        -------
        Whiteness

        Raises
        ------
        InvalidInput
            lags is out of range.
        """
        x = self.reference(self.records)
        v = self.measurements(self.records) - x @ np.asarray(self.identified.C).T
        statistic, correlation, p_value = _core.certificate.whiteness(v, lags)
        return Whiteness(self.records.stations, statistic, correlation, p_value, lags)

    def known(self, records: Records) -> Array | None:
        """Known inputs among other records.

        Parameters
        ----------
        records : Records
            Of the same stations and period.

        Returns
        -------
        (samples, p) array or None
            None where the model has none.
        """
        return None

    def levels(self, attacked: int, failure: float) -> tuple[float, float] | None:
        """Levels of the certificates that these records exceed at a given rate, whatever their law.

        Split conformal over all sets with at most `attacked` stations missing.

        Parameters
        ----------
        attacked : int
            0..N-1.
        failure : float
            The rate, above 0 and below 1.

        Returns
        -------
        (z1, z2) or None
            In standard deviations. None where they do not exist: several states, rows that are not 1 or -1, or fewer
            than 2/failure - 1 complete records.

        Raises
        ------
        InvalidInput
            A number out of range.
        """
        most, rate = whole("attacked", attacked, 0, self.model.agents - 1), chance("failure", failure)
        return clean_levels(self.model, self.measurements(self.records), most, rate)

    def inflated(self, factor: float = INFLATION) -> tuple[list[float], float]:
        """The noise bounds times a factor: the largest noise of the records is not the largest ever.

        On the wind data one station and day in 30 000 of the test years breaks a bound of the clean years, and none
        the one that is 1.1 times as large.

        Parameters
        ----------
        factor : float
            Any number; above 1 to be of use.

        Returns
        -------
        (list of N float, float)
            measurement_bound and process_bound.

        Raises
        ------
        InvalidInput
            No number.
        """
        by = number("factor", factor)
        return (by * np.asarray(self.model.measurement_bound)).tolist(), by * self.model.process_bound

    def to_json(self, attacked: int | None = None, failure: float = FAILURE) -> str:
        """The model as text: everything a scenario or another program needs.

        Parameters
        ----------
        attacked : int, optional
            0..N-1: also write what deterministic and distribution-free certificates rest on, `levels` and `inflated`.
        failure : float
            Of `levels`, above 0 and below 1.

        Returns
        -------
        str
            JSON.

        Raises
        ------
        InvalidInput
            A number out of range.
        """
        i = self.identified
        arrays: dict[str, Any] = {
            name: np.asarray(getattr(i, name)).tolist()
            for name in (
                "A",
                "C",
                "process_covariance",
                "measurement_variance",
                "measurement_bound",
                "scale",
                "season",
                "share",
            )
        }
        span = [str(self.records.dates[0]), str(self.records.dates[-1])]
        about = {
            "stations": self.records.stations,
            "units": self.records.units,
            "period_s": self.records.step,
            "fitted": span,
            "process_bound": i.process_bound,
        }
        if attacked is not None:
            bounds = self.inflated()
            about["inflated"] = {"measurement_bound": bounds[0], "process_bound": bounds[1]}
            found = self.levels(attacked, failure)
            z1, z2 = found if found is not None else (None, None)
            about["levels"] = {"attacked": attacked, "failure": failure, "z1": z1, "z2": z2}
        return json.dumps(
            about | arrays,
            indent=1,
        )


#: reweightings of `_least_absolute`, and the part of the largest number that counts as no deviation
_SWEEPS, _MET = 60, 1e-9


def _least_absolute(C: Array, y: Array) -> Array:
    """argmin over x of sum_i |y_i - C_i x| of every row of y, by iteratively reweighted least squares."""
    known = np.isfinite(y)
    size = float(np.abs(y[known]).max(initial=0.0)) or 1.0
    values = np.where(known, y, 0.0) / size
    weights = known.astype(float)
    n = C.shape[1]
    x = np.zeros((len(y), n))
    for _ in range(_SWEEPS):
        normal = np.einsum("ti,ij,ik->tjk", weights, C, C) + 1e-12 * np.eye(n)
        x = np.linalg.solve(normal, np.einsum("ti,ij,ti->tj", weights, C, values)[..., None])[..., 0]
        weights = known / np.maximum(np.abs(values - x @ C.T), _MET)
    x[known.sum(axis=1) < n] = np.nan
    return x * size


_OPTIONS = ("factors", "harmonics", "period", "root", "factor", "standardise")
#: most factors and harmonics that anybody could mean
_MOST = 10_000


def _options(records: Records, given: dict[str, Any]) -> dict[str, Any]:
    only("fit", given, _OPTIONS)
    out: dict[str, Any] = {"period": records.samples_per_year}
    if len(set(filter(None, records.units))) > 1:  # factors of deviations in different units mean nothing
        out["standardise"] = True
    for name, value in given.items():
        where = f"fit.{name}"
        if name in ("root", "standardise"):
            if not isinstance(value, bool):
                raise refusal(where, shown(value), "true or false")
        elif (found := real(value)) is None:
            raise refusal(where, shown(value), "a number")
        elif name in ("factors", "harmonics"):
            if not 0 <= found <= _MOST or found != int(found):
                raise refusal(where, shown(value), f"a whole number in 0..{_MOST}")
            value = int(found)
        else:
            value = found
        out[name] = value
    columns = 1 + 2 * out.get("harmonics", 2)
    require_memory("fit.harmonics", str(out.get("harmonics", 2)), float(len(records.values)) * columns)
    return out


def _by_name(message: str, records: Records) -> str:
    """The core's message with names of stations and times of records in place of numbers."""

    def station(found: re.Match[str]) -> str:
        return f"station {records.stations[int(found[1])]}"

    def record(found: re.Match[str]) -> str:
        return f"station {records.stations[int(found[2])]}, record of {records.dates[int(found[1])]}"

    return re.sub(r"^records\[(\d+), (\d+)\]", record, re.sub(r"^station (\d+)\b", station, message))


def fit_factors(records: Records, **options: Any) -> Fit:
    """The model of `garrison.fit` with factors as states."""
    try:
        i = _core.identify(records.values, records.first, **_options(records, options))
    except _core.Error as error:
        raise type(error)(_by_name(str(error), records)) from None
    variances = np.asarray(i.measurement_variance)
    model = _core.Model(
        i.A,
        i.C,
        process_bound=i.process_bound,
        measurement_bound=i.measurement_bound,
        process_covariance=i.process_covariance,
        measurement_covariance=[[[v]] for v in variances],
    )
    return Fit(model, i, records)
