// SPDX-License-Identifier: Apache-2.0
#include "garrison/certificate/error_system.hpp"

#include <cmath>

#include "core/solvers.hpp"
#include "require.hpp"

namespace garrison::certificate {

ErrorSystem error_system(const MatrixRef& A, const MatrixRef& C, const MatrixRef& J,
                         std::span<const int> silent) {
  const Eigen::Index n = A.rows();
  const Eigen::Index N = C.rows();
  if (n < 1 || N < 1) refuse("A, C", detail::shape(A) + " and " + detail::shape(C), "at least 1 x 1");
  detail::require_shape("A", A, n, n);
  detail::require_shape("C", C, N, n);
  detail::require_shape("J", J, N, N);
  const double stacked = static_cast<double>(N * n);
  detail::require_room("A, C", stacked * stacked);
  for (Eigen::Index i = 0; i < N; ++i) {
    const double length = C.row(i).norm();
    if (length != 0.0 && !(std::abs(length - 1.0) <= 1e-9))
      refuse("C", "row " + std::to_string(i) + " of length " + text(length), "rows of length 1, or 0",
             "divide row and measurement by the length");
    const double sum = J.row(i).sum();
    if (!(std::abs(sum - 1.0) <= 1e-9 * (1.0 + J.row(i).cwiseAbs().sum())))
      refuse("J", "row " + std::to_string(i) + " with sum " + text(sum), "row sums 1");
  }
  ErrorSystem s{
      A, C, C * A, C.rowwise().norm(), Matrix(N * n, N * n), Matrix(N * n, N), Matrix::Zero(N * n, n)};
  Matrix used = C;
  for (const int j : silent) {
    if (j < 0 || j >= N) refuse("silent", std::to_string(j), "a sensor in 0.." + std::to_string(N - 1));
    used.row(j).setZero();
  }
  for (Eigen::Index l = 0; l < N; ++l) {
    const Matrix Pi = Matrix::Identity(n, n) - used.row(l).transpose() * used.row(l);
    const Matrix PiA = Pi * A;
    for (Eigen::Index i = 0; i < N; ++i) {
      s.M.block(i * n, l * n, n, n) = J(i, l) * PiA;
      s.B.block(i * n, l, n, 1) = J(i, l) * used.row(l).transpose();
      s.B_w.middleRows(i * n, n) -= J(i, l) * Pi;
    }
  }
  return s;
}

Matrix next_covariance(const ErrorSystem& s, const Matrix& P, const MatrixRef& Q, const VectorRef& R) {
  return s.M * P * s.M.transpose() + s.B_w * Q * s.B_w.transpose() + s.B * R.asDiagonal() * s.B.transpose();
}

Vector block_deviations(const ErrorSystem& s, const Matrix& P) {
  const Eigen::Index n = s.states();
  Vector deviation(s.agents());
  for (Eigen::Index i = 0; i < s.agents(); ++i) {
    const Matrix block = P.block(i * n, i * n, n, n);
    const double largest =
        Eigen::SelfAdjointEigenSolver<Matrix>(block, Eigen::EigenvaluesOnly).eigenvalues()(n - 1);
    deviation(i) = std::sqrt(std::max(largest, 0.0));
  }
  return deviation;
}

}  // namespace garrison::certificate
