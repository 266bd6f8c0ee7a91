// SPDX-License-Identifier: Apache-2.0
#include "garrison/certificate/propagate.hpp"

#include <algorithm>
#include <cmath>

#include "core/solvers.hpp"
#include "garrison/certificate/kernels.hpp"
#include "garrison/certificate/quantiles.hpp"
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

Propagation Propagation::bounded(const MatrixRef& A, int steps, double bw) {
  detail::require_least("bw", bw, 0.0);
  Propagation p(A, steps);
  double sum = 0.0;
  for (const double norm : p.norm_) {
    p.added_.push_back(sum);
    sum += norm * bw;
  }
  return p;
}

Propagation Propagation::gaussian(const MatrixRef& A, int steps, const MatrixRef& Q, double delta) {
  Propagation p(A, steps);
  detail::require_covariance("Q", Q, A.rows());
  const double quantile = chi(delta, p.states());
  Matrix covariance = Matrix::Zero(A.rows(), A.rows());
  for (const Matrix& power : p.power_) {
    p.added_.push_back(quantile * std::sqrt(spectral_norm(covariance)));
    covariance += power * Q * power.transpose();
    if (!covariance.allFinite()) refuse("steps", std::to_string(steps), "a finite covariance", "take fewer");
  }
  return p;
}

void Propagation::age(const Region& then, int age, Region& now) const noexcept {
  const auto k = static_cast<std::size_t>(age);
  now.radius = then.answered() ? norm_[k] * then.radius + added_[k] : then.radius;
  now.box.resize(0);
  if (!then.answered()) return;
  now.center.resize(then.center.size());
  now.center.noalias() = power_[k] * then.center;
}

Region Propagation::age(const Region& then, int age) const {
  if (age < 0 || age > steps()) refuse("age", std::to_string(age), "0.." + std::to_string(steps()));
  if (then.answered()) {
    detail::require_shape("center", then.center, states(), 1);
    detail::require_least("radius", then.radius, 0.0);
  }
  Region now;
  this->age(then, age, now);
  return now;
}

}  // namespace garrison::certificate
