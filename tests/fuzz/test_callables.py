"""Every public callable of garrison and of its core, with bad values: no signal, no hang, no foreign exception.

`python tests/fuzz/test_callables.py --seconds 120 --seed 1` runs longer, or with another seed. Each batch of calls runs
in a process of its own; one call has ten seconds.
"""

from __future__ import annotations

import argparse
import contextlib
import functools
import inspect
import io
import json
import os
import random
import re
import resource
import select
import signal
import sys
import tempfile
import time
import types
import warnings
from collections import Counter
from collections.abc import Iterator
from typing import Any

import garrison as gr
from fuzz_values import ONCE, good, nasty, samples
from garrison import _core

LIMIT = 10.0  # seconds for one call
BATCH = 40
MEMORY = 3 << 30  # bytes that a call may take
#: names that are not called, with the reason
EXCLUDED: dict[str, str] = {
    "garrison.Run": "made by simulate, replay and load; its arguments are theirs",
    "garrison.Verdict": "an enumeration of Python's own",
    "garrison.BoundKind": "the same",
} | (
    dict.fromkeys(("garrison._core.replay", "garrison._core.simulate"), "progress may be anything")
    | dict.fromkeys(
        ("garrison.analyze", "garrison.compare", "garrison.design", "garrison.sweep"),
        "seconds a call: tests/python/test_questions_refuse.py tries their arguments",
    )
)

#: plain answers of functions, without arguments or methods that take any
ANSWERS = {"Analysis", "Calibration", "Comparison", "Designed", "Fit", "Mitigated", "Resilience", "Sweep"}

Job = tuple[str, str, Any, int, tuple[str, int] | None]


def parameters(function: Any) -> list[tuple[str, bool, bool]]:
    """(name, required, keyword only) of what `function` takes; from its documentation where it is bound."""
    try:
        known = [
            p
            for p in inspect.signature(function).parameters.values()
            if p.kind not in (p.VAR_KEYWORD, p.VAR_POSITIONAL)
        ]
        return [(p.name, p.default is p.empty, p.kind is p.KEYWORD_ONLY) for p in known]
    except (TypeError, ValueError):
        pass
    source = function.__init__ if isinstance(function, type) else function
    line = (source.__doc__ or "").split("\n")[0]
    inside = re.search(r"\((.*)\) ->", line)
    if not inside:
        return []
    flat = inside[1]
    while (less := re.sub(r"\[[^\[\]]*\]|\([^()]*\)|'[^']*'", "", flat)) != flat:
        flat = less
    found, keyword_only = [], False
    for part in flat.split(","):
        name = part.split(":")[0].split("=")[0].strip()
        if name == "*":
            keyword_only = True
        elif name and name != "self":
            found.append((name, "=" not in part, keyword_only))
    return found


def bare(function: Any) -> Any:
    """Without the object that it is bound to."""
    return function.func if isinstance(function, functools.partial) else function


def takes(function: Any) -> list[tuple[str, bool, bool]]:
    """`parameters` without self where that is given."""
    found = parameters(bare(function))
    return found[1:] if isinstance(function, functools.partial) and found and found[0][0] == "self" else found


def public() -> Iterator[tuple[str, str, Any]]:
    """(name, module, callable) of all public functions, classes, methods and properties."""
    modules = {"garrison": gr}
    for module in (_core, gr):
        for key, value in vars(module).items():
            if (
                isinstance(value, types.ModuleType)
                and value.__name__.startswith("garrison")
                and not key.startswith("_")
                and (module is _core or key in gr.__all__)  # the other modules of the package are its own affair
            ):
                modules[value.__name__] = value
    modules["garrison._core"] = _core
    seen: set[int] = set()
    for where, module in modules.items():
        names = getattr(module, "__all__", None) or [k for k in vars(module) if not k.startswith("_")]
        for key in names:
            value = getattr(module, key)
            if (
                not callable(value)
                or id(value) in seen
                or not str(getattr(value, "__module__", "")).startswith("garrison")
            ):
                continue
            seen.add(id(value))
            if isinstance(value, type) and issubclass(value, BaseException):
                continue
            short = where.rsplit(".", 1)[-1]
            yield f"{where}.{key}", short, value
            if isinstance(value, type):
                yield from methods(f"{where}.{key}", short, value)


def methods(name: str, owner: str, cls: type) -> Iterator[tuple[str, str, Any]]:
    """Methods and properties of a class, called on its samples."""
    found = samples()
    mine = [x for group in found.values() for x in group if type(x) is cls]
    for key, value in vars(cls).items():
        if key.startswith("_") and key not in ("__repr__", "__eq__", "__hash__"):
            continue
        if isinstance(value, staticmethod):
            yield f"{name}.{key}", owner, value.__func__
        elif isinstance(value, property) and not isinstance(value.fget, types.FunctionType):
            yield f"{name}.{key}", owner, value.fget
        elif callable(value):
            for one in mine:
                yield f"{name}.{key}", owner, functools.partial(getattr(type(one), key), one)


def cases(
    rng: random.Random, owner: str, function: Any, fault: tuple[str, int] | None
) -> tuple[tuple[Any, ...], dict[str, Any]]:
    """Arguments of one call: mostly good ones; of the bad ones `fault` (argument, which of ONCE) or any."""
    target = bare(function)
    known = takes(function)
    share = rng.choice([0.0, 0.15, 0.4, 1.0]) if fault is None else 0.0
    positional: list[Any] = []
    named: dict[str, Any] = {}
    pure = isinstance(target, types.FunctionType) or (
        isinstance(target, type) and isinstance(target.__init__, types.FunctionType)
    )
    for parameter, required, keyword_only in known:
        struck = fault is not None and fault[0] == parameter
        if not required and not struck and rng.random() < 0.6:
            continue
        value = nasty(rng) if rng.random() < share else good(rng, owner, parameter)
        if fault is not None and struck:
            value = ONCE[fault[1]]()
        if keyword_only or named or len(positional) < known.index((parameter, required, keyword_only)):
            named[parameter] = value
        else:
            positional.append(value)
    if not pure and fault is None and rng.random() < 0.03:
        named[rng.choice(["", "agentss", "\ud800", "x"])] = 1
    if not pure and fault is None and rng.random() < 0.03:
        positional = [*positional, nasty(rng)] if not named else positional[:-1]
    return tuple(positional), named


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
        positional, named = cases(rng, owner, function, fault)
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


def fuzz(seconds: float, seed: int) -> tuple[str, dict[str, list[str]]]:
    """The figures in one line, and what failed by name."""
    targets = [t for t in public() if t[0] not in EXCLUDED]
    rng = random.Random(seed)
    result: Counter[str] = Counter()
    failures: dict[str, list[str]] = {}
    calls, end = 0, time.monotonic() + seconds
    # first every argument with every bad value, then as many random rounds as there is time for
    queue: list[Job] = [
        (*t, rng.getrandbits(48), (parameter[0], k))
        for t in targets
        for parameter in takes(t[2])
        for k in range(len(ONCE))
    ]
    single = len(queue)
    with tempfile.TemporaryDirectory() as scratch, contextlib.chdir(scratch):  # some calls write files
        while calls < single or time.monotonic() < end:
            queue = queue or [(*t, rng.getrandbits(48), None) for t in targets]
            begun = supervise(queue[:BATCH], result, failures)
            calls += begun
            del queue[:begun]
    line = (
        f"callables: {len({t[0] for t in targets})} public, {calls} calls in {seconds:.0f} s (seed {seed}): "
        f"{result['fine']} fine, {result['refused']} refused in our words, {result['signal']} signals, "
        f"{result['hang']} hangs, {result['foreign']} foreign exceptions, {len(EXCLUDED)} names excluded"
    )
    return line, failures


def report(failures: dict[str, list[str]], each: int = 2) -> str:
    return "\n".join(
        f"{name} ({len(all_)})\n   " + "\n   ".join(all_[:each]) for name, all_ in sorted(failures.items())
    )


def test_every_callable_survives_bad_values(figures: list[str]) -> None:
    line, failures = fuzz(90.0, seed=0)
    figures.append(line)
    assert not failures, line + "\n" + report(failures)


def test_every_class_has_a_sample() -> None:
    """A class without one would not have its methods called."""
    classes = {value for _, _, value in public() if isinstance(value, type)}
    made = {type(x) for group in samples().values() for x in group}
    missing = {c.__name__ for c in classes if not any(issubclass(m, c) for m in made)}
    assert missing == {"BoundKind", "Verdict", "budget"} | ANSWERS


if __name__ == "__main__":
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--seconds", type=float, default=120.0)
    options.add_argument("--seed", type=int, default=0)
    options.add_argument("--all", action="store_true", help="show every failure")
    given = options.parse_args()
    figures, failed = fuzz(given.seconds, given.seed)
    print(report(failed, 10**6 if given.all else 2))
    print(figures)
    sys.exit(1 if failed else 0)
