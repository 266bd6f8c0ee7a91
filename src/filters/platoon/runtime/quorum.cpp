// SPDX-License-Identifier: Apache-2.0
#include "quorum.hpp"

#include <algorithm>
#include <cmath>

#include "garrison/filters/platoon/bounds.hpp"

namespace garrison::platoon {
namespace {

/// Middle of `count` values (the mean of the two middle ones); reorders them.
double median(double* values, int count) noexcept {
  std::sort(values, values + count);
  return count % 2 == 1 ? values[count / 2] : (values[count / 2 - 1] + values[count / 2]) / 2.0;
}

/// Where truth can be in one entry when at most `liars` of `count` values are further from it than `noise`:
/// between the outermost points that all the others can agree on.
struct Range {
  double lo = kInfinity;
  double hi = -kInfinity;
};
Range agreed(const double* value, const double* noise, int count, int liars) noexcept {
  Range range;
  const auto admitted = [&](double point) {
    int agree = 0;
    for (int j = 0; j < count; ++j)
      agree += std::abs(value[j] - point) <= noise[j] * (1.0 + kGuard) + kGuard * std::abs(point) ? 1 : 0;
    return agree >= count - liars;
  };
  for (int j = 0; j < count; ++j) {
    const double ends[2] = {value[j] - noise[j], value[j] + noise[j]};
    if (admitted(ends[0])) range.lo = std::min(range.lo, ends[0]);
    if (admitted(ends[1])) range.hi = std::max(range.hi, ends[1]);
  }
  return range;
}

}  // namespace

Sightings::Sightings(const Shared& shared, const View& view, const VehicleState& s) noexcept
    : prediction_(s.prediction) {
  for (int p = 0; p < view.size(); ++p) {
    if (!view[p].measured || s.sets.attacked.contains(view.id_of(p))) continue;
    for (int k = 0; k < 2; ++k) column_[k][count_] = view[p].y[k];
    ++count_;
  }
  liars_ = std::max(0, shared.setting.attacked - s.sets.attacked.count());
}

bool Sightings::mostly_near(const Vec<2>& centre, const Bound& reach) const noexcept {
  const double most[2] = {reach.position, reach.velocity};
  for (int k = 0; k < 2; ++k) {
    int near = 0;
    for (int j = 0; j < count_; ++j) near += std::abs(column_[k][j] - centre[k]) <= most[k] ? 1 : 0;
    if (near <= count_ / 2) return false;
  }
  return true;
}

Vec<2> Sightings::middle() const noexcept {
  if (count_ == 0) return prediction_;
  double copy[2][2 * kMostRange + 1];
  for (int k = 0; k < 2; ++k) std::copy_n(column_[k], count_, copy[k]);
  return {median(copy[0], count_), median(copy[1], count_)};
}

bool take_agreed(const Shared& shared, const View& view, VehicleState& s) noexcept {
  const Setting& g = shared.setting;
  double value[2][2 * kMostRange + 1];
  double noise[2][2 * kMostRange + 1];
  int count = 0;
  for (int p = 0; p < view.size(); ++p) {
    if (!view[p].measured || s.sets.attacked.contains(view.id_of(p))) continue;
    const Bound reached = reached_noise(g, std::abs(p - g.range));
    for (int k = 0; k < 2; ++k) value[k][count] = view[p].y[k];
    noise[0][count] = reached.position;
    noise[1][count++] = reached.velocity;
  }
  const int liars = std::max(0, g.attacked - s.sets.attacked.count());
  if (count <= liars) return false;
  double middle[2];
  double half[2];
  for (int k = 0; k < 2; ++k) {
    const Range range = agreed(value[k], noise[k], count, liars);
    if (!(range.lo <= range.hi)) return false;
    middle[k] = (range.lo + range.hi) / 2.0;
    half[k] = (range.hi - range.lo) / 2.0;
  }
  if (!(length(half) <= g.q)) return false;
  s.x = {middle[0], middle[1]};
  s.alpha = {length(half), half[0], half[1]};
  return true;
}

}  // namespace garrison::platoon
