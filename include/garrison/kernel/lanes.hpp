// SPDX-License-Identifier: Apache-2.0
// Things calculated side by side, one in every lane of a register: how their numbers get there and back.
#pragma once

#include <cstddef>
#include <utility>

#include "garrison/core/types.hpp"
#include "garrison/kernel/block.hpp"
#include "garrison/kernel/isa.hpp"

namespace garrison {

/// Where entry (i, j), j <= i, of a symmetric or lower triangular matrix is; also the number of entries
/// before row i.
constexpr int packed(int i, int j = 0) { return i * (i + 1) / 2 + j; }

/// `body(i)` for i = 0..m-1, unrolled where n is known.
template <int n, class Body>
GARRISON_INLINE void for_each_state(int m, const Body& body) {
  if constexpr (n == Dynamic)
    for (int i = 0; i < m; ++i) body(i);
  else
    [&]<int... i>(std::integer_sequence<int, i...>) GARRISON_INLINED {
      (body(std::integral_constant<int, i>{}), ...);
    }(std::make_integer_sequence<int, n>{});
}

/// m numbers each of `used` things, one thing after the other, into a lane for each. Idle lanes repeat the
/// last one.
template <int n, int B>
GARRISON_INLINE void load_lanes(const double* from, int m, int used, typename Block<B>::type* to) {
  if constexpr (n != Dynamic && n % B == 0) {
    if (used == B) {
      for (int first = 0; first < n; first += B) {
        for (int lane = 0; lane < B; ++lane) to[first + lane] = *Block<B>::of(from + lane * n + first);
        transpose<B>(to + first);
      }
      return;
    }
  }
  for (int i = 0; i < m; ++i)
    for (int lane = 0; lane < B; ++lane)
      to[i][lane] = from[static_cast<std::ptrdiff_t>(lane < used ? lane : used - 1) * m + i];
}

/// The way back; idle lanes go nowhere.
template <int n, int B>
GARRISON_INLINE void store_lanes(const typename Block<B>::type* from, int m, int used, double* to) {
  if constexpr (n != Dynamic && n % B == 0) {
    if (used == B) {
      for (int first = 0; first < n; first += B) {
        typename Block<B>::type row[std::size_t{B}];
        for (int lane = 0; lane < B; ++lane) row[lane] = from[first + lane];
        transpose<B>(row);
        for (int lane = 0; lane < B; ++lane) *Block<B>::of(to + lane * n + first) = row[lane];
      }
      return;
    }
  }
  for (int lane = 0; lane < used; ++lane)
    for (int i = 0; i < m; ++i) to[static_cast<std::ptrdiff_t>(lane) * m + i] = from[i][lane];
}

}  // namespace garrison
