// SPDX-License-Identifier: Apache-2.0
// What the sensors in range say of a vehicle by themselves, without its past.
#pragma once

#include "garrison/filters/platoon/view.hpp"

namespace garrison::platoon {

/// S3: the entrywise median of what sensors not yet proved attacked say; the prediction where nobody says
/// anything.
struct Quorum {
  Vec<2> middle;
  bool certain;  ///< less than half of it can lie
};
Quorum quorum(const Shared& shared, const View& view, const VehicleState& s) noexcept;

/// Where no median is certain: the middle of what one honest sensor at least leaves possible, when that is
/// known to within q, as a start has to be.
bool take_agreed(const Shared& shared, const View& view, VehicleState& s) noexcept;

}  // namespace garrison::platoon
