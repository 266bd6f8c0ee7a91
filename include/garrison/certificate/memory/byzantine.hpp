// SPDX-License-Identifier: Apache-2.0
// Which flooded numbers may be believed to be what their owner said, while some agents' software lies.
#pragma once

#include <vector>

#include "garrison/core/error.hpp"

namespace garrison::certificate {

/// The agents that a number went through: its owner first, then the relays.
using Path = std::vector<int>;

/// How many of the paths are disjoint but for the owner, `enough` at most.
int disjoint_paths(const std::vector<Path>& paths, int enough);

/// Unsigned relays, at most `liars` of the agents lie. paths: those that brought the SAME number of one
/// source. True when the owner is a neighbour (a path of one agent) or liars + 1 paths are disjoint: one of
/// them has no liar inside. The budget of the certificates is then s + liars: an owner may lie too.
/// Exponential in the paths only as far as they overlap. @throws InvalidInput for liars < 0, empty paths,
/// paths of different owners
GARRISON_EXPORT bool accepted(const std::vector<Path>& paths, int liars);

}  // namespace garrison::certificate
