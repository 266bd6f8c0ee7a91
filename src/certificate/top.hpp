// SPDX-License-Identifier: Apache-2.0
// top_k: what k attackers can add at most. Internal.
#pragma once

#include <algorithm>
#include <functional>
#include <numeric>
#include <span>

namespace garrison::certificate::detail {

/// Up to so many largest are kept sorted while z is read once: faster than a partition of all of z.
inline constexpr int kFew = 8;

/// Sum of the `count` largest of max(z, 0), the largest first; count <= kFew.
inline double top_few(std::span<const double> z, std::size_t count) noexcept {
  double best[kFew] = {};
  double least = 0.0;  // of those kept
  for (const double v : z) {
    if (!(v > least)) continue;
    std::size_t k = count - 1;
    for (; k > 0 && best[k - 1] < v; --k) best[k] = best[k - 1];
    best[k] = v;
    least = best[count - 1];
  }
  double sum = 0.0;
  for (std::size_t k = 0; k < count; ++k) sum += best[k];
  return sum;
}

/// Sum of the k largest of max(z, 0). May reorder z; does not allocate.
inline double top(std::span<double> z, int k) noexcept {
  if (k <= 0) return 0.0;
  const std::size_t count = std::min(z.size(), static_cast<std::size_t>(k));
  if (count <= static_cast<std::size_t>(kFew)) return count == 0 ? 0.0 : top_few(z, count);
  if (count < z.size())
    std::nth_element(z.begin(), z.begin() + static_cast<std::ptrdiff_t>(count), z.end(), std::greater<>());
  double sum = 0.0;
  for (std::size_t j = 0; j < count; ++j) sum += std::max(z[j], 0.0);
  return sum;
}

}  // namespace garrison::certificate::detail
