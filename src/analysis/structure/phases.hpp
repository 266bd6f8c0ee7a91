// SPDX-License-Identifier: Apache-2.0
// Maximum matching of deficient patterns: Karp and Sipser's start, then phases of disjoint augmenting paths.
#pragma once

#include "garrison/analysis/structure/matching.hpp"

namespace garrison::structure {

/// Karp, Sipser 1981: a vertex with one neighbour left is matched to it at no loss; without any, the next
/// column takes the free row with the fewest neighbours. Then Pothen and Fan's phases with lookahead and
/// alternating direction (Duff, Kaya, Ucar 2011); what a failed search reaches in a phase without success
/// before it is left out for good.
Matching matching_by_phases(const Pattern& columns, const Pattern& rows);

}  // namespace garrison::structure
