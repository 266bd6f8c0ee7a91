// SPDX-License-Identifier: Apache-2.0
// Order rule: of several upper bounds on one number, some wrong, the (f+1)-th smallest holds.
#pragma once

#include <span>

#include "garrison/core/error.hpp"
#include "garrison/core/types.hpp"

namespace garrison::certificate {

/// At most f of the given upper bounds on the same number are wrong: the (f+1)-th smallest is right; infinity
/// with f or fewer of them. A bound that is NaN says nothing and counts as infinity. Relays: `values` are
/// bound_around() of the regions of distinct senders, at most f of which lie. f >= 0. @throws InvalidInput
GARRISON_EXPORT double order_rule(const VectorRef& values, int f);

/// The same in place, without allocating and without a check: `values` are reordered. O(size).
GARRISON_EXPORT double order_rule(std::span<double> values, int f) noexcept;

/// W0: residuals r_j = C_j (y_j - C_j xhat) of sensors with C_j = +-1 and one state, |v_j| <= width_j for the
/// honest, at most s attacked: |xhat - x| <= (s+1)-th smallest |r_j| + width_j; infinity with s or fewer.
/// @throws InvalidInput for sizes that differ, widths < 0 or not finite, s < 0; NaN in r = missing
GARRISON_EXPORT double order_bound(const VectorRef& r, const VectorRef& width, int s);

}  // namespace garrison::certificate
