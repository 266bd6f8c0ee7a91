// SPDX-License-Identifier: Apache-2.0
// Own agents and ghosts of one rank by names, for gains that know these only.
#pragma once

#include <vector>

#include "partition/region.hpp"

namespace garrison::partition {

/// The agents of a rank by name: names 0.. in ascending order of public ids, so that whoever compares two of
/// them finds the same order.
struct Cast {
  std::vector<int> ids;   ///< public id of each name
  std::vector<char> own;  ///< whether it is an agent of this rank

  explicit Cast(const Region& region);
  /// Name of an agent that an own agent hears.
  int name_of(int id) const;
};

}  // namespace garrison::partition
