// SPDX-License-Identifier: Apache-2.0
// What the sensors in range say of a vehicle by themselves, without its past.
#pragma once

#include "garrison/filters/platoon/view.hpp"

namespace garrison::platoon {

/// What sensors not yet proved attacked say of the vehicle (y_{i|j} of (7)).
class Sightings {
 public:
  Sightings(const Shared& shared, const View& view, const VehicleState& s) noexcept;
  /// Whether less than half of them can lie.
  bool certain() const noexcept { return 2 * liars_ < count_; }
  /// S3: their entrywise median; the prediction where nobody says anything.
  Vec<2> middle() const noexcept;
  /// Whether more than half are within `reach` of `centre`, entry by entry: then `middle` is, too. Needs no
  /// sorting.
  bool mostly_near(const Vec<2>& centre, const Bound& reach) const noexcept;

 private:
  Vec<2> prediction_;
  double column_[2][2 * kMostRange + 1];
  int count_ = 0;
  int liars_ = 0;
};

/// Where no median is certain: the middle of what one honest sensor at least leaves possible, when that is
/// known to within q, as a start has to be.
bool take_agreed(const Shared& shared, const View& view, VehicleState& s) noexcept;

}  // namespace garrison::platoon
