// SPDX-License-Identifier: Apache-2.0
// A measured distance as a legal row of a window: linearised, with its remainder as a bias.
#pragma once

#include <optional>

#include "garrison/core/error.hpp"
#include "garrison/core/types.hpp"

namespace garrison::certificate {

/// |x - p| = offset + h'x + remainder: add the row (h, y - offset) with bias `remainder`.
struct RangeRow {
  Vector h;
  double offset;
  double remainder;  ///< bound
};

/// y = |x - p| + v for x in the ball (c0, rho), which must be proved (a prior, not an estimate): assumption
/// (R). Repeat with the smaller ball that comes out: every one holds. None when the ball reaches p. p, c0: n
/// numbers; rho >= 0. @throws InvalidInput
GARRISON_EXPORT std::optional<RangeRow> range_row(const VectorRef& p, const VectorRef& c0, double rho);

}  // namespace garrison::certificate
