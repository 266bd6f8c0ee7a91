// SPDX-License-Identifier: Apache-2.0
// The bound P_i >= cov(e_i) that an agent carries while its error is not stationary. Matrices are n x n,
// symmetric ones stored in full, or packed: their lower triangle row by row, as in messages. What is added to
// shares no memory with what is read.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "garrison/core/types.hpp"
#include "garrison/kernel/block.hpp"

namespace garrison::structural {

inline std::size_t entries(int n) { return static_cast<std::size_t>(n) * static_cast<std::size_t>(n); }
inline std::size_t packed(int n) { return static_cast<std::size_t>(n) * static_cast<std::size_t>(n + 1) / 2; }

/// n numbers that loops add to: in registers where n is known when this is compiled, else in `memory`.
/// Threads: one at a time.
template <int n>
class Sums {
 public:
  explicit Sums(double*) {}
  double* data() noexcept { return numbers_.data(); }

 private:
  std::array<double, static_cast<std::size_t>(n)> numbers_;
};
template <>
class Sums<Dynamic> {
 public:
  explicit Sums(double* memory) : memory_(memory) {}
  double* data() noexcept { return memory_; }

 private:
  double* memory_;
};

template <int n>
GARRISON_INLINE void pack(const double* full, int nn, double* __restrict__ lower) noexcept {
  const int size = n == Dynamic ? nn : n;
  for (int i = 0; i < size; ++i)
    for (int j = 0; j <= i; ++j) *lower++ = full[static_cast<std::ptrdiff_t>(i) * size + j];
}
template <int n>
GARRISON_INLINE void unpack(const double* lower, int nn, double* __restrict__ full) noexcept {
  const int size = n == Dynamic ? nn : n;
  for (int i = 0; i < size; ++i)
    for (int j = 0; j <= i; ++j, ++lower) {
      full[static_cast<std::ptrdiff_t>(i) * size + j] = *lower;
      full[static_cast<std::ptrdiff_t>(j) * size + i] = *lower;
    }
}
/// sum += weight * the packed matrix
template <int n>
GARRISON_INLINE void add_packed(const double* lower, double weight, int nn,
                                double* __restrict__ sum) noexcept {
  const int size = static_cast<int>(packed(n == Dynamic ? nn : n));
  for (int k = 0; k < size; ++k) sum[k] += weight * lower[k];
}
/// body(width, j) for all numbers j .. j + width - 1 of a row, in blocks of at most B: of one width where n
/// is known when this is compiled, else what is left over from `first` on in narrower ones.
template <int B, int n, class Body>
GARRISON_INLINE void for_each_block(int size, const Body& body, int first = 0) {
  constexpr int W = n == Dynamic ? B : block_of(n, B);
  int j = first;
  for (; j + W <= size; j += W) body(std::integral_constant<int, W>{}, j);
  if constexpr (n == Dynamic && W > 1) for_each_block<W / 2, n>(size, body, j);
}
/// out = L S L' + out, S symmetric; L column by column, so that all rows are read along memory. `half`: room
/// for n x n. B: doubles of a register.
template <int B, int n>
GARRISON_INLINE void add_congruence(const double* L, const double* S, int nn, double* __restrict__ half,
                                    double* __restrict__ out) noexcept {
  const int size = n == Dynamic ? nn : n;
  const auto at = [size](int i, int j) { return static_cast<std::ptrdiff_t>(i) * size + j; };
  for (int i = 0; i < size; ++i)
    for_each_block<B, n>(size, [&]<int W>(std::integral_constant<int, W>, int j) GARRISON_INLINED {
      auto sum = L[i] * *Block<W>::of(S + j);
      for (int k = 1; k < size; ++k) sum += L[at(k, i)] * *Block<W>::of(S + at(k, j));
      *Block<W>::of(half + at(i, j)) = sum;
    });
  for (int i = 0; i < size; ++i)
    for_each_block<B, n>(size, [&]<int W>(std::integral_constant<int, W>, int j) GARRISON_INLINED {
      auto sum = *Block<W>::of(out + at(i, j));
      for (int k = 0; k < size; ++k) sum += half[at(i, k)] * *Block<W>::of(L + at(k, j));
      *Block<W>::of(out + at(i, j)) = sum;
    });
}
/// Whether no entry of S is larger than positive semidefinite matrices with its diagonal have it, and that
/// diagonal is in [0, most * limit], all up to rounding. NaN is not.
template <int B, int n>
GARRISON_INLINE bool is_covariance(const double* S, double most, double limit, int nn) noexcept {
  const int size = n == Dynamic ? nn : n;
  bool all = true;
  for_each_block<B, n>(size, [&]<int W>(std::integral_constant<int, W>, int j) GARRISON_INLINED {
    using V = typename Block<W>::type;
    V d{};  // put together in a register: what was stored number by number is slow to read as a block
    for (int lane = 0; lane < W; ++lane) d[lane] = S[static_cast<std::ptrdiff_t>(j + lane) * (size + 1)];
    V bad = ((d >= -1e-9 * most) & (d <= limit * most)) ? V{} : V{} + 1.0;
    for (int i = 0; i < size; ++i) {
      const V entry = *Block<W>::of(S + static_cast<std::ptrdiff_t>(i) * size + j);
      const V largest = S[static_cast<std::ptrdiff_t>(i) * (size + 1)] * d;
      bad += entry * entry <= largest + 1e-9 * (largest + most * most) ? V{} : V{} + 1.0;
    }
    for (int lane = 0; lane < W; ++lane) all = all && bad[lane] == 0.0;
  });
  return all;
}
/// c'S c
template <int n>
GARRISON_INLINE double quadratic(const double* S, const double* c, int nn) noexcept {
  const int size = n == Dynamic ? nn : n;
  double sum = 0.0;
  for (int i = 0; i < size; ++i) {
    double row = 0.0;
    for (int k = 0; k < size; ++k) row += S[static_cast<std::ptrdiff_t>(i) * size + k] * c[k];
    sum += c[i] * row;
  }
  return sum;
}
/// out += factor * (S c)(S c)'
inline void add_seen_outer(const double* S, const double* c, double factor, int size,
                           double* __restrict__ out) noexcept {
  const auto seen = [&](int i) {
    double row = 0.0;
    for (int k = 0; k < size; ++k) row += S[static_cast<std::ptrdiff_t>(i) * size + k] * c[k];
    return row;
  };
  for (int i = 0; i < size; ++i) {
    const double left = factor * seen(i);
    for (int j = 0; j < size; ++j) out[static_cast<std::ptrdiff_t>(i) * size + j] += left * seen(j);
  }
}
/// out += factor * a b'
template <int B, int n>
GARRISON_INLINE void add_outer(const double* a, const double* b, double factor, int nn,
                               double* __restrict__ out) noexcept {
  const int size = n == Dynamic ? nn : n;
  for (int i = 0; i < size; ++i)
    for_each_block<B, n>(size, [&]<int W>(std::integral_constant<int, W>, int j) GARRISON_INLINED {
      *Block<W>::of(out + static_cast<std::ptrdiff_t>(i) * size + j) += factor * a[i] * *Block<W>::of(b + j);
    });
}

}  // namespace garrison::structural
