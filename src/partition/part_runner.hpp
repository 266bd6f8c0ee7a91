// SPDX-License-Identifier: Apache-2.0
// The agents of one rank behind one interface, as engine/runner.hpp is for a whole network.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "garrison/core/model.hpp"
#include "garrison/engine/link.hpp"
#include "partition/region.hpp"

namespace garrison::partition {

/// All ranks call the same functions in the same order. Own agents are counted in ascending order of public
/// ids.
/// Threads: one at a time.
class PartRunner {
 public:
  virtual ~PartRunner() = default;
  /// Refuses an attack on messages that the family's messages have no place for. @throws InvalidInput
  virtual void require(const MessageAttack& attack, int agents) const = 0;
  /// Time 0: one initial estimate for all, n numbers. `link` (null = perfect) must outlive the run.
  virtual void reset(const Vector& x0, Link* link) = 0;
  /// One sample: every agent senses, then all rounds. `y`: measurements of the own agents, NaN = missing.
  virtual void step(std::int64_t t, const double* y) = 0;
  /// own x n numbers, agent by agent.
  virtual void estimates(double* out) const = 0;
  /// Samples at which some estimate of the whole network was not finite, or beyond kHuge.
  virtual std::int64_t overflows() const = 0;
  /// Own agents that rejoined because of that, summed over samples.
  virtual std::int64_t resets() const = 0;
  /// Appends the state of the k-th own agent after a sample, and reads it back after `reset`.
  virtual void save(int k, std::vector<std::byte>& out) const = 0;
  /// @throws InvalidInput when the bytes are no state of this agent
  virtual void load(int k, std::span<const std::byte> state) = 0;
};

}  // namespace garrison::partition
