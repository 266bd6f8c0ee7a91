// SPDX-License-Identifier: Apache-2.0
#include "garrison/certificate/memory/cells.hpp"

#include <algorithm>
#include <cmath>

#include "../require.hpp"
#include "garrison/certificate/order_rule.hpp"

namespace garrison::certificate {
namespace {

/// Number of states; regions with an answer must agree on it.
Eigen::Index require_regions(std::span<const Region> regions) {
  if (regions.empty()) refuse("regions", "none", "at least one");
  Eigen::Index n = 0;
  for (const Region& region : regions) {
    if (!region.answered()) continue;
    if (n == 0) n = region.center.size();
    detail::require_shape("center", region.center, n, 1);
    detail::require_least("radius", region.radius, 0.0);
    if (region.box.size() > 0) detail::require_bounds("box", region.box, n);
  }
  if (n == 0) refuse("regions", "none with an answer", "at least one", "there is nothing to combine");
  return n;
}

double half_width(const Region& region, Eigen::Index i) {
  return region.box.size() > 0 ? std::min(region.box(i), region.radius) : region.radius;
}

}  // namespace

Box cells(std::span<const Region> regions, int s) {
  const Eigen::Index n = require_regions(regions);
  detail::require_least("s", s, 0);
  Box hull{Vector(n), Vector(n)};
  std::vector<double> y;
  std::vector<double> width;
  for (Eigen::Index i = 0; i < n; ++i) {
    y.clear();
    width.clear();
    int wrong = s;  // budget that refuted regions leave
    for (const Region& region : regions) {
      if (region.refuted()) {
        --wrong;
      } else if (region.answered()) {
        y.push_back(region.center(i));
        width.push_back(half_width(region, i));
      }
    }
    // A cell without limits holds every point: it neither helps nor uses up s.
    std::vector<double> room(2 * y.size());
    const Interval found = wrong < 0 ? Interval{kNaN, kNaN} : interval(y, width, wrong, room);
    hull.lo(i) = found.lo;
    hull.hi(i) = found.hi;
  }
  return hull;
}

Region intersection(std::span<const Region> regions) {
  for (const Region& region : regions)
    if (region.refuted()) return {{}, kNaN, {}};
  const Eigen::Index n = require_regions(regions);
  Vector lo = Vector::Constant(n, -kInfinity);
  Vector hi = Vector::Constant(n, kInfinity);
  for (const Region& region : regions) {
    if (!region.answered()) continue;
    for (Eigen::Index i = 0; i < n; ++i) {
      const double half = half_width(region, i);
      const double guard = 1e-12 * (half + std::abs(region.center(i)));
      lo(i) = std::max(lo(i), region.center(i) - half - guard);
      hi(i) = std::min(hi(i), region.center(i) + half + guard);
    }
  }
  Region both;
  both.center = 0.5 * (lo + hi);
  both.box = 0.5 * (hi - lo);
  both.radius = both.box.minCoeff() < 0.0 ? kNaN : both.box.norm();
  return both;
}

Vector order_rule(std::span<const Region> regions, const VectorRef& estimate, int f) {
  const Eigen::Index n = require_regions(regions);
  detail::require_shape("estimate", estimate, n, 1);
  detail::require_least("f", f, 0);
  Vector bound(n);
  std::vector<double> values(regions.size());
  for (Eigen::Index i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < regions.size(); ++k)
      values[k] = regions[k].answered()
                      ? std::abs(estimate(i) - regions[k].center(i)) + half_width(regions[k], i)
                      : kInfinity;
    bound(i) = order_rule(std::span<double>(values), f);
  }
  return bound;
}

}  // namespace garrison::certificate
