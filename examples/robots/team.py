"""Five robots with odometry see landmarks and each other when near; from sample 60 on, landmark 4 lies by 3 m."""

import garrison as gr
import numpy as np

rng, N, T, near = np.random.default_rng(1), 5, 160, 11.0
marks = np.array([[x, y] for x in (0, 8, 16) for y in (0, 8, 16)])
unit = np.eye(2 * N)  # the state: positions of all robots
place = [unit[2 * i : 2 * i + 2] for i in range(N)]
rows = [np.vstack([*[place[i]] * len(marks), *(place[j] - place[i] for j in range(N) if j != i)]) for i in range(N)]
source = [s for i in range(N) for s in [*(f"mark {k}" for k in range(9)), *[f"robot {i}"] * (N - 1)] for _ in "xy"]
model = gr.Model(unit, rows, B=unit, process_covariance=1e-4, measurement_covariance=9e-4, sources=source)

moves = 0.4 * np.cos(0.05 * np.arange(T)[:, None] + rng.uniform(0, 6, 2 * N))  # odometry: known inputs
truth = np.array([8, 8] * N) + rng.uniform(-6, 6, 2 * N) + np.zeros((T + 1, 2 * N))
truth[1:] += np.cumsum(moves + rng.normal(0, 0.01, moves.shape), axis=0)
p = truth[1:].reshape(T, N, 2)
y, present, links = [], [], [(i, j) for i in range(N) for j in range(i)]
for t in range(T):
    away = np.linalg.norm(p[t][:, None] - p[t], axis=2)
    present.append([away[i, j] < near for i, j in links])  # who is seen is heard
    for i in range(N):
        lie = 3.0 * (t >= 59) * (np.arange(9) == 4)[:, None]
        own = np.where(np.linalg.norm(marks - p[t, i], axis=1)[:, None] < near, p[t, i] + lie, np.nan)
        others = np.array([p[t, j] - p[t, i] if away[i, j] < near else [np.nan] * 2 for j in range(N) if j != i])
        y.append(np.concatenate([own.ravel(), others.ravel()]))
y = np.array(y).reshape(T, -1) + rng.normal(0, 0.03, (T, model.outputs))
net = gr.VaryingNetwork(gr.Network(links, agents=N, names=[f"robot {i}" for i in range(N)]), present)
log = {"measurements": y, "inputs": moves, "truth": truth, "start": truth[0]}
promise = {"certificate": "flooded", "failure": 1e-6, "attacked": 1}
run = gr.replay(model, net, gr.filters.Saturation(threshold=0.05, rounds=4), **log, **promise)
print(f"error {run.error[0, 60:].max():.2f} m, bound {run.bound[0, 60:].max():.2f} m at most")
