// SPDX-License-Identifier: Apache-2.0
#include "garrison/certificate/propagate.hpp"

#include <algorithm>
#include <cmath>

#include "core/solvers.hpp"
#include "garrison/certificate/kernels.hpp"
#include "garrison/certificate/quantiles.hpp"
#include "memory/shape_frame.hpp"
#include "require.hpp"

namespace garrison::certificate {

Propagation::Propagation(const MatrixRef& A, int steps) {
  if (A.rows() < 1) refuse("A", detail::shape(A), "at least 1 x 1");
  detail::require_shape("A", A, A.rows(), A.rows());
  detail::require_least("steps", steps, 0);
  detail::require_room("steps", (steps + 1.0) * static_cast<double>(A.size()));
  power_.emplace_back(Matrix::Identity(A.rows(), A.rows()));
  for (int k = 1; k <= steps; ++k) power_.emplace_back(A * power_.back());
  for (const Matrix& power : power_) {
    if (!power.allFinite())
      refuse("steps", std::to_string(steps), "powers of A that are finite", "take fewer");
    norm_.push_back(spectral_norm(power));
  }
}

void Propagation::add(double ball, const Vector& each, const Matrix& shape) {
  if (!std::isfinite(ball) || !each.allFinite() || !shape.allFinite())
    refuse("steps", std::to_string(steps()), "noise that adds up to finite numbers", "take fewer");
  added_.push_back(ball);
  each_.push_back(each);
  shape_.push_back(shape);
}

namespace {

/// The outer ellipsoid of a box.
Matrix around_box(const Vector& each) {
  return static_cast<double>(each.size()) * Matrix(each.cwiseAbs2().asDiagonal());
}

void require_gam(const MatrixRef& A, const MatrixRef& Gam) {
  detail::require_shape("Gam", Gam, A.rows(), Gam.cols());
}

}  // namespace

Propagation Propagation::bounded(const MatrixRef& A, int steps, double bw) {
  detail::require_least("bw", bw, 0.0);
  Propagation p(A, steps);
  double sum = 0.0;
  Vector each = Vector::Zero(A.rows());
  for (std::size_t k = 0; k < p.power_.size(); ++k) {
    p.add(sum, each, around_box(each));
    sum += p.norm_[k] * bw;
    each += bw * p.power_[k].rowwise().norm();
  }
  return p;
}

Propagation Propagation::gaussian(const MatrixRef& A, int steps, const MatrixRef& Q, double delta) {
  Propagation p(A, steps);
  detail::require_covariance("Q", Q, A.rows());
  const double quantile = chi(delta, p.states());
  Matrix covariance = Matrix::Zero(A.rows(), A.rows());
  for (const Matrix& power : p.power_) {
    p.add(quantile * std::sqrt(spectral_norm(covariance)),
          quantile * covariance.diagonal().cwiseMax(0.0).cwiseSqrt(), quantile * quantile * covariance);
    covariance += power * Q * power.transpose();
  }
  return p;
}

Propagation Propagation::bounded_entries(const MatrixRef& A, int steps, const MatrixRef& Gam, double bw) {
  detail::require_least("bw", bw, 0.0);
  Propagation p(A, steps);
  require_gam(A, Gam);
  Vector each = Vector::Zero(A.rows());
  for (const Matrix& power : p.power_) {
    p.add(each.norm(), each, around_box(each));
    each += bw * (power * Gam).cwiseAbs().rowwise().sum();
  }
  return p;
}

Propagation Propagation::gaussian_entries(const MatrixRef& A, int steps, const MatrixRef& Gam, double zc,
                                          double z2) {
  detail::require_least("zc", zc, 0.0);
  detail::require_least("z2", z2, 0.0);
  Propagation p(A, steps);
  require_gam(A, Gam);
  Matrix covariance = Matrix::Zero(A.rows(), A.rows());
  for (const Matrix& power : p.power_) {
    p.add(z2 * std::sqrt(spectral_norm(covariance)), zc * covariance.diagonal().cwiseMax(0.0).cwiseSqrt(),
          z2 * z2 * covariance);
    const Matrix M = power * Gam;
    covariance += M * M.transpose();
  }
  return p;
}

void Propagation::age(const Region& then, int age, Region& now) const noexcept {
  const auto k = static_cast<std::size_t>(age);
  const Matrix& A = power_[k];
  const Eigen::Index n = A.rows();
  now.radius = then.radius;
  now.stretch = kInfinity;
  const bool has_shape = then.answered() && then.shape.size() > 0 && std::isfinite(then.stretch);
  if (!has_shape) now.shape.resize(0, 0);
  if (!then.answered()) {
    now.box.resize(0);
    return;
  }
  now.center.resize(n);
  now.center.noalias() = A.lazyProduct(then.center);
  now.box.resize(n);
  // (A shape A')_ij of the ellipsoid.
  const auto carried = [&](Eigen::Index i, Eigen::Index j) {
    double sum = 0.0;
    for (Eigen::Index a = 0; a < n; ++a)
      for (Eigen::Index b = 0; b < n; ++b) sum += A(i, a) * then.shape(a, b) * A(j, b);
    return sum;
  };
  for (Eigen::Index i = 0; i < n; ++i) {
    double half = A.row(i).norm() * then.radius;
    if (then.box.size() > 0) half = std::min(half, A.row(i).cwiseAbs().dot(then.box));
    if (has_shape) half = std::min(half, then.stretch * std::sqrt(std::max(carried(i, i), 0.0)));
    now.box(i) = half + each_[k](i);
  }
  now.radius = std::min(norm_[k] * then.radius + added_[k], now.box.norm());
  if (!has_shape) return;
  now.shape.resize(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j) now.shape(i, j) = then.stretch * then.stretch * carried(i, j);
  if (shape_[k].trace() > 0.0) detail::outer_sum(now.shape, shape_[k], now.shape);
  now.stretch = 1.0;
}

Region ellipsoid(const VectorRef& center, const MatrixRef& shape, double stretch) {
  detail::require_shape("center", center, center.size(), 1);
  if (center.size() < 1) refuse("center", "no numbers", "at least one");
  detail::require_covariance("shape", shape, center.size());
  detail::require_least("stretch", stretch, 0.0);
  const Vector box = stretch * shape.diagonal().cwiseMax(0.0).cwiseSqrt();
  const double ball = stretch * std::sqrt(spectral_norm(shape));
  return {center, std::min(ball, box.norm()), box, shape, stretch};
}

Region Propagation::age(const Region& then, int age) const {
  if (age < 0 || age > steps()) refuse("age", std::to_string(age), "0.." + std::to_string(steps()));
  if (then.answered()) {
    detail::require_shape("center", then.center, states(), 1);
    detail::require_least("radius", then.radius, 0.0);
    if (then.box.size() > 0) detail::require_bounds("box", then.box, states());
    if (then.shape.size() > 0) detail::require_covariance("shape", then.shape, states());
  }
  Region now;
  this->age(then, age, now);
  return now;
}

}  // namespace garrison::certificate
