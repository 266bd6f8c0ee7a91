// SPDX-License-Identifier: Apache-2.0
// One step of the detector's bound (14) and its threshold (15), called by every agent at every sample.
#pragma once

#include "garrison/filters/saturation/setting.hpp"

namespace garrison::saturation {

/// phi_i(t) of (15) from rhobar_{t-1,i} and p(t-1): no honest sensor that still tests has a larger innovation
/// (compare with a rounding guard; for n = 1 the bound is attained). Unit of the measurement.
inline double detection_threshold(const Setting& setting, double rho_bar, double p) noexcept {
  return innovation_bound(setting, rho_bar, p);
}

/// rhobar_{t,i} of (14) from rhobar_{t-1,i} and p(t-1). `q0` is the constant of (8), which keeps the limit
/// p0; only k* uses p(t-1), as printed. `d`: sensors proved attacked, d_i(t-1) as printed or d_i(t), which is
/// sharper and as sound because a proved sensor is silent already in the step of its proof
/// (docs/filters/saturation.md#s7).
inline double rho_bar_next(const Setting& setting, double q0, double rho_bar, double p_prev, int d) noexcept {
  const double N = setting.agents;
  const double F = setting.a * (1.0 - least_gain(setting, rho_bar, p_prev) * setting.lambda0 / N);
  return F * rho_bar + q0 - d * setting.beta / N;
}

}  // namespace garrison::saturation
