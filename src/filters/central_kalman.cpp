// SPDX-License-Identifier: Apache-2.0
#include "garrison/filters/central_kalman.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/solvers.hpp"
#include "garrison/certificate/quantiles.hpp"

namespace garrison {
namespace {

using Index = Eigen::Index;

/// A noise-free output counts as one with this part of its prior deviation as noise: less would not be seen.
constexpr double kExact = 1e-14;

Matrix root(const Matrix& S) {
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(S);
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

/// QR with columns pivoted and rows sorted by size: errors are then relative to each row (Cox, Higham 1998),
/// so that large prior deviations do not drown precise measurements.
Eigen::ColPivHouseholderQR<Matrix> sorted_qr(Matrix rows, Vector* right = nullptr) {
  std::vector<Index> order(static_cast<std::size_t>(rows.rows()));
  std::iota(order.begin(), order.end(), Index{0});
  const Vector size = rows.rowwise().lpNorm<Eigen::Infinity>();
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return size(a) > size(b); });
  if (right != nullptr) *right = Vector((*right)(order));
  return Eigen::ColPivHouseholderQR<Matrix>(rows(order, Eigen::all));
}

/// An estimate x with error covariance S S'.
struct Estimate {
  Vector x;
  Matrix S;

  void predict(const Matrix& A, const Matrix& process_root) {
    x = A * x;
    const Index n = x.size();
    Matrix both(S.cols() + process_root.cols(), n);
    both << (A * S).transpose(), process_root.transpose();
    const auto qr = sorted_qr(std::move(both));
    const Matrix R = qr.matrixQR().topRows(n).triangularView<Eigen::Upper>();
    S = qr.colsPermutation() * R.transpose();
  }

  /// All outputs of one time that are there. With [I; R^-1/2 C S] = Q U the new root is S U^-1: S is never
  /// inverted.
  void correct(const Matrix& C, const Vector& R, const Matrix& y) {
    std::vector<Index> present;
    const Matrix CS = C * S;
    for (Index k = 0; k < C.rows(); ++k)
      if (std::isfinite(y(k)) && (R(k) > 0.0 || CS.row(k).squaredNorm() > 0.0)) present.push_back(k);
    if (present.empty()) return;
    const Index n = x.size();
    const auto m = static_cast<Index>(present.size());
    Matrix rows(n + m, n);
    Vector right = Vector::Zero(n + m);
    rows.topRows(n).setIdentity();
    for (Index k = 0; k < m; ++k) {
      const Index at = present[static_cast<std::size_t>(k)];
      const double deviation = std::max(std::sqrt(R(at)), kExact * CS.row(at).norm());
      rows.row(n + k) = CS.row(at) / deviation;
      right(n + k) = (y(at) - C.row(at).dot(x)) / deviation;
    }
    const auto qr = sorted_qr(std::move(rows), &right);
    const auto U = qr.matrixQR().topRows(n).triangularView<Eigen::Upper>();
    right.applyOnTheLeft(qr.householderQ().adjoint());
    S = U.solve<Eigen::OnTheRight>(Matrix(S * qr.colsPermutation()));
    x += S * right.head(n);
  }
};

/// Outputs with an innovation that a Gaussian one exceeds `level` deviations to be nan.
Matrix gated(const Estimate& prior, const Matrix& C, const Vector& R, const Matrix& y, double level) {
  const Matrix CS = C * prior.S;
  Matrix kept = y;
  for (Index k = 0; k < C.rows(); ++k)
    if (std::abs(y(k) - C.row(k).dot(prior.x)) > level * std::sqrt(CS.row(k).squaredNorm() + R(k)))
      kept(k) = kNaN;
  return kept;
}

/// Corrects with weights that solve Huber's problem.
void correct_robustly(Estimate& now, const Matrix& C, const Vector& R, const Matrix& y, double huber) {
  constexpr int kMost = 1000;
  constexpr double kSettled = 1e-12;
  const Estimate prior = now;
  Vector weight = Vector::Ones(R.size());
  for (int k = 0; k < kMost; ++k) {
    now = prior;
    now.correct(C, R.cwiseQuotient(weight), y);
    Vector next = Vector::Ones(R.size());
    for (Index r = 0; r < R.size(); ++r) {
      const double residual = std::abs(y(r) - C.row(r).dot(now.x));
      if (std::isfinite(residual) && R(r) > 0.0 && residual > huber * std::sqrt(R(r)))
        next(r) = huber * std::sqrt(R(r)) / residual;
    }
    const double change = (next - weight).cwiseQuotient(weight).cwiseAbs().maxCoeff();
    if (!(change > kSettled)) return;
    weight = std::move(next);
  }
}

void require_screen(const Screen& screen) {
  if (!(screen.gate >= 0.0 && screen.gate < 1.0))
    refuse("gate", text(screen.gate), "a probability in (0, 1), or 0 for none");
  if (!(screen.huber > 0.0)) refuse("huber", text(screen.huber), "a number of deviations > 0, such as 1.345");
  if (screen.gate > 0.0 && !std::isinf(screen.huber))
    refuse("central_kalman", "gate and huber", "one of them");
}

}  // namespace

Matrix central_kalman(const Model& model, const MatrixRef& measurements, const VectorRef& x0,
                      double start_variance, const Screen& screen) {
  require_screen(screen);
  const auto n = model.states();
  const Noise& noise = model.noise();
  if (noise.process_covariance.size() == 0 || noise.measurement_covariance.empty())
    refuse("model", "no covariances", "process_covariance and measurement_covariance",
           "a Kalman filter weighs with them");
  if (measurements.cols() != model.total_outputs())
    refuse("measurements", std::to_string(measurements.cols()) + " columns",
           std::to_string(model.total_outputs()));
  if (x0.size() != n) refuse("x0", std::to_string(x0.size()) + " numbers", std::to_string(n));
  if (!(start_variance >= 0.0) || std::isinf(start_variance))
    refuse("start_variance", text(start_variance), "a finite number >= 0");
  Vector R(model.total_outputs());
  for (int i = 0; i < model.agents(); ++i) {
    const Matrix& S = noise.measurement_covariance[static_cast<std::size_t>(i)];
    if (!S.isDiagonal(1e-12))
      refuse("measurement_covariance[" + std::to_string(i) + "]", "a full matrix", "a diagonal one");
    R.segment(model.offset(i), model.outputs(i)) = S.diagonal();
  }
  const Matrix C = model.stacked();
  const Matrix process_root = root(noise.process_covariance);
  Matrix estimates(measurements.rows() + 1, n);
  Estimate now{x0, std::sqrt(start_variance) * Matrix::Identity(n, n)};
  estimates.row(0) = now.x;
  const double level = screen.gate > 0.0 ? certificate::two_sided(screen.gate) : kInfinity;
  for (Index t = 0; t < measurements.rows(); ++t) {
    now.predict(model.A(), process_root);
    if (screen.gate > 0.0)
      now.correct(C, R, gated(now, C, R, measurements.row(t), level));
    else if (std::isinf(screen.huber))
      now.correct(C, R, measurements.row(t));
    else
      correct_robustly(now, C, R, measurements.row(t), screen.huber);
    estimates.row(t + 1) = now.x;
  }
  return estimates;
}

}  // namespace garrison
