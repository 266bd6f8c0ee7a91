// SPDX-License-Identifier: Apache-2.0
// One estimate of a Kalman filter in square-root form, and what screens its outputs. Internal.
#pragma once

#include <limits>
#include <vector>

#include "garrison/filters/central_kalman.hpp"

namespace garrison::kalman {

/// Outputs of one time, linear about some state: y = C x + offset + noise, of variances R. `offset` is empty
/// where it is zero.
struct Outputs {
  const Matrix& C;
  const Vector& R;
  const Vector& y;       ///< NaN or inf = missing
  const Vector& offset;  ///< h(x0) - C x0
  double residual(Eigen::Index k, const Vector& x) const {
    const double expected = C.row(k).dot(x);
    return y(k) - (offset.size() == 0 ? expected : expected + offset(k));
  }
};

/// An estimate x with error covariance S S'.
struct Estimate {
  Vector x;
  Matrix S;
  double since_asked = 0.0;  ///< multiplications since the budget was asked

  /// To `next`, of a plant with this A there.
  void predict(Vector next, const Matrix& A, const Matrix& process_root);
  /// With the outputs that are there, screened as asked.
  void correct(const Outputs& outputs, const Screen& screen);
  /// About to factor so many rows. @throws InvalidInput when the budget is over
  void take_time(double rows);
};

/// @throws InvalidInput where it is no screen
void require_screen(const Screen& screen);

}  // namespace garrison::kalman
