// SPDX-License-Identifier: Apache-2.0
// Who is where in the string: (5), (13), (30). Ids 0..N-1 are the paper's labels 1..N.
#pragma once

#include <algorithm>
#include <vector>

#include "garrison/core/network.hpp"

namespace garrison::platoon {

/// (5): vehicle `id` hears 2 L others.
inline bool in_V1(int id, int vehicles, int range) noexcept { return id >= range && id < vehicles - range; }
/// (30): the next ones, towards the leader first; -1 stands for the reference that leads vehicle 0. The
/// reference itself (id -1) has vehicle 0.
GARRISON_EXPORT std::vector<int> nearest(int id, int vehicles);
/// The range L of a network in which exactly the vehicles at most L places apart hear each other.
/// @throws InvalidInput for any other network, or when no vehicle hears 2 L others
int range_of(const Network& network);

/// (13): the best source of a vehicle outside V_1: of those that are in V_1 or free, the nearest; among two
/// equally near the one with the smaller error bound when `by_bound`, else (or when equal) the lower id.
/// `distance` = |i - j| and `alpha` of the candidates, offered in ascending order of id.
/// Threads: one at a time.
class BestSource {
 public:
  explicit BestSource(bool by_bound) : by_bound_(by_bound) {}
  void offer(int id, int distance, double alpha) noexcept {
    const bool better =
        id_ < 0 || distance < distance_ || (by_bound_ && distance == distance_ && alpha < alpha_);
    if (!better) return;
    id_ = id;
    distance_ = distance;
    alpha_ = alpha;
  }
  int id() const noexcept { return id_; }  ///< -1: none

 private:
  bool by_bound_;
  int id_ = -1;
  int distance_ = 0;
  double alpha_ = 0.0;
};

}  // namespace garrison::platoon
