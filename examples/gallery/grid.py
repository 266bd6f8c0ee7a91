"""A power grid: which phasor units must not fail, how many may lie

The IEEE 14-bus system, a phasor unit at every bus. `garrison import pandapower case14` makes such a scenario.
"""

import garrison as gr
import numpy as np

WAYS = "0-1 0-4 1-2 1-3 1-4 2-3 3-4 3-6 3-8 4-5 5-10 5-11 5-12 6-7 6-8 8-9 8-13 9-10 11-12 12-13"
LINES = [(int(a), int(b)) for a, b in (way.split("-") for way in WAYS.split())]
units = range(14)
seen = [[b, *(j if i == b else i for i, j in LINES if b in (i, j))] for b in units]
names = [f"bus {b + 1}" for b in units]
model = gr.Model(np.eye(14), [np.eye(14)[s] for s in seen], process_covariance=1e-6, measurement_covariance=4e-6)
figure = gr.analyze(model, gr.Network(LINES, agents=14, names=names), seconds=10).plot()
