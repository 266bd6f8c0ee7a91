// SPDX-License-Identifier: Apache-2.0
#include "garrison/certificate/two_numbers.hpp"

#include <algorithm>
#include <cmath>

#include "garrison/certificate/kernels.hpp"
#include "require.hpp"
#include "top.hpp"

namespace garrison::certificate {

TwoNumbers::TwoNumbers(const MatrixRef& A, const MatrixRef& C, int s, double rho, double p, double bw,
                       const VectorRef& bv)
    : s_(s), rho_(rho), p_(p), bw_(bw) {
  const Eigen::Index n = A.rows();
  const Eigen::Index N = C.rows();
  if (n < 1 || N < 1) refuse("A, C", detail::shape(A) + " and " + detail::shape(C), "at least 1 x 1");
  detail::require_shape("A", A, n, n);
  detail::require_shape("C", C, N, n);
  detail::require_least("s", s, 0);
  detail::require_least("rho", rho, 0.0);
  detail::require_least("p", p, 0.0);
  detail::require_least("bw", bw, 0.0);
  detail::require_bounds("bv", bv, N);
  detail::require_room("C", static_cast<double>(N * n * n));
  row_length_ = C.rowwise().norm();
  for (Eigen::Index j = 0; j < N; ++j)
    if (row_length_(j) != 0.0 && !(std::abs(row_length_(j) - 1.0) <= 1e-9))
      refuse("C", "row " + std::to_string(j) + " of length " + text(row_length_(j)),
             "rows of length 1, or 0");
  norm_CA_ = (C * A).rowwise().norm();
  bv_ = bv;
  theta_.resize(N);
  const double count = static_cast<double>(N);
  single_ = std::sqrt((count - 1.0) / count);

  const Matrix I = Matrix::Identity(n, n);
  const Matrix S = C.transpose() * C;
  Matrix side(n, N * n);   // [D_j A] side by side
  Matrix mixed(N * n, n);  // (S/N - D_j) on top of each other
  Constants& k = constants_;
  for (Eigen::Index j = 0; j < N; ++j) {
    const Matrix D = C.row(j).transpose() * C.row(j);
    side.middleCols(j * n, n) = D * A;
    mixed.middleRows(j * n, n) = S / count - D;
    k.m = std::max(k.m, spectral_norm(A - D * A));
  }
  k.c = spectral_norm(A - S * A / count);
  k.cw = spectral_norm(I - S / count);
  k.tau = spectral_norm(side) / count;
  k.kA = spectral_norm(mixed * A);
  k.kw = spectral_norm(mixed);
  const Vector own = row_length_.cwiseProduct(bv);
  // ||C C'|| = ||C||^2.
  k.v1 = std::min(own.sum(), spectral_norm(C) * bv.norm()) / count;
  k.v2 = own.norm();
}

double TwoNumbers::step(double gamma) {
  detail::require_least("gamma", gamma, 0.0);
  const Constants& k = constants_;
  // Adaptive level: level + H0 - b = 2 H0, and nobody honest is clipped.
  for (Eigen::Index j = 0; j < theta_.size(); ++j) theta_(j) = row_length_(j) == 0.0 ? 0.0 : 2.0 * honest(j);
  const std::span<double> theta(theta_.data(), static_cast<std::size_t>(theta_.size()));
  const double attack = detail::top(theta, s_);
  theta_ = theta_.cwiseAbs2();
  const double attack2 = std::sqrt(detail::top(theta, s_));
  const double rho = rho_;
  rho_ = k.c * rho + k.cw * bw_ + k.tau * p_ + k.v1 + attack / static_cast<double>(theta_.size());
  p_ = gamma == 0.0 ? 0.0 : gamma * (k.kA * rho + k.kw * bw_ + k.m * p_ + k.v2 + attack2);
  if (!std::isfinite(rho_) || !std::isfinite(p_)) rho_ = p_ = kInfinity;
  return bound();
}

}  // namespace garrison::certificate
