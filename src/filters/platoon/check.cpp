// SPDX-License-Identifier: Apache-2.0
// Conditions and bounds of theorems 1, 2 and 4.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "facts.hpp"
#include "garrison/filters/platoon/bounds.hpp"
#include "garrison/filters/platoon/loop.hpp"
#include "garrison/filters/platoon/theorems.hpp"

namespace garrison {
namespace {

/// Where a threshold has to lie, to four digits.
std::string interval(double lo, double hi) {
  std::array<char, 80> buffer{};
  std::snprintf(buffer.data(), buffer.size(), "in (%.4g, %.4g)", lo, hi);
  return buffer.data();
}

}  // namespace

Check Platoon::check(const Params& p, const Model& model, const Network& network) {
  using namespace platoon;
  const Gains g = design(p, model, network);
  const Setting& s = g.setting;
  const double nA = norm_A(s);
  Check c;
  const auto safe = beta_interval_safe(s);
  const auto printed = beta_interval(s);
  c.conditions.push_back(
      {"threshold beta", s.beta, interval(safe.lo, safe.hi), s.beta > safe.lo && s.beta < safe.hi,
       "the error bound contracts without any detection; left out, the best threshold is taken"});
  c.conditions.push_back({"threshold beta, Theorem 1", s.beta, interval(printed.lo, printed.hi),
                          s.beta > printed.lo && s.beta < printed.hi, "as printed, for some omega", false});
  const auto omega = omega_interval(s);
  const double rho = safe_limit(s);
  const double varpi_limit = (s.eps * (s.varpi - 1.0) + s.mu) / (s.varpi - (s.varpi - 1.0) * nA);
  const double worst = std::isnan(rho)
                           ? kNaN
                           : (s.eps * s.varpi + s.mu * s.range + nA * std::max(rho, varpi_limit)) /
                                 (s.varpi - (s.varpi - 1.0) * nA);
  c.quantities = {
      {"||A||", nA, "growth of an error per sample; > 1"},
      {"mubar", mubar(s), "noise of a measurement reconstructed over L links (8)"},
      {"beta", s.beta, "threshold in use"},
      {"beta_0", beta0(s), "bound on honest innovations at t = 1 (20)"},
      {"omega from", omega.lo, "omegas that Theorem 1 admits"},
      {"omega to", omega.hi, "omegas that Theorem 1 admits"},
      {"limit of rho", rho,
       "certified error of vehicles that hear 2L others, t -> infinity, nobody identified"},
      {"limit of lambda", varpi_limit, "of vehicles outside V_1 with a sensor known to be free"},
      {"limit of tau", worst, "of the others outside V_1, source L places away"},
      {"median bound", median_bound(s), "error of the median start (not in the paper), from t = 1 on"},
  };
  if (!g.formation.steers()) return c;
  c.conditions.push_back({"Assumption 4", p.gv, "> T g_s, and T^2 g_s - 2 T g_v > -4/sigma_max",
                          assumption4(s.vehicles, s.period, p.gs, p.gv), "the controlled string is stable"});
  const auto loop = loop_factors(s.vehicles, s.period, p.gs, p.gv);
  const auto four = std::isnan(worst)
                        ? LoopBound{kNaN, kNaN, kNaN, kNaN, kNaN, kNaN}
                        : theorem4(s.vehicles, s.period, p.gs, p.gv, s.eps, std::max(worst, rho));
  c.quantities.insert(c.quantities.end(),
                      {
                          {"rho(P_0)", loop.rho, "spectral radius of the controlled string"},
                          {"xi", loop.xi, "factor of Theorem 4 as printed"},
                          {"l1", loop.l1, "sum of ||P_0^k||, the sharper factor"},
                          {"phi", four.bound_safe, "limsup of (4), Theorem 4 with the corrected eta"},
                          {"phi, sharper", four.bound_sharp, "the same with the sharper factor"},
                          {"spacing error", four.spacing, "limsup |gap - desired gap|"},
                          {"collision margin", p.spacing - four.spacing,
                           "desired gap minus that; > 0: no collision in the long run"},
                      });
  return c;
}

}  // namespace garrison
