// SPDX-License-Identifier: Apache-2.0
// Least squares over some rows of a window, and the frame G^-1/2 in which its theorems are written. Internal.
#pragma once

#include <algorithm>
#include <cmath>

#include "dense.hpp"
#include "garrison/certificate/memory/window.hpp"

namespace garrison::certificate::detail {

/// G = sum of N_r N_r', scaled to a unit diagonal, = L L'. Sized once; nothing allocates after that.
class WindowFit {
 public:
  explicit WindowFit(int unknowns)
      : G_(unknowns, unknowns),
        room_(unknowns, unknowns),
        columns_(unknowns, 3),
        g_(unknowns),
        scale_(unknowns),
        theta_(unknowns) {}

  void clear(int unknowns) {
    p_ = unknowns;
    G_.topLeftCorner(p_, p_).setZero();
    g_.head(p_).setZero();
  }
  void add(const Window& w, int r) {
    const auto N = w.N(r);
    g_.head(p_) += w.z(r) * N;
    for (Eigen::Index k = 0; k < p_; ++k)
      if (N(k) != 0.0) G_.col(k).head(p_) += N(k) * N;
  }
  /// The sums of several rows at once.
  void add(const MatrixRef& G, const VectorRef& g) {
    G_.topLeftCorner(p_, p_) += G;
    g_.head(p_) += g;
  }
  /// The sums so far.
  auto G() const { return G_.topLeftCorner(p_, p_); }
  auto g() const { return g_.head(p_); }

  /// False when the rows do not determine theta: lmin <= 1e-10 lmax of the scaled G.
  bool solve() {
    auto G = G_.topLeftCorner(p_, p_);
    auto scale = scale_.head(p_);
    for (Eigen::Index k = 0; k < p_; ++k) {
      if (!(G(k, k) > 0.0 && G(k, k) <= kHuge * kHuge)) return false;
      scale(k) = std::sqrt(G(k, k));
    }
    for (Eigen::Index k = 0; k < p_; ++k) G.col(k).array() /= scale.array() * scale(k);
    auto copy = room_.topLeftCorner(p_, p_);
    copy = G;
    const auto [least, most] = extreme_eigenvalues(copy, columns_);
    if (!(least > 1e-10 * most) || !cholesky(G)) return false;
    auto theta = theta_.head(p_);
    theta.array() = g_.head(p_).array() / scale.array();
    solve_lower(G, theta);
    solve_upper(G, theta);
    rounding_ = kRounding * static_cast<double>(p_) * most / std::sqrt(least) * theta.norm();
    leverage_rounding_ = kRounding * static_cast<double>(p_) * std::sqrt(most / least);
    theta.array() /= scale.array();
    return theta.allFinite();
  }

  auto theta() const { return theta_.head(p_); }
  /// Bound on what rounding did to G^1/2 theta: G_s (theta_s + d) = g_s + what is lost of |G_s| |theta_s|, s
  /// = scaled, so that |G_s^1/2 d| <= ||G_s|| |theta_s|/sqrt(lmin) of it. States far from the origin feel it.
  double rounding() const { return rounding_; }
  /// sqrt(1 - leverage): what is left of the noise of a row in its residual. v: the row in the frame. Never
  /// less than rounding of a leverage of 1 hides: a row that hardly anything else sees has a residual all the
  /// same.
  double free(const Eigen::Ref<const Vector>& v) const {
    return std::sqrt(std::max(1.0 - v.squaredNorm(), 0.0) + leverage_rounding_);
  }
  /// v becomes G^-1/2 v (up to a rotation).
  void to_frame(Eigen::Ref<Vector> v) const {
    v.array() /= scale_.head(p_).array();
    solve_lower(G_.topLeftCorner(p_, p_), v);
  }

 private:
  static constexpr double kRounding = 4e-16;

  Matrix G_, room_, columns_;
  Vector g_, scale_, theta_;
  double rounding_ = 0.0, leverage_rounding_ = 0.0;
  Eigen::Index p_ = 0;
};

}  // namespace garrison::certificate::detail
