"""Rows that programs of the tests measure: what no network is needed for."""

import os
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

from garrison.net.accept.row import Measured, Row
from garrison.net.processes import real_time
from garrison.net.programs import BODIES, FUZZ, HOSTILE, LATENCY, SIMULATION, UNITS, VARIABLE, program

#: seeds of the simulation for each second of --seconds: less than one core does in one
_SEEDS_A_SECOND = 10
_SEEDS_A_MINUTE = 1000
_PARSERS = 11


def _printed(command: list[str], environment: dict[str, str] | None = None) -> Measured:
    done = subprocess.run(command, capture_output=True, text=True, env=environment)
    return Measured("\n      ".join((done.stdout + done.stderr).splitlines()), done.returncode == 0)


def _noise(_seconds: float, programs: str | None) -> Measured:
    return _units(programs, "*published Noise_KK*")


def _allocations(_seconds: float, programs: str | None) -> Measured:
    return _units(programs, "*no memory from the heap*")


def _units(programs: str | None, cases: str) -> Measured:
    """Some of the C++ tests, of which there has to be one."""
    done = _printed([program(UNITS, programs), f"--test-case={cases}", "--no-intro", "--no-version"])
    return Measured(done.text, done.met and "1 passed" in done.text)


def _outsiders(_seconds: float, programs: str | None) -> Measured:
    return _printed([program(HOSTILE, programs)])


def _bodies(seconds: float, programs: str | None) -> Measured:
    mutations = str(int(seconds / 300 * 1e6))
    cases = "--test-case=a body that is not what an agent could have sent*"
    return _printed([program(BODIES, programs), cases], {**os.environ, "GARRISON_MUTATIONS": mutations})


def _simulated(mode: str, seeds: float, programs: str | None) -> Measured:
    return _printed([program(SIMULATION, programs), "1", str(int(seeds)), mode])


def _latency(_seconds: float, programs: str | None) -> Measured:
    """Of ten and of thirty, with the priority that a node has."""
    runs = [_printed([*real_time(), program(LATENCY, programs), *size]) for size in (["10", "500"], ["30", "100"])]
    return Measured("\n      ".join(run.text for run in runs), all(run.met for run in runs))


def _processors(_seconds: float, programs: str | None) -> Measured:
    script = Path(__file__).parents[4] / "tests" / "node" / "processors.sh"
    if not script.is_file():
        return Measured("a checkout is needed, for tests/node/processors.sh", False)
    environment = {**os.environ, "PYTHON": sys.executable} | ({VARIABLE: programs} if programs else {})
    done = _printed([str(script)], environment)
    return Measured(done.text, done.met and "left out" not in done.text)


def _fuzz(seconds: float, programs: str | None) -> Measured:
    return _printed([program(FUZZ, programs), str(seconds / _PARSERS)])


def _speed(seconds: float, programs: str | None) -> Measured:
    """The simulation under all faults, and how fast it was."""
    measured = _simulated("all", _SEEDS_A_SECOND * seconds, programs)
    rate = re.search(r"(\d+) a minute", measured.text)
    return Measured(measured.text, measured.met and rate is not None and int(rate[1]) >= _SEEDS_A_MINUTE)


def _modes(mode: str) -> Callable[[float, str | None], Measured]:
    return lambda seconds, programs: _simulated(mode, _SEEDS_A_SECOND * seconds, programs)


QUICK = (
    Row("noise", "the published vector of Noise_KK_25519_ChaChaPoly_SHA256", _noise, needs=UNITS),
    Row("allocations", "three loops over sockets: no memory from the heap", _allocations, needs=UNITS),
    Row(
        "outsiders",
        "1e5 replayed six ways, 1e6 forged, 1e6 mutated, 1e6 strangers: none taken, a refusal <= 1 us",
        _outsiders,
        needs=HOSTILE,
    ),
)
_WHOLE = 1000.0
LONG = (
    Row(
        "latency",
        "a round of 10 and of 30 processes, four neighbours each: <= 1.3 of raw datagrams, <= 0.5 of ZeroMQ CURVE",
        _latency,
        needs=LATENCY,
    ),
    Row("processors", "logs of daemons give the same bits under qemu on s390x and aarch64", _processors, needs=UNITS),
    Row("bodies", "1e6 mutated bodies per family and dimension: refused by name, or canonical", _bodies, 300.0, BODIES),
    Row("fuzz", "mutated bytes at every parser, 60 s each: taken or refused", _fuzz, 60.0 * _PARSERS, FUZZ),
    Row("seeds", "10 000 seeds of all faults: nothing wrong, 1000 a minute and core", _speed, _WHOLE, SIMULATION),
    Row("cold", "10 000 cold restarts, detector on: no false proof", _modes("cold"), _WHOLE, SIMULATION),
    Row(
        "hours",
        "10 000 clocks an hour off: no round with two bodies, back in three samples",
        _modes("clock"),
        _WHOLE,
        SIMULATION,
    ),
    Row("liars", "1000 who sign two things: two proofs within three batches", _modes("liar"), _WHOLE / 10, SIMULATION),
    Row("honest", "10 000 seeds, all sign, with restarts: nobody convicted", _modes("honest"), _WHOLE, SIMULATION),
)
