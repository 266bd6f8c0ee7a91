// SPDX-License-Identifier: Apache-2.0
#include "garrison/filters/extended_kalman.hpp"

#include <cmath>

#include "core/spectrum.hpp"
#include "garrison/kernel/differences.hpp"
#include "kalman_estimate.hpp"

namespace garrison {
namespace {

using Index = Eigen::Index;

std::string shape(const Matrix& m) { return std::to_string(m.rows()) + " x " + std::to_string(m.cols()); }

template <class M>
M checked(const char* name, M value, Index rows, Index cols, int t) {
  if (value.rows() != rows || value.cols() != cols)
    refuse(name, shape(value), std::to_string(rows) + " x " + std::to_string(cols) + " numbers");
  if (!value.allFinite())
    refuse(name, "a number that is not finite at time " + std::to_string(t), "finite numbers",
           "the estimate may have left the range of the function");
  return value;
}

void require_variance(const MatrixRef& R) {
  if (!(R.array() >= 0.0).all() || !R.allFinite())
    refuse("measurement_variance", "a number that is negative or not finite", "finite numbers >= 0");
}

void require_noise(const NonlinearPlant& plant, const MatrixRef& y, Index n) {
  const auto& Q = plant.process_covariances;
  if (Q.empty()) checked("process_covariance", plant.process_covariance, n, n, 0);
  if (!Q.empty() && static_cast<Index>(Q.size()) < y.rows())
    refuse("process_covariance", amount(Q.size(), "matrix", "matrices") + " over time",
           "at least " + std::to_string(y.rows()) + ", one per step");
  for (std::size_t t = 0; t < Q.size(); ++t) checked("process_covariance", Q[t], n, n, static_cast<int>(t));
  const Matrix& R = plant.measurement_variances;
  if (R.size() > 0) {
    if (R.rows() < y.rows() || R.cols() != y.cols())
      refuse("measurement_variance", shape(R),
             std::to_string(y.rows()) + " x " + std::to_string(y.cols()) + ", a row per sample");
    return require_variance(R);
  }
  if (plant.measurement_variance.size() != y.cols())
    refuse("measurement_variance", amount(plant.measurement_variance.size(), "number"),
           std::to_string(y.cols()) + ", one per column of measurements");
  require_variance(plant.measurement_variance);
}

void require(const NonlinearPlant& plant, const MatrixRef& y, const VectorRef& x0, const MatrixRef& P0,
             const MatrixRef& inputs) {
  const Index n = x0.size();
  if (n < 1) refuse("x0", "no number", "one per state");
  if (!x0.allFinite()) refuse("x0", "a number that is not finite", "finite numbers");
  checked("P0", Matrix(P0), n, n, 0);
  require_noise(plant, y, n);
  if (inputs.rows() != y.rows())
    refuse("inputs", amount(inputs.rows(), "row"),
           std::to_string(y.rows()) + ", one per step: row t is u(t)");
  if (!inputs.allFinite()) refuse("inputs", "a number that is not finite", "known inputs at all times");
}

}  // namespace

Matrix central_differences(const std::function<Vector(const Vector&)>& g, const Vector& x) {
  Matrix all;
  for (Index k = 0; k < x.size(); ++k) {
    const double step = difference_step(x(k));
    Vector up = x;
    Vector down = x;
    up(k) += step;
    down(k) -= step;
    const Vector above = g(up);
    if (k == 0) all.resize(above.size(), x.size());
    all.col(k) = (above - g(down)) / (up(k) - down(k));
  }
  return all;
}

Matrix extended_kalman(const NonlinearPlant& plant, const MatrixRef& measurements, const VectorRef& x0,
                       const MatrixRef& P0, const MatrixRef& inputs, const Screen& screen) {
  kalman::require_screen(screen);
  require(plant, measurements, x0, P0, inputs);
  const Index n = x0.size();
  const Index m = measurements.cols();
  const auto& Q = plant.process_covariances;
  Matrix process_root;
  if (Q.empty()) process_root = detail::covariance_root(plant.process_covariance);
  Vector R = plant.measurement_variance;
  kalman::Estimate now{x0, detail::covariance_root(P0)};
  Matrix estimates(measurements.rows() + 1, n);
  estimates.row(0) = now.x;
  for (Index r = 0; r < measurements.rows(); ++r) {
    const int t = static_cast<int>(r);
    const Vector u = inputs.row(r);
    const auto f = [&](const Vector& x) { return checked("f", plant.f(x, u, t), n, 1, t); };
    const auto h = [&](const Vector& x) { return checked("h", plant.h(x, t + 1), m, 1, t + 1); };
    const Matrix F = plant.f_jacobian ? checked("f_jacobian", plant.f_jacobian(now.x, u, t), n, n, t)
                                      : central_differences(f, now.x);
    if (!Q.empty()) process_root = detail::covariance_root(Q[static_cast<std::size_t>(r)]);
    if (plant.measurement_variances.size() > 0) R = plant.measurement_variances.row(r);
    now.predict(f(now.x), F, process_root);
    const Matrix H = plant.h_jacobian ? checked("h_jacobian", plant.h_jacobian(now.x, t + 1), m, n, t + 1)
                                      : central_differences(h, now.x);
    const Vector offset = h(now.x) - H * now.x;
    const Vector y = measurements.row(r);
    now.correct({H, R, y, offset}, screen);
    estimates.row(r + 1) = now.x;
  }
  return estimates;
}

}  // namespace garrison
