// SPDX-License-Identifier: Apache-2.0
#include "garrison/filters/central_kalman.hpp"

#include <cmath>

namespace garrison {

Matrix central_kalman(const Model& model, const MatrixRef& measurements, const VectorRef& x0,
                      double start_variance) {
  const auto n = model.states();
  const Noise& noise = model.noise();
  if (noise.process_covariance.size() == 0 || noise.measurement_covariance.empty())
    refuse("model", "no covariances", "process_covariance and measurement_covariance",
           "a Kalman filter weighs with them");
  if (measurements.cols() != model.total_outputs())
    refuse("measurements", std::to_string(measurements.cols()) + " columns",
           std::to_string(model.total_outputs()));
  if (x0.size() != n) refuse("x0", std::to_string(x0.size()) + " numbers", std::to_string(n));
  if (!(start_variance >= 0.0)) refuse("start_variance", text(start_variance), "a number >= 0");
  Vector R(model.total_outputs());
  for (int i = 0; i < model.agents(); ++i) {
    const Matrix& S = noise.measurement_covariance[static_cast<std::size_t>(i)];
    if (!S.isDiagonal(1e-12))
      refuse("measurement_covariance[" + std::to_string(i) + "]", "a full matrix", "a diagonal one");
    R.segment(model.offset(i), model.outputs(i)) = S.diagonal();
  }
  const Matrix C = model.stacked();
  const Matrix I = Matrix::Identity(n, n);
  Matrix estimates(measurements.rows() + 1, n);
  Vector x = x0;
  Matrix P = start_variance * I;
  estimates.row(0) = x;
  for (Eigen::Index t = 0; t < measurements.rows(); ++t) {
    x = model.A() * x;
    P = model.A() * P * model.A().transpose() + noise.process_covariance;
    for (Eigen::Index k = 0; k < C.rows(); ++k) {
      const double y = measurements(t, k);
      const double S = C.row(k) * P * C.row(k).transpose() + R(k);
      if (!std::isfinite(y) || !(S > 0.0)) continue;
      const Vector K = P * C.row(k).transpose() / S;
      x += K * (y - C.row(k).dot(x));
      P = (I - K * C.row(k)) * P * (I - K * C.row(k)).transpose() + R(k) * K * K.transpose();
      P = 0.5 * (P + P.transpose().eval());
    }
    estimates.row(t + 1) = x;
  }
  return estimates;
}

}  // namespace garrison
