// SPDX-License-Identifier: Apache-2.0
// End-point scan (W1): the union of all honest sets' intervals, relaxed, for one state and Gaussian noise.
#pragma once

#include "garrison/certificate/interval.hpp"

namespace garrison::certificate {

/// Interval of x - xhat with probability >= 1 - (failure of z1 for m rows) - (failure of z2): the x that at
/// least m - s sensors explain within z1 sigma and whose weighted residual sum stays above -z2 sqrt(sum 1/R),
/// and the same from the other side. Any s; O(m^2 log m). r: C_j (y_j - C_j xhat) with C_j = +-1, NaN =
/// missing and not counted; R: variances > 0; z1, z2 >= 0. NaN = more than s attacked (or the rare event),
/// infinite = not enough rows.
/// @throws InvalidInput for sizes that differ or values out of range
GARRISON_EXPORT Interval scan(const VectorRef& r, const VectorRef& R, int s, double z1, double z2);

}  // namespace garrison::certificate
