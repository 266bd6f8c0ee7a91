"""Resilience per byte: what sharing less costs and saves

Partial sharing sends l of four entries. Fewer entries carry fewer bytes and spread less of the worst attack of
two agents.
"""

import garrison as gr
import numpy as np
from garrison.figures import resilience_figure

A = 0.95 * np.array([[0.9, 0.1, 0, 0], [0, 0.9, 0.1, 0], [0, 0, 0.9, 0.1], [0.1, 0, 0, 0.9]])
model = gr.Model(A, [np.eye(4)] * 8, process_covariance=0.01, measurement_covariance=0.1)
found = gr.resilience_per_byte(model, gr.Network.ring(8), [1, 4], gain=0.1, energy=1e4)
figure = resilience_figure(found)
