// SPDX-License-Identifier: Apache-2.0
// The bound P_i >= cov(e_i) that an agent carries while its error is not stationary. Matrices are n x n,
// symmetric ones stored in full, or packed: their lower triangle row by row, as in messages. What is added to
// shares no memory with what is read.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "garrison/core/types.hpp"

namespace garrison::structural {

inline std::size_t entries(int n) { return static_cast<std::size_t>(n) * static_cast<std::size_t>(n); }
inline std::size_t packed(int n) { return static_cast<std::size_t>(n) * static_cast<std::size_t>(n + 1) / 2; }

/// n numbers that loops add to: in registers where n is known when this is compiled, else in `memory`.
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
void pack(const double* full, int nn, double* __restrict__ lower) noexcept {
  const int size = n == Dynamic ? nn : n;
  for (int i = 0; i < size; ++i)
    for (int j = 0; j <= i; ++j) *lower++ = full[static_cast<std::ptrdiff_t>(i) * size + j];
}
template <int n>
void unpack(const double* lower, int nn, double* __restrict__ full) noexcept {
  const int size = n == Dynamic ? nn : n;
  for (int i = 0; i < size; ++i)
    for (int j = 0; j <= i; ++j, ++lower) {
      full[static_cast<std::ptrdiff_t>(i) * size + j] = *lower;
      full[static_cast<std::ptrdiff_t>(j) * size + i] = *lower;
    }
}
/// sum += weight * the packed matrix
template <int n>
void add_packed(const double* lower, double weight, int nn, double* __restrict__ sum) noexcept {
  const int size = static_cast<int>(packed(n == Dynamic ? nn : n));
  for (int k = 0; k < size; ++k) sum[k] += weight * lower[k];
}
/// out = L S L' + out, S symmetric; entry (i, k) of L is L[i * row + k * column]. `half`: room for n x n.
template <int n>
void add_congruence(const double* L, int row, int column, const double* S, int nn, double* __restrict__ half,
                    double* __restrict__ out) noexcept {
  const int size = n == Dynamic ? nn : n;
  const auto at = [size](int i, int j) { return static_cast<std::ptrdiff_t>(i) * size + j; };
  const auto l = [=](int i, int k) {
    return L[static_cast<std::ptrdiff_t>(i) * row + static_cast<std::ptrdiff_t>(k) * column];
  };
  for (int i = 0; i < size; ++i) {
    for (int j = 0; j < size; ++j) half[at(i, j)] = l(i, 0) * S[j];
    for (int k = 1; k < size; ++k)
      for (int j = 0; j < size; ++j) half[at(i, j)] += l(i, k) * S[at(k, j)];
  }
  for (int i = 0; i < size; ++i)
    for (int j = 0; j <= i; ++j) {
      double sum = 0.0;
      for (int k = 0; k < size; ++k) sum += half[at(i, k)] * l(j, k);
      out[at(i, j)] += sum;
      if (i != j) out[at(j, i)] += sum;
    }
}
/// c'S c
template <int n>
double quadratic(const double* S, const double* c, int nn) noexcept {
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
template <int n>
void add_seen_outer(const double* S, const double* c, double factor, int nn,
                    double* __restrict__ out) noexcept {
  const int size = n == Dynamic ? nn : n;
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
template <int n>
void add_outer(const double* a, const double* b, double factor, int nn, double* __restrict__ out) noexcept {
  const int size = n == Dynamic ? nn : n;
  for (int i = 0; i < size; ++i) {
    const double left = factor * a[i];
    for (int j = 0; j < size; ++j) out[static_cast<std::ptrdiff_t>(i) * size + j] += left * b[j];
  }
}

}  // namespace garrison::structural
