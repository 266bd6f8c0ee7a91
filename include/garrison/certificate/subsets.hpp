// SPDX-License-Identifier: Apache-2.0
// Subset witness (W3): the union over all sets that may be the honest ones. Sharper than W2, and as long as
// few sets exist: C(sources at hand, s).
#pragma once

#include "garrison/certificate/leverage_ball.hpp"

namespace garrison::certificate {

/// How many sets are tried at most: a few milliseconds.
inline constexpr int kMostSubsets = 5000;

/// Theorem W3, Gaussian noise. Every set of (sources at hand - s) sources whose least-squares state explains
/// its own rows is consistent; the region encloses their ellipsoids. A source in no consistent set is proved
/// attacked. Fails with probability <= rows Q(z1) + delta(z2) + delta(z3); with sources at hand >= 2 s no
/// honest source is reported as proved except with probability rows Q(z1) + 2 delta(z2) + 2 delta(z3). `z3`:
/// chi(delta3, rows - n) for the rows of such a set, also tests the whole residual (only where the law of the
/// noise is known); NaN = not used. `limit`: on the number of sets, beyond it radius = infinity.
/// Assumption::prior and ::bounded are refused: this witness does not use them. With `proved`, the attacked
/// set must never change. O(sets (rows n^2 + n^3)).
/// @throws InvalidInput as leverage_ball, and for z3 < 0 or infinite, limit < 1
GARRISON_EXPORT Witness witness_subsets(const Rows& rows, const Assumption& a, double z3 = kNaN,
                                        int limit = kMostSubsets);

}  // namespace garrison::certificate
