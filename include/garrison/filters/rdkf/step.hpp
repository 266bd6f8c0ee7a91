// SPDX-License-Identifier: Apache-2.0
// The convex step of the resilient distributed Kalman filter (Dutta, Zhang, Jin), solved exactly.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "garrison/core/error.hpp"
#include "garrison/core/types.hpp"

namespace garrison::rdkf {

/// What a residual r = b - M x costs: `norm` is the paper's lambda |r|, (8); `huber` is |r|^2 up to lambda/2
/// and lambda |r| - lambda^2/4 beyond, so that an unsaturated step is the Kalman step (our notes, 3.4).
enum class Penalty { norm, huber };

/// What of  min over x of penalty(b - M x) + (x - x0)' Q (x - x0)  does not depend on b and x0.
///
/// The dual is  max over |u| <= lambda of u'r0 - u' D u / 2,  r0 = b - M x0, D = M Q^-1 M' / 2 (plus 1/2 for
/// `huber`); with Q = L L' and M L^-T = V s Z' it falls apart into q scalars (our notes, 3.1).
struct GARRISON_EXPORT StepFactors {
  Matrix R;  ///< q x q, V' Sv^-1/2: turns a measurement y into V'b
  Matrix K;  ///< q x n, V'M
  Matrix W;  ///< n x q, Q^-1 M' V / 2
  Vector d;  ///< q, eigenvalues of D; exactly 0 on its kernel
};

/// @param whitener Sv^-1/2, q x q; @param C q x n; @param Q n x n, symmetric positive definite
GARRISON_EXPORT StepFactors step_factors(const MatrixRef& whitener, const MatrixRef& C, const MatrixRef& Q,
                                         Penalty penalty);

/// How a step ended.
struct Step {
  double mu = 0.0;  ///< multiplier: residual = mu u with |u| = lambda; 0 = not saturated; inf for lambda = 0
  int iterations = 0;  ///< of the secular equation
};

/// Least mu >= 0 with |rho_i / (d_i + mu)| <= lambda. Newton on 1/|u(mu)| = 1/lambda climbs monotonically
/// from the left bound, so nothing guards it. Entries with d_i = 0 and |rho_i| <= `zero` do not count.
inline Step secular(const double* rho, const double* d, Eigen::Index q, double lambda, double zero) noexcept {
  if (lambda == 0.0) return {kInfinity, 0};
  double largest = 0.0;
  for (Eigen::Index i = 0; i < q; ++i)
    if (d[i] > 0.0 || std::abs(rho[i]) > zero) largest = std::max(largest, std::abs(rho[i]));
  if (largest == 0.0) return {};
  const double level = lambda / largest;  // scaled: squares of huge entries would overflow
  double all = 0.0;
  double kernel = 0.0;
  double within = 0.0;
  double steepest = 0.0;
  for (Eigen::Index i = 0; i < q; ++i) {
    const double r = rho[i] / largest;
    if (d[i] > 0.0) {
      within += (r / d[i]) * (r / d[i]);
      steepest = std::max(steepest, d[i]);
      all += r * r;
    } else if (std::abs(rho[i]) > zero) {
      kernel += r * r;
      all += r * r;
    }
  }
  if (kernel == 0.0 && within <= level * level) return {};
  double mu = std::max({0.0, std::sqrt(all) / level - steepest, std::sqrt(kernel) / level});
  int iterations = 0;
  while (iterations < 100) {
    ++iterations;
    double square = 0.0;
    double slope = 0.0;
    for (Eigen::Index i = 0; i < q; ++i) {
      if (!(d[i] > 0.0) && !(std::abs(rho[i]) > zero)) continue;
      const double u = rho[i] / largest / (d[i] + mu);
      square += u * u;
      slope += u * u / (d[i] + mu);
    }
    const double length = std::sqrt(square);
    const double next = mu + (length / level - 1.0) * square / slope;
    if (!(next > mu * (1.0 + std::numeric_limits<double>::epsilon()))) break;
    mu = next;
  }
  return {mu, iterations};
}

/// Solves one step. y: q numbers, finite. x: n numbers, x0 on entry and the minimiser on return. u: room for
/// q numbers; returns V'u, the least-norm dual solution.
inline Step solve(const StepFactors& f, double lambda, const double* y, double* x, double* u) noexcept {
  const Eigen::Index q = f.d.size();
  const Eigen::Index n = f.W.rows();
  double* const rho = u;
  double b_square = 0.0;
  double Mx_square = 0.0;
  for (Eigen::Index i = 0; i < q; ++i) {
    double b = 0.0;
    double Mx = 0.0;
    for (Eigen::Index k = 0; k < q; ++k) b += f.R(i, k) * y[k];
    for (Eigen::Index k = 0; k < n; ++k) Mx += f.K(i, k) * x[k];
    rho[i] = b - Mx;
    b_square += b * b;
    Mx_square += Mx * Mx;
  }
  const double zero = 1e-14 * (std::sqrt(b_square) + std::sqrt(Mx_square));
  const Step step = secular(rho, f.d.data(), q, lambda, zero);
  for (Eigen::Index i = 0; i < q; ++i) {
    const bool counts = lambda > 0.0 && (f.d[i] > 0.0 || std::abs(rho[i]) > zero);
    u[i] = counts ? rho[i] / (f.d[i] + step.mu) : 0.0;
    for (Eigen::Index k = 0; k < n; ++k) x[k] += f.W(k, i) * u[i];
  }
  return step;
}

}  // namespace garrison::rdkf
