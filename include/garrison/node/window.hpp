// SPDX-License-Identifier: Apache-2.0
// Which counters of a session were seen: each is taken once, in a window behind the greatest (RFC 6479 has
// the idea).
#pragma once

#include <bitset>
#include <cstdint>

namespace garrison::node {

/// Threads: one at a time.
class Window {
 public:
  static constexpr std::uint64_t kWidth = 1024;

  bool fresh(std::uint64_t counter) const noexcept {
    if (counter > top_) return true;
    return counter != 0 && top_ - counter < kWidth && !seen_[counter % kWidth];
  }
  /// Only once the frame is known to be genuine.
  void mark(std::uint64_t counter) noexcept {
    if (counter > top_) {
      if (counter - top_ >= kWidth)
        seen_.reset();
      else
        for (std::uint64_t k = top_ + 1; k <= counter; ++k) seen_[k % kWidth] = false;
      top_ = counter;
    }
    seen_[counter % kWidth] = true;
  }

 private:
  std::uint64_t top_ = 0;
  std::bitset<kWidth> seen_;
};

}  // namespace garrison::node
