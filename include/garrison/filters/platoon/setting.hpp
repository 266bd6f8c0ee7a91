// SPDX-License-Identifier: Apache-2.0
// The numbers that the bounds and thresholds of the platoon rest on. Equation numbers: He, Hashemi,
// Johansson, Automatica 2021.
#pragma once

#include <algorithm>
#include <cmath>

#include "garrison/core/error.hpp"
#include "garrison/core/types.hpp"

namespace garrison::platoon {

/// Sets of a window of 2 L + 1 vehicles are kept in the bits of one word.
inline constexpr int kMostRange = 31;

/// Bounds on a vector of position (m) and velocity (m/s): on its length and on its two entries.
struct Bound {
  double norm = kNaN;
  double position = kNaN;
  double velocity = kNaN;

  template <class V>
  void visit(V& v) {
    v("norm", norm);
    v("position", position);
    v("velocity", velocity);
  }
  bool known() const noexcept { return !std::isnan(norm); }
  Bound operator+(const Bound& o) const noexcept {
    return {norm + o.norm, position + o.position, velocity + o.velocity};
  }
  Bound operator*(double factor) const noexcept {
    return {norm * factor, position * factor, velocity * factor};
  }
  Bound operator+(double all) const noexcept { return *this + Bound{all, all, all}; }
  /// The same, each number made as small as the others allow.
  Bound sharpened() const noexcept {
    const double length = std::min(norm, std::sqrt(position * position + velocity * velocity));
    return {length, std::min(position, length), std::min(velocity, length)};
  }
};

/// What Assumptions 1 and 2 and the observer's tuning say. Units: m, m/s, s.
struct Setting {
  int vehicles = 0;            ///< N >= 2 L + 1, so that somebody hears 2 L others
  int range = 0;               ///< L: vehicles hear those at most L places away, 1..kMostRange
  double period = kNaN;        ///< T > 0, sampling time
  int attacked = 0;            ///< b, 1..L: most absolute sensors attacked
  double eps = kNaN;           ///< ||d_i(t)|| <= eps, >= 0; with an unknown input that is T input more
  double mu = kNaN;            ///< ||n_ii(t)||, ||n_{i-1,i}(t)|| <= mu, >= 0
  double q = kNaN;             ///< ||xhat_i(0) - x_i(0)|| <= q, > 0
  double varpi = 2.0;          ///< 1/varpi is the gain of vehicles outside V_1; in (1, ||A||/(||A||-1))
  double beta = kNaN;          ///< static threshold, or beta_{i,0} of (25), > 0
  bool adaptive = true;        ///< (25); false: beta_i(t) = beta
  double eps_position = kNaN;  ///< bound on the first entry of d_i(t); NaN = eps
  double absolute[2] = {kNaN, kNaN};  ///< bounds on the entries of n_ii(t), position and velocity; NaN = mu
  double relative[2] = {kNaN, kNaN};  ///< of n_{i-1,i}(t)
  double input = kNaN;                ///< |u_i(t)| <= input where it is not known; NaN = it always is

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
    v("eps_position", eps_position);
    v("absolute", absolute);
    v("relative", relative);
    v("input", input);
  }
};

/// ||A|| of A = (1 T; 0 1): T/2 + sqrt(1 + T^2/4), > 1.
inline double norm_A(double period) noexcept { return period / 2.0 + std::sqrt(1.0 + period * period / 4.0); }
inline double norm_A(const Setting& s) noexcept { return norm_A(s.period); }
/// Noise of which mu bounds the length and `entries` (NaN = nothing more is known) the entries.
inline Bound noise(double mu, const double (&entries)[2]) noexcept {
  return Bound{mu, entries[0] <= mu ? entries[0] : mu, entries[1] <= mu ? entries[1] : mu}.sharpened();
}
inline Bound absolute_noise(const Setting& s) noexcept { return noise(s.mu, s.absolute); }
inline Bound relative_noise(const Setting& s) noexcept { return noise(s.mu, s.relative); }
/// Noise of y_{i|j}, `distance` = |i - j| links away.
inline Bound reached_noise(const Setting& s, int distance) noexcept {
  return absolute_noise(s) + relative_noise(s) * distance;
}
/// (8): bound on the noise of a measurement reconstructed over at most L links.
inline double mubar(const Setting& s) noexcept { return reached_noise(s, s.range).norm; }
/// beta_0 of (20) with mubar, as its proof needs (the print has mu): the bound on honest innovations at t
/// = 1.
inline double beta0(const Setting& s) noexcept { return norm_A(s) * s.q + s.eps + mubar(s); }
/// k_{i,0} of (25).
inline double k0(const Setting& s) noexcept { return s.beta / beta0(s); }
/// A bound on the error of A x + (0, T u) from one on that of x: ||A|| alpha + eps of (17)-(19), and entry by
/// entry, which grows by T and not by ||A|| per step, so that a gap of k samples costs k T and not ||A||^k.
inline Bound predicted(const Setting& s, const Bound& alpha) noexcept {
  const double eps_position = std::isnan(s.eps_position) ? s.eps : s.eps_position;
  return Bound{norm_A(s) * alpha.norm + s.eps, alpha.position + s.period * alpha.velocity + eps_position,
               alpha.velocity + s.eps}
      .sharpened();
}
inline double predicted(const Setting& s, double alpha) noexcept { return norm_A(s) * alpha + s.eps; }
/// beta_i(t) from the bound E on the error of the prediction, in print ||A|| alpha_i(t-1) + eps.
inline double threshold(const Setting& s, double E) noexcept {
  return s.adaptive ? k0(s) * (E + mubar(s)) : s.beta;
}
/// 2 L + 1 - b, the sensors in reach that surely are not attacked.
inline int honest(const Setting& s) noexcept { return 2 * s.range + 1 - s.attacked; }

/// Refuses everything that Assumptions 1 and 2 or (13) exclude. A beta outside beta_interval() is no error.
/// @throws InvalidInput
GARRISON_EXPORT void require(const Setting& setting);

}  // namespace garrison::platoon
