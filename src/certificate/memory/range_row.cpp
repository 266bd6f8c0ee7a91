// SPDX-License-Identifier: Apache-2.0
#include "garrison/certificate/memory/range_row.hpp"

#include "../require.hpp"

namespace garrison::certificate {

std::optional<RangeRow> range_row(const VectorRef& p, const VectorRef& c0, double rho) {
  if (p.size() < 1) refuse("p", "no numbers", "at least one");
  detail::require_shape("p", p, p.size(), 1);
  detail::require_shape("c0", c0, p.size(), 1);
  detail::require_least("rho", rho, 0.0);
  const double d = (c0 - p).norm();
  if (!(d > rho)) return {};
  Vector h = (c0 - p) / d;
  const double offset = d - h.dot(c0);
  return RangeRow{std::move(h), offset, rho * rho / (2.0 * (d - rho))};
}

}  // namespace garrison::certificate
