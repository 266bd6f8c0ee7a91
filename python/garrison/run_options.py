"""What every run can be given besides model, network and filter: attacks, faults of links, what to certify."""

from collections.abc import Mapping
from typing import Any

from garrison import _core
from garrison.arguments import chance, entries, flag, number, whole
from garrison.words import near, only, refusal, shown

#: of a row of `link`
_LEAST = 1 - 2**31


def attacks(value: Any) -> list[_core.Attack]:
    """One attack or several."""
    words = "an attack of garrison.attacks, or a list of them"
    found: list[Any] = [value] if isinstance(value, (_core.Attack, str)) else entries("attack", value, words)
    for one in found:
        if not isinstance(one, _core.Attack):
            raise refusal("attack", shown(one), words)
    return found


#: how far the measurements go on which a certificate rests
SPREADS = ("none", "local", "flooded", "direct")
ONE_SPREAD = ", ".join(f'"{name}"' for name in SPREADS[:-1]) + f' or "{SPREADS[-1]}"'


def certified(name: Any) -> bool:
    """Whether a certificate is asked for, whatever the name is worth."""
    return not (isinstance(name, str) and name == "none")


def certificate(
    filter: _core.Filter, name: Any, failure: Any, attacked: Any, levels: Any = None, memory: Any = False
) -> dict[str, Any]:
    """What to certify: `attacked` is the filter's own where it has one."""
    if not isinstance(name, str):
        raise refusal("certificate", shown(name), ONE_SPREAD)
    if name not in SPREADS:
        raise refusal("certificate", repr(name), ONE_SPREAD, near(name, list(SPREADS)))
    out: dict[str, Any] = {"certificate": name, "failure": chance("failure", failure)}
    if attacked is not None:
        out["attacked"] = whole("attacked", attacked, 0)
    if levels is not None:
        out["levels"] = pair_of_levels(levels)
    if flag("memory", memory):
        out["memory"] = True
    if name == "none" and "memory" in out:
        raise refusal("memory", 'True with certificate "none"', "False", f"{ONE_SPREAD} says what an agent remembers")
    if name == "none":
        return {}
    if "attacked" not in out and "attacked" not in filter.params:
        advice = "say how many sources may be attacked at a time"
        raise refusal("attacked", f"no value, with certificate {name!r}", "a whole number >= 0", advice)
    return {"attacked": filter.params.get("attacked")} | out


def pair_of_levels(levels: Any) -> tuple[float, float]:
    """z1 and z2, as Fitted.levels and calibrate give them."""
    words = "two numbers > 0, (z1, z2)"
    found = entries("levels", levels, words)
    if len(found) != 2:
        raise refusal("levels", shown(levels), words, "garrison.fit(...).levels(attacked, failure) finds them")
    z1, z2 = number("levels[0]", found[0]), number("levels[1]", found[1])
    if not (z1 > 0 and z2 > 0):
        raise refusal("levels", shown(levels), words)
    return z1, z2


def link(value: Mapping[str, Any] | None) -> dict[str, Any]:
    """Faults of the links."""
    if value is None:
        return {}
    if not isinstance(value, Mapping):
        raise refusal("link", shown(value), 'a dict such as {"drop": 0.1}')
    lists = {"cuts": 4, "lost": 4}
    known = ["drop", "delay", "delay_rounds", *lists]
    only("link", (key if isinstance(key, str) else repr(key) for key in value), known)
    out = {key: number(f"link.{key}", one) for key, one in value.items() if key not in lists}
    if "delay_rounds" in out:
        out["delay_rounds"] = whole("link.delay_rounds", value["delay_rounds"], 1)
        if "delay" not in out:
            raise refusal("link.delay_rounds", "a delay without its probability", "delay beside it")
    return out | {key: _rows(f"link.{key}", value[key], width) for key, width in lists.items() if key in value}


def _rows(which: str, value: Any, width: int) -> list[tuple[int | None, ...]]:
    """Rows of whole numbers or None."""
    expected = f"a list of rows of {width} whole numbers or None"
    rows = []
    for k, row in enumerate(entries(which, value, expected)):
        found = entries(f"{which}[{k}]", row, f"{width} whole numbers or None")
        if len(found) != width:
            raise refusal(f"{which}[{k}]", shown(row), f"{width} whole numbers or None")
        rows.append(tuple(None if v is None else whole(f"{which}[{k}]", v, _LEAST) for v in found))
    return rows
