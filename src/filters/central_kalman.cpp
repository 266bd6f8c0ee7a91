// SPDX-License-Identifier: Apache-2.0
#include "garrison/filters/central_kalman.hpp"

#include "core/spectrum.hpp"
#include "garrison/core/response.hpp"
#include "kalman_estimate.hpp"

namespace garrison {
namespace {

using Index = Eigen::Index;

void require(const Model& model, const MatrixRef& measurements, double start_variance, const Screen& screen,
             const Known& known) {
  kalman::require_screen(screen);
  const Noise& noise = model.noise();
  const bool covariance = noise.process_covariance.size() != 0 || !known.series.process_covariance.empty();
  const bool measured = !noise.measurement_covariance.empty() || !known.series.measurement_covariance.empty();
  if (!covariance || !measured)
    refuse("model", "no covariances", "process_covariance and measurement_covariance",
           "a Kalman filter weighs with them");
  if (measurements.cols() != model.total_outputs())
    refuse("measurements", amount(measurements.cols(), "column"), std::to_string(model.total_outputs()));
  if (!(start_variance >= 0.0) || std::isinf(start_variance))
    refuse("start_variance", text(start_variance), "a finite number >= 0");
  const Matrix& u = known.inputs;
  if (model.inputs() > 0 && (u.rows() != measurements.rows() || u.cols() != model.inputs()))
    refuse("inputs", u.size() == 0 ? "none" : std::to_string(u.rows()) + " x " + std::to_string(u.cols()),
           std::to_string(measurements.rows()) + " x " + std::to_string(model.inputs()) +
               ", because the model has B",
           "row t is u(t), which leads from time t to t + 1");
  if (model.inputs() == 0 && u.size() > 0)
    refuse("inputs", amount(u.rows(), "row"), "none, because the model has no B");
  if (!u.allFinite()) refuse("inputs", "a number that is not finite", "known inputs at all times");
  require_series(known.series, model, static_cast<int>(measurements.rows()));
}

/// Variances of all measurements of sample t, agent by agent.
Vector variances(const Model& model, const Series& series, int t) {
  Vector R(model.total_outputs());
  for (int i = 0; i < model.agents(); ++i) {
    const Matrix S = measurement_covariance_at(series, model, i, t);
    if (!S.isDiagonal(1e-12))
      refuse("measurement_covariance[" + std::to_string(i) + "]", "a full matrix", "a diagonal one");
    R.segment(model.offset(i), model.outputs(i)) = S.diagonal();
  }
  return R;
}

/// The filter, on what passed `require`.
Matrix filtered(const Model& model, const MatrixRef& measurements, const VectorRef& x0, double start_variance,
                const Screen& screen, const Known& known) {
  const auto n = model.states();
  const Series& series = known.series;
  const bool constant = series.measurement_covariance.empty();
  Vector R = constant ? variances(model, series, 1) : Vector();
  const Matrix C = model.stacked();
  Matrix process_root;
  if (series.process_covariance.empty())
    process_root = detail::covariance_root(model.noise().process_covariance);
  Matrix estimates(measurements.rows() + 1, n);
  kalman::Estimate now{x0, std::sqrt(start_variance) * Matrix::Identity(n, n)};
  estimates.row(0) = now.x;
  const Vector none;
  for (Index t = 0; t < measurements.rows(); ++t) {
    const auto at = static_cast<std::size_t>(t);
    const int sample = static_cast<int>(t) + 1;
    const Matrix& A = series.A_at(model, sample);
    if (!series.process_covariance.empty())
      process_root = detail::covariance_root(series.process_covariance[at]);
    now.predict(model.inputs() == 0
                    ? Vector(A * now.x)
                    : driven(A, now.x, series.B_at(model, sample), known.inputs.row(t).transpose()),
                A, process_root);
    if (!constant) R = variances(model, series, sample);
    const Vector y = measurements.row(t);
    now.correct({series.C.empty() ? C : series.C[at], R, y, none}, screen);
    estimates.row(t + 1) = now.x;
  }
  return estimates;
}

}  // namespace

Matrix central_kalman(const Model& model, const MatrixRef& measurements, const VectorRef& x0,
                      double start_variance, const Screen& screen, const Known& known) {
  require(model, measurements, start_variance, screen, known);
  if (x0.size() != model.states()) refuse("x0", amount(x0.size(), "number"), std::to_string(model.states()));
  return filtered(model, measurements, x0, start_variance, screen, known);
}

std::vector<Matrix> local_kalman(const Model& model, const Network& network, const MatrixRef& measurements,
                                 const MatrixRef& x0, double start_variance, const Screen& screen,
                                 const Known& known) {
  require(model, measurements, start_variance, screen, known);
  if (network.agents() != model.agents())
    refuse("network", amount(network.agents(), "agent"),
           std::to_string(model.agents()) + ", because C has one matrix per agent");
  if (x0.rows() != model.states() || x0.cols() != model.agents())
    refuse("x0", std::to_string(x0.rows()) + " x " + std::to_string(x0.cols()),
           std::to_string(model.states()) + " x " + std::to_string(model.agents()));
  std::vector<Matrix> all;
  for (int i = 0; i < model.agents(); ++i) {
    Matrix heard = Matrix::Constant(measurements.rows(), measurements.cols(), kNaN);
    const auto hear = [&](int j) {
      heard.middleCols(model.offset(j), model.outputs(j)) =
          measurements.middleCols(model.offset(j), model.outputs(j));
    };
    hear(i);
    for (const int j : network.neighbours(i)) hear(j);
    all.push_back(filtered(model, heard, x0.col(i), start_variance, screen, known));
  }
  return all;
}

}  // namespace garrison
