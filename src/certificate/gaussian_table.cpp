// SPDX-License-Identifier: Apache-2.0
#include "garrison/certificate/gaussian_table.hpp"

#include <cmath>
#include <optional>

#include "garrison/certificate/quantiles.hpp"
#include "recursion.hpp"
#include "require.hpp"

namespace garrison::certificate {
namespace {

/// sigma_j: deviation of the noise part of an honest innovation when P holds before the step.
Vector innovation_deviations(const ErrorSystem& s, const Matrix& P, const MatrixRef& Q, const VectorRef& R) {
  const Eigen::Index n = s.states();
  const auto variance = [](const auto& row, const MatrixRef& S) { return (row * S).dot(row); };
  Vector sigma(s.agents());
  for (Eigen::Index j = 0; j < s.agents(); ++j)
    sigma(j) = std::sqrt(variance(s.CA.row(j), P.block(j * n, j * n, n, n)) + variance(s.C.row(j), Q) + R(j));
  return sigma;
}

/// P(infinity) of P = M P M' + D by doubling; none when M is not Schur.
std::optional<Matrix> covariance_limit(const Matrix& M, const Matrix& D) {
  Matrix P = D;
  Matrix power = M;
  for (int k = 0; k < 60; ++k) {
    const Matrix more = power * P * power.transpose();
    P += more;
    if (!P.allFinite()) return {};
    if (more.cwiseAbs().maxCoeff() <= 1e-17 * P.cwiseAbs().maxCoeff()) return P;
    power = power * power;
  }
  return {};
}

}  // namespace

Vector GaussianTable::bound(int t, double delta) const {
  if (t < 0 || t >= table.d.rows())
    refuse("t", std::to_string(t), "a step in 0.." + std::to_string(table.d.rows() - 1));
  return table.d.row(t) + chi(delta, states) * deviation.row(t);
}

GaussianTable gaussian_table(const Kernels& k, const TableOptions& options, const MatrixRef& Q,
                             const VectorRef& R, double z) {
  const ErrorSystem& s = k.system;
  const Eigen::Index N = s.agents();
  detail::require_table(k, options);
  detail::require_covariance("Q", Q, s.states());
  detail::require_bounds("R", R, N);
  detail::require_least("z", z, 0.0);
  const Gains none = Gains::Zero(k.window() + 1, N);
  detail::Recursion recursion(k, options, none, none);
  const Vector b = Vector::Zero(N);
  GaussianTable result;
  result.deviation = Gains::Constant(options.T + 1, N, kInfinity);
  result.states = static_cast<int>(s.states());
  result.deviation.row(0).setZero();
  Matrix P = Matrix::Zero(s.M.rows(), s.M.cols());
  result.table = recursion.run([&](int t, const Vector& eta) {
    const Vector sigma = innovation_deviations(s, P, Q, R);
    P = next_covariance(s, P, Q, R);
    if (P.allFinite()) result.deviation.row(t) = block_deviations(s, P);
    return recursion.inputs(eta + z * sigma, b);
  });
  const std::optional<Matrix> limit =
      covariance_limit(s.M, next_covariance(s, Matrix::Zero(s.M.rows(), s.M.cols()), Q, R));
  if (limit) {
    const Vector sigma = (1.0 + 1e-9) * innovation_deviations(s, *limit, Q, R);
    result.deviation_for_ever = (1.0 + 1e-9) * block_deviations(s, *limit);
    result.innovation_for_ever = sigma;
    result.table.steady = recursion.steady(
        result.table, [&](const Vector& eta) { return recursion.inputs(eta + z * sigma, b); });
  }
  return result;
}

}  // namespace garrison::certificate
