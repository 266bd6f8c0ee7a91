// SPDX-License-Identifier: Apache-2.0
// The numbers that the bounds and thresholds of the platoon rest on. Equation numbers: He, Hashemi,
// Johansson, Automatica 2021.
#pragma once

#include <cmath>

#include "garrison/core/error.hpp"
#include "garrison/core/types.hpp"

namespace garrison::platoon {

/// Sets of a window of 2 L + 1 vehicles are kept in the bits of one word.
inline constexpr int kMostRange = 31;

/// What Assumptions 1 and 2 and the observer's tuning say. Units: m, m/s, s.
struct Setting {
  int vehicles = 0;      ///< N >= 2 L + 1, so that somebody hears 2 L others
  int range = 0;         ///< L: vehicles hear those at most L places away, 1..kMostRange
  double period = kNaN;  ///< T > 0, sampling time
  int attacked = 0;      ///< b, 1..L: most absolute sensors attacked
  double eps = kNaN;     ///< ||d_i(t)|| <= eps, >= 0
  double mu = kNaN;      ///< ||n_ii(t)||, ||n_{i-1,i}(t)|| <= mu, >= 0
  double q = kNaN;       ///< ||xhat_i(0) - x_i(0)|| <= q, > 0
  double varpi = 2.0;    ///< 1/varpi is the gain of vehicles outside V_1; in (1, ||A||/(||A||-1))
  double beta = kNaN;    ///< static threshold, or beta_{i,0} of (25), > 0
  bool adaptive = true;  ///< (25); false: beta_i(t) = beta

  template <class V>
  void visit(V& v) {
    v.range("vehicles", vehicles, 1, 65535);
    v.range("range", range, 1, kMostRange);
    v("period", period);
    v.range("attacked", attacked, 0, 65535);
    v("eps", eps);
    v("mu", mu);
    v("q", q);
    v("varpi", varpi);
    v("beta", beta);
    v("adaptive", adaptive);
  }
};

/// ||A|| of A = (1 T; 0 1): T/2 + sqrt(1 + T^2/4), > 1.
inline double norm_A(double period) noexcept { return period / 2.0 + std::sqrt(1.0 + period * period / 4.0); }
inline double norm_A(const Setting& s) noexcept { return norm_A(s.period); }
/// (8): bound on the noise of a measurement reconstructed over at most L links.
inline double mubar(const Setting& s) noexcept { return (s.range + 1) * s.mu; }
/// beta_0 of (20) with mubar, as its proof needs (the print has mu): the bound on honest innovations at t
/// = 1.
inline double beta0(const Setting& s) noexcept { return norm_A(s) * s.q + s.eps + mubar(s); }
/// k_{i,0} of (25).
inline double k0(const Setting& s) noexcept { return s.beta / beta0(s); }
/// beta_i(t) from alpha_i(t-1).
inline double threshold(const Setting& s, double alpha) noexcept {
  return s.adaptive ? k0(s) * (norm_A(s) * alpha + s.eps + mubar(s)) : s.beta;
}
/// 2 L + 1 - b, the sensors in reach that surely are not attacked.
inline int honest(const Setting& s) noexcept { return 2 * s.range + 1 - s.attacked; }

/// Refuses everything that Assumptions 1 and 2 or (13) exclude. A beta outside beta_interval() is no error.
/// @throws InvalidInput
GARRISON_EXPORT void require(const Setting& setting);

}  // namespace garrison::platoon
