"""garrison.fit: a model from records, with factors or with every station as states."""

from typing import Any

from garrison.fitting import Fit, fit_factors
from garrison.fitting_full import fit_full
from garrison.tables import Records
from garrison.words import hinted, refusal, shown


@hinted
def fit(records: Records, **options: Any) -> Fit:
    """Identify seasonal cycle, factors, A, C, noise levels and bounds from clean records.

    Parameters
    ----------
    records : Records
        Of garrison.tables.read_records.
    **options
        factors (state dimension, default 2), harmonics (2), period (of the cycle in samples, default a year), root
        (False: True works on square roots), factor (1: unit conversion), standardise (True: factors of every column
        in units of its own spread, whatever the columns' units are; False: all columns have one unit; left out: True
        where the header names different units, else False where their sizes are comparable); states ("factors", or
        "all": every station is a state, a vector autoregression). With states = "all" and in place of factors: order
        (samples of the past; 0, the default: the likeliest for held-out samples), most (largest order that is tried,
        4), held_out (share of the samples, the last ones, that choose it, 0.25), inputs (names of columns that are
        known inputs) and noise (part of a station's residual variance that is taken for measurement noise, 0.01: such
        records cannot tell it from the rest).

    Returns
    -------
    Fit
        The model, and what brings records into its coordinates.

    Raises
    ------
    InvalidInput
        The records do not suffice.
    """
    if not isinstance(records, Records):
        raise refusal("fit.records", shown(records), "Records, as garrison.tables.read_records returns them")
    states = options.pop("states", "factors")
    if states not in ("factors", "all"):
        raise refusal("fit.states", shown(states), '"factors" or "all"')
    alone = ("factors", "standardise") if states == "all" else ("order", "most", "held_out", "noise", "inputs")
    for name in alone:
        if name in options:
            got = f"{shown(options[name])} with states = {states!r}"
            other = "none: there are no factors then" if states == "all" else 'states = "all" beside it'
            raise refusal(f"fit.{name}", got, other)
    return (fit_full if states == "all" else fit_factors)(records, **options)
