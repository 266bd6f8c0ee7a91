// SPDX-License-Identifier: Apache-2.0
// Which (beta, eta0, L) satisfy condition (9): theorem 2 made exact in closed form,
// docs/filters/saturation.md#s-closed.
#pragma once

#include <functional>
#include <optional>

#include "garrison/filters/saturation/constants.hpp"

namespace garrison::saturation {

/// Supremum over beta of the margin of (9) per unit of eta0 as eta0 -> infinity; > 0 exactly when some
/// (beta, eta0) satisfies (9) for this g under positive noise. -inf when a g >= 1. Reads N, a, lambda0, g, s.
/// @throws InvalidInput
GARRISON_EXPORT double feasibility_margin(const Setting& setting);

/// Fewest rounds considered by minimal_rounds before it reports that none suffice.
inline constexpr int kMostRounds = 1'000'000'000;

/// Smallest L >= 1 with a positive feasibility margin, where L rounds contract the disagreement by
/// contraction(L), a number in 0..1 that does not increase with L. Empty when the margin at contraction 0 is
/// not positive, or no L <= kMostRounds is enough. Setting::contraction is not read.
/// @throws InvalidInput
GARRISON_EXPORT std::optional<int> minimal_rounds(const Setting& setting,
                                                  const std::function<double(int)>& contraction);
/// The same for plain rounds, contraction(L) = gamma^L, 0 <= gamma < 1 of (8).
GARRISON_EXPORT std::optional<int> minimal_rounds(const Setting& setting, double gamma);

/// Supremum of ||A|| for which some (beta, eta0, L) satisfies (9) under positive noise, when lambda0 >= s:
/// N/(N - lambda0 + s); inf when nothing limits ||A|| (s = 0 and lambda0 = N). At least twice as far above 1
/// as the eps in the proof of theorem 2. For lambda0 < s the value is below 1 and not the supremum, which is
/// then 1: a plant with ||A|| < 1 needs no measurement. Reads N, lambda0, s. @throws InvalidInput
GARRISON_EXPORT double normA_max_exact(const Setting& setting);

/// eps in the proof of theorem 2: (9) is feasible for 1 <= ||A|| < 1 + eps. NaN unless lambda0 > s.
/// @throws InvalidInput
GARRISON_EXPORT double eps_paper(const Setting& setting);

/// Condition (11), lambda0 > s, strict beyond rounding (1e-12 N). @throws InvalidInput
GARRISON_EXPORT bool condition11(const Setting& setting);

struct Interval {
  double lo;  ///< NaN when empty
  double hi;  ///< NaN when empty; may be inf
};
/// All beta > 0 that satisfy (9) for the given eta0, g and noise (p0, q0, F all depend on beta; the margin is
/// concave in beta, so they form one interval). lo = 0 stands for an open end. Empty (NaN) when a g >= 1.
/// Setting::beta is not read. @throws InvalidInput
GARRISON_EXPORT Interval beta_interval(const Setting& setting);

}  // namespace garrison::saturation
