// SPDX-License-Identifier: Apache-2.0
// What reaches whom when no message is lost. Internal.
#pragma once

#include <cstdint>
#include <vector>

#include "core/hops.hpp"

namespace garrison::detail {

/// Hops from every agent to every other, in the direction in which messages travel.
class Flood {
 public:
  Flood() = default;
  /// Of a network in which everybody reaches everybody.
  explicit Flood(const Network& network) {
    for (int i = 0; i < network.agents(); ++i) hops_.push_back(detail::hops_from(network, i).to);
  }
  /// From agent `from` to agent `to`.
  int hops(int from, int to) const {
    return hops_[static_cast<std::size_t>(to)][static_cast<std::size_t>(from)];
  }

 private:
  std::vector<std::vector<int>> hops_;  // of each receiver
};

}  // namespace garrison::detail
