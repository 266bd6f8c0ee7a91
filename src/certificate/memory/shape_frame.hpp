// SPDX-License-Identifier: Apache-2.0
// P^-1/2 of an ellipsoid {d' P^-1 d <= r^2}, and largest eigenvalues of small matrices. Internal.
#pragma once

#include <algorithm>
#include <cmath>

#include "dense.hpp"

namespace garrison::certificate::detail {

/// W with W P W' = I on the range of P. Sized once; nothing allocates after that.
class ShapeFrame {
 public:
  explicit ShapeFrame(int n) : scaled_(n, n), W_(n, n), room_(n, n), columns_(n, 3), d_(n), v_(n) {}

  /// P: n x n, positive semidefinite, any scales of its coordinates.
  void set(const MatrixRef& P) {
    const Eigen::Index n = P.rows();
    for (Eigen::Index k = 0; k < n; ++k) d_(k) = std::sqrt(std::max(P(k, k), 1e-300));
    for (Eigen::Index k = 0; k < n; ++k) scaled_.col(k).array() = P.col(k).array() / (d_.array() * d_(k));
    diagonalise(scaled_, room_);
    const double largest = scaled_.diagonal().maxCoeff();
    W_.setZero();
    for (Eigen::Index k = 0; k < n; ++k) {
      const double value = scaled_(k, k);
      if (!(value > 1e-13 * largest)) continue;
      const auto u = room_.col(k);
      for (Eigen::Index j = 0; j < n; ++j) W_.col(j) += (u(j) / (std::sqrt(value) * d_(j))) * u;
    }
  }
  const Matrix& W() const { return W_; }
  /// ||W d||.
  double length(const VectorRef& d) {
    v_ = W_.lazyProduct(d);
    return v_.norm();
  }
  /// sqrt(lmax(W P W')): how far the unit ellipsoid of P reaches in this frame.
  double stretch(const MatrixRef& P) {
    scaled_ = W_.lazyProduct(P);
    room_ = scaled_.lazyProduct(W_.transpose());
    return std::sqrt(std::max(extreme_eigenvalues(room_, columns_).second, 0.0));
  }
  /// ||W M|| (largest singular value), M with n rows.
  double norm(const MatrixRef& M) {
    room_ = M.lazyProduct(M.transpose());
    scaled_ = W_.lazyProduct(room_);
    room_ = scaled_.lazyProduct(W_.transpose());
    return std::sqrt(std::max(extreme_eigenvalues(room_, columns_).second, 0.0));
  }
  /// Least and largest eigenvalue of P.
  std::pair<double, double> eigenvalues(const MatrixRef& P) {
    room_ = P;
    return extreme_eigenvalues(room_, columns_);
  }

 private:
  Matrix scaled_, W_, room_, columns_;
  Vector d_, v_;
};

/// Two ellipsoids added: (1 + 1/tau) Ep + (1 + tau) Eg contains p + g for p in the one of Ep, g in that of
/// Eg; tau makes the trace least.
inline void outer_sum(const MatrixRef& Ep, const MatrixRef& Eg, Eigen::Ref<Matrix> sum) {
  const double ratio = std::sqrt(std::max(Ep.trace(), 1e-300) / std::max(Eg.trace(), 1e-300));
  const double tau = std::clamp(ratio, 1e-3, 1e3);
  sum = (1.0 + 1.0 / tau) * Ep + (1.0 + tau) * Eg;
}

}  // namespace garrison::certificate::detail
