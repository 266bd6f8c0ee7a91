// SPDX-License-Identifier: Apache-2.0
// Sets of a given size out of some ids. Internal.
#pragma once

#include <cmath>
#include <span>

namespace garrison::certificate::detail {

/// How many sets of `take` out of `of` there are.
inline double choices(int of, int take) {
  double count = 1.0;
  for (int k = 1; k <= take; ++k) count *= static_cast<double>(of - take + k) / k;
  return std::round(count);
}

/// Calls visit() with each set of `take` of the ids marked `mark` in `part`, in lexicographic order; stops,
/// and returns false, when visit() does.
template <class Part, class Visit>
bool each_choice(std::span<const int> ids, int take, std::span<Part> part, Part mark, const Visit& visit) {
  if (take == 0) return visit();
  for (std::size_t k = 0; k + static_cast<std::size_t>(take) <= ids.size(); ++k) {
    Part& of = part[static_cast<std::size_t>(ids[k])];
    const Part before = of;
    of = mark;
    const bool on = each_choice(ids.subspan(k + 1), take - 1, part, mark, visit);
    of = before;
    if (!on) return false;
  }
  return true;
}

}  // namespace garrison::certificate::detail
