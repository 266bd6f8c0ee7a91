"""CSV files of the world: separators, decimals, times, gaps, units, names."""

import datetime as dt
from pathlib import Path

import garrison as gr
import numpy as np
import pytest
from garrison.scenario.section import moment
from garrison.tables import read_matrix, read_records, read_rows

nan = float("nan")
DAYS = [dt.date(2024, 1, 1), dt.date(2024, 1, 2), dt.date(2024, 1, 3)]
MONTHS = [dt.date(2024, m, 1) for m in (1, 2, 3)]
NOON = [dt.datetime(2024, 1, 13, h) for h in (11, 12, 13)]
HOURS = [dt.datetime(2024, 1, 1, h) for h in (0, 1, 2)]


def write(folder: Path, text: str, encoding: str = "utf-8") -> Path:
    path = folder / "x.csv"
    path.write_bytes(text.encode(encoding))
    return path


SAME = {
    "commas": "date,A,B\n2024-01-01,1.5,2\n2024-01-02,2.5,3\n2024-01-03,,4\n",
    "semicolons": "date;A;B\n2024-01-01;1.5;2\n2024-01-02;2.5;3\n2024-01-03;;4\n",
    "decimal commas": "date;A;B\n2024-01-01;1,5;2\n2024-01-02;2,5;3\n2024-01-03;;4\n",
    "tabs": "date\tA\tB\n2024-01-01\t1,5\t2\n2024-01-02\t2,5\t3\n2024-01-03\t\t4\n",
    "bars": "date|A|B\n2024-01-01|1.5|2\n2024-01-02|2.5|3\n2024-01-03|NA|4\n",
    "carriage returns": "date,A,B\r\n2024-01-01,1.5,2\r\n2024-01-02,2.5,3\r\n2024-01-03,,4\r\n",
    "blank last line": "date,A,B\n2024-01-01,1.5,2\n2024-01-02,2.5,3\n2024-01-03,,4\n\n  \n",
    "trailing commas": "date,A,B,\n2024-01-01,1.5,2,\n2024-01-02,2.5,3,\n2024-01-03,,4,\n",
    "trailing commas, not in the header": "date,A,B\n2024-01-01,1.5,2,\n2024-01-02,2.5,3,\n2024-01-03,,4,\n",
    "comments": "# from a logger\ndate,A,B\n2024-01-01,1.5,2\n# pause\n2024-01-02,2.5,3\n2024-01-03,,4\n",
    "header in a comment": "# logger 7\n#date,A,B\n2024-01-01,1.5,2\n2024-01-02,2.5,3\n2024-01-03,,4\n",
    "quotes": '"date","A","B"\n"2024-01-01","1.5","2"\n"2024-01-02","2.5","3"\n"2024-01-03","","4"\n',
    "blanks": "date , A , B\n 2024-01-01 , 1.5 , 2\n 2024-01-02 , 2.5 , 3\n 2024-01-03 ,  , 4\n",
    "missing words": "date,A,B\n2024-01-01,1.5,2\n2024-01-02,2.5,3\n2024-01-03,n/a,4\n",
    "no newline at the end": "date,A,B\n2024-01-01,1.5,2\n2024-01-02,2.5,3\n2024-01-03,null,4",
    "slashes, day first": "date,A,B\n1/1/2024,1.5,2\n2/1/2024,2.5,3\n13/1/2024,,4\n",
    "points": "Datum;A;B\n01.01.2024;1,5;2\n02.01.2024;2,5;3\n03.01.2024;;4\n",
    "year first": "date,A,B\n2024/01/01,1.5,2\n2024/01/02,2.5,3\n2024/01/03,,4\n",
    "separator told first": "sep=;\ndate;A;B\n2024-01-01;1,5;2\n2024-01-02;2,5;3\n2024-01-03;;4\n",
    "midnight": "date,A,B\n2024-01-01 00:00,1.5,2\n2024-01-02 00:00,2.5,3\n2024-01-03 00:00,,4\n",
    "exponents": "date,A,B\n2024-01-01,15e-1,2E0\n2024-01-02,+2.5,3.\n2024-01-03,-,.4e1\n",
}


@pytest.mark.parametrize("kind", SAME)
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
def test_one_table_in_many_forms(tmp_path: Path, kind: str, encoding: str) -> None:
    text = SAME[kind]
    found = read_records(write(tmp_path, text, encoding))
    assert found.stations == ["A", "B"]
    if kind == "slashes, day first":  # the 13th says which is the day
        assert found.dates[0] == dt.date(2024, 1, 1) and found.dates[-1] == dt.date(2024, 1, 13)
        assert np.isnan(found.values[2:12]).all() and "10 missing rows" in found.notes[0]
        found = type(found)(DAYS, found.stations, found.values[[0, 1, 12]])
    assert found.dates == DAYS
    np.testing.assert_array_equal(found.values, [[1.5, 2], [2.5, 3], [nan, 4]])
    assert found.step == 86400 and found.samples_per_year == 365.25


CLOCKS = {
    "hourly": ("2024-01-01 00:00", "2024-01-01 01:00", "2024-01-01 02:00", HOURS, 3600),
    "T and seconds": ("2024-01-01T00:00:00", "2024-01-01T01:00:00", "2024-01-01T02:00:00", HOURS, 3600),
    "UTC": ("2024-01-01T00:00Z", "2024-01-01T01:00Z", "2024-01-01T02:00Z", HOURS, 3600),
    "time zone": ("2024-01-01T02:00+02:00", "2024-01-01T03:00+02:00", "2024-01-01T04:00+02:00", HOURS, 3600),
    "zone that changes": ("2024-01-01T02:00+02:00", "2024-01-01T02:00+01:00", "2024-01-01T03:00+01:00", HOURS, 3600),
    "points and time": ("01.01.2024 00:00", "01.01.2024 01:00", "01.01.2024 02:00", HOURS, 3600),
    "seconds": ("0", "0.5", "1.0", [0.0, 0.5, 1.0], 0.5),
    "rounded seconds": ("0.00", "0.33", "0.67", [0.0, 0.33, 0.67], 0.335),
    "milliseconds since 1970": ("1704067200000", "1704070800000", "1704074400000", HOURS, 3600),
    "microseconds since 1970": ("1704067200000000", "1704070800000000", "1704074400000000", HOURS, 3600),
    "nanoseconds since 1970": ("1704067200000000000", "1704070800000000000", "1704074400000000000", HOURS, 3600),
    "seconds since 1970": ("1704067200", "1704070800", "1704074400", HOURS, 3600),
    "seconds since 1970, with parts": ("1704067200.0", "1704070800.000", "1.7040744e9", HOURS, 3600),
    "seconds since 1970, days": ("1704067200", "1704153600", "1704240000", DAYS, 86400),
    "months as ISO": ("2024-01", "2024-02", "2024-03", MONTHS, 30.4375 * 86400),
    "months, the year last": ("01/2024", "02/2024", "03/2024", MONTHS, 30.4375 * 86400),
    "months in words": ("Jan 2024", "February 2024", "Mar 2024", MONTHS, 30.4375 * 86400),
    "days in words": ("1 Jan 2024", "2 January 2024", "Jan 3 2024", DAYS, 86400),
    "compact days": ("20240101", "20240102", "20240103", DAYS, 86400),
    "compact": ("20240101T000000", "20240101T010000", "20240101T020000", HOURS, 3600),
    "compact, short": ("20240101T00", "20240101T0100", "20240101T02", HOURS, 3600),
    "compact, UTC": ("20240101T000000Z", "20240101T010000Z", "20240101T030000+0100", HOURS, 3600),
    "compact, no T": ("20240101000000", "20240101010000", "20240101020000", HOURS, 3600),
    "compact, minutes": ("202401010000", "202401010100", "202401010200", HOURS, 3600),
    "compact, hours": ("2024010100", "2024010101", "2024010102", HOURS, 3600),
    "clock of 12 hours": ("1/13/2024 11:00 AM", "1/13/2024 12:00 PM", "1/13/2024 1:00 PM", NOON, 3600),
    "clock of 12 hours, ISO": ("2024-01-13 11:00am", "2024-01-13 12:00 p.m.", "2024-01-13 01:00:00 pm", NOON, 3600),
    "midnight of 12 hours": ("2024-01-01 12:00 AM", "2024-01-01 1:00 AM", "2024-01-01 2:00 AM", HOURS, 3600),
    "end of the day": ("2023-12-31 24:00", "2024-01-01 01:00", "2024-01-01 02:00", HOURS, 3600),
    "times of the day": ("12:00:00", "12:00:30", "12:01:00", [43200.0, 43230.0, 43260.0], 30),
    "elapsed time": ("0:00:00.0", "0:00:00.5", "0:00:01.0", [0.0, 0.5, 1.0], 0.5),
    "zone by name": ("2024-01-01 00:00 UTC", "2024-01-01 01:00 UTC", "2024-01-01 02:00 UTC", HOURS, 3600),
    "milliseconds since 1970, days": ("1704067200000", "1.704153600e12", "1704240000000", DAYS, 86400),
    "tenths of a second": (
        "2024-01-01 00:00:00.000",
        "2024-01-01 00:00:00.100",
        "2024-01-01 00:00:00.200",
        [dt.datetime(2024, 1, 1, 0, 0, 0, k * 100000) for k in range(3)],
        0.1,
    ),
    "ends of months": (
        "2024-01-31",
        "2024-02-29",
        "2024-03-31",
        [dt.date(2024, *d) for d in ((1, 31), (2, 29), (3, 31))],
        30.4375 * 86400,
    ),
    "weekly": ("2024-01-01", "2024-01-08", "2024-01-15", [dt.date(2024, 1, d) for d in (1, 8, 15)], 7 * 86400),
    "monthly": ("2024-01-01", "2024-02-01", "2024-03-01", [dt.date(2024, m, 1) for m in (1, 2, 3)], 30.4375 * 86400),
    "yearly": ("2022-07-01", "2023-07-01", "2024-07-01", [dt.date(y, 7, 1) for y in (2022, 2023, 2024)], 31557600),
}


@pytest.mark.parametrize("kind", CLOCKS)
def test_any_regular_period(tmp_path: Path, kind: str) -> None:
    *cells, dates, step = CLOCKS[kind]
    rows = "".join(f"{cell},{k}\n" for k, cell in enumerate(cells))
    found = read_records(write(tmp_path, f"time,A\n{rows}"))
    assert found.dates == dates
    assert found.step == pytest.approx(step, rel=1e-12)
    assert found.values.ravel().tolist() == [0, 1, 2]


@pytest.mark.parametrize(("first", "factor"), [("t [min]", 60), ("t [h]", 3600)])
def test_large_numbers_of_another_unit_are_no_dates(tmp_path: Path, first: str, factor: float) -> None:
    found = read_records(write(tmp_path, f"{first},A\n1704067200,0\n1704067201,1\n1704067202,2\n"))
    assert found.step == factor and found.dates[0] == 1704067200 * factor


def test_years_and_hours_by_their_name(tmp_path: Path) -> None:
    years = read_records(write(tmp_path, "year,A\n1990,1\n1991,2\n1993,3\n"))
    assert years.dates == [dt.date(y, 1, 1) for y in (1990, 1991, 1992, 1993)]
    assert read_records(write(tmp_path, "hour,A\n0,1\n1,2\n2,3\n")).step == 3600


@pytest.mark.parametrize("separator", [",", ";", " "])
def test_dates_and_times_of_day_in_two_columns(tmp_path: Path, separator: str) -> None:
    text = "date,time,A\n2024-01-01,00:00,1\n2024-01-01,01:00,2\n2024-01-01,02:00:00,3\n"
    found = read_records(write(tmp_path, text.replace(",", separator)))
    assert found.dates == HOURS and found.stations == ["A"]


ENDS = [
    ("1961-03", "1961-04", dt.date(1961, 3, 1), dt.date(1961, 4, 30)),
    ("1962", "1963", dt.date(1962, 1, 1), dt.date(1963, 12, 31)),
    ("19620301", "3 Mar 1962", dt.date(1962, 3, 1), dt.date(1962, 3, 3)),
]


@pytest.mark.parametrize(("start", "end", "first", "last"), ENDS)
def test_ends_of_a_choice_may_be_months_and_years(
    wind: Path, start: str, end: str, first: dt.date, last: dt.date
) -> None:
    found = read_records(wind / "irish_wind.csv").between(moment("--from", start), moment("--to", end, last=True))
    assert (found.dates[0], found.dates[-1]) == (first, last)


def test_a_number_that_is_no_year_is_called_a_number(wind: Path) -> None:
    records = read_records(wind / "irish_wind.csv")
    with pytest.raises(gr.InvalidInput, match=r"^to: got the number 12, expected a date YYYY-MM-DD, a month or a year"):
        records.between(None, 12.0)
    for wrong in ("1962-13", "soon", "1/2/1962", ""):
        with pytest.raises(gr.InvalidInput, match="expected a date YYYY-MM-DD"):
            moment("--to", wrong)


def test_days_are_no_seconds(tmp_path: Path) -> None:
    assert read_records(write(tmp_path, "day,A\n0,1\n1,2\n2,2\n")).step == 86400
    assert read_records(write(tmp_path, "day [h],A\n0,1\n1,2\n2,2\n")).step == 3600


def test_gaps_become_missing_records(tmp_path: Path) -> None:
    found = read_records(write(tmp_path, "time,A\n2024-01-01,1\n2024-01-02,2\n2024-01-05,3\n"))
    np.testing.assert_array_equal(found.values.ravel(), [1, 2, nan, nan, 3])
    assert found.dates[3] == dt.date(2024, 1, 4)
    assert found.notes == ["x.csv: 2 missing rows between the first and the last one, read as missing records"]


def test_units_are_kept_and_are_no_part_of_the_name(tmp_path: Path) -> None:
    found = read_records(write(tmp_path, "t [s],flow [/min],temp (degC),p\n0,1,2,3\n1,1,2,3\n"))
    assert found.stations == ["flow", "temp", "p"]
    assert found.units == ["/min", "degC", ""]


@pytest.mark.parametrize(
    ("unit", "seconds"), [("ms", 1e-3), ("us", 1e-6), ("\u00b5s", 1e-6), ("min", 60), ("h", 3600), ("s", 1), ("k", 1)]
)
def test_units_of_the_time_count(tmp_path: Path, unit: str, seconds: float) -> None:
    found = read_records(write(tmp_path, f"t [{unit}],A\n0,1\n2,1\n4,2\n"))
    assert found.step == pytest.approx(2 * seconds)


QUOTED = {
    "between commas": 'date,A,B\n2024-01-01,"1,5","2,0"\n2024-01-02,"2,5",3\n2024-01-03,,4\n',
    "between semicolons": 'date;A;B\n2024-01-01;"1,5";"2,0"\n2024-01-02;"2,5";"3"\n2024-01-03;;"4"\n',
    "three places, but not alone": 'date,A,B\n2024-01-01,"1,500","2,0"\n2024-01-02,"2,500",3\n2024-01-03,,4\n',
    "below one": 'date,A,B\n2024-01-01,"0,1500e1","2"\n2024-01-02,"0,25e1",3\n2024-01-03,,4\n',
}


@pytest.mark.parametrize("kind", QUOTED)
def test_quoted_decimal_commas(tmp_path: Path, kind: str) -> None:
    found = read_records(write(tmp_path, QUOTED[kind]))
    np.testing.assert_array_equal(found.values, [[1.5, 2], [2.5, 3], [nan, 4]])


DECIDED = {
    "below one": "date;A;B\n1;1,234;0,500\n2;2,345;3,000\n",
    "other places": "date;A;B\n1;1,234;2,5\n2;2,345;3,000\n",
    "no separator beside": "date;A;B\n1;1,234;2,500\n2;2,345;1500\n",
}


@pytest.mark.parametrize("kind", DECIDED)
def test_the_whole_file_says_what_a_comma_is(tmp_path: Path, kind: str) -> None:
    found = read_records(write(tmp_path, DECIDED[kind].replace("date", "t")))
    assert found.values[:, 0].tolist() == [1.234, 2.345] and found.notes == []


def test_a_comma_that_nothing_decides_is_said(tmp_path: Path) -> None:
    found = read_records(write(tmp_path, "t;A\n1;1,234\n2;2,345\n"))
    assert found.values.ravel().tolist() == [1.234, 2.345]
    (note,) = found.notes
    assert note.startswith("x.csv: 1,234 is read as 1.234, with a decimal comma; if it separates thousands")
    notes: list[str] = []
    path = write(tmp_path, "1,234;2,345\n1,500;2,000\n")
    assert read_matrix(path, notes=notes)[0].tolist() == [1.234, 2.345] and len(notes) == 1
    with pytest.raises(gr.InvalidInput, match="separates thousands"):
        read_matrix(path)


def test_a_matrix_with_quoted_decimal_commas(tmp_path: Path) -> None:
    np.testing.assert_array_equal(read_matrix(write(tmp_path, '"0,9","0,1"\n"0","0,5"\n')), [[0.9, 0.1], [0, 0.5]])


def test_a_square_matrix_has_no_gaps(tmp_path: Path) -> None:
    for cell in ("nan", "", "inf", "NA"):
        with pytest.raises(gr.InvalidInput, match=r"x\.csv, line 2, column 1: got .*, expected a finite number"):
            read_matrix(write(tmp_path, f"1,2\n{cell},4\n"), square=True)


HEADLESS = ["the first row", "which looks like data", "a header", "put one above"]
REFUSED = {
    "years of two digits": ("date,A\n13/01/24,1\n14/01/24,2\n", ["line 2", "'13/01/24'", "YYYY-MM-DD"]),
    "days of a spreadsheet": ("date,A\n45292,1\n45293,2\n", ["line 2", "the date '45292'", "YYYY-MM-DD"]),
    "beyond all doubles": ("date,A\n2024-01-01,1e400\n2024-01-02,2\n", ["line 2, column A", "'1e400'"]),
    "thousands in quotes": ('date,A\n2024-01-01,"1,234"\n2024-01-02,"2,345"\n', ["'1,234'", "thousands"]),
    "thousands, some without": ("date;A\n2024-01-01;1,234\n2024-01-02;987\n", ["'1,234'", "thousands"]),
    "minutes or hours": ("t,A\n12:00,1\n12:05,2\n", ["line 2", "'12:00'", "YYYY-MM-DD"]),
    "past midnight": ("t,A\n23:59:59,1\n00:00:00,2\n", ["line 3", "a time before"]),
    "times elsewhere": ("t,A\n0,2020-01-01\n1,2020-01-02\n", ["column A", "the column of times comes first"]),
    "blanks between thousands": ("t,A\n0,1 234\n1,2\n", ["column A", "nothing between thousands"]),
    "commas between thousands": ("t;A\n0;1,234,567\n1;2\n", ["column A", "nothing between thousands"]),
    "per cent": ("t,A\n0,5%\n1,2\n", ["column A", "'5%'", "units in the header"]),
    "units": ("t,A\n0,5.1 m/s\n1,2\n", ["column A", "'5.1 m/s'", "units in the header"]),
    "words": ("t,A\n0,broken\n1,2\n", ["column A", "'broken', expected a number or an empty cell"]),
    "13 pm": ("t,A\n2024-01-01 13:00 pm,1\n2024-01-01 2:00 pm,2\n", ["line 2", "13:00 pm"]),
    "no month": ("t,A\n2024-13,1\n2024-02,2\n", ["line 2", "2024-13"]),
    "twice": ("date,A,A\n2024-01-01,1,2\n2024-01-02,1,2\n", ["line 1", "'A' twice (columns 1 and 2)"]),
    "empty name": ("date,A,\n2024-01-01,1,2\n2024-01-02,1,2\n", ["line 1", "no name for column 2"]),
    "duplicate": ("date,A\n2024-01-01,1\n2024-01-01,2\n", ["line 3", "the same time", "remove the duplicate"]),
    "clocks go back": ("t,A\n2024-10-27 02:00,1\n2024-10-27 02:00,2\n", ["line 3", "where clocks change", "zone"]),
    "backwards": ("date,A\n2024-01-02,1\n2024-01-01,2\n", ["line 3", "before", "sort"]),
    "irregular": ("date,A\n2024-01-01,1\n2024-01-03,2\n2024-01-06,2\n", ["line 4", "whole number of periods of 2 day"]),
    "one row off": (
        "t,A\n" + "".join(f"{k + (0.4 if k == 5 else 0)},{k}\n" for k in range(9)),
        ["line 7", "got 5.4 after 4.0, expected a whole number of periods of 1 s later"],
    ),
    "one date off": (
        "t,A\n" + "".join(f"2024-01-{k:02}{'T06:00' * (k == 7)},1\n" for k in range(1, 12)),
        ["line 8", "2024-01-07 06:00:00 after 2024-01-06", "periods of 1 day later"],
    ),
    "a title": ("Records of 2024\ndate,A\n2024-01-01,1\n2024-01-02,2\n", ["line 1", "above rows of 2 columns"]),
    "mixed zones": ("t,A\n2024-01-01T00:00Z,1\n2024-01-01T01:00,2\n", ["line 3", "without a time zone"]),
    "ambiguous": ("date,A\n1/2/2024,1\n1/3/2024,2\n", ["either order", "YYYY-MM-DD"]),
    "text": ("date,A,B\n2024-01-01,1,2\n2024-01-02,x,y\n", ["line 3, column A", "'x'", "also in column B"]),
    "underscore": ("date,A\n2024-01-01,1_0.5\n2024-01-02,1\n", ["line 2, column A", "'1_0.5'"]),
    "thousands": ("date;A\n2024-01-01;1.234,5\n2024-01-02;1\n", ["line 2, column A", "1.234,5"]),
    "decimal comma between commas": ("date,A\n2024-01-01,51,93\n2024-01-02,1\n", ["line 2", "3 columns", "expected 2"]),
    "no time": ("A,B\n1,2\n2,3\n", ["without times"]),
    "empty time": ("date,A\n2024-01-01,1\n,2\n", ["line 3", "no time"]),
    "not a date": ("date,A\n2024-01-01,1\nsoon,2\n", ["line 3", "'soon'"]),
    "not a day": ("date,A\n2024-02-30,1\n2024-03-01,2\n", ["line 2", "'2024-02-30', expected a day of the calendar"]),
    "no header, but dates": ("2024-01-01,1\n2024-01-02,1\n2024-01-03,2\n", HEADLESS),
    "no header": ("1,2\n3,4\n5,6\n", HEADLESS),
    "no header, months": ("2024-01,1\n2024-02,1\n2024-03,2\n", HEADLESS),
    "no header, compact": ("20240101T000000,1\n20240101T010000,1\n", HEADLESS),
    "no header, 12 hours": ("1/13/2024 1:00 PM,1\n1/13/2024 2:00 PM,1\n", HEADLESS),
    "no header, since 1970": ("1704067200,1\n1704070800,1\n", HEADLESS),
    "no header, decimal commas": ("0,5;1,5\n1,5;2,5\n2,5;2,5\n", HEADLESS),
    "no header, gaps": ("0,NA,1\n1,2,2\n2,3,3\n", HEADLESS),
    "no header, words first": ("DUB,1.5,2\nCLA,2,3\nRPT,2,3\n", HEADLESS),
    "one row": ("date,A\n2024-01-01,1\n", ["1 row", "at least two"]),
    "nothing": ("", ["an empty file"]),
    "only the time": ("date\n2024-01-01\n2024-01-02\n", ["no column besides the time"]),
    "few rows, long gap": ("t,A\n0,1\n1,2\n1000000,2\n", ["fewer gaps"]),
}


@pytest.mark.parametrize("kind", REFUSED)
def test_what_is_refused(tmp_path: Path, kind: str) -> None:
    text, words = REFUSED[kind]
    with pytest.raises(gr.InvalidInput) as caught:
        read_records(write(tmp_path, text))
    for word in words:
        assert word in str(caught.value), str(caught.value)


@pytest.mark.parametrize("data", [b"\xff\xfe\x00", b"\x80\x81", b"date,A\n\x00\x00,1\n"])
def test_what_is_no_text(tmp_path: Path, data: bytes) -> None:
    (tmp_path / "x.csv").write_bytes(data)
    with pytest.raises(gr.IoError, match="readable CSV"):
        read_records(tmp_path / "x.csv")


@pytest.mark.parametrize(("value", "words"), [(-9999, "-9999"), (-999, "-999"), (1e6, "1e+06")])
def test_suspicious_constants_are_named(tmp_path: Path, value: float, words: str) -> None:
    cells = [str(10 + k % 7) for k in range(40)]
    cells[5] = cells[9] = f"{value:g}"
    rows = "".join(f"{k},{c}\n" for k, c in enumerate(cells))
    (note,) = read_records(write(tmp_path, f"t,A\n{rows}")).notes
    assert "column A: 2 values such as " + words in note and "robust deviations off" in note
    plain = "".join(f"{k},{10 + k % 7}\n" for k in range(40))
    assert read_records(write(tmp_path, f"t,A\n{plain}")).notes == []


def test_a_signal_that_passes_through_all_values_on_its_way_is_none(tmp_path: Path) -> None:
    """A car at a steady speed that brakes and goes on: the slow part is hundreds of robust deviations off."""
    speed = [20.0 + 0.01 * np.sin(7.3 * k) for k in range(300)]
    speed[200:240] = [20.0 - 0.8 * min(k, 40 - k) for k in range(40)]
    rows = "".join(f"{k},{v:.4f}\n" for k, v in enumerate(speed))
    assert read_records(write(tmp_path, f"t,A\n{rows}")).notes == []
    speed[100] = -9999.0
    rows = "".join(f"{k},{v:.4f}\n" for k, v in enumerate(speed))
    (note,) = read_records(write(tmp_path, f"t,A\n{rows}")).notes
    assert "such as -9999" in note


def test_a_constant_within_the_spread_of_a_column_is_named(tmp_path: Path) -> None:
    cells = [f"{-999 if k % 9 == 5 else 700 * np.sin(7.3 * k):g}" for k in range(60)]
    (note,) = read_records(write(tmp_path, "t,A\n" + "".join(f"{k},{c}\n" for k, c in enumerate(cells)))).notes
    assert "column A: 7 values of exactly -999" in note and "make the cells empty" in note
    cells = [f"{-99.9 if k % 9 == 5 else 12 + round(2 * np.sin(7.3 * k), 1):g}" for k in range(90)]
    (note,) = read_records(write(tmp_path, "t,A\n" + "".join(f"{k},{c}\n" for k, c in enumerate(cells)))).notes
    assert "column A: 10 values of exactly -99.9" in note or "10 values such as -99.9" in note
    once = ["-999" if k == 5 else f"{700 * np.sin(7.3 * k):g}" for k in range(60)]
    assert read_records(write(tmp_path, "t,A\n" + "".join(f"{k},{c}\n" for k, c in enumerate(once)))).notes == []


@pytest.mark.parametrize(
    ("name", "first", "step", "doubted"),
    [
        ("time", 44197, 1, True),
        ("time", 44197.5, 1 / 24, True),
        ("time [s]", 44197, 1, False),
        ("time [d]", 44197, 1, False),
        ("time", 0, 1, False),
        ("day", 44197, 1, False),
        ("time", 737791, 1, True),
        ("time", 2459215.5, 1, True),
    ],
)
def test_day_numbers_of_spreadsheets_are_doubted(
    tmp_path: Path, name: str, first: float, step: float, doubted: bool
) -> None:
    rows = "".join(f"{first + step * k:.10g},{k % 5}\n" for k in range(30))
    notes = read_records(write(tmp_path, f"{name},A\n{rows}")).notes
    assert any("are read as seconds; if they are" in note for note in notes) == doubted
    with pytest.raises(gr.InvalidInput, match="format the column as a date"):
        read_records(write(tmp_path, "date,A\n44197,1\n44198,2\n44199,3\n"))


def test_fit_says_so(tmp_path: Path, wind: Path, capsys: pytest.CaptureFixture[str]) -> None:
    from garrison.cli import main

    lines = (wind / "irish_wind.csv").read_text().splitlines()[:400]
    lines[50] = lines[50].replace(lines[50].split(",")[1], "-9999", 1)
    path = write(tmp_path, "\n".join(lines))
    assert main(["fit", str(path), "-o", str(tmp_path / "m.json")]) == 0
    assert "warning: x.csv: column RPT: 1 value such as -9999" in capsys.readouterr().err


@pytest.mark.parametrize(
    "text",
    [
        "1,2\n3,4\n",
        "1;2\n3;4\n",
        "1 2\n3 4\n",
        "1\t2\n3\t4",
        "a,b\n1,2\n3,4\n",
        "1,2,\n3,4,\n",
        "# A\n1,2\n\n3,4\n\n",
        "1.0;2\n3;4",
    ],
)
def test_matrices(tmp_path: Path, text: str) -> None:
    np.testing.assert_array_equal(read_matrix(write(tmp_path, text)), [[1, 2], [3, 4]])


def test_a_single_column_and_a_row_of_missing_values(tmp_path: Path) -> None:
    np.testing.assert_array_equal(read_matrix(write(tmp_path, "1\n2\n3\n")), [[1], [2], [3]])
    np.testing.assert_array_equal(read_matrix(write(tmp_path, "1,2\n,\n3,4\n")), [[1, 2], [nan, nan], [3, 4]])
    assert read_rows(write(tmp_path, "1,2\n")).separator == ","


def test_times_beyond_the_records_are_noted(wind: Path) -> None:
    records = read_records(wind / "irish_wind.csv")
    assert records.between(dt.date(1961, 1, 1), dt.date(1978, 12, 31)).notes == records.notes
    assert records.between(dt.date(1950, 1, 1), dt.date(1999, 1, 1)).notes[-2:] == [
        "from 1950-01-01: the records begin later, at 1961-01-01",
        "to 1999-01-01: the records end earlier, at 1978-12-31",
    ]


def test_records_match_by_name_and_period(wind: Path) -> None:
    records = read_records(wind / "irish_wind.csv").between(None, dt.date(1962, 12, 31))
    found = gr.fit(records, factors=1)
    turned = type(records)(records.dates, records.stations[::-1], records.values[:, ::-1])
    np.testing.assert_array_equal(found.measurements(turned), found.measurements(records))
    with pytest.raises(gr.InvalidInput, match="also RPT"):
        found.measurements(records.of(records.stations[1:]))
    hourly = type(records)(records.dates, records.stations, records.values, 3600.0)
    with pytest.raises(gr.InvalidInput, match="a period of 3600 s"):
        found.measurements(hourly)


def test_hourly_records_have_a_year_of_hours(tmp_path: Path) -> None:
    rng = np.random.default_rng(1)
    start = dt.datetime(2024, 1, 1)
    lines = [f"{start + dt.timedelta(hours=k)},{a:.3f},{b:.3f}" for k, (a, b) in enumerate(rng.normal(size=(400, 2)))]
    records = read_records(write(tmp_path, "time,A,B\n" + "\n".join(lines)))
    assert records.samples_per_year == 8766
    assert gr.fit(records, factors=1, harmonics=1).model.states == 1
    cut = records.between(dt.date(2024, 1, 2), dt.date(2024, 1, 3))
    assert (cut.dates[0], cut.dates[-1]) == (dt.datetime(2024, 1, 2), dt.datetime(2024, 1, 3, 23))
    with pytest.raises(gr.InvalidInput, match="a date YYYY-MM-DD"):
        records.between(5.0, None)


def test_fit_speaks_of_stations_by_name(tmp_path: Path) -> None:
    rng = np.random.default_rng(0)
    rows = [f"{k},{a:.3f},{a + b:.3f},7" for k, (a, b) in enumerate(rng.normal(size=(200, 2)))]
    records = read_records(write(tmp_path, "t,north,south,dead\n" + "\n".join(rows)))
    with pytest.raises(gr.InvalidInput, match=r"^station dead: got records without variation"):
        gr.fit(records, period=20, harmonics=1)
    values = records.values.copy()
    values[3, 1] = np.inf
    with pytest.raises(gr.InvalidInput, match=r"^station south, record of 3\.0: got inf"):
        gr.fit(type(records)(records.dates, records.stations, values), period=20, harmonics=1)


@pytest.mark.parametrize("time", ["date", "year,month,day"])
def test_rows_of_separators_alone_are_left_out(tmp_path: Path, time: str) -> None:
    rows = [f"2024-01-{k:02},{k}" for k in range(1, 6)]
    if time != "date":
        rows = [row.replace("-", ",") for row in rows]
    empty = "," * rows[0].count(",")
    expected = read_records(write(tmp_path, "\n".join([f"{time},A", *rows])))
    got = read_records(write(tmp_path, "\n".join([f"{time},A", *rows[:3], empty, *rows[3:], empty, empty])))
    assert got.dates == expected.dates
    assert np.array_equal(got.values, expected.values)


def test_infinite_values_are_said_aloud(tmp_path: Path) -> None:
    got = read_records(write(tmp_path, "date,A\n2024-01-01,1\n2024-01-02,inf\n2024-01-03,2\n"))
    assert np.isinf(got.values[1, 0])
    assert any("column A: 1 infinite value" in note for note in got.notes)
