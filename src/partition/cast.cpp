// SPDX-License-Identifier: Apache-2.0
#include "partition/cast.hpp"

#include <algorithm>

namespace garrison::partition {

Cast::Cast(const Region& region) : ids(region.ids), own(region.ids.size(), 0) {
  std::sort(ids.begin(), ids.end());
  for (int place = 0; place < region.own; ++place)
    own[static_cast<std::size_t>(name_of(region.ids[static_cast<std::size_t>(place)]))] = 1;
}

int Cast::name_of(int id) const {
  return static_cast<int>(std::lower_bound(ids.begin(), ids.end(), id) - ids.begin());
}

}  // namespace garrison::partition
