// SPDX-License-Identifier: Apache-2.0
// Several Monte Carlo trials side by side in one step.
#pragma once

#include <cstdint>

#include "garrison/core/error.hpp"
#include "garrison/core/types.hpp"

namespace garrison {

/// Trials per step.
inline constexpr int kLanes = 8;

/// Steps kLanes independent trials of a whole network at once. Every operation acts lane by lane, so each
/// trial has the bits it would have alone.
/// Threads: one at a time.
class GARRISON_EXPORT TrialsRunner {
 public:
  virtual ~TrialsRunner() = default;
  /// x0: one n x N matrix per lane.
  virtual void reset(const Matrix* x0) = 0;
  /// y: total_outputs x kLanes numbers, [measurement][lane]; NaN = missing.
  virtual void step(const double* y) = 0;
  /// Estimates after the step: out[lane] receives those of one trial, agent by agent in order of public id.
  /// The first `used` lanes only.
  virtual void read(double* const* out, int used) const = 0;
};

}  // namespace garrison
