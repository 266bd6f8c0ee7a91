// SPDX-License-Identifier: Apache-2.0
// The local covariance recursion (11) of several agents side by side, in square-root form.
//
// P_i(k) = L D L' (unit lower triangle, diagonal), a measurement row h of unit noise after the other:
//   l = M'L'h,  g = D l,  alpha = 1 + l'g,  M <- M (I - g l' / (alpha + sqrt(alpha))),     M = I at first
// since (I - b g l') D (I - b g l')' = D - g g'/alpha, which is Potter's update without a root of P. Then
//   (I - Kf H) P_i = L M D M'L'                     the filtered covariance; its gain times innovations is
//   Kf e = L sum_r M_(r-1) g_r (e_r - h_r'(Kf e so far)) / alpha_r
//   P_i(k+1) = (A L M) D (A L M)' + Q               the matrix of (11), never in Joseph's two products
//   K_i = A Kf of (9),  C_i = gamma A L M D M'L'    gamma A barM_i^-1 of the paper
//   (docs/filters/partial_sharing.md#m1), no inverse of P
// alpha >= 1, D >= 0, and P is a sum of squares: nothing can fail, whatever R, P0 and A are. A pivot that is
// rounding of zero is zero, so singular P0 and Q are ordinary input. No agent's numbers meet those of
// another, and every entry sums in one order: the bits are the same for any number of agents side by side.
#pragma once

#include <cmath>

#include "garrison/kernel/lanes.hpp"

namespace garrison::partial_sharing {

/// Sizes beyond this are not carried on: the recursion stands still rather than overflow.
inline constexpr double kLargestVariance = 1e150;
/// Change up to which the recursion counts as converged: rounding.
inline constexpr double kConverged = 2e-15;
/// Pivots below this have no reciprocal.
inline constexpr double kLeastPivot = 1e-290;

/// One step of B agents. Matrices are packed; entries of one agent are `stride` values apart.
/// Threads: one at a time.
template <int n, int B>
class Recursion {
 public:
  using V = typename Block<B>::type;

  /// Values of scratch: of its own, and for every measurement row.
  static constexpr int scratch(int m) { return 2 * packed(m) + 5 * m + m * m; }
  static constexpr int scratch_per_row(int m) { return 3 * m + 2; }

  GARRISON_INLINE Recursion(V* scratch, V* rows, int states, int outputs) : states_(states), q(outputs) {
    L = scratch;
    c = L + packed(states);
    d = c + packed(states);
    h = d + states;
    v = h + states;
    x = v + states;
    b = x + states;
    F = b + states;
    raw = rows;
    l = raw + outputs * states;
    g = l + outputs * states;
    reciprocal = g + outputs * states;
    beta = reciprocal + outputs;
  }

  /// P = L D L'; pivots that are rounding of zero give a zero in D.
  GARRISON_INLINE void factor(const V* P, int stride) {
    for_each_state<n>(m(), [&](auto j) GARRISON_INLINED {
      V pivot = P[packed(j, j) * stride];
      const V size = pivot;
      for (int k = 0; k < j; ++k) pivot -= L[packed(j, k)] * c[packed(j, k)];
      const auto counts = pivot > 4e-16 * m() * size + kLeastPivot;
      d[j] = counts ? pivot : V{};
      const V inverse = counts ? 1.0 / pivot : V{};
      for (int i = j + 1; i < m(); ++i) {
        V sum = P[packed(i, j) * stride];
        for (int k = 0; k < j; ++k) sum -= L[packed(i, k)] * c[packed(j, k)];
        c[packed(i, j)] = sum;  // L D
        L[packed(i, j)] = sum * inverse;
      }
    });
  }

  /// Row r = 0, 1, .. of the whitened measurements.
  GARRISON_INLINE void use_row(int r, const V* row) {
    V* const lr = l + r * m();
    V* const gr = g + r * m();
    transposed(row, raw + r * m());
    for (int j = 0; j < m(); ++j) lr[j] = raw[r * m() + j];
    for (int s = 0; s < r; ++s) reflect(beta[s], l + s * m(), g + s * m(), lr);
    for (int j = 0; j < m(); ++j) gr[j] = d[j] * lr[j];
    V alpha;
    dot(lr, gr, alpha);
    alpha += 1.0;
    V root = alpha;
    for (int lane = 0; lane < B; ++lane) root[lane] = std::sqrt(root[lane]);
    reciprocal[r] = 1.0 / alpha;
    beta[r] = 1.0 / (alpha + root);
  }

  /// out += Kf e + gamma (I - Kf H) P u
  GARRISON_INLINE void correct(const V* e, const V* u, double gamma, V* out) {
    transposed(u, v);
    for (int r = 0; r < q; ++r) reflect(beta[r], l + r * m(), g + r * m(), v);
    for (int j = 0; j < m(); ++j) v[j] *= d[j];
    for (int r = q; r-- > 0;) reflect(beta[r], g + r * m(), l + r * m(), v);
    for (int j = 0; j < m(); ++j) x[j] = V{};
    for (int r = 0; r < q; ++r) {
      V t;
      dot(raw + r * m(), x, t);
      t = (e[r] - t) * reciprocal[r];
      for (int j = 0; j < m(); ++j) h[j] = g[r * m() + j] * t;
      for (int s = r; s-- > 0;) reflect(beta[s], g + s * m(), l + s * m(), h);
      for (int j = 0; j < m(); ++j) x[j] += h[j];
    }
    for (int j = 0; j < m(); ++j) x[j] += gamma * v[j];
    for_each_state<n>(m(), [&](auto i) GARRISON_INLINED {
      V sum = x[i];
      for (int j = 0; j < i; ++j) sum += L[packed(i, j)] * x[j];
      out[i] += sum;
    });
  }

  /// P(k) -> P(k+1) where its trace is below `limit`. `change`: how much P changed, relative to its largest
  /// entry; 0 also where it was left as it is. A, Q: column by column.
  GARRISON_INLINE void predict(const double* A, const double* Q, V* P, int stride, const V& limit,
                               V& change) {
    V* const next = c;
    V moved{};
    V size{};
    V trace{};
    for (int i = 0; i < m(); ++i) {
      V fixed[kOnStack<n>];
      V* const row = n == Dynamic ? b : fixed;
      scaled_row(A, i, row);
      for (int j = 0; j <= i; ++j) {
        V sum;
        dot(row, F + j * m(), sum);
        sum += Q[j * m() + i];
        next[packed(i, j)] = sum;
        const V apart = sum - P[packed(i, j) * stride];
        const V distance = apart < 0.0 ? -apart : apart;
        moved = moved < distance ? distance : moved;
      }
      const V diagonal = next[packed(i, i)];  // the largest entry is among these
      size = size < diagonal ? diagonal : size;
      trace += diagonal;
    }
    for (int k = 0; k < packed(m()); ++k) {
      const V old = P[k * stride];
      P[k * stride] = trace < limit ? next[k] : old;
    }
    const V relative = size > 0.0 ? moved / size : V{};
    change = trace < limit ? relative : V{};
  }

 private:
  GARRISON_INLINE int m() const { return n == Dynamic ? states_ : n; }

  /// s't; even and odd entries for themselves, which halves the wait for sums
  GARRISON_INLINE void dot(const V* s, const V* t, V& out) const {
    V sum[2]{};
    for_each_state<n>(m(), [&](auto k) GARRISON_INLINED {
      if (k < 2)
        sum[k] = s[k] * t[k];
      else
        sum[k % 2] += s[k] * t[k];
    });
    out = sum[0];
    if (m() > 1) out += sum[1];
  }
  /// y <- (I - factor s t') y
  GARRISON_INLINE void reflect(const V& factor, const V* s, const V* t, V* y) const {
    V along;
    dot(t, y, along);
    along *= factor;
    for_each_state<n>(m(), [&](auto j) GARRISON_INLINED { y[j] -= along * s[j]; });
  }
  /// out = L'y
  GARRISON_INLINE void transposed(const V* y, V* out) const {
    for_each_state<n>(m(), [&](auto j) GARRISON_INLINED {
      V sum = y[j];
      for (int k = j + 1; k < m(); ++k) sum += L[packed(k, j)] * y[k];
      out[j] = sum;
    });
  }
  /// Row i of F = A L M, and of F D.
  GARRISON_INLINE void scaled_row(const double* A, int i, V* row) {
    for_each_state<n>(m(), [&](auto j) GARRISON_INLINED { row[j] = V{} + A[j * m() + i]; });
    for_each_state<n>(m(), [&](auto k) GARRISON_INLINED {
      for (int j = 0; j < k; ++j) row[j] += A[k * m() + i] * L[packed(k, j)];
    });
    for (int r = 0; r < q; ++r) reflect(beta[r], l + r * m(), g + r * m(), row);
    for_each_state<n>(m(), [&](auto j) GARRISON_INLINED {
      F[i * m() + j] = row[j];
      row[j] *= d[j];
    });
  }

  int states_;
  int q;
  V *L, *c, *d, *h, *v, *x, *b, *F;    // matrices packed, F row by row
  V *raw, *l, *g, *reciprocal, *beta;  // of every row: L'h, l, g, 1/alpha, b
};

}  // namespace garrison::partial_sharing
