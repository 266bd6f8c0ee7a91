"""Mutated scenarios and CSV files: success, a check that fails, or one line of refusal; never a traceback or a bug."""

import random
import re
from pathlib import Path

import pytest
from garrison.cli import main

SEED = 20240607
SCENARIOS, TABLES = 200, 100
#: exit codes, in words
ENDS = {0: "fine", 1: "with a check that fails", 2: "refused in one line"}

#: values that people and machines put where something else belongs
_LONG = "1" + 400 * "0"
VALUES = [
    "0", "-1", "1", "2.5", "1e308", "nan", "inf", "-inf", "2147483647", "9223372036854775807", "99999999999999999999",
    _LONG, f"[{_LONG}]",
   
    "true", "false", '""', '"x"', '"10%"', '"nan"', '"DUB"', "[]", "[[]]", "[1]", "[1, 2]", "[[1, 2], [3]]", '["a"]',
    "[[0, 1], [1, 2]]", "{}", "{ file = 'x.csv' }", "{ file = 3 }", "1961-02-01", "1961-02-01T10:00:00Z", "07:32:00",
    '"1961-03-01"', '"ring"', '"../../etc/passwd"', "[true]", "[nan, 1.0]", "'''a\nb'''", '"\\u0000"', '"[/b] $x_$"',
]  # fmt: skip
CELLS = [
    "", " ", "NA", "nan", "inf", "-9999", "1e400", "1e-400", "1_0", "0x10", "1,5", "1.2.3", "x", "[/]",
    "\u22121", "\ufeff", "\x00",
    '"', '"a,b"', "2024-13-01", "1/2/2024", "00:00", "2024-01-01T00:00Z", "\t", ";", "#", "१", "--", "1e5", "1 2",
]  # fmt: skip

PLANT = """
title = "t"
[model]
A = [[1.0, 0.1], [0.0, 0.9]]
C = [[1, 0], [0, 1], [1, 0], [0, 1], [1, 0]]
process_bound = 0.02
measurement_bound = 0.01
process_covariance = [[0.1, 0.0], [0.0, 0.1]]
measurement_covariance = [[[0.1]], [[0.1]], [[0.1]], [[0.1]], [[0.1]]]
[network]
kind = "band"
range = 2
[filter]
name = "saturation"
threshold = 2.0
rounds = 3
attacked = 1
initial_error = 2.0
detector = false
[[compare]]
name = "structural"
false_alarm = 0.01
window = 2
[[compare]]
name = "partial_sharing"
gain = 0.05
[[compare]]
name = "rdkf"
penalty = "huber"
[[attack]]
kind = "bias"
agents = [1]
value = 5.0
start = 3
stop = 6
probability = 0.5
[[attack]]
kind = "replay"
schedule = [[2, [0]], [5, [3]]]
delay = 2
[link]
drop = 0.1
delay = 0.1
delay_rounds = 1
[noise]
law = "uniform"
[run]
steps = 8
trials = 2
seed = 3
threads = 1
x0 = [1.0, 1.0]
start = [0.0, 0.0]
start_error = 0.5
"""
WIND = """
[model]
fit = "wind.csv"
to = 1961-04-30
factors = 1
harmonics = 1
root = true
[network]
stations = "stations.csv"
radius_km = 200
[data]
file = "wind.csv"
from = "1961-03-01"
to = "1961-05-01"
[filter]
name = "structural"
label = "s"
isolate = true
[[compare]]
name = "central_kalman"
[[attack]]
kind = "ramp"
agents = ["DUB", 3]
slope = 0.1
start = "1961-03-20"
"""
STRING = """
[model]
vehicles = 6
period = 0.05
[network]
kind = "band"
range = 2
[filter]
name = "platoon"
attacked = 1
process_noise = 0.05
measurement_noise = 0.2
initial_error = 30.0
reference = [0.0, 20.0]
spacing = 25.0
gs = 2.0
gv = 4.0
[run]
steps = 6
start = [[0, 20], [-25, 20], [-50, 20], [-75, 20], [-100, 20], [-125, 20]]
"""


def mutated(text: str, rng: random.Random) -> str:
    """One to three slips: another value, a line lost, doubled, moved or misspelt, brackets changed."""
    lines = text.strip().splitlines()
    for _ in range(rng.choice([1, 1, 1, 2, 3])):
        k = rng.randrange(len(lines))
        line = lines[k]
        slip = rng.randrange(12)
        if slip <= 3 and "=" in line:
            lines[k] = f"{line.split('=')[0]}= {rng.choice(VALUES)}"
        elif slip >= 8:  # another number in place of one
            lines[k] = re.sub(r"\d+(\.\d+)?", lambda m: rng.choice([m[0], "0.5", "1", "2", "3.0", "7"]), line)
        elif slip == 4:
            del lines[k]
        elif slip == 5:
            lines.insert(rng.randrange(len(lines) + 1), line)
        elif slip == 6 and len(line) > 2:
            at = rng.randrange(len(line) - 1)
            lines[k] = line[:at] + line[at + 1] + line[at] + line[at + 2 :]
        elif line.startswith("["):
            lines[k] = line.replace("[[", "[").replace("]]", "]") if "[[" in line else f"[{line}]"
        else:
            lines[k] = line + rng.choice(["]", '"', " # x", "\u2028", ",", "\\"])
    return "\n".join(lines) + "\n"


def mutated_table(text: str, rng: random.Random) -> bytes:
    """One to four slips in a CSV file: cells, rows, separators, encodings."""
    lines = text.strip().splitlines()
    for _ in range(rng.choice([1, 1, 1, 2, 4])):
        slip = rng.randrange(8)
        k = rng.randrange(min(len(lines), 6))
        cells = lines[k].split(",")
        if slip <= 3:
            cells[rng.randrange(len(cells))] = rng.choice(CELLS)
        elif slip == 4:
            del cells[rng.randrange(len(cells))]
        elif slip == 5:
            cells.append(rng.choice(CELLS))
        elif slip == 6:
            lines.insert(rng.randrange(len(lines)), lines[k])
        lines[k] = ",".join(cells)
    body = "\n".join(lines)
    body = body.replace(",", rng.choice([",", ",", ",", ";", "\t", " "])) + rng.choice(
        ["", "\n", "\n\n", "\r\n", "\n,,,\n"]
    )
    data = body.encode(rng.choice(["utf-8", "utf-8", "utf-8-sig", "utf-16", "latin-1"]), "replace")
    return data[: rng.randrange(len(data))] if rng.random() < 0.1 else data


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory, wind: Path) -> Path:
    """A quarter of a year of wind and its stations."""
    path = tmp_path_factory.mktemp("fuzz")
    lines = (wind / "irish_wind.csv").read_text().splitlines()[:150]
    (path / "wind.csv").write_text("\n".join(lines) + "\n")
    (path / "stations.csv").write_text((wind / "stations.csv").read_text())
    return path


def require_orderly(arguments: list[str], what: str, capsys: pytest.CaptureFixture[str]) -> int:
    """Run the command; it must end as documented."""
    capsys.readouterr()
    code = main(arguments)
    err = capsys.readouterr().err
    assert code in (0, 1, 2), f"{code}: {err}\n{what}"
    assert "Traceback" not in err, f"{err}\n{what}"
    if code == 2:
        refusals = [line for line in err.splitlines() if line.startswith("garrison: ")]
        assert len(refusals) == 1 and err.splitlines()[-1] == refusals[0], f"{err!r}\n{what}"
    return code


def test_the_originals_are_fine(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for k, text in enumerate((PLANT, WIND, STRING)):
        (folder / f"fine{k}.toml").write_text(text)
        assert require_orderly(["run", str(folder / f"fine{k}.toml"), "-o", str(folder / f"o{k}")], text, capsys) == 0


def counted(what: str, codes: list[int]) -> str:
    """The figures of one kind of mutants; require_orderly has refused anything else."""
    ends = ", ".join(f"{codes.count(code)} {words}" for code, words in ENDS.items())
    return f"{what}: {len(codes)} mutated, {ends}; no traceback, no bug"


def test_mutated_scenarios(folder: Path, figures: list[str], seed: int, capsys: pytest.CaptureFixture[str]) -> None:
    rng = random.Random(SEED + seed)
    path = folder / "mutant.toml"
    codes = []
    for _ in range(SCENARIOS):
        text = mutated(rng.choice([PLANT, PLANT, WIND, STRING]), rng)
        path.write_text(text, encoding="utf-8")
        codes.append(require_orderly(["check", str(path)], text, capsys))
    figures.append(counted("scenarios", codes))
    assert 10 < codes.count(2) < SCENARIOS - 10  # neither all of them wrong, nor none


def test_what_check_accepts_runs(
    folder: Path, figures: list[str], seed: int, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """`check` looks at everything that `run` will look at."""
    monkeypatch.setattr("garrison._commands.run._write_pictures", lambda *a: None)  # slow, and tested elsewhere
    rng = random.Random(SEED + seed + 1)
    path, out = folder / "twice.toml", folder / "twice"
    codes = []
    for _ in range(60):
        text = mutated(rng.choice([PLANT, WIND, STRING]), rng)
        path.write_text(text, encoding="utf-8")
        checked = require_orderly(["check", str(path)], text, capsys)
        ran = require_orderly(["run", str(path), "-o", str(out), "--force"], text, capsys)
        assert (checked == 2) == (ran == 2), f"check {checked}, run {ran}\n{text}"
        codes.append(ran)
    figures.append(counted("scenarios, checked and run alike", codes))


def test_mutated_tables(
    folder: Path, wind: Path, figures: list[str], seed: int, capsys: pytest.CaptureFixture[str]
) -> None:
    rng = random.Random(SEED + seed + 2)
    records, stations = (folder / "wind.csv").read_text(), (folder / "stations.csv").read_text()
    square = "\n".join(",".join(str(int(i == j or i + 1 == j)) for j in range(6)) for i in range(6))
    path, scenario = folder / "m.csv", folder / "m.toml"
    codes = []
    for k in range(TABLES):
        source = stations if k % 4 == 0 else square if k % 4 == 2 else records
        data = mutated_table(source, rng)
        path.write_bytes(data)
        if k % 4 == 0:
            scenario.write_text(WIND.replace('"stations.csv"', '"m.csv"'))
            arguments = ["check", str(scenario)]
        elif k % 4 == 1:
            scenario.write_text(WIND.replace('"wind.csv"', '"m.csv"'))
            arguments = ["check", str(scenario)]
        elif k % 4 == 2:
            arguments = ["structure", str(path)]
        else:
            arguments = ["fit", str(path), "--json"]
        codes.append(require_orderly(arguments, repr(data[:300]), capsys))
    figures.append(counted("CSV files", codes))
    assert codes.count(0) > 0 and codes.count(2) > 10  # neither all of them wrong, nor none
