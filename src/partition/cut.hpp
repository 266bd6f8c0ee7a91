// SPDX-License-Identifier: Apache-2.0
// Gains of a whole network, cut down to the agents and ghosts of one rank: what `part` of a family does for
// one agent.
#pragma once

#include <span>

#include "garrison/filters/partial_sharing/filter.hpp"
#include "garrison/filters/rdkf/filter.hpp"
#include "garrison/filters/structural/filter.hpp"
#include "partition/region.hpp"

namespace garrison::partition {

/// The agents of a rank by name: names 0.. in ascending order of public ids, so that whoever compares two of
/// them finds the same order.
struct Cast {
  std::vector<int> ids;   ///< public id of each name
  std::vector<char> own;  ///< whether it is an agent of this rank

  explicit Cast(const Region& region);
  int size() const { return static_cast<int>(ids.size()); }
  /// Name of an agent that an own agent hears.
  int name_of(int id) const;
};

Rdkf::Gains cut(const Rdkf::Gains& all, const Cast& cast);
PartialSharing::Gains cut(const PartialSharing::Gains& all, const Cast& cast);
Structural::Gains cut(const Structural::Gains& all, const Cast& cast);

}  // namespace garrison::partition
