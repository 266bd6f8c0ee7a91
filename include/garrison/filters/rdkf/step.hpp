// SPDX-License-Identifier: Apache-2.0
// The convex step of the resilient distributed Kalman filter (Dutta, Zhang, Jin), solved exactly.
#pragma once

#include "garrison/core/error.hpp"
#include "garrison/core/types.hpp"
#include "garrison/filters/rdkf/packed.hpp"

namespace garrison::rdkf {

/// What a residual r = b - M x costs (b = Sv^-1/2 y, M = Sv^-1/2 C, the symmetric root):
enum class Penalty {
  norm,   ///< lambda |r|, the paper's (8)
  huber,  ///< |r|^2 up to lambda/2, lambda |r| - lambda^2/4 beyond: unsaturated it is the Kalman step
          ///< (docs/filters/rdkf.md#r-huber)
  l1,     ///< lambda times the sum of |r_m|: one bad sensor does not blind the agent's others,
          ///< docs/filters/rdkf.md#r-l1
  group,  ///< lambda times the sum over the neighbourhood of |b_j - M_j x|; measurements travel too
          ///< (docs/filters/rdkf.md#r-l1)
};

/// What of  min over x of penalty(b - M x) + (x - x0)' Q (x - x0)  does not depend on b and x0, for `norm`
/// and `huber`.
///
/// The dual is  max over |u| <= lambda of u'r0 - u' D u / 2,  r0 = b - M x0, D = M Q^-1 M' / 2 (plus 1/2 for
/// `huber`); with Q = L L' and M L^-T = V s Z' it falls apart into q scalars
/// (docs/filters/rdkf.md#r-exact).
struct GARRISON_EXPORT StepFactors {
  Packed R;           ///< q x q, V' Sv^-1/2: turns a measurement y into V'b
  Packed K;           ///< q x n, V'M
  Packed W;           ///< n x q, Q^-1 M' V / 2
  Aligned<double> d;  ///< eigenvalues of D, exactly 0 on its kernel; q, filled up with zeros

  int outputs() const { return K.rows; }
  int states() const { return K.columns; }
  /// Doubles of room that a step needs.
  std::size_t room() const { return static_cast<std::size_t>(4 * padded(outputs()) + padded(states())); }

  template <class V>
  void visit(V& v) {
    v("R", R);
    v("K", K);
    v("W", W);
    v("d", d);
  }
};

/// @param whitener Sv^-1/2, q x q; @param C q x n; @param Q n x n, symmetric positive definite
/// @param penalty norm or huber
GARRISON_EXPORT StepFactors step_factors(const MatrixRef& whitener, const MatrixRef& C, const MatrixRef& Q,
                                         Penalty penalty);

/// The other choices of one step.
struct Price {
  double lambda = 1.0;     ///< >= 0
  double smoothing = 0.0;  ///< eps >= 0: lambda sqrt(|r|^2 + eps^2) instead of lambda |r|

  template <class V>
  void visit(V& v) {
    v("lambda", lambda);
    v("smoothing", smoothing);
  }
};

/// How a step ended.
struct Step {
  double mu = 0.0;  ///< multiplier: residual = mu u with |u| = lambda; 0 = not saturated; inf for lambda = 0
  int iterations = 0;  ///< of the secular equation
};

/// Solves one step. y: q numbers, finite. x: n numbers, x0 on entry and the minimiser on return. `room`:
/// f.room() doubles; the first q return V'u, the least-norm dual solution. Same bits on every instruction
/// set.
GARRISON_EXPORT Step solve(const StepFactors& f, const Price& price, const double* y, double* x,
                           double* room) noexcept;

}  // namespace garrison::rdkf
