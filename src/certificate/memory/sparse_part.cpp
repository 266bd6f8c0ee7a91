// SPDX-License-Identifier: Apache-2.0
#include "sparse_part.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/solvers.hpp"
#include "undetectable_search.hpp"

namespace garrison::certificate::detail {
namespace {

constexpr int kPowers = 30;         // of the inverse, to estimate the smallest eigenvalue
constexpr int kRefinements = 4;     // of one solution
constexpr double kSettled = 1e-11;  // error of an entry of Lam that needs no refinement

}  // namespace

SparsePart::SparsePart(RowPart part, SparseRows H) : part_(std::move(part)), H_(std::move(H)) {
  if (H_.rows() < H_.cols()) return;
  gram_ = SparseGram(H_.transpose() * H_);
  factor_.compute(gram_);
  if (factor_.info() == Eigen::Success && factor_.vectorD().minCoeff() > 0.0) least_ = find_least();
}

double SparsePart::find_least() const {
  // The factor of a matrix that rounding has moved so far tells nothing of the matrix itself.
  const double norm =
      gram_.diagonal().sum() / static_cast<double>(gram_.cols()) + gram_.coeffs().abs().maxCoeff();
  const double rounding = 1e3 * std::numeric_limits<double>::epsilon() * norm;
  Vector v = Vector::LinSpaced(gram_.cols(), 1.0, 2.0).normalized();
  double estimate = 0.0;
  for (int k = 0; k < kPowers; ++k) {
    const Vector w = factor_.solve(v);
    if (!(w.norm() > 0.0) || !std::isfinite(w.norm())) return 0.0;
    estimate = 1.0 / w.norm();
    v = w / w.norm();
  }
  for (double shift = 0.99 * estimate; shift > rounding; shift *= 0.5)
    if (is_above(shift)) return shift - rounding;
  return 0.0;
}

bool SparsePart::is_above(double shift) const {
  SparseGram less = gram_;
  for (Eigen::Index k = 0; k < less.cols(); ++k) less.coeffRef(k, k) -= shift;
  const Eigen::SimplicialLDLT<SparseGram> factor(less);
  return factor.info() == Eigen::Success && factor.vectorD().minCoeff() > 0.0;
}

Vector SparsePart::solve(const Vector& h, double& error) const {
  Vector x = factor_.solve(h);
  for (int k = 0;; ++k) {
    // h_j' G^-1 r <= |r| / sqrt(least), because a row of Lam^(1/2) is no longer than 1.
    const Vector left = h - gram_ * x;
    error = left.norm() / std::sqrt(least_);
    if (error <= kSettled || k == kRefinements) return x;
    x += factor_.solve(left);
  }
}

double SparsePart::hat_row(Eigen::Index i, Vector& out) const {
  double error = 0.0;
  const Vector h = H_.row(i).transpose();
  out = H_ * solve(h, error);
  return error;
}

bool SparsePart::needed(const std::vector<int>& set) const {
  const auto k = static_cast<Eigen::Index>(set.size());
  Matrix block(k, k);
  Vector row;
  for (Eigen::Index a = 0; a < k; ++a) {
    hat_row(set[static_cast<std::size_t>(a)], row);
    for (Eigen::Index b = 0; b < k; ++b) block(a, b) = row(set[static_cast<std::size_t>(b)]);
  }
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(0.5 * (block + block.transpose()));
  if (!(eigen.eigenvalues()(k - 1) > 1.0 - kNear)) return false;
  // The change of the state that these rows show most of, and what the others see of it.
  Vector h = Vector::Zero(H_.cols());
  for (Eigen::Index a = 0; a < k; ++a)
    h += eigen.eigenvectors()(a, k - 1) * Vector(H_.row(set[static_cast<std::size_t>(a)]).transpose());
  double error = 0.0;
  Vector seen = H_ * solve(h, error);
  const double all = seen.norm();
  for (const int a : set) seen(a) = 0.0;
  return seen.norm() <= kNear * all;
}

}  // namespace garrison::certificate::detail
