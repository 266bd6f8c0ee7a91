// SPDX-License-Identifier: Apache-2.0
// Admissible thresholds and asymptotic bounds of the observer, (20)-(26), in closed form.
#pragma once

#include "garrison/filters/platoon/setting.hpp"

namespace garrison::platoon {

/// (20) at omega in (0, 1). @throws InvalidInput for a bad setting (also below)
GARRISON_EXPORT double beta1_bar(const Setting& setting, double omega);
GARRISON_EXPORT double beta2_bar(const Setting& setting, double omega);
/// (23) at omega: with b >= 1 it is equivalent to 0 < beta1_bar < beta2_bar (Remark 5 says that it is not
/// necessary; docs/filters/platoon.md#e6). False when omega q <= f_1.
GARRISON_EXPORT bool proposition2(const Setting& setting, double omega);
/// (24).
GARRISON_EXPORT double f3(const Setting& setting, double omega);
GARRISON_EXPORT double f4(const Setting& setting, double omega);

struct Interval {
  double lo;  ///< NaN when empty
  double hi;
};
/// All omega with 0 < beta1_bar < beta2_bar (open interval).
GARRISON_EXPORT Interval omega_interval(const Setting& setting);
/// All betas that Theorem 1 admits for some omega (docs/filters/platoon.md#s1-omega). Setting::beta is
/// validated, not used.
GARRISON_EXPORT Interval beta_interval(const Setting& setting);
/// The same for the bound that holds: the safe recursion maps q below q without any detection.
GARRISON_EXPORT Interval beta_interval_safe(const Setting& setting);
/// Limit of the safe recursion with empty sets from q, static or adaptive; NaN when it does not stay below
/// infinity.
GARRISON_EXPORT double safe_limit(const Setting& setting);
/// The beta of beta_interval_safe() with the least safe_limit() under the adaptive threshold.
/// @throws DesignInfeasible when the interval is empty
GARRISON_EXPORT double best_threshold(const Setting& setting);

/// What is known when an asymptotic bound starts to hold.
struct Known {
  int free_in_reach = 0;  ///< |S_{i,1}|
  int proved = 0;         ///< |S^a_i|
  int distance = 1;       ///< |j_i^* - i|
};
/// Theorem 1, (21) and (22). As printed it inherits the faults of (17), and alpha1 freezes kbar at t = 0: the
/// recursion itself has a far smaller limit (safe_limit).
struct StaticBounds {
  double k_star, Q, m, alpha1, alpha2, alpha3;
};
GARRISON_EXPORT StaticBounds theorem1(const Setting& setting, const Known& known);
/// Theorem 2, (26), with 2L+1-b in place of L-b+.. in h_{i,1}, as (D.2) has it.
struct AdaptiveBounds {
  double k0, h1, h2, alpha1, alpha2, alpha3;
};
GARRISON_EXPORT AdaptiveBounds theorem2(const Setting& setting, const Known& known);

}  // namespace garrison::platoon
