// SPDX-License-Identifier: Apache-2.0
#include "symmetric_eigen.hpp"

#include "core/solvers.hpp"

namespace garrison::detail {
namespace {

template <class Square>
void solve(const double* S, Eigen::Index n, double* values, double* vectors) {
  const Square matrix = Eigen::Map<const Matrix>(S, n, n);
  const Eigen::SelfAdjointEigenSolver<Square> eigen(
      matrix, vectors == nullptr ? Eigen::EigenvaluesOnly : Eigen::ComputeEigenvectors);
  Eigen::Map<Vector>(values, n) = eigen.eigenvalues();
  if (vectors != nullptr) Eigen::Map<Matrix>(vectors, n, n) = eigen.eigenvectors();
}

}  // namespace

void symmetric_eigen(const double* S, Eigen::Index n, double* values, double* vectors) {
  constexpr int kSmall = 8;
  if (n <= kSmall)
    solve<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kSmall, kSmall>>(
        S, n, values, vectors);
  else
    solve<Matrix>(S, n, values, vectors);
}

}  // namespace garrison::detail
