// SPDX-License-Identifier: Apache-2.0
// Sums that do not depend on the order of what is added, and so not on which rank adds it.
#pragma once

#include <array>
#include <cstdint>

#include "partition/exchange.hpp"

namespace garrison::partition {

/// Sum of up to 2^31 numbers of at most 2 in size, each cut off at a multiple of 2^-90.
class ExactSum {
 public:
  void add(double term) { units_ += static_cast<Units>(term * kUnit); }
  /// Over all ranks, the same on each. All ranks together.
  double total(Exchange& exchange) const {
    // In pieces that leave room for carries: the lower ones are never negative.
    std::array<std::int64_t, 4> pieces{};
    Units rest = units_;
    for (std::size_t k = 0; k < 3; ++k, rest >>= 32)
      pieces[k] = static_cast<std::int64_t>(rest & Units{0xffffffff});
    pieces[3] = static_cast<std::int64_t>(rest);
    exchange.sum(pieces);
    Units all = pieces[3];
    for (std::size_t k = 3; k-- > 0;) all = all * (Units{1} << 32) + pieces[k];
    return static_cast<double>(all) / kUnit;
  }

 private:
  __extension__ using Units = __int128;
  static constexpr double kUnit = 0x1p90;
  Units units_ = 0;
};

}  // namespace garrison::partition
