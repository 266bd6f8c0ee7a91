// SPDX-License-Identifier: Apache-2.0
#include "garrison/analysis/power_norms.hpp"

#include <cmath>
#include <limits>
#include <string>

#include "core/solvers.hpp"

namespace garrison {

PowerNorms::PowerNorms(const MatrixRef& A, int most) {
  const auto n = A.rows();
  if (n < 1 || A.cols() != n || !A.allFinite())
    refuse("A", std::to_string(n) + " x " + std::to_string(A.cols()), "a square matrix of finite numbers");
  if (most < 1) refuse("most", std::to_string(most), "a number of powers >= 1");
  // The product of k matrices is off by about k n eps of the product of their norms' actual sizes; the
  // allowance keeps the norm an upper bound.
  const double rounding = 4.0 * static_cast<double>(n) * std::numeric_limits<double>::epsilon();
  Matrix power = Matrix::Identity(n, n);
  Matrix absolute = Matrix::Identity(n, n);  // entries of |A|^k bound what rounding can have done
  double before = 0.0;
  for (int k = 0; k <= most; ++k) {
    const double allowance = k == 0 ? 0.0 : rounding * k * absolute.norm();
    norm_.push_back(k == 0 ? 1.0 : Eigen::JacobiSVD<Matrix>(power).singularValues()(0) + allowance);
    sum_.push_back(before);
    before += norm_.back();
    power = power * A;
    absolute = absolute * A.cwiseAbs();
  }
  sum_.push_back(before);
}

double PowerNorms::norm(long long k) const {
  const auto most = static_cast<long long>(norm_.size()) - 1;
  double factor = 1.0;
  for (; k > most; k -= most) factor *= norm_.back();
  return factor * norm_[static_cast<std::size_t>(k)];
}

double PowerNorms::predicted(long long k, double start, double step) const {
  const auto most = static_cast<long long>(norm_.size()) - 1;
  // Block by block: the error at the end of one is the initial error of the next.
  for (; k > most; k -= most) start = norm_.back() * start + step * sum_[static_cast<std::size_t>(most)];
  return norm_[static_cast<std::size_t>(k)] * start + step * sum_[static_cast<std::size_t>(k)];
}

}  // namespace garrison
