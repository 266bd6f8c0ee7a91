// SPDX-License-Identifier: Apache-2.0
#include "garrison/certificate/informed.hpp"

#include <algorithm>

#include "garrison/certificate/quantiles.hpp"
#include "require.hpp"

namespace garrison::certificate {
namespace {

void require_start(const ErrorSystem& s, const VectorRef& start, int steps) {
  detail::require_bounds("start", start, s.agents());
  detail::require_least("steps", steps, 1);
  detail::require_room("steps", static_cast<double>(steps) * static_cast<double>(s.agents()));
}

/// What the errors at t0 still do: sum_l ||(power)_il|| start_l.
Vector faded(const ErrorSystem& s, const Matrix& power, const VectorRef& start) {
  const Eigen::Index n = s.states();
  Vector sum = Vector::Zero(s.agents());
  for (Eigen::Index i = 0; i < s.agents(); ++i)
    for (Eigen::Index l = 0; l < s.agents(); ++l)
      if (start(l) > 0.0) sum(i) += spectral_norm(power.block(i * n, l * n, n, n)) * start(l);
  return sum;
}

/// Bounds of all rows; `noise(power)`: what the noise of k steps may be when power = M^(k-1).
template <class NoisePart>
Gains rows(const ErrorSystem& s, const VectorRef& start, int steps, const NoisePart& noise) {
  Gains bounds = Gains::Constant(steps, s.agents(), kInfinity);
  Matrix power = Matrix::Identity(s.M.rows(), s.M.cols());
  for (int k = 0; k < steps; ++k) {
    const Vector part = noise(power);
    power = s.M * power;
    if (!power.allFinite() || !part.allFinite()) break;  // the rest stays infinite
    bounds.row(k) = faded(s, power, start) + part;
  }
  return bounds;
}

}  // namespace

int lists_complete(int step, int diameter, int rounds) {
  detail::require_least("step", step, 0);
  detail::require_least("diameter", diameter, 0);
  detail::require_least("rounds", rounds, 1);
  const int flooding = diameter / rounds + (diameter % rounds != 0 ? 1 : 0);
  return step + std::max(flooding, 1) - 1;
}

Gains informed(const ErrorSystem& s, const VectorRef& start, int steps, double bw, const VectorRef& bv) {
  require_start(s, start, steps);
  detail::require_least("bw", bw, 0.0);
  detail::require_bounds("bv", bv, s.agents());
  Vector sum = Vector::Zero(s.agents());
  return rows(s, start, steps, [&](const Matrix& power) -> const Vector& {
    const Matrix G = power * s.B;
    const Matrix W = power * s.B_w;
    for (Eigen::Index i = 0; i < s.agents(); ++i)
      sum(i) += spectral_norm(s.block(W, i)) * bw + s.block(G, i).colwise().norm().dot(bv.transpose());
    return sum;
  });
}

Gains informed(const ErrorSystem& s, const VectorRef& start, int steps, const MatrixRef& Q,
               const VectorRef& R, const MatrixRef& P0, double delta) {
  require_start(s, start, steps);
  detail::require_covariance("Q", Q, s.states());
  detail::require_bounds("R", R, s.agents());
  detail::require_covariance("P0", P0, s.M.rows());
  const double quantile = chi(delta, static_cast<int>(s.states()));
  Matrix P = P0;
  return rows(s, start, steps, [&](const Matrix&) -> Vector {
    P = next_covariance(s, P, Q, R);
    if (!P.allFinite()) return Vector::Constant(s.agents(), kInfinity);
    return quantile * block_deviations(s, P);
  });
}

}  // namespace garrison::certificate
