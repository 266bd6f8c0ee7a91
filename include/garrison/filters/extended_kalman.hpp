// SPDX-License-Identifier: Apache-2.0
// The extended Kalman filter: a nonlinear plant by functions, all measurements in one place. A baseline: no
// bound.
#pragma once

#include <functional>
#include <vector>

#include "garrison/filters/central_kalman.hpp"

namespace garrison {

/// x(t+1) = f(x(t), u(t), t) + w, y(t) = h(x(t), t) + v. Functions may throw; results are checked.
struct GARRISON_EXPORT NonlinearPlant {
  std::function<Vector(const Vector& x, const Vector& u, int t)> f;  ///< n numbers
  std::function<Vector(const Vector& x, int t)> h;                   ///< m numbers
  /// Of f and h in x, n x n and m x n; empty = by central differences.
  std::function<Matrix(const Vector& x, const Vector& u, int t)> f_jacobian = {};
  std::function<Matrix(const Vector& x, int t)> h_jacobian = {};
  Matrix process_covariance;    ///< n x n
  Vector measurement_variance;  ///< m, >= 0
  /// In place of these two where they change: of every step, and T x m, row r of time r+1.
  std::vector<Matrix> process_covariances = {};
  Matrix measurement_variances = {};
};

/// Estimates (T+1) x n from measurements T x m, row r belonging to time r+1; NaN or inf = missing. Starts
/// from x0 with covariance P0. `inputs`: T x p, row t is u(t); T x 0 where there are none. Linearised about
/// the estimate, then as central_kalman (square-root form, gate and Huber weights). @throws InvalidInput when
/// shapes do not fit, or a function returns something that is not finite
GARRISON_EXPORT Matrix extended_kalman(const NonlinearPlant& plant, const MatrixRef& measurements,
                                       const VectorRef& x0, const MatrixRef& P0, const MatrixRef& inputs,
                                       const Screen& screen = {});

/// Derivative of g at x by central differences (kernel/differences.hpp).
GARRISON_EXPORT Matrix central_differences(const std::function<Vector(const Vector&)>& g, const Vector& x);

}  // namespace garrison
