// SPDX-License-Identifier: Apache-2.0
// What rounding adds to the bounds of a run. Internal.
#pragma once

namespace garrison::certificate {

/// Times a sum of distances, which is rounded.
inline constexpr double kSums = 1.0 + 1e-13;
/// Part of a state that rounding may change while it ages.
inline constexpr double kAgeingRounding = 1e-12;

}  // namespace garrison::certificate
