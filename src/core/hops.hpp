// SPDX-License-Identifier: Apache-2.0
// How far agents are apart.
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "garrison/core/network.hpp"

namespace garrison::detail {

struct Hops {
  std::vector<int> to;  ///< per agent, against the direction of its links; -1 = not reached
  int furthest = 0;     ///< of those that are reached
  bool reaches_all = false;
};

/// Hops from `agent` to those that it hears, directly or through others.
inline Hops hops_from(const Network& network, int agent) {
  const auto N = static_cast<std::size_t>(network.agents());
  Hops hops;
  hops.to.assign(N, -1);
  hops.to[static_cast<std::size_t>(agent)] = 0;
  std::vector<int> queue{agent};
  for (std::size_t at = 0; at < queue.size(); ++at)
    for (const int j : network.neighbours(queue[at])) {
      int& found = hops.to[static_cast<std::size_t>(j)];
      if (found >= 0) continue;
      found = hops.to[static_cast<std::size_t>(queue[at])] + 1;
      queue.push_back(j);
    }
  hops.furthest = hops.to[static_cast<std::size_t>(queue.back())];
  hops.reaches_all = queue.size() == N;
  return hops;
}

/// Hops between the agents that are furthest apart; none where some are never reached.
inline std::optional<int> diameter(const Network& network) {
  int furthest = 0;
  for (int from = 0; from < network.agents(); ++from) {
    const Hops hops = hops_from(network, from);
    if (!hops.reaches_all) return {};
    furthest = std::max(furthest, hops.furthest);
  }
  return furthest;
}

}  // namespace garrison::detail
