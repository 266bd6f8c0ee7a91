// SPDX-License-Identifier: Apache-2.0
#include "clearly_observable.hpp"

#include <cmath>

#include "balance.hpp"
#include "pencil.hpp"

namespace garrison::detail {
namespace {

/// Ten times the largest distance that counts as unclear: entries that are rounding only cannot matter then.
constexpr double kClear = 1e-9;
/// Beyond, sigma_min(O) says nothing: powers of A are too alike.
constexpr Eigen::Index kMostStates = 16;

Matrix observability_matrix(const Matrix& A, const Matrix& C) {
  const Eigen::Index m = C.rows();
  Matrix O(m * A.rows(), A.cols());
  O.topRows(m) = C;
  for (Eigen::Index k = 1; k < A.rows(); ++k)
    O.middleRows(k * m, m).noalias() = O.middleRows((k - 1) * m, m) * A;
  return O;
}

/// 1 / |R^-1| (Frobenius), at most the least singular value; 0 or nan where R is singular.
double least_singular_bound(const Matrix& O) {
  const Eigen::Index n = O.cols();
  const Eigen::HouseholderQR<Matrix> qr(O);
  const auto R = qr.matrixQR().topRows(n).template triangularView<Eigen::Upper>();
  return 1.0 / Matrix(R.solve(Matrix::Identity(n, n))).norm();
}

}  // namespace

bool clearly_observable(const Matrix& A, const Matrix& C) {
  const Eigen::Index n = A.rows();
  if (C.rows() == 0 || n == 0 || n > kMostStates || !A.allFinite() || !C.allFinite()) return false;
  const Pair pair = rows_scaled(A, C, natural_rate(A));
  const double size = pair_size(pair.A, pair.C);
  const double sigma = least_singular_bound(observability_matrix(pair.A / size, pair.C / size));
  return sigma / (1.2 * std::pow(static_cast<double>(n), 1.5)) > kClear;
}

}  // namespace garrison::detail
