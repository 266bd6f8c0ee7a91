"""The scenario that `garrison init` writes."""

TEMPLATE = """\
# Look at it: garrison check FILE        Run it: garrison run FILE -o out
# Another value for a key, for once: garrison run FILE --set filter.threshold=1.0 -o out
# All filters and attacks with their parameters: garrison list
title = "Two states, six sensors, one liar"

[model]  # x(t) = A x(t-1) + w(t-1), and sensor i measures y_i(t) = C_i x(t) + v_i(t)
A = [[0.95, 0.1], [0.0, 0.9]]                        # or { file = "A.csv" }
C = [[1, 0], [0, 1], [1, 0], [0, 1], [1, 0], [0, 1]] # one entry per agent; [] for one without sensors
process_bound = 0.02                                 # length of w at most
measurement_bound = 0.01                             # size of v at most
process_covariance = 1e-4                            # for the filters that weigh by covariances
measurement_covariance = 3e-5
# In place of A and C: a model fitted to clean records, a column per sensor.
# fit = "records.csv"
# factors = 2

[network]  # who hears whom
kind = "complete"                                    # or ring, path, star, band, grid, random_geometric, ..
# edges = [[0, 1], [1, 2]]                           # pairs of agents, from 0; in place of kind

[filter]
name = "saturation"
threshold = 0.5                                      # innovations above this are clipped
rounds = 3                                           # messages per sample
attacked = 1                                         # sensors that may lie at a time
initial_error = 5.0                                  # length of the error at the start at most
detector = true                                      # identifies sensors that lie

[[compare]]  # other filters on the same data, as many as wanted
name = "central_kalman"                              # uses every measurement as it comes

[[attack]]  # as many as wanted; none: everybody is honest
kind = "bias"
agents = [2]
value = 3.0
start = 30
# stop = 60

# [link]  # messages that get lost
# drop = 0.1

# [data]  # recorded measurements in place of simulated ones; then no steps
# file = "measurements.csv"

[run]
steps = 100
trials = 10
seed = 0
"""
