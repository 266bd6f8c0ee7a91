// SPDX-License-Identifier: Apache-2.0
// Strongly connected components of a digraph.
#pragma once

#include <vector>

#include "garrison/analysis/structure/pattern.hpp"

namespace garrison::structure {

/// Component of every vertex, 0..count-1. No link leads from a component to one with a larger number, so
/// components that no link leaves ("parents" in the structural paper) come before those that reach them.
struct GARRISON_EXPORT Components {
  int count = 0;
  std::vector<int> of;

  /// The members of each component, sorted; components in the order of their least member.
  std::vector<std::vector<int>> lists() const;
};

/// Tarjan's algorithm in one pass without recursion, O(vertices + links). Entry (i, j) is the link j -> i.
/// @throws InvalidInput when `links` is not square.
GARRISON_EXPORT Components strong_components(const Pattern& links);

/// Per component: no link leads out of it to another one. A single state without a link counts.
std::vector<char> parents(const Pattern& links, const Components& components);

}  // namespace garrison::structure
