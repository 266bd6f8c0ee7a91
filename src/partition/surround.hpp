// SPDX-License-Identifier: Apache-2.0
// The ghosts around the own agents of a rank, and what each peer needs of these in turn.
#pragma once

#include "partition/region.hpp"

namespace garrison::partition {

/// Completes a region that has its own agents: ghosts up to `depth` hops away, who hears whom, routes.
/// `neighbours`: of the own agents by place; the rest as for `region_of`. @throws InvalidInput when there is
/// too much of it for one rank
void surround(Region& r, Neighbours neighbours, const Lists& lists, std::span<const std::int32_t> owner,
              int rank, int depth);

}  // namespace garrison::partition
