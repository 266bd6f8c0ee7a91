"""Five recorded cars, one odometer that drifts

A file in the form of OpenACC becomes a scenario; the only car that is accused is the one whose odometer really
drifts.
"""

from pathlib import Path
from tempfile import mkdtemp

from garrison.figures import innovation_figure
from garrison.importers.openacc import import_openacc
from garrison.jobs import run_scenario
from garrison.scenario import read_scenario

examples = Path(__file__).parents[1]
folder = Path(mkdtemp())
import_openacc([examples / "import/openacc_sample.csv"]).write(folder)
scenario = read_scenario(folder / "scenario.toml")
figure = innovation_figure(scenario, run_scenario(scenario)[0].run)
