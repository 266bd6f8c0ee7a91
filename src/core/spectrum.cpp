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
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(P);
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

}  // namespace detail
}  // namespace garrison
