// SPDX-License-Identifier: Apache-2.0
// Two numbers (M): a bound for unknown, time-varying averaging with acknowledged links. Loose, the last
// resort.
#pragma once

#include <cmath>

#include "garrison/core/error.hpp"
#include "garrison/core/types.hpp"

namespace garrison::certificate {

/// ||mean of e|| <= rho, ||stacked e - mean|| <= p, for any J(t) with row and column sums 1 and
/// ||J(t) - 11'/N|| <= gamma(t). Bounded noise, adaptive level.
/// Threads: one at a time.
class GARRISON_EXPORT TwoNumbers {
 public:
  /// The constants of the recursion, in the letters of docs/certificates.md.
  struct Constants {
    double c, cw, tau, kA, kw, m, v1, v2;
  };

  /// A: n x n; C: N x n, rows of length 1 or 0; s >= 0; rho, p: start, >= 0; bw >= 0; bv: N numbers >= 0.
  /// @throws InvalidInput
  TwoNumbers(const MatrixRef& A, const MatrixRef& C, int s, double rho, double p, double bw,
             const VectorRef& bv);

  /// One step with ||J - 11'/N|| <= gamma; returns the bound on every ||e_i||. Does not allocate. O(N log N).
  /// gamma >= 0. @throws InvalidInput
  double step(double gamma);
  /// Adaptive level of the coming step: no honest innovation of this sensor is larger. 0 without a sensor.
  double level(Eigen::Index sensor) const {
    return row_length_(sensor) == 0.0 ? 0.0 : honest(sensor) + bv_(sensor);
  }
  /// The same of all sensors, N numbers.
  Vector levels() const {
    return Vector::NullaryExpr(row_length_.size(), [this](Eigen::Index j) { return level(j); });
  }
  double rho() const { return rho_; }
  double p() const { return p_; }
  /// rho + sqrt((N-1)/N) p; infinite once the recursion overflowed.
  double bound() const { return std::isinf(rho_) ? kInfinity : rho_ + single_ * p_; }
  const Constants& constants() const { return constants_; }

 private:
  /// H0: bound on an honest innovation less the sensor's own noise.
  double honest(Eigen::Index sensor) const {
    const double predicted = norm_CA_(sensor) == 0.0 ? 0.0 : norm_CA_(sensor) * bound();
    return predicted + row_length_(sensor) * bw_;
  }

  Constants constants_{};
  int s_;
  double rho_, p_, bw_, single_;
  Vector norm_CA_, row_length_, bv_;
  Vector theta_;  // room
};

}  // namespace garrison::certificate
