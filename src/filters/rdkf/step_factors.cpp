// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "core/solvers.hpp"
#include "garrison/filters/rdkf/step.hpp"

namespace garrison::rdkf {

StepFactors step_factors(const MatrixRef& whitener, const MatrixRef& C, const MatrixRef& Q, Penalty penalty) {
  const Eigen::Index q = C.rows();
  const Eigen::Index n = C.cols();
  const Eigen::LLT<Matrix> factor(Q);
  if (factor.info() != Eigen::Success)
    refuse("Q", "a matrix that is not positive definite", "a symmetric positive definite matrix");
  if (q == 0) return {Packed(Matrix(0, 0)), Packed(Matrix(0, n)), Packed(Matrix(n, 0)), {}};
  const Matrix M = whitener * C;
  // M L^-T, not M Q^-1 M', whose eigenvalues would be the squares of these singular values.
  const Matrix scaled = factor.matrixL().solve(M.transpose()).transpose();
  const Eigen::JacobiSVD<Matrix> svd(scaled, Eigen::ComputeFullU);
  const Vector& s = svd.singularValues();
  const double rounding = 1e-14 * (s.size() > 0 ? s(0) : 0.0) * static_cast<double>(std::max(q, n));
  Matrix K = svd.matrixU().transpose() * M;
  Matrix W = factor.solve(K.transpose()) / 2.0;
  StepFactors f;
  f.d.assign(static_cast<std::size_t>(padded(q)), 0.0);
  for (Eigen::Index i = 0; i < q; ++i) {
    const double singular = i < s.size() && s(i) > rounding ? s(i) : 0.0;
    f.d[static_cast<std::size_t>(i)] = (singular * singular + (penalty == Penalty::huber ? 1.0 : 0.0)) / 2.0;
    if (singular > 0.0) continue;
    K.row(i).setZero();
    W.col(i).setZero();
  }
  f.R = Packed(svd.matrixU().transpose() * whitener);
  f.K = Packed(K);
  f.W = Packed(W);
  return f;
}

}  // namespace garrison::rdkf
