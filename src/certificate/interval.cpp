// SPDX-License-Identifier: Apache-2.0
#include "garrison/certificate/interval.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "require.hpp"

namespace garrison::certificate {

Interval interval(std::span<const double> y, std::span<const double> width, int s,
                  std::span<double> room) noexcept {
  const std::size_t m = y.size();
  if (static_cast<std::size_t>(s) >= m) return {};
  const std::size_t need = m - static_cast<std::size_t>(s);
  const auto low = room.first(m);
  const auto high = room.subspan(m, m);
  for (std::size_t j = 0; j < m; ++j) {
    // Noise at its bound puts x exactly on an end.
    const double half = width[j] + 1e-12 * (width[j] + std::abs(y[j]));
    low[j] = y[j] - half;
    high[j] = y[j] + half;
  }
  std::sort(low.begin(), low.end());
  std::sort(high.begin(), high.end());
  // Intervals that hold x: begun by x, less those that ended before it.
  const auto covered = [&](double x) {
    return static_cast<std::size_t>(std::upper_bound(low.begin(), low.end(), x) - low.begin()) -
               static_cast<std::size_t>(std::lower_bound(high.begin(), high.end(), x) - high.begin()) >=
           need;
  };
  const auto lo = std::find_if(low.begin(), low.end(), covered);
  if (lo == low.end()) return {kNaN, kNaN};
  const auto hi = std::find_if(high.rbegin(), high.rend(), covered);
  return {*lo, *hi};
}

Interval interval(const VectorRef& y, const VectorRef& width, int s) {
  detail::require_least("s", s, 0);
  detail::require_bounds("width", width, y.size());
  std::vector<double> at_hand;
  std::vector<double> widths;
  for (Eigen::Index j = 0; j < y.size(); ++j) {
    if (!(std::abs(y(j)) <= kHuge)) continue;
    at_hand.push_back(y(j));
    widths.push_back(width(j));
  }
  std::vector<double> room(2 * at_hand.size());
  return interval(at_hand, widths, s, room);
}

}  // namespace garrison::certificate
