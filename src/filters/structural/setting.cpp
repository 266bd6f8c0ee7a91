// SPDX-License-Identifier: Apache-2.0
#include "garrison/filters/structural/setting.hpp"

#include <cmath>
#include <string>

#include "core/spectrum.hpp"

namespace garrison::structural {
namespace {

std::string entry(const char* which, Eigen::Index i, Eigen::Index j) {
  return std::string(which)
      .append("[")
      .append(std::to_string(i))
      .append(", ")
      .append(std::to_string(j))
      .append("]");
}

std::string shape(const Matrix& M) { return std::to_string(M.rows()) + " x " + std::to_string(M.cols()); }

void require_matrix(const std::string& which, const Matrix& M, Eigen::Index rows, Eigen::Index columns) {
  if (M.rows() != rows || M.cols() != columns)
    refuse(which, shape(M), std::to_string(rows) + " x " + std::to_string(columns));
  for (Eigen::Index i = 0; i < rows; ++i)
    for (Eigen::Index j = 0; j < columns; ++j)
      if (!std::isfinite(M(i, j))) refuse(entry(which.c_str(), i, j), text(M(i, j)), "a finite number");
}

void require_covariance(const std::string& which, const Matrix& M, Eigen::Index size) {
  require_matrix(which, M, size, size);
  const double scale = M.cwiseAbs().maxCoeff();
  if ((M - M.transpose()).cwiseAbs().maxCoeff() > 1e-12 * scale)
    refuse(which, "a matrix that is not symmetric", "a symmetric covariance", "use (M + M') / 2");
  const double least = garrison::detail::least_eigenvalue(M);
  if (least < -1e-12 * scale)
    refuse(which, "least eigenvalue " + text(least), "a positive semidefinite covariance", "check its sign");
}

}  // namespace

void require_graphs(const Setting& s) {
  if (s.A.rows() < 1) refuse("A", shape(s.A), "a square matrix with at least one row");
  require_matrix("A", s.A, s.A.rows(), s.A.rows());
  if (s.C.rows() < 1) refuse("C", shape(s.C), "one row per agent, at least one agent");
  require_matrix("C", s.C, s.C.rows(), s.n());
  require_matrix("W", s.W, s.N(), s.N());
  require_matrix("U", s.U, s.N(), s.N());
  for (Eigen::Index i = 0; i < s.N(); ++i) {
    for (Eigen::Index j = 0; j < s.N(); ++j) {
      if (s.W(i, j) < 0.0) refuse(entry("W", i, j), text(s.W(i, j)), "a weight >= 0");
      if (s.U(i, j) != 0.0 && s.U(i, j) != 1.0) refuse(entry("U", i, j), text(s.U(i, j)), "0 or 1");
    }
    if (s.U(i, i) != 1.0)
      refuse(entry("U", i, i), text(s.U(i, i)), "1", "an agent always has its own measurement");
    const double sum = s.W.row(i).sum();
    if (std::abs(sum - 1.0) > 1e-9)
      refuse("row " + std::to_string(i) + " of W", "a sum of " + text(sum), "1 (W is row-stochastic)",
             "divide the row by its sum");
  }
}

void require_valid(const Setting& s) {
  require_graphs(s);
  require_covariance("E", s.E, s.n());
  require_covariance("R", s.R, s.N());
}

void require_gains(const Setting& s, const GainMatrices& K) {
  if (static_cast<Eigen::Index>(K.size()) != s.N())
    refuse("K", amount(K.size(), "matrix", "matrices"), std::to_string(s.N()) + ", one per agent");
  for (std::size_t i = 0; i < K.size(); ++i)
    require_matrix("K[" + std::to_string(i) + "]", K[i], s.n(), s.n());
}

}  // namespace garrison::structural
