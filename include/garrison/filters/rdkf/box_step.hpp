// SPDX-License-Identifier: Apache-2.0
// The step with the elementwise penalty lambda |b - M x|_1: a concave quadratic over a box.
#pragma once

#include "garrison/filters/rdkf/step.hpp"

namespace garrison::rdkf {

/// Most rows of a C with this penalty: a step lists its free entries on the stack.
inline constexpr int kMostBoxOutputs = 512;

/// What of  min over x of lambda |b - M x|_1 + (x - x0)' Q (x - x0)  does not depend on b and x0.
/// Dual: max over |u_m| <= lambda of u'(b - M x0) - u'H u / 2, H = M Q^-1 M' / 2, x = x0 + Q^-1 M' u / 2.
struct GARRISON_EXPORT BoxFactors {
  Matrix R;               ///< q x q, Sv^-1/2
  Matrix M;               ///< q x n
  Matrix W;               ///< n x q, Q^-1 M' / 2
  Matrix H;               ///< q x q
  double proximal = 0.0;  ///< weight that makes every sub-problem strictly concave, also with dependent rows

  int outputs() const { return static_cast<int>(M.rows()); }
  /// Doubles of room that a step needs.
  std::size_t room() const {
    const auto q = static_cast<std::size_t>(M.rows());
    return q * q + 8 * q;
  }

  template <class V>
  void visit(V& v) {
    v("R", R);
    v("M", M);
    v("W", W);
    v("H", H);
    v("proximal", proximal);
  }
};

/// BoxFactors::proximal where the largest diagonal entry of H is this.
inline double proximal_weight(double largest) { return largest > 0.0 ? 1e-9 * largest : 1.0; }

/// @throws InvalidInput when C has too many rows, or Q is not positive definite
GARRISON_EXPORT BoxFactors box_factors(const MatrixRef& whitener, const MatrixRef& C, const MatrixRef& Q);

/// Solves one step by an active set on proximal sub-problems, which end exactly. Arguments as in `solve`; u
/// comes first in `room`. mu: |b - M x| / lambda, 0 when no sensor is saturated; iterations: of the active
/// set.
GARRISON_EXPORT Step solve_box(const BoxFactors& f, double lambda, const double* y, double* x,
                               double* room) noexcept;

}  // namespace garrison::rdkf
