// SPDX-License-Identifier: Apache-2.0
// top_k: what k attackers can add at most. Internal.
#pragma once

#include <algorithm>
#include <functional>
#include <numeric>
#include <span>

namespace garrison::certificate::detail {

/// Sum of the k largest of max(z, 0). Reorders z; does not allocate.
inline double top(std::span<double> z, int k) noexcept {
  if (k <= 0) return 0.0;
  const std::size_t count = std::min(z.size(), static_cast<std::size_t>(k));
  if (count < z.size())
    std::nth_element(z.begin(), z.begin() + static_cast<std::ptrdiff_t>(count), z.end(), std::greater<>());
  double sum = 0.0;
  for (std::size_t j = 0; j < count; ++j) sum += std::max(z[j], 0.0);
  return sum;
}

}  // namespace garrison::certificate::detail
