// SPDX-License-Identifier: Apache-2.0
#include "garrison/filters/rdkf/step.hpp"

#include <Eigen/Cholesky>
#include <Eigen/SVD>

namespace garrison::rdkf {

StepFactors step_factors(const MatrixRef& whitener, const MatrixRef& C, const MatrixRef& Q, Penalty penalty) {
  const Eigen::Index q = C.rows();
  const Eigen::LLT<Matrix> factor(Q);
  if (factor.info() != Eigen::Success)
    refuse("Q", "a matrix that is not positive definite", "a symmetric positive definite matrix");
  if (q == 0) return {Matrix(0, 0), Matrix(0, C.cols()), Matrix(C.cols(), 0), Vector(0)};
  const Matrix M = whitener * C;
  // M L^-T, not M Q^-1 M', whose eigenvalues would be the squares of these singular values.
  const Matrix scaled = factor.matrixL().solve(M.transpose()).transpose();
  const Eigen::JacobiSVD<Matrix> svd(scaled, Eigen::ComputeFullU);
  const Vector& s = svd.singularValues();
  const double rounding = 1e-14 * (s.size() > 0 ? s(0) : 0.0) * static_cast<double>(std::max(q, C.cols()));
  StepFactors f;
  f.R = svd.matrixU().transpose() * whitener;
  f.K = svd.matrixU().transpose() * M;
  f.W = factor.solve(f.K.transpose()) / 2.0;
  f.d = Vector::Zero(q);
  for (Eigen::Index i = 0; i < q; ++i) {
    const double singular = i < s.size() && s(i) > rounding ? s(i) : 0.0;
    f.d(i) = (singular * singular + (penalty == Penalty::huber ? 1.0 : 0.0)) / 2.0;
    if (singular > 0.0) continue;
    f.K.row(i).setZero();
    f.W.col(i).setZero();
  }
  return f;
}

}  // namespace garrison::rdkf
