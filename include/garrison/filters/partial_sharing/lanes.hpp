// SPDX-License-Identifier: Apache-2.0
// A few agents side by side: where their numbers are, and how they get there.
#pragma once

#include <cstddef>
#include <utility>

#include "garrison/core/block.hpp"
#include "garrison/core/clones.hpp"
#include "garrison/core/types.hpp"

namespace garrison::partial_sharing {

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

/// B x B numbers between agent by agent and a lane per agent.
template <int B>
GARRISON_INLINE void transpose(typename Block<B>::type* row) {
  [&]<int... l>(std::integer_sequence<int, l...>) GARRISON_INLINED {
    const auto exchange = [&]<int width>(std::integral_constant<int, width>) GARRISON_INLINED {
      for (int k = 0; k < B; ++k) {
        if ((k & width) != 0) continue;
        const auto a = row[k];
        const auto b = row[k + width];
        row[k] = __builtin_shufflevector(a, b, ((l & width) == 0 ? l : B + l - width)...);
        row[k + width] = __builtin_shufflevector(a, b, ((l & width) == 0 ? l + width : B + l)...);
      }
    };
    exchange(std::integral_constant<int, 1>{});
    if constexpr (B > 2) exchange(std::integral_constant<int, 2>{});
    if constexpr (B > 4) exchange(std::integral_constant<int, 4>{});
  }(std::make_integer_sequence<int, B>{});
}

/// m numbers each of `used` agents, one agent after the other, into a lane per agent. Idle lanes repeat the
/// last agent.
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
        typename Block<B>::type row[B];
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

}  // namespace garrison::partial_sharing
