// SPDX-License-Identifier: Apache-2.0
// What is done to the estimates of many agents at once before they hear from each other.
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
    constexpr int W = block_of(n, B);
    using V = typename Block<W>::type;
    for (std::size_t k = 0; k < agents; ++k, x += n, out += n) {
      V sum[n / W];
      for (int c = 0; c < n / W; ++c) sum[c] = *Block<W>::of(A + c * W) * x[0];
      for (int i = 1; i < n; ++i)
        for (int c = 0; c < n / W; ++c) sum[c] += *Block<W>::of(A + i * n + c * W) * x[i];
      for (int c = 0; c < n / W; ++c) *Block<W>::of(out + c * W) = sum[c];
    }
  }
};

struct Finite {
  template <int B>
  GARRISON_INLINE static void run(const double* x, std::size_t count, bool* finite) noexcept {
    typename Block<B>::type zeros{};  // turn into NaN when a number is not finite
    std::size_t k = 0;
    for (; k + B <= count; k += B) zeros += 0.0 * *Block<B>::of(x + k);
    for (; k < count; ++k) zeros[0] += 0.0 * x[k];
    for (int lane = 0; lane < B; ++lane) *finite = *finite && zeros[lane] == 0.0;
  }
};
}  // namespace detail

/// out = A x of every agent, agent by agent; A column by column. The bits are those of `multiply`.
template <int n>
void predict(const double* A, const double* x, double* out, std::size_t agents, int nn) noexcept {
  if constexpr (n == Dynamic) {
    const auto row = static_cast<std::size_t>(nn);
    for (std::size_t k = 0; k < agents; ++k) multiply<n>(A, x + k * row, out + k * row, nn);
  } else if constexpr (n % 4 == 0) {
    run_widest<detail::Predict<n>>(A, x, out, agents);
  } else {
    detail::Predict<n>::template run<2>(A, x, out, agents);
  }
}

/// Whether no number is infinite or NaN.
inline bool all_finite(const double* x, std::size_t count) noexcept {
  bool finite = true;
  run_widest<detail::Finite>(x, count, &finite);
  return finite;
}

}  // namespace garrison
