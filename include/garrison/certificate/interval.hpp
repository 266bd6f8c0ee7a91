// SPDX-License-Identifier: Apache-2.0
// Interval rule (W0; Marzullo): where at least m - s of m intervals overlap. One state, bounded noise.
#pragma once

#include <span>

#include "garrison/core/error.hpp"
#include "garrison/core/types.hpp"

namespace garrison::certificate {

/// [lo, hi]. No refutation: (-infinity, infinity) = not enough rows; (NaN, NaN) = more than s attacked.
struct Interval {
  double lo = -kInfinity;
  double hi = kInfinity;
};

/// Hull of the points that lie in at least m - s of the intervals y_j +- width_j (each wider by a guard of
/// 1e-12 (width + |y|) on both sides, which stays in the answer). Contains x when at most s are attacked.
/// y: C_j y_j of the m sensors at hand, NaN = missing and not counted. width: bounds of the noise, >= 0.
/// @throws InvalidInput for sizes that differ, widths < 0 or not finite, s < 0
GARRISON_EXPORT Interval interval(const VectorRef& y, const VectorRef& width, int s);

/// The same without allocating and without a check; y: finite. room: 2 m numbers. O(m log m).
GARRISON_EXPORT Interval interval(std::span<const double> y, std::span<const double> width, int s,
                                  std::span<double> room) noexcept;

}  // namespace garrison::certificate
