// SPDX-License-Identifier: Apache-2.0
// One agent's round of Laplacian averaging: the single definition that filters and kernels share.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "garrison/core/types.hpp"

namespace garrison {

/// Entry k of a round: x - alpha (d x - sum of the d neighbours' entries), (5) with the sum taken first.
/// V: a double, or a vector of them, entry by entry.
template <class V>
inline __attribute__((always_inline)) V averaged_entry(V x, V sum, double degree, double alpha) noexcept {
  return x - alpha * (degree * x - sum);
}

/// The same, Chebyshev-filtered: omega * plain - (omega - 1) * entry one round ago.
template <class V>
inline __attribute__((always_inline)) V averaged_entry(V x, V sum, double degree, double alpha, double omega,
                                                       V previous) noexcept {
  return omega * averaged_entry(x, sum, degree, alpha) - (omega - 1.0) * previous;
}

/// One round of one agent, in place: x (n numbers) becomes its average with `count` neighbours, whose rows
/// are `row(0) .. row(count-1)`; `previous` becomes the old x, null where no round is Chebyshev-filtered.
/// Sums start with the first row and run in the order of the rows, entry by entry, so the bits do not depend
/// on vector width. omega = 1 is a plain round.
template <int n, class Row>
inline void average_round(int nn, double alpha, double omega, double* x, double* previous, std::size_t count,
                          const Row& row) noexcept {
  const auto degree = static_cast<double>(count);
  const auto finish = [&](int k, double sum) {
    const double next = omega == 1.0 ? averaged_entry(x[k], sum, degree, alpha)
                                     : averaged_entry(x[k], sum, degree, alpha, omega, previous[k]);
    if (previous != nullptr) previous[k] = x[k];
    x[k] = next;
  };
  if constexpr (n == Dynamic) {
    for (int k = 0; k < nn; ++k) {
      double sum = count > 0 ? row(0)[k] : 0.0;
      for (std::size_t j = 1; j < count; ++j) sum += row(j)[k];
      finish(k, sum);
    }
  } else {
    std::array<double, static_cast<std::size_t>(n)> sum{};
    if (count > 0) std::copy_n(row(0), n, sum.begin());
    for (std::size_t j = 1; j < count; ++j) {
      const double* other = row(j);
      for (int k = 0; k < n; ++k) sum[static_cast<std::size_t>(k)] += other[k];
    }
    for (int k = 0; k < n; ++k) finish(k, sum[static_cast<std::size_t>(k)]);
  }
}

}  // namespace garrison
