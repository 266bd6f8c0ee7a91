// SPDX-License-Identifier: Apache-2.0
// A few doubles that are added and multiplied together, entry by entry.
#pragma once

#include <cstddef>
#include <utility>

#include "garrison/core/types.hpp"
#include "garrison/kernel/isa.hpp"

namespace garrison {

/// B doubles of a longer array, at any address. Operations are entry by entry, so the bits are those of a
/// loop. B must not be wider than a register: see run_widest.
template <int B>
struct Block {
  typedef double type __attribute__((vector_size(B * sizeof(double)), aligned(sizeof(double)), may_alias));

  static const type* of(const double* p) { return reinterpret_cast<const type*>(p); }
  static type* of(double* p) { return reinterpret_cast<type*>(p); }
};

/// Widest block of at most `most` (a power of two) that divides a row of W entries.
constexpr int block_of(int W, int most) { return W % most == 0 ? most : block_of(W, most / 2); }

/// B rows of B doubles become the columns.
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
    if constexpr (B > 1) exchange(std::integral_constant<int, 1>{});
    if constexpr (B > 2) exchange(std::integral_constant<int, 2>{});
    if constexpr (B > 4) exchange(std::integral_constant<int, 4>{});
  }(std::make_integer_sequence<int, B>{});
}

// In the functions below `most` is how many doubles a register of the caller's instruction set has; every
// machine has registers of two.

/// out = A x for a matrix stored column by column; every entry sums in the order of the columns.
template <int n, int most = 2>
GARRISON_INLINE void multiply(const double* A, const double* x, double* out, int nn) noexcept {
  if constexpr (n == Dynamic) {
    for (int i = 0; i < nn; ++i) out[i] = A[i] * x[0];
    for (int k = 1; k < nn; ++k)
      for (int i = 0; i < nn; ++i) out[i] += A[static_cast<std::ptrdiff_t>(k) * nn + i] * x[k];
  } else {
    constexpr int B = block_of(n, most);
    for (int i = 0; i < n; i += B) {
      auto sum = *Block<B>::of(A + i) * x[0];
      for (int k = 1; k < n; ++k) sum += *Block<B>::of(A + k * n + i) * x[k];
      *Block<B>::of(out + i) = sum;
    }
  }
}

/// out = x
template <int n, int most = 2>
GARRISON_INLINE void copy(const double* x, double* out, int nn) noexcept {
  if constexpr (n == Dynamic) {
    for (int k = 0; k < nn; ++k) out[k] = x[k];
  } else {
    constexpr int B = block_of(n, most);
    for (int k = 0; k < n; k += B) *Block<B>::of(out + k) = *Block<B>::of(x + k);
  }
}

/// x += factor c
template <int n, int most = 2>
GARRISON_INLINE void add_scaled(double factor, const double* c, double* x, int nn) noexcept {
  if constexpr (n == Dynamic) {
    for (int k = 0; k < nn; ++k) x[k] += factor * c[k];
  } else {
    constexpr int B = block_of(n, most);
    for (int k = 0; k < n; k += B) *Block<B>::of(x + k) += factor * *Block<B>::of(c + k);
  }
}

}  // namespace garrison
