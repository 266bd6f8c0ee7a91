// SPDX-License-Identifier: Apache-2.0
// The length of a pair of numbers, alike on every machine.
#pragma once

#include <algorithm>
#include <cmath>

namespace garrison {

/// sqrt(x^2 + y^2), where |x| + |y| can be had, by operations that round alike everywhere. std::hypot does
/// not, and asks for a C library of 2022 (GLIBC_2.35) where it is called.
inline double hypotenuse(double x, double y) noexcept {
  const double sum = std::abs(x) + std::abs(y);
  if (sum == 0.0 || !std::isfinite(sum)) return sum;
  const double longer = std::max(std::abs(x), std::abs(y));
  const double ratio = std::min(std::abs(x), std::abs(y)) / longer;
  return longer * std::sqrt(1.0 + ratio * ratio);
}

}  // namespace garrison
