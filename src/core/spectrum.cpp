// SPDX-License-Identifier: Apache-2.0
#include "core/spectrum.hpp"

#include "core/solvers.hpp"

namespace garrison {

double spectral_radius(const MatrixRef& M) {
  if (M.rows() == 0) return 0.0;
  return Eigen::EigenSolver<Matrix>(M, false).eigenvalues().cwiseAbs().maxCoeff();
}

namespace detail {

double least_eigenvalue(const MatrixRef& S) {
  return Eigen::SelfAdjointEigenSolver<Matrix>(S, Eigen::EigenvaluesOnly).eigenvalues()(0);
}

Matrix covariance_root(const MatrixRef& P) {
  Vector scale = P.diagonal().cwiseMax(0.0).cwiseSqrt();
  scale = (scale.array() > 0.0).select(scale, 1.0);
  const Vector inverse = scale.cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(inverse.asDiagonal() * P * inverse.asDiagonal());
  return scale.asDiagonal() * eigen.eigenvectors() *
         eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

}  // namespace detail
}  // namespace garrison
