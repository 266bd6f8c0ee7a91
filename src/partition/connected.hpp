// SPDX-License-Identifier: Apache-2.0
// Whether everybody can reach everybody, asked of all ranks.
#pragma once

#include "partition/region.hpp"

namespace garrison::partition {

/// Network::require_connected, which every family whose rounds average asks for. All ranks together; the
/// refusal is the same on all. @throws InvalidInput with an agent that is cut off
void require_connected(const Region& region, Exchange& exchange);

}  // namespace garrison::partition
