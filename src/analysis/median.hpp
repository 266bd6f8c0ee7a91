// SPDX-License-Identifier: Apache-2.0
// The middle of numbers. Internal.
#pragma once

#include <algorithm>

namespace garrison::detail {

/// The upper median; reorders the values, of which there is at least one and none is NaN.
template <class Values>
double median(Values& values) {
  const auto middle = values.begin() + values.size() / 2;
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace garrison::detail
