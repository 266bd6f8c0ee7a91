// SPDX-License-Identifier: Apache-2.0
// Drivers: a simulated plant, or a recorded log.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "garrison/attacks/measurement.hpp"
#include "garrison/core/series.hpp"
#include "garrison/drivers/nonlinear.hpp"
#include "garrison/drivers/record.hpp"
#include "garrison/engine/any_filter.hpp"

namespace garrison {

/// Trials have numbers below this one: their random streams are apart from each other.
inline constexpr int kMostTrials = 1 << 24;

/// What to keep of a run.
struct GARRISON_EXPORT Keep {
  bool estimate = true;
  bool report = true;    ///< bound, statistic, threshold, verdict, accusations
  bool signals = false;  ///< the family's own signals
  bool measurements = true;
  bool details = false;  ///< the family's lists (sets, gains), whenever one changes
  bool box = false;      ///< with `report`: the bound of each coordinate
  bool error = true;     ///< where the truth is known
  bool truth = true;     ///< the same
};

/// Settings that simulation and replay share.
struct GARRISON_EXPORT RunOptions {
  int trials = 1;
  /// Number of the first trial, >= 0: trial k of the run has the bits of trial first_trial + k of a run from
  /// 0.
  int first_trial = 0;
  std::uint64_t seed = 0;
  int threads = 0;              ///< 0 = all cores it may use; the result does not depend on it
  Matrix start;                 ///< initial estimates, n x N, or n x 1 for all agents alike; empty = zeros
  std::vector<Attack> attacks;  ///< applied in this order
  std::vector<std::shared_ptr<const MessageAttack>> message_attacks;
  LinkFaults link;
  /// Known inputs, steps x Model::inputs(): row t is u(t), which leads from time t to t + 1. Filters get the
  /// measurements without the plant's response to them, and the record has it in the estimates again:
  /// docs/adr/0016.
  Matrix inputs;
  std::shared_ptr<const Series> series;  ///< what of the plant changes in time; null = nothing
  /// The plant by functions, in place of the model's A, B and C; null = it is linear. Every agent works with
  /// its own linearisation, of h about its own f(xhat_i): docs/adr/0016. No bound.
  std::shared_ptr<const Nonlinear> nonlinear;
  Keep keep;
  /// Called now and then with the number of finished samples and their total; false stops the run.
  std::function<bool(std::int64_t, std::int64_t)> progress;
  /// Takes the arrays of the run in blocks as it goes, so that memory holds one block per running trial,
  /// however long the run is: those of trial `trial` at times `first` .. `first` + Record::steps, as the only
  /// trial of a record that is valid during the call. Called from the threads of the run, once at a time, for
  /// each trial in order of time; what it throws is thrown by the run. The record that the run returns has
  /// lists, counters and warnings, but no arrays.
  std::function<void(const Record& block, int trial, int first)> sink;
  std::size_t block_bytes = std::size_t{16}
                            << 20;  ///< at most, of all arrays of a block; or one time of them
};

/// How the simulated plant starts and is disturbed.
struct GARRISON_EXPORT PlantOptions {
  int steps = 0;
  Vector x0;  ///< true initial state; empty = zeros. Agents with states of their own: agent by agent
  /// The common initial estimate (or, with states of their own, each one) is moved by a random vector of at
  /// most this length.
  double start_error = 0.0;
  /// "uniform" within the model's bounds, "extreme" at them, "normal" with the model's covariances, "none",
  /// or "auto": uniform where bounds are known, else normal where covariances are, else none.
  std::string noise = "auto";
  /// Recorded disturbances in place of a noise law, one row per time; only for families with a world.
  Matrix disturbances = {};
};

/// x(t+1) = A x(t) + B u(t) + w(t), y = C x + v, attacked, filtered. Trials differ in noise, attack chance
/// and link faults; each depends on (seed, trial) only.
/// @throws InvalidInput when something does not fit; run-time trouble is counted in the record.
GARRISON_EXPORT Record simulate(const Prepared& prepared, const PlantOptions& plant,
                                const RunOptions& options);
/// The same, designed for this one run.
GARRISON_EXPORT Record simulate(const Model& model, const Network& network, const AnyFilter& filter,
                                const PlantOptions& plant, const RunOptions& options);

/// Recorded runs, C-ordered and not owned; NaN = missing.
struct GARRISON_EXPORT Log {
  const double* measurements = nullptr;  ///< [run][time first_sample..steps][Model::total_outputs()]
  const double* truth = nullptr;  ///< [run][time 0..steps][state] or [..][agent][state]; null = not known
  int runs = 1;
  int steps = 0;
};

/// Feeds a log to the filter: one run to every trial, or as many runs as trials, one to each. Attacks apply
/// on top (trials of one run differ in their chance).
/// @throws InvalidInput when something does not fit; run-time trouble is counted in the record.
GARRISON_EXPORT Record replay(const Prepared& prepared, const Log& log, const RunOptions& options);
/// The same, designed for this one run.
GARRISON_EXPORT Record replay(const Model& model, const Network& network, const AnyFilter& filter,
                              const Log& log, const RunOptions& options);

/// One run: measurements steps x total_outputs; `truth` empty, or (steps+1) x n.
GARRISON_EXPORT Record replay(const Model& model, const Network& network, const AnyFilter& filter,
                              const MatrixRef& measurements, const MatrixRef& truth,
                              const RunOptions& options);

}  // namespace garrison
