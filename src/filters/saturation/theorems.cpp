// SPDX-License-Identifier: Apache-2.0
#include "garrison/filters/saturation/theorems.hpp"

#include <string>

#include "garrison/kernel/hypotenuse.hpp"

namespace garrison::saturation {
namespace {

/// R(x, t) + p(t) of (10) with t0 = 1, for t = 1..T.
std::vector<double> bounds_over_time(const Setting& s, double x, double rho1, double q0, int T) {
  std::vector<double> bounds;
  bounds.reserve(static_cast<std::size_t>(T));
  for (int t = 1; t <= T; ++t)
    bounds.push_back(std::pow(x, t - 1) * rho1 + q0 * geometric_sum(x, t - 1) + p_at(s, t));
  return bounds;
}

/// numerator/(1 - x), the limit of R(x, t); absent when x >= 1.
double settled(double numerator, double x) { return x < 1.0 ? numerator / (1.0 - x) : kNaN; }

double require_norm(const char* which, double value) {
  if (value < 0.0 || std::isinf(value)) refuse(which, text(value), "a finite number >= 0", "it is a norm");
  return value;
}

}  // namespace

TheoremBounds theorem_bounds(const Setting& s, double varpi, int T) {
  require(s);
  require_norm("varpi", varpi);
  if (T < 1) refuse("T", std::to_string(T), "a whole number >= 1");
  TheoremBounds b;
  if (!contracts(s)) return b;
  const auto [p0, q0, F_eta0, margin9, cond9] = constants(s);
  b.cond9 = cond9;
  if (!cond9) return b;
  const double rho1 = rho_sequence(s, 1)[1];
  b.thm1_item1 = bounds_over_time(s, F(s, rho1), rho1, q0, T);
  b.thm1_item2 = rho1 + p0;
  // On the knife edge of (9) rounding may lose the fixed point; rho_0 = eta0 is then the limit.
  const double lo = fixed_points(s).lo;
  b.thm1_item3 = (std::isnan(lo) ? s.eta0 : lo) + p0;
  const double qbar = s.a >= 1.0 ? q0 : s.b_w + std::max(s.beta, s.b_w + s.b_v + s.a * p0);
  b.prop2_f = settled(qbar, F_eta0) + p0;

  const double level = (s.beta - s.b_w - s.b_v) / s.a;
  b.cond12_margin = level - (rho1 + p0);
  b.cond12 = b.cond12_margin > 1e-12 * (std::abs(level) + rho1 + p0);
  if (!b.cond12 || std::isnan(varpi)) return b;
  b.thm3_item2 = bounds_over_time(s, varpi, rho1, q0, T);
  b.thm3_item3 = settled(q0, varpi) + p0;
  return b;
}

double varpi_bound(const Setting& s) {
  require_network(s);
  return s.a * (1.0 - s.lambda0 / s.agents);
}

std::vector<DetectedBound> theorem4(const Setting& s, int T) {
  require(s);
  if (T < 0) refuse("T", std::to_string(T), "a whole number >= 0");
  std::vector<DetectedBound> list;
  if (!contracts(s)) return list;
  const Constants k = constants(s);
  if (!k.cond9) return list;
  const double rho_T = rho_sequence(s, T).back();
  const double lo = fixed_points(s).lo;
  const double limit = std::isnan(lo) ? s.eta0 : lo;
  for (int d = 0; d <= s.attacked; ++d) {
    const double relief = d * s.beta / s.agents;
    DetectedBound b{d, rho_T, k.q0 - relief, limit, kNaN, kNaN, kNaN};
    if (d > 0) b.rhobar_limit = fixed_points(s, b.qbar).lo;
    b.F_star = F(s, b.rhobar_limit);
    b.W = limit + k.p0 - (d > 0 ? settled(relief, b.F_star) : 0.0);
    b.tight = b.rhobar_limit + k.p0;
    list.push_back(b);
  }
  return list;
}

InformedBound informed_bound(const Setting& s, double tau0, double varpi, int spread) {
  require(s);
  require_norm("tau0", tau0);
  require_norm("varpi", varpi);
  if (spread < 0) refuse("spread", std::to_string(spread), "a whole number >= 0");
  const double honest = s.agents - s.attacked;
  const double g11 = s.a * s.contraction;
  const double g12 = g11 * std::sqrt(honest);
  InformedBound b{kNaN, kNaN, 0.5 * (g11 + varpi + hypotenuse(g11 - varpi, 2.0 * std::sqrt(g12 * tau0)))};
  const auto before = theorem_bounds(s, varpi, 1);
  if (!before.cond9 || !(b.spectral_radius < 1.0)) return b;
  const double to_p = s.contraction * std::sqrt(honest) * (s.b_w + s.b_v);
  const double to_rho = s.b_w + s.b_v * honest / s.agents;
  double p = constants(s).p0;
  double rho = before.thm1_item2 - p;
  // The limit of the recursion, by Cramer's rule: 1 - G has a positive determinant.
  const double determinant = (1.0 - g11) * (1.0 - varpi) - g12 * tau0;
  const double p_limit = ((1.0 - varpi) * to_p + g12 * to_rho) / determinant;
  const double rho_limit = (tau0 * to_p + (1.0 - g11) * to_rho) / determinant;
  b.asymptotic = std::max(before.thm1_item3, p_limit + rho_limit);
  b.uniform = std::max(before.thm1_item2, p_limit + rho_limit);
  constexpr int kMost = 1'000'000;
  constexpr double kSlack =
      1e-9;  // what is left of the way to the limit when the recursion is no longer followed
  for (int t = 1; t <= kMost; ++t) {
    const bool spreading = t <= spread;
    const double next = to_p + g11 * p + g12 * rho;
    rho = to_rho + (spreading ? s.a : varpi) * rho +
          (spreading ? s.a * std::sqrt(honest) / s.agents : tau0) * p;
    p = next;
    b.uniform = std::max(b.uniform, p + rho);
    if (!spreading && p + rho <= (p_limit + rho_limit) * (1.0 + kSlack) + kSlack * b.uniform) break;
  }
  b.uniform *= 1.0 + 2.0 * kSlack;
  return b;
}

MatrixG theorem5(const Setting& s, double tau0, double varpi) {
  require_network(s);
  require_norm("tau0", tau0);
  require_norm("varpi", varpi);
  const double ag = s.a * s.contraction;
  MatrixG G{2.0 * ag, ag * std::sqrt(static_cast<double>(s.agents - s.attacked)), tau0, varpi, kNaN};
  // A nonnegative 2x2 matrix has real eigenvalues and the larger one is the spectral radius.
  G.spectral_radius = 0.5 * (G.g11 + G.g22 + hypotenuse(G.g11 - G.g22, 2.0 * std::sqrt(G.g12 * G.g21)));
  return G;
}

}  // namespace garrison::saturation
