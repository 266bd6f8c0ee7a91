// SPDX-License-Identifier: Apache-2.0
// Whether numbers are small enough to work with.
#pragma once

#include <cstddef>

#include "garrison/core/types.hpp"
#include "garrison/kernel/block.hpp"
#include "garrison/kernel/isa.hpp"

namespace garrison {

namespace detail {
/// `nan`: what it counts as.
template <bool nan>
struct AllBelow {
  template <int B>
  GARRISON_INLINE static void run(const double* x, std::size_t count, double limit, bool* all) noexcept {
    using V = typename Block<B>::type;
    const V most = V{} + limit;
    V beyond{};
    std::size_t k = 0;
    for (; k + B <= count; k += B) {
      const V value = *Block<B>::of(x + k);
      const V size = value < 0.0 ? -value : value;
      if constexpr (nan)
        beyond = size >= most ? V{} + 1.0 : beyond;
      else
        beyond = size < most ? beyond : V{} + 1.0;
    }
    for (; k < count; ++k) {
      const double size = x[k] < 0.0 ? -x[k] : x[k];
      const bool below = nan ? !(size >= limit) : size < limit;
      beyond[0] = below ? beyond[0] : 1.0;
    }
    *all = true;
    for (int lane = 0; lane < B; ++lane) *all = *all && beyond[lane] == 0.0;
  }
};
}  // namespace detail

/// Whether every |x| < limit; NaN is not.
inline bool all_below(const double* x, std::size_t count, double limit) noexcept {
  bool all = true;
  run_widest<detail::AllBelow<false>>(x, count, limit, &all);
  return all;
}

/// The same, where NaN stands for what is missing and counts as small.
inline bool known_below(const double* x, std::size_t count, double limit) noexcept {
  bool all = true;
  run_widest<detail::AllBelow<true>>(x, count, limit, &all);
  return all;
}

/// Whether no number is infinite or NaN.
inline bool all_finite(const double* x, std::size_t count) noexcept { return all_below(x, count, kInfinity); }

}  // namespace garrison
