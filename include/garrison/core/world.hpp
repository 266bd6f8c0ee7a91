// SPDX-License-Identifier: Apache-2.0
// The contract of a family that brings its own plant: agents with states of their own, which they drive.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "garrison/core/error.hpp"
#include "garrison/core/types.hpp"

namespace garrison {

/// How a world starts and is disturbed in one trial.
struct WorldOptions {
  Vector x0;                 ///< true initial states, agent by agent (n N); empty = the family's default
  Matrix start;              ///< initial estimates, n x N
  double start_error = 0.0;  ///< each one is moved by a random vector of at most this length, >= 0
  std::string noise = "auto";
  const Matrix* disturbances = nullptr;  ///< recorded ones in place of a noise law, one row per time; or null
  std::uint64_t seed = 0;
  std::uint32_t trial = 0;
};

/// The plants of all agents in one trial. A driver asks for time 0, 1, 2, ... in this order.
/// Threads: one at a time.
class GARRISON_EXPORT World {
 public:
  virtual ~World() = default;
  /// Initial estimates of the agents, n x N.
  virtual const Matrix& start() const = 0;
  /// States of all agents at the present time, agent by agent (n N).
  virtual std::span<const double> truth() const = 0;
  /// Moves to time t with what the agents did at t-1 (`control`, one number each, not read at t = 0) and
  /// writes the honest measurements of t.
  virtual void next(std::int64_t t, std::span<const double> control, std::span<double> y) = 0;
};

}  // namespace garrison
