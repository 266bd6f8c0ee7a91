"""Three of twelve wind stations report ten units too much

Daily wind in Ireland. The saturation filter identifies all three on the first day; the certified bound holds
whoever lies.
"""

from pathlib import Path

import garrison as gr
from garrison.scenario import read_scenario

examples = Path(__file__).parents[1]
winter = {"data.from": "1971-11-01", "data.to": "1972-03-01"}
wind = read_scenario(examples / "wind/hijacked.toml", set=winter)
certified = gr.prepare(wind.model, wind.network, wind.filters[0][1], certificate="flooded", failure=1e-6, attacked=3)
run = certified.replay(measurements=wind.measurements, truth=wind.truth, attack=wind.attacks)
unprotected = gr.replay(
    wind.model,
    wind.network,
    gr.filters.ScalarGain(rounds=10),
    measurements=wind.measurements,
    truth=wind.truth,
    attack=wind.attacks,
)
figure = run.plot(agents=["VAL", "DUB", "MAL"], compare=[unprotected])
