// SPDX-License-Identifier: Apache-2.0
// Constants (6)-(10) of the saturation filter and the limit of its error recursion (7), in closed form.
#pragma once

#include <cstdint>
#include <vector>

#include "garrison/filters/saturation/setting.hpp"

namespace garrison::saturation {

/// How p0 and q0 depend on beta: p0 = c beta, q0 = Q1 + Q2 beta.
struct Slopes {
  double c;   ///< sqrt(N) g / (1 - a g); NaN when a g >= 1, like Q2
  double Q1;  ///< what the noise adds per step, unit of the state
  double Q2;  ///< ((N-s) a c + s) / N; sharp: (sqrt(N-s) a c + s) / N
};
/// Reads N, a, g, s and, for Q1, the noise bounds (Q1 = NaN when they are NaN).
Slopes slopes(const Setting& setting);

struct Constants {
  double p0;            ///< (8): limit and supremum of p(t), not attained
  double q0;            ///< (8), printed or sharp (Setting::sharp)
  double F_eta0;        ///< F(eta0)
  double cond9_margin;  ///< eta0 (1 - F(eta0)) - q0
  /// (9): margin >= 0 up to 1e-12 relative, because rho_hi and the ends of the beta interval are knife edges.
  bool cond9;
};
/// @throws InvalidInput for a bad setting or a g >= 1 (p0 does not exist)
GARRISON_EXPORT Constants constants(const Setting& setting);

/// 1 + x + ... + x^(t-1) for x >= 0, t >= 0, without cancellation near x = 1; inf where it overflows.
double geometric_sum(double x, std::int64_t t);
/// p(t) of (10), t >= 0. Exists for every a g, also for a g >= 1, where it grows without bound.
/// @throws InvalidInput for a bad setting or t < 0
GARRISON_EXPORT double p_at(const Setting& setting, std::int64_t t);

/// k* of (8) at rho >= 0, with the limit p0. @throws InvalidInput, see constants()
double k_star(const Setting& setting, double rho);
/// F of (8) at rho >= 0, in 0..a. May exceed 1 for large rho if a > 1; (9) makes F <= 1 wherever (7) goes.
/// @throws InvalidInput, see constants()
GARRISON_EXPORT double F(const Setting& setting, double rho);
/// rho_0 .. rho_T of (7), T >= 0. @throws InvalidInput, see constants()
GARRISON_EXPORT std::vector<double> rho_sequence(const Setting& setting, int T);

/// Ends of {r >= 0 : F(r) r + q0 <= r}, an interval because F(r) r is convex
/// (docs/filters/saturation.md#s-closed). (9) says that eta0 lies in it; then lim rho_t = lo, whatever eta0.
struct FixedPoints {
  double lo;  ///< NaN when the set is empty
  double hi;  ///< NaN when the set is empty; inf when there is no upper end (always for a < 1)
};
/// Setting::eta0 is validated but not used. Both NaN also when a g >= 1.
/// @throws InvalidInput for a bad setting
GARRISON_EXPORT FixedPoints fixed_points(const Setting& setting);
/// The same with `q0` in place of (8), as (17) needs after some attackers are proved; a rounding-size
/// negative `q0` counts as 0.
GARRISON_EXPORT FixedPoints fixed_points(const Setting& setting, double q0);

}  // namespace garrison::saturation
