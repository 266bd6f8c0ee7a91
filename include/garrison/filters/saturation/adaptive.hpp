// SPDX-License-Identifier: Apache-2.0
// Adaptive saturation level (not in the paper: docs/filters/saturation.md#s-adaptive): beta_t is the known
// bound on honest innovations, so no honest measurement is ever clipped and the asymptotic bound no longer
// depends on eta0.
#pragma once

#include "garrison/filters/saturation/setting.hpp"

namespace garrison::saturation {

/// beta_t from rho_{t-1} and p_{t-1} (rho_0 = eta0, p_0 = 0). Unit of the measurement.
inline double adaptive_threshold(const Setting& setting, double rho, double p) noexcept {
  return innovation_bound(setting, rho, p);
}

/// State of the recursion after a step that used the level `beta`.
struct AdaptiveStep {
  double beta;  ///< beta_t, in force at t
  double rho;   ///< rho_t >= ||mean of xhat_i(t) - x(t)||
  double p;     ///< p_t >= disagreement at t
};

/// Step t from rho_{t-1} and p_{t-1}; `varpi` as in theorem 3, or an upper bound of it. Setting::beta and
/// Setting::lambda0 are not read. The error of every sensor is at most rho_t + p_t.
inline AdaptiveStep adaptive_next(const Setting& setting, double varpi, double rho, double p) noexcept {
  const double beta = adaptive_threshold(setting, rho, p);
  const double attack = setting.attacked * beta / setting.agents;
  return {beta, varpi * rho + honest_offset(setting, p) + attack, disagreement_next(setting, p, beta)};
}

}  // namespace garrison::saturation
