// SPDX-License-Identifier: Apache-2.0
// The bound P_i >= cov(e_i) that an agent carries while its error is not stationary. Matrices are n x n,
// symmetric ones stored in full; messages hold their lower triangle.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace garrison::structural {

inline std::size_t entries(int n) { return static_cast<std::size_t>(n) * static_cast<std::size_t>(n); }
inline std::size_t packed(int n) { return static_cast<std::size_t>(n) * static_cast<std::size_t>(n + 1) / 2; }

inline void pack(const double* full, int n, double* lower) noexcept {
  for (int i = 0; i < n; ++i)
    for (int j = 0; j <= i; ++j) *lower++ = full[static_cast<std::ptrdiff_t>(i) * n + j];
}
/// full += weight * the symmetric matrix with this lower triangle
inline void add_packed(const double* lower, double weight, int n, double* full) noexcept {
  for (int i = 0; i < n; ++i)
    for (int j = 0; j <= i; ++j) {
      const double more = weight * *lower++;
      full[static_cast<std::ptrdiff_t>(i) * n + j] += more;
      if (i != j) full[static_cast<std::ptrdiff_t>(j) * n + i] += more;
    }
}
/// out = L S L' + out, S symmetric; entry (i, k) of L is L[i * row + k * column]. `half`: room for n x n.
inline void add_congruence(const double* L, int row, int column, const double* S, int n, double* half,
                           double* out) noexcept {
  const auto at = [n](int i, int j) { return static_cast<std::ptrdiff_t>(i) * n + j; };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      double sum = 0.0;
      for (int k = 0; k < n; ++k)
        sum +=
            L[static_cast<std::ptrdiff_t>(i) * row + static_cast<std::ptrdiff_t>(k) * column] * S[at(k, j)];
      half[at(i, j)] = sum;
    }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j <= i; ++j) {
      double sum = 0.0;
      for (int k = 0; k < n; ++k)
        sum += half[at(i, k)] *
               L[static_cast<std::ptrdiff_t>(j) * row + static_cast<std::ptrdiff_t>(k) * column];
      out[at(i, j)] += sum;
      if (i != j) out[at(j, i)] += sum;
    }
}
/// c'S c
inline double quadratic(const double* S, const double* c, int n) noexcept {
  double sum = 0.0;
  for (int i = 0; i < n; ++i) {
    double row = 0.0;
    for (int k = 0; k < n; ++k) row += S[static_cast<std::ptrdiff_t>(i) * n + k] * c[k];
    sum += c[i] * row;
  }
  return sum;
}
/// out += factor * (S c)(S c)'
inline void add_seen_outer(const double* S, const double* c, double factor, int n, double* out) noexcept {
  const auto seen = [&](int i) {
    double row = 0.0;
    for (int k = 0; k < n; ++k) row += S[static_cast<std::ptrdiff_t>(i) * n + k] * c[k];
    return row;
  };
  for (int i = 0; i < n; ++i) {
    const double left = factor * seen(i);
    for (int j = 0; j < n; ++j) out[static_cast<std::ptrdiff_t>(i) * n + j] += left * seen(j);
  }
}
/// out += factor * a b'
inline void add_outer(const double* a, const double* b, double factor, int n, double* out) noexcept {
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) out[static_cast<std::ptrdiff_t>(i) * n + j] += factor * a[i] * b[j];
}

}  // namespace garrison::structural
