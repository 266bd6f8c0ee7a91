// SPDX-License-Identifier: Apache-2.0
// The local covariance recursion (11) of one agent, in square-root form.
//
// With S S' = P_i, measurements whitened by R_i (unit noise) and taken one after the other (Potter):
//   f = S'h,  alpha = 1 + f'f,  k = S f / alpha,  S <- S - S f f' / (alpha + sqrt(alpha))
// then S S' = (I - Kf H) P_i, the filtered covariance, and
//   P_i(k+1) = (A S)(A S)' + Q                     the matrix of (11), never in Joseph's two products
//   K_i = A Kf of (9),  C_i = gamma A S S'         gamma A barM_i^-1 of the paper (note 1), no inverse of P
// alpha >= 1 and P is a sum of squares: nothing can fail, whatever R, P0 and A are. A pivot of S that is
// rounding of zero is zero, so singular P0 and Q are ordinary input.
#pragma once

#include <algorithm>
#include <cmath>

#include "garrison/core/block.hpp"
#include "garrison/core/clones.hpp"
#include "garrison/core/types.hpp"

namespace garrison::partial_sharing {

/// Where one agent's recursion works; all matrices column by column, m x m unless said otherwise.
struct Recursion {
  double* P;        ///< in: P(k), exactly symmetric; out: P(k+1)
  double* S;        ///< out: square root of the filtered covariance
  double* T;        ///< out: its transpose
  double* K;        ///< out: gain of the whitened innovations, outputs columns of m: A K W is K_i
  double* v;        ///< scratch, m
  double* f;        ///< scratch, m
  const double* H;  ///< whitened rows W H_i, outputs rows of m
  const double* A;
  const double* Q;
  int outputs;
  int states;
};

/// Sizes beyond this are not carried on: the recursion stands still rather than overflow.
inline constexpr double kLargestVariance = 1e150;

namespace kernel {

template <int n, int B>
GARRISON_INLINE void axpy(double factor, const double* x, double* y, int m) {
  if constexpr (n == Dynamic) {
    for (int i = 0; i < m; ++i) y[i] += factor * x[i];
  } else {
    constexpr int W = block_of(n, B);
    for (int i = 0; i < n; i += W) *Block<W>::of(y + i) += factor * *Block<W>::of(x + i);
  }
}
template <int n, int B>
GARRISON_INLINE void zero(double* y, int m) {
  const int count = n == Dynamic ? m : n;
  for (int i = 0; i < count; ++i) y[i] = 0.0;
}

/// S lower triangular with S S' = P, T = S'; pivots that are rounding of zero give a zero column.
template <int n, int B>
GARRISON_INLINE void square_root(const double* P, double* S, double* T, int mm) {
  const int m = n == Dynamic ? mm : n;
  for (int i = 0; i < m * m; ++i) S[i] = P[i];
  for (int k = 0; k < m; ++k) {
    double* const column = S + k * m;
    const double pivot = column[k];
    if (!(pivot > 4e-16 * m * P[k * m + k])) {
      zero<n, B>(column, m);
    } else {
      const double inverse = 1.0 / std::sqrt(pivot);
      for (int i = 0; i < m; ++i) column[i] *= inverse;
      for (int i = 0; i < k; ++i) column[i] = 0.0;
      for (int j = k + 1; j < m; ++j) axpy<n, B>(-column[j], column, S + j * m, m);
    }
    for (int i = 0; i < m; ++i) T[i * m + k] = column[i];
  }
}

template <int n, int B>
GARRISON_INLINE void use_row(const Recursion& r, int row) {
  const int m = n == Dynamic ? r.states : n;
  const double* const h = r.H + row * m;
  zero<n, B>(r.f, m);
  zero<n, B>(r.v, m);
  for (int c = 0; c < m; ++c) axpy<n, B>(h[c], r.T + c * m, r.f, m);
  double square = 0.0;
  for (int c = 0; c < m; ++c) square += r.f[c] * r.f[c];
  const double alpha = 1.0 + square;
  for (int c = 0; c < m; ++c) axpy<n, B>(r.f[c], r.S + c * m, r.v, m);
  double* const gain = r.K + row * m;
  for (int i = 0; i < m; ++i) gain[i] = r.v[i] / alpha;
  for (int before = 0; before < row;
       ++before) {  // gains for one common innovation instead of one after the other
    double seen = 0.0;
    for (int i = 0; i < m; ++i) seen += h[i] * r.K[before * m + i];
    axpy<n, B>(-seen, gain, r.K + before * m, m);
  }
  const double beta = 1.0 / (alpha + std::sqrt(alpha));
  for (int c = 0; c < m; ++c) axpy<n, B>(-beta * r.f[c], r.v, r.S + c * m, m);
  for (int c = 0; c < m; ++c) axpy<n, B>(-beta * r.v[c], r.f, r.T + c * m, m);
}

/// P <- (A S)(A S)' + Q; returns the largest change of an entry over the largest entry. Uses v.
template <int n, int B>
GARRISON_INLINE double predict(const Recursion& r, double* next) {
  const int m = n == Dynamic ? r.states : n;
  for (int i = 0; i < m * m; ++i) next[i] = r.Q[i];
  for (int c = 0; c < m; ++c) {
    zero<n, B>(r.v, m);
    for (int k = 0; k < m; ++k) axpy<n, B>(r.S[c * m + k], r.A + k * m, r.v, m);
    for (int j = 0; j < m; ++j) axpy<n, B>(r.v[j], r.v, next + j * m, m);
  }
  double change = 0.0;
  double size = 0.0;
  for (int i = 0; i < m * m; ++i) {
    change = std::max(change, std::abs(next[i] - r.P[i]));
    size = std::max(size, std::abs(next[i]));
  }
  if (!(size < kLargestVariance)) return 0.0;
  for (int i = 0; i < m * m; ++i) r.P[i] = next[i];
  return size > 0.0 ? change / size : 0.0;
}

}  // namespace kernel

/// One step of (9) and (11). `next`: scratch, m x m. Returns how much P changed, relative to its largest
/// entry; 0 also when it would have grown beyond kLargestVariance and was left as it is. B: doubles per
/// register.
template <int n, int B>
GARRISON_INLINE double advance(const Recursion& r, double* next) noexcept {
  kernel::square_root<n, B>(r.P, r.S, r.T, r.states);
  for (int row = 0; row < r.outputs; ++row) kernel::use_row<n, B>(r, row);
  return kernel::predict<n, B>(r, next);
}

/// Change up to which the recursion counts as converged: rounding.
inline constexpr double kConverged = 2e-15;

}  // namespace garrison::partial_sharing
