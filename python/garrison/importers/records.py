"""Records of several sensors (CSV) as a scenario: a model fitted to a clean part, a network, a replay of the rest."""

import datetime as dt
import re
import shutil
from dataclasses import dataclass
from pathlib import Path

from garrison import _core
from garrison.importers.bundle import Bundle
from garrison.importers.limits import require_positive, require_probability
from garrison.scenario.reader import read_scenario
from garrison.tables import Records, read_records
from garrison.tables.clock import Moment
from garrison.words import count, refusal

SOURCE = "records of your own, copied unchanged to records.csv; their licence is that of their publisher."
_YEARS = 2.0
_FEWEST = 20


@dataclass(frozen=True)
class Choice:
    """clean: last moment of the part that the model is fitted to; None: the first half of the records.

    factors: states of the model. harmonics: of a yearly season; None: 2 where the clean part has two years, else 0.
    stations: CSV with places; radius: km, of neighbours. false_alarm: rate of a test, per sample. standardise: every
    column in units of its own spread; None: where the header names different units.
    """

    clean: Moment | None = None
    factors: int = 1
    harmonics: int | None = None
    stations: Path | None = None
    radius: float | None = None
    false_alarm: float = 1e-4
    standardise: bool | None = None

    def __post_init__(self) -> None:
        require_probability("false-alarm", self.false_alarm)
        if self.factors < 1:
            raise refusal("--factors", str(self.factors), "a whole number >= 1")
        if self.harmonics is not None and self.harmonics < 0:
            raise refusal("--harmonics", str(self.harmonics), "a whole number >= 0")
        if self.radius is not None:
            require_positive(radius=self.radius)


@dataclass
class RecordsBundle(Bundle):
    """A bundle with the files that the scenario reads beside it."""

    copies: dict[str, Path] | None = None

    def write(self, folder: Path) -> None:
        """As every bundle, and copies of the user's files; what `garrison run` would refuse of them is refused here."""
        super().write(folder)
        for name, path in (self.copies or {}).items():
            shutil.copyfile(path, folder / name)
        try:
            read_scenario(folder / "scenario.toml")
        except _core.Error as error:
            raise type(error)(self._in_words_of_the_command(str(error), folder)) from None

    def _in_words_of_the_command(self, message: str, folder: Path) -> str:
        """A message about the scenario with the user's files and the command's options in place of what it names."""
        for name, path in (self.copies or {}).items():
            message = message.replace(str(folder / name), str(path))
        message = re.sub(r"\bfit\.(factors|harmonics)\b", r"--\1", message)
        return re.sub(
            r"\bset standardise \(true: (.*); false: (.*)\)", r"--standardise: \1; --no-standardise: \2", message
        )


def import_csv(path: Path, choice: Choice | None = None) -> Bundle:
    """Records of several sensors: a column of times and a column per sensor.

    Parameters
    ----------
    path : Path
        Of a CSV file.
    choice : Choice, optional
        End of the clean part, states and season of the model, places of the sensors, false-alarm rate.

    Returns
    -------
    Bundle
        What `write(folder)` writes: scenario.toml and the files beside it; facts and notes for people.

    Raises
    ------
    IoError
        A file cannot be read.
    InvalidInput
        With the line: the content does not fit; when it is written, also what a run would refuse.
    """
    choice = choice or Choice()
    records = read_records(path)
    sensors = len(records.stations)
    if sensors < 3:
        raise refusal(str(path), count(sensors, "sensor"), "at least 3, which measure related things")
    if len(records.dates) < 2 * _FEWEST:
        raise refusal(
            str(path), count(len(records.dates), "record"), f"at least {2 * _FEWEST}: half of them for the fit"
        )
    if (choice.stations is None) != (choice.radius is None):
        raise refusal("--stations, --radius", "one of them", "both or none")
    last, rest = _split(records, choice.clean)
    years = len(records.between(None, last).dates) / records.samples_per_year
    harmonics = choice.harmonics if choice.harmonics is not None else 2 if years >= _YEARS else 0
    copies = {"records.csv": path} | ({"stations.csv": choice.stations} if choice.stations else {})
    standardise = {} if choice.standardise is None else {"standardise": choice.standardise}
    model = {"fit": "records.csv", "to": _shown(last), "factors": choice.factors, "harmonics": harmonics}
    tables = {
        "title": f"{path.stem}: {sensors} sensors",
        "model": model | standardise,
        "network": _network(sensors, choice),
        "data": {"file": "records.csv", "from": _shown(rest)},
        "filter": {"name": "structural", "false_alarm": choice.false_alarm, "isolate": True},
    }
    facts = [
        ("sensors", f"{sensors}: {', '.join(records.stations[:12])}{', ..' if sensors > 12 else ''}"),
        ("records", f"{len(records.dates)}, every {records.step:g} s, {records.dates[0]} to {records.dates[-1]}"),
        ("model", f"fitted up to {last}: {count(choice.factors, 'state')}, {count(harmonics, 'harmonic')} of a year"),
    ]
    notes = [
        *records.notes,
        "the records up to the end of the fit are taken as right; --to chooses another end",
        "a model that was fitted alarms more often than asked: garrison calibrate finds what to ask for, from "
        f"{1 / choice.false_alarm:.0f} tests on (one per sensor and record after the fit) for the rate asked for",
    ]
    return RecordsBundle(tables, SOURCE, None, None, facts, notes, copies)


def _split(records: Records, clean: Moment | None) -> tuple[Moment, Moment]:
    """Last record of the fit, first record after it."""
    if clean is not None:
        clean = records.of_same_kind("--to", clean, last=True)
    k = len(records.dates) // 2 if clean is None else records.index("--to", clean) + 1
    if not _FEWEST <= k <= len(records.dates) - 2:
        span = f"{records.dates[_FEWEST - 1]} to {records.dates[-3]}"
        raise refusal("--to", str(clean), f"a moment from {span}, so that there are records for the fit and after it")
    return records.dates[k - 1], records.dates[k]


def _shown(moment: Moment) -> str | float:
    return (
        moment.isoformat(sep=" ")
        if isinstance(moment, dt.datetime)
        else str(moment)
        if isinstance(moment, dt.date)
        else moment
    )


def _network(sensors: int, choice: Choice) -> dict[str, object]:
    if choice.stations is not None:
        return {"stations": "stations.csv", "radius_km": choice.radius}
    return {"kind": "complete", "agents": sensors}
