"""Grids of pandapower: JSON files, and the cases that it ships."""

import logging
import warnings
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from garrison import _core
from garrison.importers.libraries import library
from garrison.words import near, refusal

Array = NDArray[np.float64]
_PURPOSE = "reading a grid"
#: columns of a branch in pandapower's internal case, those of MATPOWER: from, to, x, tap ratio, in service
_FROM, _TO, _X, _TAP, _STATUS = 0, 1, 3, 8, 10


@dataclass(frozen=True)
class Grid:
    """Buses and branches in service. branches: (bus, bus, susceptance per unit). angles: rad, DC power flow.

    same: other names of a bus, of those that closed switches make one with it -> its number.
    """

    title: str
    names: list[str]
    branches: list[tuple[int, int, float]]
    angles: Array
    same: dict[str, int] = field(default_factory=dict)

    @cached_property
    def near(self) -> list[dict[int, float]]:
        """Of every bus: those that a branch joins to it, with the susceptance of all such branches."""
        found: list[dict[int, float]] = [{} for _ in self.names]
        for i, k, b in self.branches:
            for bus, other in ((i, k), (k, i)):
                found[bus][other] = found[bus].get(other, 0.0) + b
        return found


def read_grid_case(case: str) -> Grid:
    """A file or a case of pandapower. Raises InvalidInput or IoError."""
    pandapower = library("pandapower", "grid", _PURPOSE)
    logging.getLogger("pandapower").setLevel(logging.ERROR)  # it advises to install what makes it faster
    net = _of_file(pandapower, Path(case)) if _is_file(case) else _of_name(case)
    title = Path(case).stem if _is_file(case) else case
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            pandapower.rundcpp(net)
        ppc = net._ppc
        lookup = net._pd2ppc_lookups["bus"]
    except Exception as error:
        what = " ".join(str(error).split())[:200] or type(error).__name__
        raise refusal(
            title, f"a grid without a DC power flow ({what})", "a grid that pandapower.rundcpp solves"
        ) from None
    return _grid(title, net, ppc, lookup)


def _is_file(case: str) -> bool:
    return Path(case).suffix.lower() in (".json", ".p", ".xlsx") or Path(case).is_file()


def _of_file(pandapower: Any, path: Path) -> Any:
    if not path.is_file():
        raise _core.IoError(f"{path}: got no such file, expected a grid that pandapower.to_json wrote")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            net = pandapower.from_json(str(path))
    except Exception as error:
        what = " ".join(str(error).split())[:200] or type(error).__name__
        raise refusal(str(path), f"no grid ({what})", "a JSON file that pandapower.to_json wrote") from None
    if not hasattr(net, "bus") or not len(net.bus):
        raise refusal(str(path), "a file without buses", "a JSON file that pandapower.to_json wrote")
    return net


def _of_name(case: str) -> Any:
    networks = library("pandapower.networks", "grid", _PURPOSE)
    known = sorted(name for name in dir(networks) if name.startswith(("case", "GB", "iceland")))
    if case not in known:
        raise refusal("CASE", repr(case), f"a JSON file, or one of {', '.join(known)}", near(case, known))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return getattr(networks, case)()


def _grid(title: str, net: Any, ppc: Any, lookup: Any) -> Grid:
    """From pandapower's internal case, where switches are closed, transformers are branches, and islands are gone."""
    branch = np.real(ppc["branch"])
    branch = branch[branch[:, _STATUS] > 0]
    used = sorted({int(b) for b in branch[:, [_FROM, _TO]].ravel()})
    place = {b: k for k, b in enumerate(used)}
    tap = np.where(branch[:, _TAP] == 0.0, 1.0, branch[:, _TAP])
    reactance = branch[:, _X] * tap
    if (np.abs(reactance) < _LEAST_X).any():
        reactance = np.where(np.abs(reactance) < _LEAST_X, _LEAST_X, reactance)
    branches = [
        (place[int(i)], place[int(k)], float(1.0 / x))
        for i, k, x in zip(branch[:, _FROM], branch[:, _TO], reactance, strict=True)
    ]
    if not branches:
        raise refusal(title, "no branch in service", "a grid with lines")
    angles = np.deg2rad(np.real(ppc["bus"])[used, 8].astype(float))
    same = {str(index): place[int(lookup[index])] for index in net.bus.index if int(lookup[index]) in place}
    return Grid(title, _names(net, lookup, used), branches, angles, same)


#: per unit, of a branch that the file says has no reactance
_LEAST_X = 1e-6


def _names(net: Any, lookup: Any, used: list[int]) -> list[str]:
    """Index in pandapower of the first bus of each internal one; buses inside of transformers have none."""
    first: dict[int, str] = {}
    for index in net.bus.index:
        first.setdefault(int(lookup[index]), str(index))
    return [first.get(b, f"internal {b}") for b in used]
