// SPDX-License-Identifier: Apache-2.0
#include "garrison/analysis/poles.hpp"

#include <algorithm>
#include <string>

#include "core/solvers.hpp"

namespace garrison {
namespace {

constexpr int kSweeps = 5;

Matrix ackermann(const Matrix& A, const Matrix& c, const std::vector<double>& poles) {
  const auto n = A.rows();
  Matrix polynomial = Matrix::Identity(n, n);
  for (const double pole : poles) polynomial *= A - pole * Matrix::Identity(n, n);
  Matrix O(n, n);
  O.row(0) = c;
  for (Eigen::Index k = 1; k < n; ++k) O.row(k) = O.row(k - 1) * A;
  return polynomial * O.partialPivLu().solve(Vector::Unit(n, n - 1));
}

/// Orthonormal basis of what an m x n matrix of rank r maps to 0.
Matrix kernel(const Matrix& M, Eigen::Index r) {
  if (r == 0) return Matrix::Identity(M.cols(), M.cols());
  const Eigen::JacobiSVD<Matrix> svd(M, Eigen::ComputeFullV);
  return svd.matrixV().rightCols(M.cols() - r);
}

/// The unit vector of a space (orthonormal basis S) that is farthest from the span of the others' columns.
Vector farthest(const Matrix& S, const Matrix& others) {
  if (others.cols() == 0) return S.col(0);
  const Eigen::JacobiSVD<Matrix> span(others, Eigen::ComputeThinU);
  const Matrix U = span.matrixU().leftCols(span.rank());
  const Matrix rest = S - U * (U.transpose() * S);
  const Eigen::JacobiSVD<Matrix> svd(rest, Eigen::ComputeFullV);
  return S * svd.matrixV().col(0);
}

Matrix without(const Matrix& X, Eigen::Index k, Eigen::Index filled) {
  Matrix others(X.rows(), filled - (k < filled ? 1 : 0));
  for (Eigen::Index c = 0, to = 0; c < filled; ++c)
    if (c != k) others.col(to++) = X.col(c);
  return others;
}

/// Of the dual: x with (A' - pole I) x in the range of C'; these are the eigenvectors that can be had.
std::vector<Matrix> possible_eigenvectors(const Matrix& A, const Matrix& rows,
                                          const std::vector<double>& poles) {
  const auto n = A.rows();
  const Matrix unseen = kernel(rows, rows.rows());  // n x (n - r), orthogonal to the range of C'
  std::vector<Matrix> spaces;
  for (const double pole : poles) {
    const Matrix M = unseen.transpose() * (A.transpose() - pole * Matrix::Identity(n, n));
    spaces.push_back(kernel(M, n - rows.rows()));
  }
  return spaces;
}

void require_shapes(const MatrixRef& A, const MatrixRef& C, const std::vector<double>& poles) {
  if (A.rows() != A.cols() || A.rows() == 0)
    refuse("place_poles.A", std::to_string(A.rows()) + " x " + std::to_string(A.cols()), "a square matrix");
  if (C.rows() == 0 || C.cols() != A.cols())
    refuse("place_poles.C", std::to_string(C.rows()) + " x " + std::to_string(C.cols()),
           "rows of " + amount(A.cols(), "number"));
  if (static_cast<Eigen::Index>(poles.size()) != A.rows())
    refuse("poles", amount(poles.size(), "number"), std::to_string(A.rows()) + ", one per state");
}

void require_multiplicity(const std::vector<double>& poles, Eigen::Index rank) {
  for (const double pole : poles) {
    const auto times = std::count(poles.begin(), poles.end(), pole);
    if (times > rank)
      refuse("poles", text(pole) + " " + std::to_string(times) + " times",
             "a pole at most " + std::to_string(rank) + " times, the number of independent outputs",
             "move them apart a little");
  }
}

}  // namespace

Matrix place_poles(const MatrixRef& A, const MatrixRef& C, const std::vector<double>& poles) {
  require_shapes(A, C, poles);
  if (C.rows() == 1) return ackermann(A, C, poles);
  const auto n = A.rows();
  const Eigen::JacobiSVD<Matrix> svd(C, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const Eigen::Index r = svd.rank();
  require_multiplicity(poles, r);
  const std::vector<Matrix> spaces = possible_eigenvectors(A, svd.matrixV().leftCols(r).transpose(), poles);
  Matrix X(n, n);
  for (Eigen::Index k = 0; k < n; ++k)
    X.col(k) = farthest(spaces[static_cast<std::size_t>(k)], without(X, k, k));
  for (int sweep = 0; sweep < kSweeps; ++sweep)
    for (Eigen::Index k = 0; k < n; ++k)
      X.col(k) = farthest(spaces[static_cast<std::size_t>(k)], without(X, k, n));
  // (A - H C)' = X diag(poles) X^-1, and H' solves C' H' = A' - that.
  const Vector eigenvalues = Eigen::Map<const Vector>(poles.data(), n);
  const Matrix wanted = X.transpose().partialPivLu().solve((X * eigenvalues.asDiagonal()).transpose());
  return (A - wanted) * svd.solve(Matrix::Identity(C.rows(), C.rows()));
}

}  // namespace garrison
