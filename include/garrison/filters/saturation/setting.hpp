// SPDX-License-Identifier: Apache-2.0
// The numbers that the bounds of the saturation filter rest on, and the three formulas that the analysis
// and the run-time filter share. Equation numbers: He, Ren, Sandberg, Johansson, IEEE TAC 2022.
#pragma once

#include <algorithm>
#include <cmath>

#include "garrison/core/error.hpp"
#include "garrison/core/types.hpp"

namespace garrison::saturation {

/// Plant, network and tuning, reduced to what the theorems need. All sensors have rows of unit length and
/// start from the same estimate (Lemma 2 and the detector fail otherwise: docs/filters/saturation.md#s1).
struct Setting {
  int agents = 0;             ///< N >= 1
  double a = kNaN;            ///< ||A||, spectral norm, >= 0
  double lambda0 = kNaN;      ///< (6) or a certified lower bound of it (safe in every theorem), 0..N-s
  double contraction = kNaN;  ///< g, 0..1: gamma^L, or the factor of Chebyshev-filtered rounds
  int attacked = 0;           ///< s, 0..N: most sensors attacked at a time
  double beta = kNaN;         ///< saturation level, > 0, unit of the measurement
  double eta0 = kNaN;         ///< ||xhat(0) - x(0)|| <= eta0, > 0, unit of the state
  double b_w = kNaN;          ///< ||w(t)|| <= b_w, >= 0
  double b_v = kNaN;          ///< |v_i(t)| <= b_v for all i, >= 0
  /// q0 with sqrt(N-s)/N a p0 in place of (N-s)/N a p0 (p(t) bounds the stacked vector: Cauchy-Schwarz) and
  /// without the b_w that (24) counts twice (docs/filters/saturation.md#s6). Sound and smaller; false = as
  /// printed in (8).
  bool sharp = false;

  template <class V>
  void visit(V& v) {
    v("agents", agents);
    v("a", a);
    v("lambda0", lambda0);
    v("contraction", contraction);
    v("attacked", attacked);
    v("beta", beta);
    v("eta0", eta0);
    v("b_w", b_w);
    v("b_v", b_v);
    v("sharp", sharp);
  }
};

/// Refuses N, lambda0, s out of range. @throws InvalidInput
void require_sensors(const Setting& setting);
/// The same and a, g. @throws InvalidInput
void require_network(const Setting& setting);
/// Refuses eta0 <= 0, negative b_w or b_v, and numbers that are not finite. @throws InvalidInput
void require_start_and_noise(const Setting& setting);
/// Refuses a beta that is not finite and > 0 (beta = inf never saturates and has no bound). @throws
/// InvalidInput
void require_threshold(const Setting& setting);
/// All of the above.
GARRISON_EXPORT void require(const Setting& setting);

/// a g < 1, the paper's L > ln||A|| / ln(1/gamma) in the form that has no logarithm of 0.
inline bool contracts(const Setting& setting) noexcept { return setting.a * setting.contraction < 1.0; }
/// Refuses a g >= 1, where p0 and everything built on it does not exist. @throws InvalidInput
void require_contraction(const Setting& setting);

/// Bound on the innovation of an honest sensor when the mean error is at most `rho` and the disagreement at
/// most `p`, both at t-1: a (rho + p) + b_w + b_v. Unit of the measurement.
inline double innovation_bound(const Setting& setting, double rho, double p) noexcept {
  return setting.a * (rho + p) + setting.b_w + setting.b_v;
}

/// k* of (8) and (14): the least gain (4) of an honest sensor at that innovation, 0..1.
inline double least_gain(const Setting& setting, double rho, double p) noexcept {
  const double bound = innovation_bound(setting, rho, p);
  return bound <= setting.beta ? 1.0 : setting.beta / bound;
}

/// p(t) of (10) from p(t-1): the disagreement ||Ebar(t)|| after a step with saturation level `beta`.
inline double disagreement_next(const Setting& setting, double p, double beta) noexcept {
  return setting.contraction * (setting.a * p + std::sqrt(static_cast<double>(setting.agents)) * beta);
}

/// Sum of what honest sensors add to the mean error through disagreement `p` and noise, the q0 of (8) without
/// s beta / N. Printed or sharp, see Setting::sharp.
inline double honest_offset(const Setting& setting, double p) noexcept {
  const double N = setting.agents;
  const double honest = setting.agents - setting.attacked;
  if (setting.sharp) return (honest * setting.b_v + std::sqrt(honest) * setting.a * p) / N + setting.b_w;
  return honest / N * (setting.b_w + setting.b_v + setting.a * p) + setting.b_w;
}

}  // namespace garrison::saturation
