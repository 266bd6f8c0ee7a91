// SPDX-License-Identifier: Apache-2.0
// Which rounds of a sample share an exchange.
#pragma once

#include <algorithm>
#include <cstddef>

namespace garrison::partition {

/// A round of a sample with `rounds` of them, where ghosts are known `depth` hops away: every round takes
/// away one hop of what is known of them, and an exchange brings it back.
struct Block {
  bool first;         ///< there is an exchange before this round
  std::size_t reach;  ///< hops from own agents within which this round is worked out

  Block(int round, int rounds, int depth)
      : first(round % depth == 0),
        reach(static_cast<std::size_t>(std::min(depth, rounds - round + round % depth) - 1 - round % depth)) {
  }
};

}  // namespace garrison::partition
