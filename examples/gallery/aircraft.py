"""An aircraft whose satellite navigation is spoofed

Reported positions and velocities test each other. The alarm comes with the first spoofed report. After a
minute the filter takes the position up again, right or not, because no other sensor says where the aircraft is
(the run warns of it); the way back to the truth is an alarm again, and then all is quiet.
"""

from pathlib import Path
from tempfile import mkdtemp

from garrison.figures import innovation_figure
from garrison.importers.adsb import import_adsb
from garrison.jobs import run_scenario
from garrison.scenario import read_scenario

examples = Path(__file__).parents[1]
folder = Path(mkdtemp())
import_adsb(examples / "import/adsb_sample.json.gz").write(folder)
scenario = read_scenario(folder / "scenario.toml")
figure = innovation_figure(scenario, run_scenario(scenario)[0].run, before=100, after=450)
