// SPDX-License-Identifier: Apache-2.0
// Derivatives by central differences: the step of one variable.
#pragma once

#include <algorithm>
#include <cmath>

namespace garrison {

/// The cube root of the precision times max(1, |x|): what the step neglects is then about what rounding adds.
inline double difference_step(double x) { return std::cbrt(0x1p-52) * std::max(1.0, std::abs(x)); }

}  // namespace garrison
