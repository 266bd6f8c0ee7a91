// SPDX-License-Identifier: Apache-2.0
// What reaches whom when no message is lost. Internal.
#pragma once

#include <cstdint>
#include <vector>

#include "garrison/core/network.hpp"

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
    std::vector<int> queue;
    for (int i = 0; i < N; ++i) {
      auto& from = hops_.emplace_back(static_cast<std::size_t>(N), -1);
      from[static_cast<std::size_t>(i)] = 0;
      queue.assign(1, i);
      for (std::size_t at = 0; at < queue.size(); ++at)
        for (const int j : network.neighbours(queue[at])) {
          int& hops = from[static_cast<std::size_t>(j)];
          if (hops >= 0) continue;
          hops = from[static_cast<std::size_t>(queue[at])] + 1;
          queue.push_back(j);
          if (hops > most) return;
        }
      if (queue.size() < static_cast<std::size_t>(N)) return;
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
