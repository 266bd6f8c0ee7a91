// SPDX-License-Identifier: Apache-2.0
// What reaches whom when no message is lost. Internal.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "core/hops.hpp"

namespace garrison::detail {

/// Hops from every agent to every other, in the direction in which messages travel.
class Flood {
 public:
  Flood() = default;
  /// Gives up, and says so, where some pair of agents is further apart than `most` hops, or the network is so
  /// large that it would take long to know.
  Flood(const Network& network, int most) {
    const int N = network.agents();
    if (N > kMostAgents) return;
    for (int i = 0; i < N; ++i) {
      detail::Hops hops = detail::hops_from(network, i);
      if (!hops.reaches_all || hops.furthest > most) return;
      hops_.push_back(std::move(hops.to));
    }
    reaches_all_ = true;
  }
  bool reaches_all() const { return reaches_all_; }
  /// From agent `from` to agent `to`; where all are reached.
  int hops(int from, int to) const {
    return hops_[static_cast<std::size_t>(to)][static_cast<std::size_t>(from)];
  }

 private:
  static constexpr int kMostAgents = 1000;
  std::vector<std::vector<int>> hops_;  // of each receiver
  bool reaches_all_ = false;
};

}  // namespace garrison::detail
