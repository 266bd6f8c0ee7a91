"""Red team: every filter against every attack

Two of eight sensors lie in every way that garrison knows. Rows are filters and baselines, columns attacks.
"""

import garrison as gr

model = gr.Model(
    [[0.98, 0.02], [0.02, 0.98]],
    [[1, 0], [0, 1]] * 4,
    process_bound=0.02,
    measurement_bound=0.05,
    process_covariance=1e-4,
    measurement_covariance=6e-4,
)
figure = gr.compare(model, gr.Network.complete(8), attacked=[2, 5], baselines=False, trials=2, steps=50).plot()
