"""The networks that are measured: the wind example, and bands of any size."""

import tempfile
from collections.abc import Callable
from datetime import date, timedelta
from pathlib import Path

from garrison.net.folder import NodeFolder
from garrison.net.outcome import Outcome
from garrison.net.plan import Plan, read_plan
from garrison.net.processes import Processes
from garrison.net.running import carry_out

Meanwhile = Callable[[Processes, list[NodeFolder]], None]

_PLANT = """
[model]
A = [[0.99, 0.05], [-0.05, 0.97]]
C = {rows}
process_bound = 0.02
measurement_bound = 0.01
[network]
kind = "band"
range = 2
[filter]
name = "saturation"
threshold = 1.5
rounds = {rounds}
[run]
steps = {steps}
seed = 1
x0 = [1.0, 1.0]
"""

#: where the examples are: in a checkout, or from the package garrison-doc
_EXAMPLES = (Path(__file__).parents[4] / "examples", Path("/usr/share/doc/garrison/examples"))
_FIRST_DAY, _DAY_MS = date(1971, 12, 12), 400.0  # as examples/wind/network.toml has them


def wind(seconds: float) -> Plan:
    """The wind example, a day every 0.4 s, the first twenty without an attack; at least as long as in its file."""
    paths = [folder / "wind" / "network.toml" for folder in _EXAMPLES]
    days = max(110, round(1000 * seconds / _DAY_MS))
    last = (_FIRST_DAY + timedelta(days=days - 1)).isoformat()
    plan = read_plan(next((path for path in paths if path.is_file()), paths[0]), {"data.to": last})
    plan.expect = {"complete": 0.999, "bound": 1.0}
    return plan


def band(agents: int, rounds: int, period_ms: float, seconds: float) -> Plan:
    """So many agents on a band, for so long."""
    rows = [[1, 0] if i % 2 == 0 else [0, 1] for i in range(agents)]
    steps = max(20, int(1000 * seconds / period_ms))
    with tempfile.TemporaryDirectory(prefix="garrison-net-") as place:
        folder = Path(place)
        (folder / "scenario.toml").write_text(_PLANT.format(rows=rows, rounds=rounds, steps=steps))
        (folder / "network.toml").write_text(f'scenario = "scenario.toml"\n[run]\nperiod_ms = {period_ms}\n')
        return read_plan(folder / "network.toml")


def carried_out(plan: Plan, programs: str | None, kills: int = 0, meanwhile: Meanwhile | None = None) -> Outcome:
    """Run it in a folder that is removed."""
    with tempfile.TemporaryDirectory(prefix="garrison-net-") as folder:
        return carry_out(plan, Path(folder), programs=programs, kills=kills, meanwhile=meanwhile)
