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

/// What rounding can add to an error in one sample in which numbers of this size were added: some dozens of
/// units in the last place, for the vehicles and sensors as well as for the filter.
inline double rounding(double size) noexcept { return 1e-14 * size; }

/// kbar of (17): the least gain (14) of an honest sensor. `E`: bound on ||xbar_i - x_i||, here and below.
inline double least_gain(const Setting& s, double beta, double E) noexcept {
  const double most = E + mubar(s);
  return most <= beta ? 1.0 : beta / most;
}

/// (17) as printed (with kbar in place of k_i(t)), from alpha_i(t-1). FALSE in general: it multiplies the
/// process noise by the wrong factor (N = 5, L = 2, b = 2, T = .01, q = 300, eps = .1, mu =
/// .001, beta = 30 has an error of 294.0992 under a "bound" of 294.0887) and counts too few sensors once more
/// than 2L+1-b are free (it then falls below 0). Kept for comparison; never reported as a bound.
inline double printed_bound(const Setting& s, double beta, double alpha, const Window& w) noexcept {
  const double two_L = 2.0 * s.range;
  const double k = least_gain(s, beta, predicted(s, alpha));
  const double m = 1.0 - (w.free_in_reach + (honest(s) - w.free_in_reach) * k) / two_L;
  return m * norm_A(s) * alpha + ((s.eps + mubar(s)) * honest(s) + (s.attacked - w.proved) * beta) / two_L;
}

/// The valid replacement. e = (1 - K/2L)(A e^- - d) + noise and saturated rest, with
/// the gains of the honest sensors summing to K in [lo, hi]. Gains are numbers, so that it holds for entries.
/// Threads: one at a time.
class SafeStep {
 public:
  SafeStep(const Setting& s, double beta, double E, const Window& w) noexcept {
    const double two_L = 2.0 * s.range;
    const int liars = std::max(0, std::min(w.undecided, s.attacked - w.proved));  // c
    const double lo = w.free + (w.undecided - liars) * least_gain(s, beta, E);
    const double hi = w.free + w.undecided - liars;
    kept_ = std::max(std::abs(1.0 - lo / two_L), std::abs(1.0 - hi / two_L));
    used_ = hi / two_L;
    lies_ = liars * beta / two_L;
  }
  double operator()(double E, double noise) const noexcept { return kept_ * E + used_ * noise + lies_; }
  Bound operator()(const Bound& E, const Bound& noise) const noexcept {
    return {(*this)(E.norm, noise.norm), (*this)(E.position, noise.position),
            (*this)(E.velocity, noise.velocity)};
  }

 private:
  double kept_;  // of the prediction's error
  double used_;  // of the noise
  double lies_;
};
inline double safe_bound(const Setting& s, double beta, double E, const Window& w) noexcept {
  return SafeStep(s, beta, E, w)(E, mubar(s));
}

/// The same with the noise of each reconstructed measurement, and the maximum over the vertices of the gains
/// (the bound is convex in them). `free_noise`: sum of it over the free sensors; `noise`: that of the
/// undecided ones, w.undecided numbers in falling order.
inline double tight_bound(const Setting& s, double beta, double E, const Window& w, double free_noise,
                          const double* noise) noexcept {
  const double two_L = 2.0 * s.range;
  const int liars = std::max(0, std::min(w.undecided, s.attacked - w.proved));
  const int used = w.undecided - liars;
  const double k = least_gain(s, beta, E);
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

/// (18) and (19): a vehicle outside V_1 that moves its prediction by 1/varpi towards what is off by at most
/// `other`: its own measurement when that is free, or the prediction of vehicle j, bounded as j sent it (6),
/// plus the noise of the links between them. Behind a gap it goes all the way (varpi = 1).
inline Bound moved(const Bound& E, double varpi, const Bound& other) noexcept {
  if (varpi == 1.0) return other;  // nothing is known of E
  return E * ((varpi - 1.0) / varpi) + other * (1.0 / varpi);
}

/// Error of the entrywise median of the y_{i|j} (S3): while at most half of them less one lie, every entry
/// lies between honest ones, which are within the noise over L links.
inline Bound median_error(const Setting& s) noexcept {
  const Bound noise = reached_noise(s, s.range);
  return {std::sqrt(noise.position * noise.position + noise.velocity * noise.velocity), noise.position,
          noise.velocity};
}
inline double median_bound(const Setting& s) noexcept { return median_error(s).norm; }

}  // namespace garrison::platoon
