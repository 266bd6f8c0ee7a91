"""Five robots with odometry see landmarks and each other when near; from sample 60 on, landmark 4 lies by 3 m."""

import garrison as gr
import numpy as np

rng, N, T, near = np.random.default_rng(1), 5, 160, 11.0
marks = np.array([[x, y] for x in (0, 8, 16) for y in (0, 8, 16)])
place = [np.eye(2 * N)[2 * i : 2 * i + 2] for i in range(N)]  # of robot i in the state of the team
rows = [np.vstack([*[place[i]] * len(marks), *(place[j] - place[i] for j in range(N) if j != i)]) for i in range(N)]
source = [s for i in range(N) for s in [*(f"mark {k}" for k in range(9)), *[f"robot {i}"] * (N - 1)] for _ in "xy"]
model = gr.Model(np.eye(2 * N), rows, B=np.eye(2 * N), process_bound=0.05, measurement_bound=0.05, sources=source)

moves = 0.4 * np.cos(0.05 * np.arange(T)[:, None] + rng.uniform(0, 6, 2 * N))  # odometry: known inputs
truth = np.array([8, 8] * N) + rng.uniform(-6, 6, 2 * N) + np.zeros((T + 1, 2 * N))
truth[1:] += np.cumsum(moves + rng.uniform(-0.015, 0.015, moves.shape), axis=0)
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
y = np.array(y).reshape(T, -1) + rng.uniform(-0.05, 0.05, (T, model.outputs))
net = gr.VaryingNetwork(gr.Network(links, agents=N, names=[f"robot {i}" for i in range(N)]), present)
