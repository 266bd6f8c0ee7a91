// SPDX-License-Identifier: Apache-2.0
// Bounds on ||xhat_i(t) - x_i(t)||, one step at a time: (17)-(19) and what replaces (17).
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "garrison/filters/platoon/setting.hpp"

namespace garrison::platoon {

/// (14): share of an innovation of length `norm` that is used.
inline double gain(double beta, double norm, bool attacked, bool free) noexcept {
  if (attacked) return 0.0;
  return free || norm <= beta ? 1.0 : beta / norm;
}

/// What a vehicle of V_1 knows when it updates. Counts are of its window {i-L..i+L}; a sensor whose
/// measurement did not arrive has gain 0 and counts nowhere.
struct Window {
  int free = 0;           ///< f: measurements of sensors known to be free
  int undecided = 0;      ///< und: measurements of sensors that are neither free nor proved attacked
  int proved = 0;         ///< |S^a_i|: all sensors proved attacked, in the window or not
  int free_in_reach = 0;  ///< |S_{i,1}| of (16), arrived or not (printed bound only)
};

/// kbar of (17): the least gain (14) of an honest sensor. `alpha` = alpha_i(t-1).
inline double least_gain(const Setting& s, double beta, double alpha) noexcept {
  const double most = norm_A(s) * alpha + s.eps + mubar(s);
  return most <= beta ? 1.0 : beta / most;
}

/// (17) as printed (with kbar in place of k_i(t)). FALSE in general: it multiplies the process noise by the
/// wrong factor (our notes, E1: N = 5, L = 2, b = 2, T = .01, q = 300, eps = .1, mu = .001, beta = 30 has an
/// error of 294.0992 under a "bound" of 294.0887) and counts too few sensors once more than 2L+1-b are free
/// (E2: it then falls below 0). Kept for comparison; never reported as a bound.
inline double printed_bound(const Setting& s, double beta, double alpha, const Window& w) noexcept {
  const double two_L = 2.0 * s.range;
  const double k = least_gain(s, beta, alpha);
  const double m = 1.0 - (w.free_in_reach + (honest(s) - w.free_in_reach) * k) / two_L;
  return m * norm_A(s) * alpha + ((s.eps + mubar(s)) * honest(s) + (s.attacked - w.proved) * beta) / two_L;
}

/// The valid replacement (our notes, section 1). e = (1 - K/2L)(A e^- - d) + noise and saturated rest, with
/// the gains of the honest sensors summing to K in [lo, hi].
inline double safe_bound(const Setting& s, double beta, double alpha, const Window& w) noexcept {
  const double two_L = 2.0 * s.range;
  const int liars = std::max(0, std::min(w.undecided, s.attacked - w.proved));  // c
  const double lo = w.free + (w.undecided - liars) * least_gain(s, beta, alpha);
  const double hi = w.free + w.undecided - liars;
  const double m = std::max(std::abs(1.0 - lo / two_L), std::abs(1.0 - hi / two_L));
  return m * (norm_A(s) * alpha + s.eps) + (hi * mubar(s) + liars * beta) / two_L;
}

/// The same with the noise of each reconstructed measurement, (|i-j|+1) mu, and the maximum over the vertices
/// of the gains (the bound is convex in them). `free_noise`: sum of it over the free sensors; `noise`: that
/// of the undecided ones, w.undecided numbers in falling order.
inline double tight_bound(const Setting& s, double beta, double alpha, const Window& w, double free_noise,
                          const double* noise) noexcept {
  const double two_L = 2.0 * s.range;
  const int liars = std::max(0, std::min(w.undecided, s.attacked - w.proved));
  const int used = w.undecided - liars;
  const double k = least_gain(s, beta, alpha);
  const double E = norm_A(s) * alpha + s.eps;
  double rest = 0.0;  // noise of those at the least gain
  for (int j = 0; j < used; ++j) rest += noise[j];
  double full = 0.0;
  double worst = 0.0;
  for (int o = 0; o <= used; ++o) {
    const double K = w.free + o + (used - o) * k;
    worst = std::max(worst, std::abs(1.0 - K / two_L) * E + (free_noise + full + k * rest) / two_L);
    if (o == used) break;
    full += noise[o];
    rest -= noise[o];
  }
  return worst + liars * beta / two_L;
}

/// (18): a free vehicle outside V_1, which uses its own measurement.
inline double free_bound(const Setting& s, double alpha) noexcept {
  return (s.varpi - 1.0) * norm_A(s) * alpha / s.varpi + (s.eps * (s.varpi - 1.0) + s.mu) / s.varpi;
}

/// (19): any other vehicle outside V_1, which uses the prediction of vehicle j at `distance`; `alpha_j` is
/// the bound of t-1 that j sent in (6).
inline double borrowed_bound(const Setting& s, double alpha, double alpha_j, int distance) noexcept {
  return (s.varpi - 1.0) * norm_A(s) * alpha / s.varpi +
         (s.eps * s.varpi + s.mu * distance + norm_A(s) * alpha_j) / s.varpi;
}

/// (19) of a vehicle behind a gap, which takes that prediction as it is.
inline double anew_bound(const Setting& s, double alpha_j, int distance) noexcept {
  return s.eps + s.mu * distance + norm_A(s) * alpha_j;
}

/// A vehicle that nothing arrived for: the prediction alone.
inline double predicted_bound(const Setting& s, double alpha) noexcept { return norm_A(s) * alpha + s.eps; }

/// Error of the componentwise median of the y_{i|j} (S3): while at most half of them less one lie,
/// every component lies between honest ones, which are within (L+1) mu.
inline double median_bound(const Setting& s) noexcept { return std::sqrt(2.0) * mubar(s); }

}  // namespace garrison::platoon
