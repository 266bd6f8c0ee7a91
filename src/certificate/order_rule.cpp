// SPDX-License-Identifier: Apache-2.0
#include "garrison/certificate/order_rule.hpp"

#include <algorithm>
#include <cmath>

#include "require.hpp"

namespace garrison::certificate {

double order_rule(std::span<double> values, int f) noexcept {
  for (double& value : values)
    if (std::isnan(value)) value = kInfinity;
  if (f < 0 || static_cast<std::size_t>(f) >= values.size()) return kInfinity;
  std::nth_element(values.begin(), values.begin() + f, values.end());
  return values[static_cast<std::size_t>(f)];
}

double order_rule(const VectorRef& values, int f) {
  detail::require_least("f", f, 0);
  Vector room = values;
  return order_rule(std::span(room.data(), static_cast<std::size_t>(room.size())), f);
}

double order_bound(const VectorRef& r, const VectorRef& width, int s) {
  detail::require_least("s", s, 0);
  detail::require_bounds("width", width, r.size());
  Vector room = r.cwiseAbs() + width;
  return order_rule(std::span(room.data(), static_cast<std::size_t>(room.size())), s);
}

}  // namespace garrison::certificate
