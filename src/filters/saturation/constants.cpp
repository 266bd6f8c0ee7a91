// SPDX-License-Identifier: Apache-2.0
#include "garrison/filters/saturation/constants.hpp"

#include <cmath>
#include <string>

namespace garrison::saturation {
namespace {

double F_at(const Setting& s, double p0, double rho) {
  return s.a * (1.0 - least_gain(s, rho, p0) * s.lambda0 / s.agents);
}

double q0_at(const Setting& s, double p0) { return honest_offset(s, p0) + s.attacked * s.beta / s.agents; }

double existing_p0(const Setting& s) {
  require(s);
  require_contraction(s);
  return slopes(s).c * s.beta;
}

double require_rho(double rho) {
  if (!(rho >= 0.0)) refuse("rho", text(rho), "a number >= 0", "it bounds a norm");
  return rho;
}

}  // namespace

Slopes slopes(const Setting& s) {
  const double N = s.agents;
  const double honest = s.agents - s.attacked;
  const double c = contracts(s) ? std::sqrt(N) * s.contraction / (1.0 - s.a * s.contraction) : kNaN;
  const double weight = s.sharp ? std::sqrt(honest) : honest;
  return {c, honest_offset(s, 0.0), (weight * s.a * c + s.attacked) / N};
}

Constants constants(const Setting& s) {
  Constants k{};
  k.p0 = existing_p0(s);
  k.q0 = q0_at(s, k.p0);
  k.F_eta0 = F_at(s, k.p0, s.eta0);
  k.cond9_margin = s.eta0 * (1.0 - k.F_eta0) - k.q0;
  k.cond9 = std::isfinite(k.cond9_margin) && k.cond9_margin >= -1e-12 * (s.eta0 * (1.0 + k.F_eta0) + k.q0);
  return k;
}

double geometric_sum(double x, std::int64_t t) {
  if (t <= 0) return 0.0;
  if (x == 1.0) return static_cast<double>(t);
  // x - 1 is exact near 1, and log1p, expm1 keep its relative accuracy.
  return std::expm1(static_cast<double>(t) * std::log1p(x - 1.0)) / (x - 1.0);
}

double p_at(const Setting& s, std::int64_t t) {
  require(s);
  if (t < 0) refuse("t", std::to_string(t), "a whole number >= 0");
  const double g = s.contraction;
  return g == 0.0 ? 0.0 : std::sqrt(static_cast<double>(s.agents)) * s.beta * g * geometric_sum(s.a * g, t);
}

double k_star(const Setting& s, double rho) { return least_gain(s, require_rho(rho), existing_p0(s)); }

double F(const Setting& s, double rho) { return F_at(s, existing_p0(s), require_rho(rho)); }

std::vector<double> rho_sequence(const Setting& s, int T) {
  if (T < 0) refuse("T", std::to_string(T), "a whole number >= 0");
  const double p0 = existing_p0(s);
  const double q0 = q0_at(s, p0);
  std::vector<double> rho{s.eta0};
  rho.reserve(static_cast<std::size_t>(T) + 1);
  for (int t = 0; t < T; ++t) rho.push_back(F_at(s, p0, rho.back()) * rho.back() + q0);
  return rho;
}

}  // namespace garrison::saturation
