// SPDX-License-Identifier: Apache-2.0
// An order of the agents in which neighbours are near each other in memory.
#pragma once

#include <span>
#include <vector>

#include "garrison/core/error.hpp"

namespace garrison {

/// Reverse Cuthill-McKee order (position -> id) of an undirected graph given by sorted lists; works for any
/// lists. Linear in the number of edges up to sorting by degree; deterministic.
std::vector<int> reverse_cuthill_mckee(std::span<const int> offsets, std::span<const int> lists);

}  // namespace garrison
