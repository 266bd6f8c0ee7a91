// SPDX-License-Identifier: Apache-2.0
// Weighted least squares over some rows, by the eigenvalues of G = sum C_j'C_j / R_j. Internal.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/solvers.hpp"
#include "garrison/certificate/rows.hpp"

namespace garrison::certificate::detail {

/// Sized once; nothing allocates after that.
class LeastSquares {
 public:
  explicit LeastSquares(int states)
      : eigen_(states), G_(states, states), to_frame_(states, states), c_(states), g_(states), u_(states) {}

  /// Solves over the rows j with `uses(j)`; false when they do not determine the state: lmin(G) <= 1e-10
  /// lmax(G).
  template <class Uses>
  bool solve(const Rows& rows, const Uses& uses) {
    return factor(rows, uses) && locate(rows, uses);
  }
  /// The part of `solve` that no measurement enters.
  template <class Uses>
  bool factor(const Rows& rows, const Uses& uses) {
    G_.setZero();
    for (int j = 0; j < rows.size(); ++j) {
      if (!uses(j)) continue;
      const double weight = 1.0 / rows.variance(j);
      for (Eigen::Index k = 0; k < G_.cols(); ++k) G_.col(k) += weight * rows.c(j)(k) * rows.c(j);
    }
    eigen_.compute(G_);
    const auto& values = eigen_.eigenvalues();
    const double least = values(0);
    if (!(least > 1e-10 * values(values.size() - 1)) || !(least <= kHuge * kHuge)) return false;
    // Columns of V over the root of their eigenvalue: G^-1 = T T', and G^-1/2 c is T'c up to a rotation.
    for (Eigen::Index k = 0; k < values.size(); ++k)
      to_frame_.col(k) = eigen_.eigenvectors().col(k) / std::sqrt(values(k));
    return true;
  }
  /// The rest of it, after `factor` of the same rows. Where rounding counts it is refined once: what rounding
  /// of G leaves is then less than what rounding of the measurements does. It counts where that is
  /// asked for (`exact`: the bound of the noise may be 0), and where measurements are far larger than their
  /// noise.
  template <class Uses>
  bool locate(const Rows& rows, const Uses& uses, bool exact = false) {
    c_.setZero();
    const double largest = start(rows, uses);
    rounds_ = exact || largest > kFarAboveNoise * kFarAboveNoise;
    if (rounds_) refine(rows, uses);
    return c_.allFinite();
  }

  const Vector& state() const { return c_; }
  /// What rounding changes a measurement of this row and C_j state() by: a part of their largest term; 0
  /// where it does not count.
  double rounding(const Rows& rows, int j) const {
    if (!rounds_) return 0.0;
    constexpr double kUnits = 8.0 * std::numeric_limits<double>::epsilon();
    const double* const c = rows.c(j).data();
    double largest = std::abs(rows.y(j));
    for (Eigen::Index k = 0; k < c_.size(); ++k) largest = std::max(largest, std::abs(c[k] * c_[k]));
    return kUnits * static_cast<double>(c_.size() + 1) * largest;
  }
  /// lmin(G).
  double least() const { return eigen_.eigenvalues()(0); }
  /// C_j G^-1 C_j'.
  double spread2(const Rows& rows, int j) {
    u_.noalias() = to_frame_.transpose() * rows.c(j);
    return u_.squaredNorm();
  }
  /// (G^-1)_kk.
  double variance(Eigen::Index k) const { return to_frame_.row(k).squaredNorm(); }

 private:
  /// Deviations; noise of the measurements is then a million times what rounding does to them.
  static constexpr double kFarAboveNoise = 1e6;

  /// From zero; the largest y_j^2 / R_j.
  template <class Uses>
  double start(const Rows& rows, const Uses& uses) {
    double largest = 0.0;
    step(rows, uses, [&](int j, const double*) {
      largest = std::max(largest, rows.y(j) * rows.y(j) / rows.variance(j));
      return rows.y(j);
    });
    return largest;
  }
  /// Once more, by the residuals.
  template <class Uses>
  void refine(const Rows& rows, const Uses& uses) {
    step(rows, uses, [&](int j, const double* c) {
      double residual = rows.y(j);
      for (Eigen::Index k = 0; k < c_.size(); ++k) residual -= c[k] * c_[k];
      return residual;
    });
  }
  template <class Uses, class Residual>
  void step(const Rows& rows, const Uses& uses, const Residual& residual) {
    const Eigen::Index n = g_.size();
    g_.setZero();
    for (int j = 0; j < rows.size(); ++j) {
      if (!uses(j)) continue;
      const double* const c = rows.c(j).data();
      const double weighted = residual(j, c) / rows.variance(j);
      for (Eigen::Index k = 0; k < n; ++k) g_[k] += weighted * c[k];
    }
    u_.noalias() = to_frame_.transpose().lazyProduct(g_);
    c_.noalias() += to_frame_.lazyProduct(u_);
  }

  Eigen::SelfAdjointEigenSolver<Matrix> eigen_;
  Matrix G_, to_frame_;
  Vector c_, g_, u_;
  bool rounds_ = false;  // rounding counts
};

}  // namespace garrison::certificate::detail
