// SPDX-License-Identifier: Apache-2.0
// Predictions of many agents at once.
#pragma once

#include <cstddef>

#include "garrison/core/block.hpp"
#include "garrison/core/clones.hpp"
#include "garrison/core/types.hpp"

namespace garrison {

namespace detail {
template <int n>
struct Predict {
  template <int B>
  GARRISON_INLINE static void run(const double* A, const double* x, double* out,
                                  std::size_t agents) noexcept {
    for (std::size_t k = 0; k < agents; ++k, x += n, out += n) multiply<n, B>(A, x, out, n);
  }
};
}  // namespace detail

/// out = A x of every agent, agent by agent; A column by column. The bits are those of `multiply`.
template <int n>
void predict(const double* A, const double* x, double* out, std::size_t agents, int nn) noexcept {
  if constexpr (n == Dynamic) {
    const auto row = static_cast<std::size_t>(nn);
    for (std::size_t k = 0; k < agents; ++k) multiply<n>(A, x + k * row, out + k * row, nn);
  } else {
    run_widest_of<detail::Predict<n>, n>(A, x, out, agents);
  }
}

}  // namespace garrison
