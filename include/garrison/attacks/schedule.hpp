// SPDX-License-Identifier: Apache-2.0
// Which agents are attacked, and when.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "garrison/core/error.hpp"
#include "garrison/core/random.hpp"

namespace garrison {

/// Attacked sets over time. Phase k is in force from its `start` until the next phase's start, the last one
/// until `stop` (excluded). With probability < 1 each agent is attacked at each time independently.
/// Threads: constant once made; any number may share it.
class GARRISON_EXPORT Schedule {
 public:
  static constexpr std::int64_t kForever = std::numeric_limits<std::int64_t>::max();
  struct Phase {
    std::int64_t start;
    std::vector<int> agents;
  };

  /// @throws InvalidInput when phases do not start in increasing order, stop is not after the last start,
  /// an agent id is negative, or probability is outside [0, 1].
  explicit Schedule(std::vector<Phase> phases, std::int64_t stop = kForever, double probability = 1.0);

  /// One phase: the same agents from `start` on.
  Schedule(std::int64_t start, std::vector<int> agents, std::int64_t stop = kForever,
           double probability = 1.0);

  /// Agents that may be attacked at time t, before chance.
  std::span<const int> agents(std::int64_t t) const;
  /// Start of the phase in force at t (t itself when none is).
  std::int64_t since(std::int64_t t) const;
  /// Chance decides for (t, agent); `random` and `salt` belong to one attack of one trial.
  bool strikes(const Random& random, std::int64_t t, int agent, std::uint32_t salt) const;
  /// Start of the first phase.
  std::int64_t first() const { return phases_.front().start; }
  /// As given, with the agents of every phase sorted.
  const std::vector<Phase>& phases() const { return phases_; }
  std::int64_t stop() const { return stop_; }
  double probability() const { return probability_; }
  /// Every agent that occurs in some phase, sorted.
  std::vector<int> everyone() const;
  /// Refuses an agent id that the network does not have.
  void require_agents_below(int agents) const;

 private:
  std::vector<Phase> phases_;
  std::int64_t stop_;
  double probability_;
};

}  // namespace garrison
