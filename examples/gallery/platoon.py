"""Eight vehicles in a string, two with spoofed positions

Vehicle 2 is led away slowly, vehicle 5 sees an old recording. Both are proved attacked; the bounds and least
gaps hold.
"""

from pathlib import Path

import garrison as gr
from garrison.scenario import read_scenario

examples = Path(__file__).parents[1]
string = read_scenario(examples / "platoon/spoofed.toml")
run = gr.simulate(
    string.model,
    string.network,
    string.filters[0][1],
    attack=string.attacks,
    keep=("estimate", "report", "measurements", "details", "signals"),
    **string.run,
)
figure = run.plot()
