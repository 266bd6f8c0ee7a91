// SPDX-License-Identifier: Apache-2.0
// Best saturation level, and number of rounds, for the certified asymptotic bound of theorem 1.
#pragma once

#include <functional>

#include "garrison/filters/saturation/feasibility.hpp"

namespace garrison::saturation {

/// A saturation level with the bound it certifies.
struct Threshold {
  double beta;   ///< minimises lim rho_t + p0
  double bound;  ///< that minimum: limsup ||xhat_i(t) - x(t)|| <= bound, unit of the state
  double
      eta0;  ///< initial error bound to run with: the given one, or the lower fixed point when that is larger
  Interval admissible;  ///< beta_interval at the given eta0 (NaN when only a larger eta0 is feasible)
};

/// Distance kept from the edge where (9) becomes an equality.
inline constexpr double kEdgeMargin = 1e-6;

/// Minimises J(beta) = lim rho_t + p0 over all beta for which (7) has fixed points and eta0 <= rho_hi (an
/// eta0 below rho_lo may be enlarged). The admissible betas have no upper end and J is quasiconvex, so the
/// minimum is global; it is usually the lower end of the admissible set, where (9) is an equality, and
/// interior only for small eta0. `margin` >= 0: beta is at least (1 + margin) times that end. Setting::beta
/// is not read.
/// @throws DesignInfeasible when no beta is admissible, or when the bound only falls as beta -> 0 (a < 1, or
/// a = 1 without noise: there is no minimum); the message has the reason and the number
/// @throws InvalidInput for a bad setting
GARRISON_EXPORT Threshold best_threshold(const Setting& setting, double margin = kEdgeMargin);

/// Rounds and saturation level designed together.
struct Design {
  int rounds;          ///< L
  double contraction;  ///< contraction(L), to put into the Setting
  Threshold threshold;
  int fewest_rounds;  ///< smallest L for which any (beta, eta0) satisfies (9), also if outside the range
};

/// More rounds never raise the certified bound, so the best L of `least`..`most` is `most` up to rounding: of
/// all L whose bound is at most (1 + `slack`) times the best of the range, the smallest is returned (slack
/// 0.01 often halves the traffic). Where no threshold is best, because a < 1 and the bound only falls as beta
/// -> 0, to a limit > 0: one whose bound is within 1e-6 of it. `contraction`: see minimal_rounds.
/// Setting::beta and Setting::contraction are not read.
/// @throws DesignInfeasible as best_threshold (without such a limit), also when `most` rounds are too few
/// @throws InvalidInput for a bad setting, 1 <= least <= most violated, slack < 0
GARRISON_EXPORT Design design_rounds_and_threshold(const Setting& setting,
                                                   const std::function<double(int)>& contraction, int least,
                                                   int most, double slack = 1e-9,
                                                   double margin = kEdgeMargin);

}  // namespace garrison::saturation
