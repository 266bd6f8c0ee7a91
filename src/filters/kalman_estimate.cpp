// SPDX-License-Identifier: Apache-2.0
#include "kalman_estimate.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/solvers.hpp"
#include "garrison/certificate/quantiles.hpp"
#include "garrison/core/budget.hpp"

namespace garrison::kalman {
namespace {

using Index = Eigen::Index;

/// A noise-free output counts as one with this part of its prior deviation as noise: less would not be seen.
constexpr double kExact = 1e-14;

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

/// All outputs of one time that are there, with these variances. With [I; R^-1/2 C S] = Q U the new root is
/// S U^-1: S is never inverted.
void correct_plainly(Estimate& now, const Outputs& o, const Vector& R) {
  std::vector<Index> present;
  const Matrix CS = o.C * now.S;
  for (Index k = 0; k < o.C.rows(); ++k)
    if (std::isfinite(o.y(k)) && (R(k) > 0.0 || CS.row(k).squaredNorm() > 0.0)) present.push_back(k);
  if (present.empty()) return;
  const Index n = now.x.size();
  const auto m = static_cast<Index>(present.size());
  now.take_time(static_cast<double>(n + m));
  Matrix rows(n + m, n);
  Vector right = Vector::Zero(n + m);
  rows.topRows(n).setIdentity();
  for (Index k = 0; k < m; ++k) {
    const Index at = present[static_cast<std::size_t>(k)];
    const double deviation = std::max(std::sqrt(R(at)), kExact * CS.row(at).norm());
    rows.row(n + k) = CS.row(at) / deviation;
    right(n + k) = o.residual(at, now.x) / deviation;
  }
  const auto qr = sorted_qr(std::move(rows), &right);
  const auto U = qr.matrixQR().topRows(n).triangularView<Eigen::Upper>();
  right.applyOnTheLeft(qr.householderQ().adjoint());
  now.S = U.solve<Eigen::OnTheRight>(Matrix(now.S * qr.colsPermutation()));
  now.x += now.S * right.head(n);
}

/// Outputs with an innovation that a Gaussian one exceeds `level` deviations to be nan.
Vector gated(const Estimate& prior, const Outputs& o, double level) {
  const Matrix CS = o.C * prior.S;
  Vector kept = o.y;
  for (Index k = 0; k < o.C.rows(); ++k)
    if (std::abs(o.residual(k, prior.x)) > level * std::sqrt(CS.row(k).squaredNorm() + o.R(k)))
      kept(k) = kNaN;
  return kept;
}

/// Corrects with weights that solve Huber's problem.
void correct_robustly(Estimate& now, const Outputs& o, double huber) {
  constexpr int kMost = 1000;
  constexpr double kSettled = 1e-12;
  const Estimate prior = now;
  const Vector& R = o.R;
  Vector weight = Vector::Ones(R.size());
  for (int k = 0; k < kMost; ++k) {
    now.x = prior.x;
    now.S = prior.S;
    correct_plainly(now, o, R.cwiseQuotient(weight));
    Vector next = Vector::Ones(R.size());
    for (Index r = 0; r < R.size(); ++r) {
      const double residual = std::abs(o.residual(r, now.x));
      if (std::isfinite(residual) && R(r) > 0.0 && residual > huber * std::sqrt(R(r)))
        next(r) = huber * std::sqrt(R(r)) / residual;
    }
    const double change = (next - weight).cwiseQuotient(weight).cwiseAbs().maxCoeff();
    if (!(change > kSettled)) return;
    weight = std::move(next);
  }
}

}  // namespace

void Estimate::take_time(double rows) {
  constexpr double kWorthAsking = 1e6;  // multiplications, about a millisecond
  const auto n = static_cast<double>(x.size());
  since_asked += rows * n * n;
  if (since_asked < kWorthAsking) return;
  since_asked = 0.0;
  require_time("a Kalman filter");
}

void Estimate::predict(Vector next, const Matrix& A, const Matrix& process_root) {
  x = std::move(next);
  const Index n = x.size();
  Matrix both(S.cols() + process_root.cols(), n);
  take_time(static_cast<double>(both.rows()));
  both << (A * S).transpose(), process_root.transpose();
  const auto qr = sorted_qr(std::move(both));
  const Matrix R = qr.matrixQR().topRows(n).triangularView<Eigen::Upper>();
  S = qr.colsPermutation() * R.transpose();
}

void Estimate::correct(const Outputs& o, const Screen& screen) {
  if (screen.gate > 0.0) {
    const Vector kept = gated(*this, o, certificate::two_sided(screen.gate));
    correct_plainly(*this, {o.C, o.R, kept, o.offset}, o.R);
  } else if (std::isinf(screen.huber)) {
    correct_plainly(*this, o, o.R);
  } else {
    correct_robustly(*this, o, screen.huber);
  }
}

void require_screen(const Screen& screen) {
  if (!(screen.gate >= 0.0 && screen.gate < 1.0))
    refuse("gate", text(screen.gate), "a probability in (0, 1), or 0 for none");
  if (!(screen.huber > 0.0)) refuse("huber", text(screen.huber), "a number of deviations > 0, such as 1.345");
  if (screen.gate > 0.0 && !std::isinf(screen.huber))
    refuse("central_kalman", "gate and huber", "one of them");
}

}  // namespace garrison::kalman
