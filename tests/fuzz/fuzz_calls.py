"""Calls with bad values, in forks: how each one ends."""

from __future__ import annotations

import contextlib
import io
import json
import os
import random
import resource
import select
import signal
import sys
import tempfile
import warnings
from collections import Counter
from pathlib import Path
from typing import Any

import garrison as gr
from fuzz_targets import EXCLUDED, public, takes
from fuzz_values import FIXED, KEPT, ONCE, SCENARIO, good, nasty

LIMIT = 10.0  # seconds for one call
BATCH = 40
MEMORY = 3 << 30  # bytes that a call may take

Job = tuple[str, str, Any, int, tuple[str, int] | None]  # name, module, callable, seed, (argument, which of ONCE)


def cases(
    rng: random.Random, name: str, owner: str, function: Any, fault: tuple[str, int] | None
) -> tuple[tuple[Any, ...], dict[str, Any]]:
    """Arguments of one call: mostly good ones; of the bad ones `fault` (argument, which of ONCE) or any."""
    known = takes(function)
    share = rng.choice([0.0, 0.15, 0.4, 1.0]) if fault is None else 0.0
    positional: list[Any] = []
    named: dict[str, Any] = {}
    for k, (parameter, required, keyword_only) in enumerate(known):
        struck = fault is not None and fault[0] == parameter
        kept = KEPT.get(name, {})
        if not required and not struck and parameter not in kept and rng.random() < 0.6:
            continue
        if fault is not None and struck:
            value = ONCE[fault[1]]()
        elif (name, parameter) not in FIXED and rng.random() < share:
            value = nasty(rng)
        else:
            value = kept[parameter] if parameter in kept else good(rng, owner, parameter)
        if keyword_only or named or len(positional) < k:
            named[parameter] = value
        else:
            positional.append(value)
    if fault is None and not name.endswith("__"):  # what operators call has a form of its own
        misuse(rng, positional, named)
    return tuple(positional), named


def misuse(rng: random.Random, positional: list[Any], named: dict[str, Any]) -> None:
    """Now and then an unknown name, one argument too many or too few."""
    if rng.random() < 0.03:
        named[rng.choice(["", "agentss", "\ud800", "x"])] = 1
    if rng.random() < 0.03:
        if named:
            del positional[-1:]
        else:
            positional.append(nasty(rng))


def foreign(error: BaseException) -> bool:
    """Not in our words."""
    if not isinstance(error, gr.Error):
        return True
    words = str(error)
    return "bug of garrison" in words or (
        isinstance(error, gr.InvalidInput) and not (": got " in words and "expected" in words)
    )


def show(value: Any) -> str:
    """A value in a report."""
    try:
        words = repr(value)
    except BaseException as error:
        words = f"<repr fails: {error!r}>"
    words = words.encode("ascii", "backslashreplace").decode()
    return words if len(words) < 160 else words[:157] + "..."


def run_batch(batch: list[Job], out: int) -> None:
    """The child: announce every call, then say how it went."""
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    os.environ["GARRISON_MEMORY_GB"] = "1"
    warnings.simplefilter("ignore")
    sys.stdout = sys.stderr = io.StringIO()
    for name, owner, function, seed, fault in batch:
        rng = random.Random(seed)
        positional, named = cases(rng, name, owner, function, fault)
        words = ", ".join([*map(show, positional), *(f"{show(k)[1:-1]}={show(v)}" for k, v in named.items())])
        tell(out, {"call": f"{name}({words})", "name": name})
        try:
            function(*positional, **named)
            tell(out, {"end": "fine"})
        except BaseException as error:
            kind = "foreign" if foreign(error) else "refused"
            tell(
                out,
                {
                    "end": kind,
                    "error": f"{type(error).__name__}: {str(error)[:300]}".encode("ascii", "backslashreplace").decode(),
                },
            )


def tell(out: int, record: dict[str, str]) -> None:
    os.write(out, (json.dumps(record) + "\n").encode())


def supervise(batch: list[Job], result: Counter[str], failures: dict[str, list[str]]) -> int:
    """Run a batch in a fork; the number of calls that were begun."""
    read, write = os.pipe()
    child = os.fork()
    if child == 0:
        code = 1
        try:
            os.close(read)
            run_batch(batch, write)
            code = 0
        finally:
            os._exit(code)
    os.close(write)
    begun, call, name, rest, hung = 0, "", "", b"", False
    while True:
        ready, _, _ = select.select([read], [], [], LIMIT)
        if not ready:
            hung = True
            os.kill(child, signal.SIGKILL)
        data = os.read(read, 1 << 16)
        if not data:
            break
        *lines, rest = (rest + data).split(b"\n")
        for line in lines:
            record = json.loads(line)
            if "call" in record:
                begun, call, name = begun + 1, record["call"], record["name"]
                continue
            result[record["end"]] += 1
            if record["end"] == "foreign":
                failures.setdefault(name, []).append(f"{call}\n      {record['error']}")
            call = ""
    os.close(read)
    _, status = os.waitpid(child, 0)
    if call:
        result["hang" if hung else "signal"] += 1
        why = (
            "no end within 10 s"
            if hung
            else f"signal {os.WTERMSIG(status)}"
            if os.WIFSIGNALED(status)
            else "process ended"
        )
        failures.setdefault(name, []).append(f"{call}\n      {why}")
    return max(begun, 1)


def spent() -> float:
    """Seconds of a processor that the forks have taken."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def fuzz(seconds: float, seed: int) -> tuple[str, dict[str, list[str]]]:
    """The figures in one line, and what failed by name. seconds: of a processor; the first pass is never cut short."""
    targets = [t for t in public() if t[0] not in EXCLUDED]
    rng = random.Random(seed)
    result: Counter[str] = Counter()
    failures: dict[str, list[str]] = {}
    end = spent() + seconds
    # first every argument with every bad value, then as many random rounds as there is time for
    queue: list[Job] = [
        (*target, rng.getrandbits(48), (parameter, k))
        for target in targets
        for parameter, _, _ in takes(target[2])
        if (target[0], parameter) not in FIXED
        for k in range(len(ONCE))
    ] + [(*target, rng.getrandbits(48), None) for target in targets]
    first = len(queue)
    with tempfile.TemporaryDirectory() as scratch, contextlib.chdir(scratch):  # some calls write files
        Path("scenario.toml").write_text(SCENARIO)
        while first > 0 or spent() < end:
            queue = queue or [(*t, rng.getrandbits(48), None) for t in targets]
            begun = supervise(queue[:BATCH], result, failures)
            first -= begun
            del queue[:begun]
    calls = sum(result.values())
    line = (
        f"callables: {len({t[0] for t in targets})} public, {calls} calls (seed {seed}): "
        f"{result['fine']} fine, {result['refused']} refused in our words, {result['signal']} signals, "
        f"{result['hang']} hangs over {LIMIT:.0f} s, {result['foreign']} foreign exceptions; "
        f"not called: {', '.join(EXCLUDED)}"
    )
    return line, failures


def report(failures: dict[str, list[str]], each: int = 2) -> str:
    return "\n".join(
        f"{name} ({len(all_)})\n   " + "\n   ".join(all_[:each]) for name, all_ in sorted(failures.items())
    )
